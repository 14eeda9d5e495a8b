// What the tests of choices and ratings would say under other exclusion rules.
#include "analysis/report/html.h"
#include "analysis/report/sections.h"

#include <inttypes.h>
#include <math.h>
#include <string.h>

static void p_cell(FILE *out, double p)
{
    char text[24];
    html_p_value(text, p);
    html_cell(out, "td", "%s", isnan(p) ? "\u2013" : text);
}

static const struct choice_cell *same_cell(const struct choices *in, const struct choice_cell *cell)
{
    for (size_t i = 0; i < in->cell_count; i++) {
        const struct choice_cell *other = &in->cells[i];
        if (other->test == cell->test && other->reference == cell->reference && other->right == cell->right &&
            strcmp(other->block, cell->block) == 0 && strcmp(other->factors, cell->factors) == 0)
            return other;
    }
    return NULL;
}

static void choice_cells(FILE *out, const struct choice_cell *cell)
{
    if (!cell || cell->n == 0) {
        html_cell(out, "td", "none");
        html_cell(out, "td", "\u2013");
        return;
    }
    html_cell(out, "td", "%" PRId64 " of %" PRId64, cell->chosen, cell->n);
    p_cell(out, cell->p_value);
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
    if (!test || n == 0) {
        html_cell(out, "td", "none");
        html_cell(out, "td", "\u2013");
        return;
    }
    html_cell(out, "td", "%+.2f (n %zu)", test->estimate, n);
    p_cell(out, test->p_value);
}

// A comparison of first ratings is that of `like` only where the same two orders are compared.
static void first_cells(FILE *out, const struct rating_question *q, const struct rating_question *like)
{
    bool same = q && q->compared;
    for (size_t i = 0; same && i < 2; i++)
        same = q->groups[i].first_condition == like->groups[i].first_condition;
    test_cells(out, same ? &q->first_between : NULL, same ? q->groups[0].n + q->groups[1].n : 0);
}

static void rating_rows(const struct report *r, const struct rating_question *q)
{
    const struct rating_question *in[3] = {q, same_question(&r->ratings, q),
                                           same_question(&r->stricter.ratings, q)},
                                 *like = NULL;
    FILE *out = r->out;
    for (int i = 0; i < 3 && !like; i++)
        like = in[i] && in[i]->compared ? in[i] : NULL;
    if (like) {
        fputs("<tr>", out);
        html_cell(out, "th scope=\"row\" class=\"word\"", "%s: first ratings, %s minus %s", q->question,
                  report_label(r, like->groups[0].first_condition),
                  report_label(r, like->groups[1].first_condition));
        for (int i = 0; i < 3; i++)
            first_cells(out, in[i], like);
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
        char words[384];
        rating_option_words(r->sample, &q->cells[k], words);
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

// By name: under other rules another factor may have lost all but one level. NULL where there is none.
static const struct stat_anova_effect *find_effect(const struct ratings *in, const struct factorial *f,
                                                   const char *name, size_t *out_people)
{
    char other[256];
    for (size_t i = 0; i < in->factorials.count; i++) {
        const struct factorial *g = &in->factorials.items[i];
        if (strcmp(g->question, f->question) != 0 || strcmp(g->block, f->block) != 0)
            continue;
        *out_people = g->people;
        for (size_t k = 0; k < g->anova.effect_count; k++) {
            factorial_effect_name(g, g->anova.effects[k].factors, " \u00d7 ", other);
            if (strcmp(other, name) == 0)
                return &g->anova.effects[k];
        }
    }
    return NULL;
}

static void effect_cells(FILE *out, const struct stat_anova_effect *e, size_t people)
{
    if (!e)
        html_cell(out, "td", "none");
    else if (isnan(e->f))
        html_cell(out, "td", "no F (n %zu)", people);
    else
        html_cell(out, "td", "F = %.2f (n %zu)", e->f, people);
    p_cell(out, e ? e->p_gg : (double)NAN);
}

// Of the rules `set` those effects that no set before it has: an analysis may become possible by an exclusion.
static void effect_rows(const struct report *r, const struct factorial *f, const struct ratings *const in[3],
                        int set)
{
    for (size_t k = 0; k < f->anova.effect_count; k++) {
        const struct stat_anova_effect *effects[3];
        size_t people[3] = {0};
        char name[256];
        bool known = false;
        factorial_effect_name(f, f->anova.effects[k].factors, " \u00d7 ", name);
        for (int i = 0; i < 3; i++) {
            effects[i] = find_effect(in[i], f, name, &people[i]);
            known = known || (effects[i] && i < set);
        }
        if (known)
            continue;
        fputs("<tr>", r->out);
        html_cell(r->out, "th scope=\"row\" class=\"word\"", "%s, %s: %s", f->question, f->block, name);
        for (int i = 0; i < 3; i++)
            effect_cells(r->out, effects[i], people[i]);
        fputs("</tr>\n", r->out);
    }
}

static void choice_rows(const struct report *r)
{
    for (size_t i = 0; i < r->all.choices.cell_count; i++) {
        const struct choice_cell *cell = &r->all.choices.cells[i];
        char words[256];
        report_cell_words(cell, words);
        fputs("<tr>", r->out);
        html_cell(r->out, "th scope=\"row\" class=\"word\"", "%s", words);
        choice_cells(r->out, cell);
        choice_cells(r->out, same_cell(&r->choices, cell));
        choice_cells(r->out, same_cell(&r->stricter.choices, cell));
        fputs("</tr>\n", r->out);
    }
}

// Every test once: cells and questions of all data hold those of the others.
void report_what_if(const struct report *r)
{
    const struct ratings *const ratings[3] = {&r->all.ratings, &r->ratings, &r->stricter.ratings};
    if (r->sample->exclusion_count == 0)
        return;
    fputs("<h3>What if</h3>\n<p>The same tests on all data, under the rules that hold (planned and late), and "
          "with the stricter ones too. In brackets: people, of thresholds those who have one. A dash: no "
          "p.</p>\n<div class=\"table\" tabindex=\"0\" role=\"region\" "
          "aria-label=\"What if\"><table class=\"wrap\">\n<caption>Answers for the test option or right ones, "
          "difference of ratings, F, threshold or JOD, and p (of F: p GG)</caption>\n<thead><tr><th "
          "scope=\"col\" class=\"word\">test</th><th scope=\"col\">all data</th><th scope=\"col\">p</th><th "
          "scope=\"col\">these rules</th><th scope=\"col\">p</th><th scope=\"col\">stricter</th><th "
          "scope=\"col\">p</th></tr></thead>\n<tbody>\n",
          r->out);
    choice_rows(r);
    for (size_t i = 0; i < r->all.ratings.question_count; i++)
        rating_rows(r, &r->all.ratings.questions[i]);
    for (size_t i = 0; i < r->all.ratings.options.count; i++)
        option_rows(r, &r->all.ratings.options.items[i]);
    for (int set = 0; set < 3; set++)
        for (size_t i = 0; i < ratings[set]->factorials.count; i++)
            effect_rows(r, &ratings[set]->factorials.items[i], ratings, set);
    report_what_if_scales(r);
    fputs("</tbody></table></div>\n", r->out);
    report_what_if_notes(r);
}
