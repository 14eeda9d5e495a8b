// Thresholds of staircases, adjusted values, and preferences on one scale.
#include "analysis/report/html.h"
#include "analysis/report/level.h"
#include "analysis/report/sections.h"

#include <inttypes.h>
#include <math.h>
#include <string.h>

static void number_td(FILE *out, double value)
{
    if (isnan(value))
        html_cell(out, "td", "\u2013");
    else
        html_cell(out, "td", "%.3g", value);
}

static void interval_td(FILE *out, double low, double high)
{
    if (isnan(low) || isnan(high))
        html_cell(out, "td", "\u2013");
    else
        html_cell(out, "td", "%.3g to %.3g", low, high);
}

static void open_table(FILE *out, const char *label, const char *caption)
{
    fputs("<div class=\"table\" tabindex=\"0\" role=\"region\" aria-label=\"", out);
    html_text(out, label);
    fputs("\"><table class=\"wrap\">\n<caption>", out);
    html_text(out, caption);
    fputs("</caption>\n<thead><tr>", out);
}

static void headings(FILE *out, const char *const *names)
{
    for (; *names; names++)
        html_cell(out, (*names)[0] == '<' ? "th scope=\"col\" class=\"word\"" : "th scope=\"col\"", "%s",
                  (*names)[0] == '<' ? *names + 1 : *names);
    fputs("</tr></thead>\n<tbody>\n", out);
}

// --- staircases ---

static void mean_rows(const struct report *r, const struct threshold_cell *cell)
{
    const struct {
        const char *what;
        const struct threshold_mean *mean;
    } rows[] = {{cell->quest ? "QUEST+" : "reversals", &cell->by_staircase},
                {"maximum likelihood", &cell->by_fit},
                {"Bayes", &cell->by_bayes}};
    FILE *out = r->out;
    for (size_t i = 0; i < 3; i++) {
        const struct threshold_mean *m = rows[i].mean;
        bool none = i > 0 ? cell->graded : cell->source == THRESHOLD_LEVELS;
        if (none || cell->pooled)
            continue;
        fputs("<tr>", out);
        html_cell(out, "th scope=\"row\" class=\"word\"", "%s", cell->words);
        html_cell(out, "td class=\"word\"", "%s", rows[i].what);
        html_cell(out, "td", "%zu of %zu", m->of.n, cell->person_count);
        number_td(out, m->of.mean);
        number_td(out, m->of.sd);
        number_td(out, m->median);
        interval_td(out, m->t.ci_low, m->t.ci_high);
        fputs("</tr>\n", out);
    }
}

static void note_td(FILE *out, const struct threshold_cell *cell, const struct threshold_person *p)
{
    const struct stat_fit *fit = &p->fit;
    if (cell->graded)
        html_cell(out, "td class=\"word\"", "not fitted: answers on a scale");
    else if (fit->status == STAT_FIT_STEP)
        html_cell(out, "td class=\"word\"", "not estimable: a jump between %.3g and %.3g", fit->step.low,
                  fit->step.high);
    else if (fit->status != STAT_FIT_OK)
        html_cell(out, "td class=\"word\"", "not estimable: %s", stat_fit_reason(fit->status));
    else
        html_cell(out, "td class=\"word\"", "%s", "");
}

static void people_table(const struct report *r, const struct threshold_cell *cell)
{
    char caption[256], profile[48], credible[48];
    FILE *out = r->out;
    bool staircase = cell->source == THRESHOLD_STAIRCASES;
    snprintf(caption, sizeof caption, "%s%s%.200s", cell->pooled ? "All people together" : "Each person",
             strcmp(cell->words, "all") ? ", " : "", strcmp(cell->words, "all") ? cell->words : "");
    snprintf(profile, sizeof profile, "%g\u00a0%% profile", 100 * r->conf);
    snprintf(credible, sizeof credible, "%g\u00a0%% credible", 100 * r->conf);
    const char *const names[] = {"<participant", "steps", cell->quest ? "QUEST+" : "reversals",
                                 "likelihood",   profile, "Bayes",
                                 credible,       "<note", NULL};
    const char *const of_levels[] = {"<participant", "answers", "likelihood", profile,
                                     "Bayes",        credible,  "<note",      NULL};
    open_table(out, caption, caption);
    headings(out, staircase ? names : of_levels);
    for (size_t i = 0; i < cell->person_count; i++) {
        const struct threshold_person *p = &cell->people[i];
        bool ok = p->fit.status == STAT_FIT_OK;
        fputs("<tr>", out);
        if (cell->pooled)
            html_cell(out, "th scope=\"row\" class=\"word\"", "%zu people", cell->pooled);
        else
            html_cell(out, "th scope=\"row\" class=\"word\"", "%s", r->sample->people[p->person].code);
        html_cell(out, "td", "%zu", p->step_count);
        if (staircase)
            number_td(out, p->estimate);
        number_td(out, ok ? p->fit.function.threshold : (double)NAN);
        interval_td(out, ok ? p->fit.threshold.low : (double)NAN, p->fit.threshold.high);
        number_td(out, p->bayes.threshold.mean);
        interval_td(out, p->bayes.threshold.credible.low, p->bayes.threshold.credible.high);
        note_td(out, cell, p);
        fputs("</tr>\n", out);
    }
    fputs("</tbody></table></div>\n", out);
}

