#include "analysis/tools/choices_people.h"

#include "analysis/tools/binomial_json.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>

// A number, or a dash where there is none.
static void number(struct table *t, int digits, double value)
{
    if (isnan(value))
        table_cell(t, "-");
    else
        table_cell(t, "%.*f", digits, value);
}

void choices_p_cell(struct table *table, double p)
{
    if (p < 0.0001)
        table_cell(table, "<0.0001");
    else
        number(table, 4, p);
}

void choices_range_cell(struct table *table, struct stat_interval ci)
{
    if (isnan(ci.low) || isnan(ci.high))
        table_cell(table, "-");
    else if (isinf(ci.low))
        table_cell(table, "below %.1f", 100 * ci.high);
    else if (isinf(ci.high))
        table_cell(table, "above %.1f", 100 * ci.low);
    else
        table_cell(table, "%.1f to %.1f", 100 * ci.low, 100 * ci.high);
}

static bool print_tests(const struct choices *c)
{
    const char *const headings[] = {"<block",    "<cell", "people", "answers each",   "%",        "flip p",
                                    "least p",   "t",     "t p",    "overdispersion", "pooled %", "pooled p",
                                    "pooled CI", NULL};
    struct table t;
    table_init(&t, headings);
    for (size_t i = 0; i < c->cell_count; i++) {
        const struct choice_cell *cell = &c->cells[i];
        if (!cell->several)
            continue;
        struct stat_people people = stat_people_sum(cell->counts, cell->people);
        table_cell(&t, "%s", cell->block);
        table_cell(&t, "%s", cell->label);
        table_cell(&t, "%zu", people.people);
        if (people.least_n == people.most_n)
            table_cell(&t, "%" PRId64, people.least_n);
        else
            table_cell(&t, "%" PRId64 " to %" PRId64, people.least_n, people.most_n);
        number(&t, 1, 100 * cell->estimate);
        choices_p_cell(&t, c->p0 == 0.5 ? cell->flip.p_value : (double)NAN);
        if (c->p0 == 0.5)
            table_cell(&t, "%.2g", cell->flip.least_p);
        else
            table_cell(&t, "-");
        number(&t, 3, cell->t.t);
        choices_p_cell(&t, cell->t.p_value);
        number(&t, 2, cell->overdispersion);
        number(&t, 1, 100 * cell->binomial.estimate);
        choices_p_cell(&t, cell->binomial.p_value);
        choices_range_cell(&t, cell->binomial.ci);
    }
    puts("\nSeveral answers per person: people are tested, not answers");
    bool ok = table_print(&t, stdout);
    table_finish(&t);
    return ok;
}

static void print_warnings(const struct choices *c)
{
    for (size_t i = 0; i < c->cell_count; i++) {
        const struct choice_cell *cell = &c->cells[i];
        if (cell->method == CHOICE_SIGN_FLIP && cell->flip.least_p > 1 - c->conf)
            printf("%s: %zu of %zu people did not choose both equally often; with so many the sign-flip p is "
                   "never "
                   "below %.2g and cannot reach %.2g.\n",
                   cell->label, cell->flip.uneven, cell->flip.people, cell->flip.least_p, 1 - c->conf);
        if (cell->several && isnan(cell->t.t))
            printf("%s: no t interval, which needs two people with different shares.\n", cell->label);
        if (cell->several &&
            ((isfinite(cell->ci.low) && cell->ci.low < 0) || (isfinite(cell->ci.high) && cell->ci.high > 1)))
            printf("%s: the t interval reaches beyond 0 or 100 %%; so near the end, t fits badly.\n",
                   cell->label);
    }
    puts("%: mean of the people's shares, each person counting the same, with its t interval above. least p: "
         "had "
         "all leaned\nthe same way. overdispersion: Pearson's chi-squared of the people's counts over its "
         "degrees "
         "of freedom; 1 where\nanswers are independent.\n"
         "Warning: pooled is the binomial test as papers have it. It takes the answers of one person as "
         "independent; where\noverdispersion exceeds 1 its p is too small and its interval too narrow.");
}

static bool print_models(const struct choices *c)
{
    const char *const headings[] = {"<block", "<cell",    "intercept", "SE",       "SD", "t", "df",
                                    "p",      "middle %", "CI",        "people %", "CI", NULL};
    struct table t;
    table_init(&t, headings);
    for (size_t i = 0; i < c->cell_count; i++) {
        const struct choice_cell *cell = &c->cells[i];
        const struct stat_mixed_logit *m = &cell->mixed;
        if (!cell->several)
            continue;
        table_cell(&t, "%s", cell->block);
        table_cell(&t, "%s", cell->label);
        number(&t, 3, m->intercept);
        number(&t, 3, m->std_error);
        number(&t, 3, m->sd);
        number(&t, 3, m->t);
        number(&t, 0, m->df);
        choices_p_cell(&t, m->p_value);
        number(&t, 1, 100 * m->conditional);
        choices_range_cell(&t, m->conditional_ci);
        number(&t, 1, 100 * m->population);
        choices_range_cell(&t, m->population_ci);
    }
    puts("\nLogistic mixed model, one random intercept per person");
    bool ok = table_print(&t, stdout);
    table_finish(&t);
    for (size_t i = 0; i < c->cell_count; i++) {
        const char *words = stat_mixed_words(c->cells[i].mixed.state);
        if (c->cells[i].several && words[0])
            printf("%s: %s.\n", c->cells[i].label, words);
    }
    puts("Intercept and SD in logits; p from t with N - 1 degrees of freedom. middle: preference of a person "
         "in the "
         "middle\n(conditional); people: mean preference over people.");
    return ok;
}

