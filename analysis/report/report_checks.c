// Null and catch trials, and what the tests would say under other exclusion rules.
#include "analysis/report/html.h"
#include "analysis/report/level.h"
#include "analysis/report/sections.h"

#include <inttypes.h>
#include <math.h>
#include <string.h>

static void p_words(const struct report *r, const char *test, const struct check_bias *b)
{
    char p[24], holm[24];
    html_p_value(p, b->p_value);
    html_p_value(holm, b->holm);
    html_printf(r->out, "%s p %s%s, with Holm\u2019s correction for these two checks %s). ", test,
                p[0] == '<' ? "" : "= ", p, holm);
}

static void bias_sentence(const struct report *r, const char *what, const struct check_bias *b)
{
    const struct stat_binomial *all = &b->binomial;
    html_printf(r->out, "%s was chosen in %" PRId64 " of %" PRId64, what, all->k, all->n);
    if (!b->several) {
        html_printf(r->out, " (%.1f\u00a0%%, %g\u00a0%% interval %.1f to %.1f\u00a0%%, ", 100 * all->estimate,
                    100 * r->conf, 100 * all->ci.low, 100 * all->ci.high);
        p_words(r, "exact", b);
        return;
    }
    html_printf(r->out, "; mean of the shares of %zu %s %.1f\u00a0%% (", b->people,
                b->people == 1 ? "person" : "people", 100 * b->estimate);
    if (isnan(b->t.ci_low))
        fputs("no interval can be estimated, ", r->out);
    else
        html_printf(r->out, "%g\u00a0%% t interval %.1f to %.1f\u00a0%%, ", 100 * r->conf, 100 * b->t.ci_low,
                    100 * b->t.ci_high);
    if (isnan(b->p_value))
        fputs("one person cannot be tested). ", r->out);
    else
        p_words(r, "exact sign-flip", b);
}

static void people_table(const struct report *r)
{
    FILE *out = r->out;
    const struct checks *c = &r->checks;
    fputs("<div class=\"table\" tabindex=\"0\" role=\"region\" aria-label=\"Null and catch "
          "trials\"><table>\n<caption>"
          "Null and catch trials per person</caption>\n<thead><tr><th scope=\"col\" "
          "class=\"word\">participant</th>"
          "<th scope=\"col\">null trials, slot a chosen</th><th scope=\"col\">catch trials "
          "missed</th></tr></thead>\n"
          "<tbody>\n",
          out);
    for (size_t i = 0; i < c->person_count; i++) {
        const struct check_person *p = &c->people[i];
        fputs("<tr>", out);
        html_cell(out, "th scope=\"row\" class=\"word\"", "%s%s", r->sample->people[p->person].code,
                  p->excluded ? " (excluded)" : "");
        if (p->nulls)
            html_cell(out, "td", "%" PRId64 " of %" PRId64, p->null_a, p->nulls);
        else
            html_cell(out, "td", "\u2013");
        if (p->catches)
            html_cell(out, "td", "%" PRId64 " of %" PRId64, p->missed, p->catches);
        else
            html_cell(out, "td", "\u2013");
        fputs("</tr>\n", out);
    }
    fputs("</tbody></table></div>\n", out);
}

void report_checks(const struct report *r)
{
    const struct checks *c = &r->checks;
    if (c->person_count == 0)
        return;
    report_heading(r, "Null and catch trials");
    fputs("<p>", r->out);
    if (c->nulls) {
        html_printf(
            r->out,
            "In null trials both options are the same, so a side that is chosen more often is a bias. ");
        bias_sentence(r, "Slot a", &c->side);
        bias_sentence(r, "The option shown first", &c->first);
        fputs("A large p does not show that there is no bias. ", r->out);
    }
    if (c->null_equal)
        html_printf(r->out, "\u201cEqual\u201d was answered in %" PRId64 " null trials. ", c->null_equal);
    if (c->catches)
        html_printf(r->out, "Of %" PRId64 " catch trials with an obvious difference %" PRId64 " were missed.",
                    c->catches, c->missed);
    fputs("</p>\n", r->out);
    people_table(r);
}

// --- what if ---