static void staircase_words(const struct report *r)
{
    fputs("<p>", r->out);
    html_printf(
        r->out,
        "A staircase\u2019s own estimate is the mean of its last reversals (up-down) or the posterior mean "
        "(QUEST+). Likelihood and Bayes are logistic functions fitted to all answers of a person, the guess "
        "fixed at one half (of preferences both asymptotes free); their threshold lies midway between the "
        "asymptotes (75\u00a0%% right without lapses), "
        "which "
        "is not where a 1-up/2-down staircase settles (70.7\u00a0%%). Likelihood: lapse at most 0.06 (of "
        "preferences 0.5), profile "
        "intervals. Bayes: priors of Sch\u00fctt et al. 2016, overdispersed answers. Means and their t "
        "intervals are over people; people without an estimate are not in them, and not by chance. Where "
        "several people answered once each at a level, they share one function, without intervals: a "
        "person\u2019s answers are not independent.");
    fputs("</p>\n", r->out);
}

static const char *const figure_caption =
    "<span class=\"key\" style=\"background:#e8912d\"></span> Percent of right answers by level, larger for "
    "more "
    "answers, all people together for the eye only. Thin lines: each person\u2019s fitted function where it is "
    "estimable. <span class=\"key\" style=\"background:#2f6da8\"></span> Each person\u2019s threshold by the "
    "staircase. <span class=\"key\" style=\"background:#cfe6d2\"></span> Their mean with its interval.";

static const char *const levels_caption =
    "<span class=\"key\" style=\"background:#e8912d\"></span> Percent of right answers, or of answers for the "
    "test option, by level, larger for more answers, all people together. Thin lines: fitted functions where "
    "they "
    "are estimable.";

static bool same_group(const struct threshold_cell *a, const struct threshold_cell *b)
{
    return a->source == b->source && a->preference == b->preference && strcmp(a->block, b->block) == 0 &&
           strcmp(a->parameter, b->parameter) == 0;
}

// The heading of a block and its means over people.
static void open_group(const struct report *r, size_t first)
{
    const struct thresholds *t = &r->thresholds;
    const struct threshold_cell *cell = &t->cells[first];
    char parameter[96], ci[48];
    level_name(cell->parameter, parameter);
    fputs("<h3>", r->out);
    html_printf(r->out, "Block \u201c%s\u201d, %s%s", cell->block, parameter,
                cell->preference                   ? ": preferences for the test option"
                : cell->source == THRESHOLD_LEVELS ? ": right answers"
                                                   : "");
    fputs("</h3>\n", r->out);
    if (cell->pooled)
        return;
    snprintf(ci, sizeof ci, "%g\u00a0%% interval of M", 100 * r->conf);
    const char *const names[] = {"<cell", "<threshold by", "people", "M", "SD", "median", ci, NULL};
    open_table(r->out, "Thresholds over people", "Thresholds over people");
    headings(r->out, names);
    for (size_t j = first; j < t->cell_count && same_group(cell, &t->cells[j]); j++)
        mean_rows(r, &t->cells[j]);
    fputs("</tbody></table></div>\n", r->out);
}

static void report_staircases(const struct report *r)
{
    const struct thresholds *t = &r->thresholds;
    if (t->cell_count == 0)
        return;
    report_heading(r, "Thresholds");
    staircase_words(r);
    for (size_t i = 0; i < t->cell_count; i++) {
        const struct threshold_cell *cell = &t->cells[i];
        if (i == 0 || !same_group(cell, &t->cells[i - 1]))
            open_group(r, i);
        if (strcmp(cell->words, "all") != 0) {
            fputs("<p><strong>", r->out);
            html_text(r->out, cell->words);
            fputs("</strong></p>\n", r->out);
        }
        if (i < REPORT_STAIRCASES)
            report_figure(r, &r->threshold_figures[i],
                          cell->source == THRESHOLD_LEVELS ? levels_caption : figure_caption);
        people_table(r, cell);
        for (size_t j = 0; j < cell->person_count; j++)
            if (cell->people[j].bayes.rough) {
                fputs("<p class=\"note\">", r->out);
                html_printf(r->out,
                            "%s: the sum over the posterior did not settle; Bayes may be off by more than "
                            "0.5\u00a0%% of its interval.",
                            cell->pooled ? "All people" : r->sample->people[cell->people[j].person].code);
                fputs("</p>\n", r->out);
            }
        if (cell->prior_bound && !cell->pooled)
            fprintf(
                r->out,
                "<p>Bayes: the interval of %zu of %zu people reaches beyond the levels shown, where the prior "
                "decides.</p>\n",
                cell->prior_bound, cell->by_bayes.of.n);
    }
    if (t->excluded + t->not_done)
        fprintf(r->out,
                "<p>Steps left out of the fits: %" PRId64 " of excluded trials, %" PRId64
                " of trials that are not done.</p>\n",
                t->excluded, t->not_done);
    if (t->not_finite)
        fprintf(r->out, "<p class=\"note\">Left out, levels that are not finite: %" PRId64 ".</p>\n",
                t->not_finite);
}