static bool print_contrasts(const struct choices *c)
{
    const char *const headings[] = {"<block", "<factor", "<a", "<b", "people", "a - b %",
                                    "CI",     "t",       "df", "p",  "Holm p", NULL};
    struct table t;
    table_init(&t, headings);
    for (size_t i = 0; i < c->contrast_count; i++) {
        const struct choice_contrast *x = &c->contrasts[i];
        table_cell(&t, "%s", x->block);
        table_cell(&t, "%s", x->factor);
        table_cell(&t, "%s", x->a);
        table_cell(&t, "%s", x->b);
        table_cell(&t, "%zu", x->people);
        number(&t, 1, 100 * x->t.estimate);
        choices_range_cell(&t, (struct stat_interval){x->t.ci_low, x->t.ci_high});
        number(&t, 3, x->t.t);
        number(&t, 0, x->t.df);
        choices_p_cell(&t, x->t.p_value);
        choices_p_cell(&t, x->holm);
    }
    puts("\nLevels compared within people: two-sided t-test of each person's difference of shares");
    bool ok = table_print(&t, stdout);
    table_finish(&t);
    puts(
        "In cells that are otherwise the same, all pairs of levels once somebody answered several times at one "
        "of\nthem. Holm p: adjusted for the pairs of one factor's levels.");
    return ok;
}

bool choices_people_print(const struct choices *choices)
{
    if (!print_tests(choices))
        return false;
    print_warnings(choices);
    return print_models(choices) && (choices->contrast_count == 0 || print_contrasts(choices));
}

static void flip_json(struct json *json, const struct stat_signflip *flip, double conf)
{
    json_open(json, "sign_flip", '{');
    json_integer(json, "people", (int64_t)flip->people);
    json_integer(json, "uneven_people", (int64_t)flip->uneven);
    json_number(json, "statistic", flip->statistic);
    json_number(json, "p_value", flip->p_value);
    json_number(json, "least_p", flip->least_p);
    json_bool(json, "can_be_clear", flip->least_p <= 1 - conf);
    json_close(json, '}');
}

static void t_json(struct json *json, const struct stat_ttest *t)
{
    json_open(json, "t", '{');
    json_number(json, "estimate", t->estimate);
    json_number(json, "t", t->t);
    json_number(json, "df", t->df);
    json_number(json, "p_value", t->p_value);
    json_number(json, "ci_low", t->ci_low);
    json_number(json, "ci_high", t->ci_high);
    json_close(json, '}');
}

static void mixed_json(struct json *json, const struct stat_mixed_logit *m)
{
    json_open(json, "mixed_model", '{');
    json_bool(json, "fitted", !isnan(m->intercept));
    json_text(json, "note", stat_mixed_words(m->state));
    json_number(json, "intercept", m->intercept);
    json_number(json, "std_error", m->std_error);
    json_number(json, "sd", m->sd);
    json_number(json, "log_likelihood", m->log_likelihood);
    json_number(json, "t", m->t);
    json_number(json, "df", m->df);
    json_number(json, "p_value", m->p_value);
    json_number(json, "intercept_ci_low", m->intercept_ci.low);
    json_number(json, "intercept_ci_high", m->intercept_ci.high);
    json_number(json, "conditional", m->conditional);
    json_number(json, "conditional_ci_low", m->conditional_ci.low);
    json_number(json, "conditional_ci_high", m->conditional_ci.high);
    json_number(json, "population", m->population);
    json_number(json, "population_ci_low", m->population_ci.low);
    json_number(json, "population_ci_high", m->population_ci.high);
    json_close(json, '}');
}

void choices_people_json(struct json *json, const struct choice_cell *cell, double conf)
{
    struct stat_people people = stat_people_sum(cell->counts, cell->people);
    json_integer(json, "people", (int64_t)people.people);
    json_integer(json, "least_answers", people.least_n);
    json_integer(json, "most_answers", people.most_n);
    if (cell->binomial.p0 == 0.5)
        flip_json(json, &cell->flip, conf);
    t_json(json, &cell->t);
    mixed_json(json, &cell->mixed);
    json_open(json, "pooled", '{');
    binomial_json(json, &cell->binomial);
    json_close(json, '}');
}

void choices_contrasts_json(struct json *json, const struct choices *choices)
{
    json_open(json, "contrasts", '[');
    for (size_t i = 0; i < choices->contrast_count; i++) {
        const struct choice_contrast *x = &choices->contrasts[i];
        json_open(json, NULL, '{');
        json_text(json, "block", x->block);
        json_text(json, "factor", x->factor);
        json_text(json, "a", x->a);
        json_text(json, "b", x->b);
        json_integer(json, "cell_pairs", (int64_t)x->cell_pairs);
        json_integer(json, "people", (int64_t)x->people);
        t_json(json, &x->t);
        json_number(json, "p_holm", x->holm);
        json_close(json, '}');
    }
    json_close(json, ']');
}