static const struct choice_cell *same_cell(const struct choices *in, const struct choice_cell *cell)
{
    for (size_t i = 0; i < in->cell_count; i++) {
        const struct choice_cell *other = &in->cells[i];
        if (other->test == cell->test && other->reference == cell->reference &&
            strcmp(other->block, cell->block) == 0 && strcmp(other->factors, cell->factors) == 0)
            return other;
    }
    return NULL;
}

static void choice_cells(FILE *out, const struct choice_cell *cell)
{
    char p[24];
    if (!cell || cell->n == 0) {
        html_cell(out, "td", "none");
        html_cell(out, "td", "\u2013");
        return;
    }
    html_p_value(p, cell->p_value);
    html_cell(out, "td", "%" PRId64 " of %" PRId64, cell->chosen, cell->n);
    html_cell(out, "td", "%s", p);
}

static const struct rating_question *same_question(const struct ratings *in, const struct rating_question *q)
{
    for (size_t i = 0; i < in->question_count; i++)
        if (strcmp(in->questions[i].question, q->question) == 0)
            return &in->questions[i];
    return NULL;
}

static const struct rating_group *same_group(const struct rating_question *q, const struct rating_group *group)
{
    for (size_t i = 0; q && i < q->group_count; i++)
        if (q->groups[i].first_condition == group->first_condition &&
            q->groups[i].second_condition == group->second_condition)
            return &q->groups[i];
    return NULL;
}

static void test_cells(FILE *out, const struct stat_ttest *test, size_t n)
{
    char p[24];
    if (!test || n == 0) {
        html_cell(out, "td", "none");
        html_cell(out, "td", "\u2013");
        return;
    }
    html_p_value(p, test->p_value);
    html_cell(out, "td", "%+.2f (n %zu)", test->estimate, n);
    html_cell(out, "td", "%s", p);
}

static size_t compared(const struct rating_question *q)
{
    return q && q->compared ? q->groups[0].n + q->groups[1].n : 0;
}

static void rating_rows(const struct report *r, const struct rating_question *q)
{
    const struct rating_question *in[3] = {q, same_question(&r->ratings, q),
                                           same_question(&r->stricter.ratings, q)};
    FILE *out = r->out;
    if (q->compared) {
        fputs("<tr>", out);
        html_cell(out, "th scope=\"row\" class=\"word\"", "%s: first ratings compared", q->question);
        for (int i = 0; i < 3; i++)
            test_cells(out, in[i] ? &in[i]->first_between : NULL, compared(in[i]));
        fputs("</tr>\n", out);
    }
    for (size_t k = 0; k < q->group_count; k++) {
        fputs("<tr>", out);
        html_cell(out, "th scope=\"row\" class=\"word\"", "%s: change from %s to %s", q->question,
                  report_label(r, q->groups[k].first_condition),
                  report_label(r, q->groups[k].second_condition));
        for (int i = 0; i < 3; i++) {
            const struct rating_group *group = same_group(in[i], &q->groups[k]);
            test_cells(out, group ? &group->change : NULL, group ? group->n : 0);
        }
        fputs("</tr>\n", out);
    }
}

static const struct rating_option_cell *same_option_cell(const struct ratings *in, const char *question,
                                                         const struct rating_option_cell *cell)
{
    for (size_t i = 0; i < in->options.count; i++)
        for (size_t k = 0; k < in->options.items[i].cell_count; k++) {
            const struct rating_option_cell *other = &in->options.items[i].cells[k];
            if (strcmp(in->options.items[i].question, question) == 0 && other->test == cell->test &&
                other->reference == cell->reference && strcmp(other->block, cell->block) == 0 &&
                strcmp(other->factors, cell->factors) == 0)
                return other;
        }
    return NULL;
}

static void option_rows(const struct report *r, const struct rating_options *q)
{
    const struct ratings *in[3] = {&r->all.ratings, &r->ratings, &r->stricter.ratings};
    for (size_t k = 0; k < q->cell_count; k++) {
        char words[256];
        level_all(r->sample, q->cells[k].factors, words);
        fputs("<tr>", r->out);
        html_cell(r->out, "th scope=\"row\" class=\"word\"", "%s: %s less %s%s%s", q->question,
                  report_label(r, q->cells[k].test), report_label(r, q->cells[k].reference),
                  words[0] ? ", " : "", words);
        for (int i = 0; i < 3; i++) {
            const struct rating_option_cell *cell = same_option_cell(in[i], q->question, &q->cells[k]);
            test_cells(r->out, cell ? &cell->difference : NULL, cell ? cell->n : 0);
        }
        fputs("</tr>\n", r->out);
    }
}

