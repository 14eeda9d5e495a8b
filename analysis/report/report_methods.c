// The paragraph of methods, as a paper wants it: what was done with these data, and nothing that was not.
#include "analysis/report/html.h"
#include "analysis/report/sections.h"

#include <math.h>

// Parts with commas between them and "and" before the last.
static void join(FILE *out, const char *const *parts, size_t count)
{
    for (size_t i = 0; i < count; i++)
        fprintf(out, "%s%s", i == 0 ? "" : i + 1 == count ? " and " : ", ", parts[i]);
}

static void factor_intervals(const struct report *r, const bool *shown)
{
    if (shown[FACTOR_MCNEMAR])
        fputs("The interval of a difference within people of one answer each is Fay and Lumbard\u2019s (2021), "
              "which agrees with McNemar\u2019s exact test. ",
              r->out);
    if (shown[FACTOR_FISHER])
        fputs("The interval of a difference between people of one answer each is Newcombe\u2019s. ", r->out);
    if (shown[FACTOR_EXCHANGE])
        fputs("The interval of a difference between people of several answers is Welch\u2019s. ", r->out);
}

static void factor_methods(const struct report *r)
{
    static const char *const words[] = {
        [FACTOR_FISHER] = "between people by Fisher\u2019s exact test of one answer each",
        [FACTOR_EXCHANGE] = "between people by exchanging whole people",
        [FACTOR_MCNEMAR] = "within people by McNemar\u2019s exact test of one answer each",
        [FACTOR_COCHRAN] = "within people by Cochran\u2019s Q of one answer each (by permutation)"};
    enum { METHODS = sizeof words / sizeof words[0] };
    bool used[METHODS] = {false}, shown[METHODS] = {false}, contrasts = false;
    const char *parts[METHODS + 1];
    size_t count = 0;
    for (size_t i = 0; i < r->factors.count; i++) {
        const struct choice_factor_test *x = &r->factors.tests[i];
        used[x->method] = used[x->method] || !isnan(x->p_value);
        shown[x->method] = shown[x->method] || !isnan(x->ci.low);
    }
    for (size_t i = 0; i < r->choices.contrast_count; i++)
        contrasts = contrasts || !isnan(r->choices.contrasts[i].t.p_value);
    for (size_t i = 0; i < METHODS; i++)
        if (used[i])
            parts[count++] = words[i];
    if (contrasts)
        parts[count++] =
            "within people of several answers by a t-test of each person\u2019s difference of shares";
    if (count == 0)
        return;
    fputs("Levels of a factor were compared in cells that are otherwise the same, between or within people as "
          "their trials were planned: ",
          r->out);
    join(r->out, parts, count);
    fputs(". ", r->out);
    factor_intervals(r, shown);
}

static void order_methods(const struct report *r)
{
    bool between = false, within = false;
    for (size_t i = 0; i < r->ratings.question_count; i++) {
        const struct rating_question *q = &r->ratings.questions[i];
        between = between || (q->compared && !isnan(q->first_between.p_value));
        for (size_t k = 0; k < q->group_count; k++)
            within = within || !isnan(q->groups[k].change.p_value);
    }
    if (between)
        fputs("First ratings were compared between the two order groups by Welch\u2019s t-test. ", r->out);
    if (within)
        fputs("Second ratings were compared with the first ones within each order group by a paired t-test and "
              "by Wilcoxon\u2019s signed-rank test (exact with ties, zeros dropped). ",
              r->out);
}