// --- adjusted values ---

static void report_adjusted(const struct report *r)
{
    const struct adjusted *a = &r->adjusted;
    FILE *out = r->out;
    if (a->cell_count == 0)
        return;
    report_heading(r, "Adjusted values");
    fputs("<p>What people set parameters to. A person\u2019s repeats are averaged "
          "first; "
          "means and their t intervals are over people.</p>\n",
          out);
    report_figure(r, &r->adjusted_figure,
                  "Each gray dot is a person\u2019s mean; beside them the mean over people with its "
                  "interval.");
    char ci[48];
    snprintf(ci, sizeof ci, "%g\u00a0%% interval of M", 100 * r->conf);
    const char *const names[] = {"<parameter", "<cell", "people", "M", "SD", "median", ci, NULL};
    open_table(out, "Adjusted values over people", "Adjusted values over people");
    headings(out, names);
    for (size_t i = 0; i < a->cell_count; i++) {
        const struct adjusted_cell *cell = &a->cells[i];
        const struct threshold_mean *m = &cell->over_people;
        char parameter[96];
        level_name(cell->parameter, parameter);
        fputs("<tr>", out);
        html_cell(out, "th scope=\"row\" class=\"word\"", "%s", parameter);
        html_cell(out, "td class=\"word\"", "%s", cell->words);
        html_cell(out, "td", "%zu", cell->person_count);
        number_td(out, m->of.mean);
        number_td(out, m->of.sd);
        number_td(out, m->median);
        interval_td(out, m->t.ci_low, m->t.ci_high);
        fputs("</tr>\n", out);
    }
    fputs("</tbody></table></div>\n", out);
}

// --- preferences on one scale ---

// True where an interval has an open end.
static bool jod_rows(const struct report *r, const struct jod_block *b)
{
    FILE *out = r->out;
    bool open = false;
    for (size_t place = 0; place < b->option_count; place++) {
        size_t i = b->order[place];
        const struct stat_jod *s = &b->scores[i];
        char interval[64];
        fputs("<tr>", out);
        html_cell(out, "th scope=\"row\" class=\"word\"", "%s", report_label(r, b->options[i]));
        html_cell(out, "td", "%" PRId64 " of %" PRId64, s->won, s->n);
        if (isnan(s->score))
            html_cell(out, "td", "\u2013");
        else
            html_cell(out, "td", "%.2f", s->score);
        jod_interval_text(s, 2, interval);
        html_cell(out, "td", "%s", interval[0] ? interval : "\u2013");
        html_cell(out, "td class=\"word\"", "%s", jod_reason(s));
        fputs("</tr>\n", out);
        open = open || jod_open(s);
    }
    fputs("</tbody></table></div>\n", out);
    return open;
}

static void report_jod(const struct report *r)
{
    FILE *out = r->out;
    if (r->jod.block_count == 0)
        return;
    report_heading(r, "Preferences on one scale");
    fputs(
        "<p>Just-objectionable differences (JOD) from the reference, by "
        "Thurstone\u2019s case V and maximum likelihood: one JOD apart is 75&nbsp;% preference, negative is "
        "worse. "
        "Scenes are put together. Intervals by a bootstrap over people. What no chain of answers prefers to "
        "the "
        "reference, or the reference to, has no place on the scale without a prior, and none is assumed.</p>\n",
        out);
    char ci[48];
    snprintf(ci, sizeof ci, "%g\u00a0%% interval", 100 * r->conf);
    bool open = false;
    const char *const names[] = {"<option", "preferred", "JOD", ci, "<note", NULL};
    for (size_t i = 0; i < r->jod.block_count; i++) {
        const struct jod_block *b = &r->jod.blocks[i];
        char caption[256];
        snprintf(caption, sizeof caption, "Block \u201c%.100s\u201d: %zu %s by %" PRId64 " %s", b->block,
                 b->answer_count, b->answer_count == 1 ? "comparison" : "comparisons", b->persons,
                 b->persons == 1 ? "person" : "people");
        open_table(out, caption, caption);
        headings(out, names);
        open = jod_rows(r, b) || open;
    }
    if (open)
        fprintf(
            out,
            "<p>An interval \u201cbelow\u201d or \u201cabove\u201d a number has no other end: in more than "
            "%.3g&nbsp;%% of the resampled studies no chain of answers preferred the option to the reference, "
            "or none the reference to it, which puts it beyond every number.</p>\n",
            50 * (1 - r->conf));
}

void report_thresholds(const struct report *r)
{
    report_staircases(r);
    report_adjusted(r);
    report_jod(r);
}