// By name: under other rules another factor may have lost all but one level.
static void effect_cells(FILE *out, const struct ratings *in, const struct factorial *f, const char *name)
{
    char other[256], p[24];
    for (size_t i = 0; i < in->factorials.count; i++) {
        const struct factorial *g = &in->factorials.items[i];
        if (strcmp(g->question, f->question) != 0 || strcmp(g->block, f->block) != 0)
            continue;
        for (size_t k = 0; k < g->anova.effect_count; k++) {
            const struct stat_anova_effect *e = &g->anova.effects[k];
            factorial_effect_name(g, e->factors, " \u00d7 ", other);
            if (strcmp(other, name) != 0 || isnan(e->f))
                continue;
            html_p_value(p, e->p_gg);
            html_cell(out, "td", "F = %.2f (n %zu)", e->f, g->people);
            html_cell(out, "td", "%s", p);
            return;
        }
    }
    html_cell(out, "td", "none");
    html_cell(out, "td", "\u2013");
}

static void effect_rows(const struct report *r, const struct factorial *f)
{
    for (size_t k = 0; k < f->anova.effect_count; k++) {
        char name[256];
        factorial_effect_name(f, f->anova.effects[k].factors, " \u00d7 ", name);
        fputs("<tr>", r->out);
        html_cell(r->out, "th scope=\"row\" class=\"word\"", "%s, %s: %s", f->question, f->block, name);
        effect_cells(r->out, &r->all.ratings, f, name);
        effect_cells(r->out, &r->ratings, f, name);
        effect_cells(r->out, &r->stricter.ratings, f, name);
        fputs("</tr>\n", r->out);
    }
}

// Every test once: cells and questions of all data hold those of the others.
void report_what_if(const struct report *r)
{
    FILE *out = r->out;
    const struct choices *all = &r->all.choices;
    if (r->sample->exclusion_count == 0)
        return;
    fputs("<h3>What if</h3>\n<p>The same tests on all data, under the rules that hold (planned and late), and "
          "with "
          "the stricter ones too.</p>\n<div class=\"table\" tabindex=\"0\" role=\"region\" aria-label=\"What "
          "if\">"
          "<table class=\"wrap\">\n<caption>Answers for the test option, difference of ratings or F, and "
          "p (of F: p GG)</caption>\n"
          "<thead><tr><th scope=\"col\" class=\"word\">test</th><th scope=\"col\">all data</th><th "
          "scope=\"col\">p</th>"
          "<th scope=\"col\">these rules</th><th scope=\"col\">p</th><th scope=\"col\">stricter</th>"
          "<th scope=\"col\">p</th></tr></thead>\n<tbody>\n",
          out);
    for (size_t i = 0; i < all->cell_count; i++) {
        const struct choice_cell *cell = &all->cells[i];
        char words[256];
        if (cell->level_count)
            level_join(cell, 0, cell->level_count, words);
        else
            snprintf(words, sizeof words, "%s", cell->label);
        fputs("<tr>", out);
        html_cell(out, "th scope=\"row\" class=\"word\"", "%s", words);
        choice_cells(out, cell);
        choice_cells(out, same_cell(&r->choices, cell));
        choice_cells(out, same_cell(&r->stricter.choices, cell));
        fputs("</tr>\n", out);
    }
    for (size_t i = 0; i < r->all.ratings.question_count; i++)
        rating_rows(r, &r->all.ratings.questions[i]);
    for (size_t i = 0; i < r->all.ratings.options.count; i++)
        option_rows(r, &r->all.ratings.options.items[i]);
    for (size_t i = 0; i < r->all.ratings.factorials.count; i++)
        effect_rows(r, &r->all.ratings.factorials.items[i]);
    report_what_if_scales(r);
    fputs("</tbody></table></div>\n", out);
}