static void rating_methods(const struct report *r)
{
    size_t pairs = 0, analysed = 0, followed = 0, left_out = 0;
    order_methods(r);
    for (size_t i = 0; i < r->ratings.options.count; i++)
        for (size_t k = 0; k < r->ratings.options.items[i].cell_count; k++)
            pairs += isnan(r->ratings.options.items[i].cells[k].difference.p_value) ? 0 : 1;
    for (size_t i = 0; i < r->ratings.factorials.count; i++) {
        const struct factorial *f = &r->ratings.factorials.items[i];
        analysed += !f->refusal[0];
        left_out += f->refusal[0] ? 0 : f->left_count;
        for (size_t k = 0; !f->refusal[0] && k < f->factor_count; k++)
            followed += f->factors[k].pair_count;
    }
    if (pairs)
        html_printf(
            r->out,
            "Ratings of both options of a trial were compared within people by paired t-tests%s, and by "
            "Wilcoxon\u2019s signed-rank test. ",
            pairs > 1 ? " with Holm\u2019s adjustment over cells" : "");
    if (analysed)
        fputs("Ratings over crossed factors were averaged per person and cell and analysed by a full factorial "
              "analysis of variance within participants; sphericity is not tested but always corrected for, "
              "and Greenhouse\u2013Geisser\u2019s p decides. ",
              r->out);
    if (followed)
        fputs("Levels of factors with an effect were compared by paired t-tests with Holm\u2019s adjustment. ",
              r->out);
    if (left_out)
        fputs("People without a rating in every cell are left out of it. ", r->out);
}

static void null_methods(const struct report *r)
{
    const struct check_bias *const all[] = {&r->checks.side, &r->checks.first};
    bool exact = false, flip = false;
    for (size_t i = 0; i < sizeof all / sizeof all[0]; i++) {
        bool tested = r->checks.nulls > 0 && !isnan(all[i]->p_value);
        exact = exact || (tested && !all[i]->several);
        flip = flip || (tested && all[i]->several);
    }
    if (exact || flip)
        html_printf(r->out, "Choices in null trials were held against one half by the exact %s%s%s. ",
                    exact ? "binomial test" : "", exact && flip ? " and the exact " : "",
                    flip ? "sign-flip test over people" : "");
}

// Whether any effect size is printed.
static bool any_effect_size(const struct ratings *ratings)
{
    bool any = false;
    for (size_t i = 0; i < ratings->question_count; i++) {
        any = any || (ratings->questions[i].compared && !isnan(ratings->questions[i].between_effect.d));
        for (size_t k = 0; k < ratings->questions[i].group_count; k++)
            any = any || !isnan(ratings->questions[i].groups[k].effect.d);
    }
    for (size_t i = 0; i < ratings->options.count; i++)
        for (size_t k = 0; k < ratings->options.items[i].cell_count; k++)
            any = any || !isnan(ratings->options.items[i].cells[k].effect.d);
    for (size_t i = 0; i < ratings->factorials.count; i++)
        for (size_t k = 0; k < ratings->factorials.items[i].factor_count; k++)
            any = any || ratings->factorials.items[i].factors[k].pair_count > 0;
    return any;
}

// What the section "Effects on choices that are no preference" tests.
static void effect_methods(const struct report *r)
{
    bool flip = false, t = false;
    for (int i = 0; i < EFFECT_CHECKS; i++) {
        const struct effect *e = &r->effects.checks[i];
        flip = flip || (!isnan(e->p_value) && e->exact);
        t = t || (!isnan(e->p_value) && !e->exact);
    }
    if (flip || t)
        html_printf(r->out,
                    "Effects on choices that are no preference (side, order and the like) were tested over "
                    "people, of whom each gives one value, by %s, with Holm\u2019s adjustment over these "
                    "checks. ",
                    flip && t ? "the exact sign-flip test or, of many people, Student\u2019s t-test"
                    : flip    ? "the exact sign-flip test"
                              : "Student\u2019s t-test");
}

void report_methods(const struct report *r)
{
    report_heading(r, "Methods");
    fputs("<p>", r->out);
    if (r->choices.cell_count)
        report_choices_methods(r);
    factor_methods(r);
    effect_methods(r);
    null_methods(r);
    rating_methods(r);
    if (any_effect_size(&r->ratings))
        fputs("d is Cohen\u2019s (d<sub>z</sub>: in the SD of the differences), with exact intervals by the "
              "noncentral t distribution. ",
              r->out);
    report_scale_methods(r);
    report_planned_methods(r);
    report_equivalence_methods(r);
    html_printf(r->out,
                "Intervals cover %g\u00a0%%. Where Holm is not named, p-values are not corrected for "
                "the number of tests. ",
                100 * r->conf);
    if (r->sample->simulated)
        fputs("<strong>All sessions are simulated:</strong> the answers come from a model that reads image "
              "errors, and say "
              "nothing about people.",
              r->out);
    fputs("</p>\n", r->out);
}
