#include "analysis/tools/choices_factors.h"

#include "analysis/tools/choices_people.h"

#include <math.h>

static void odds_cells(struct table *t, const struct choice_factor_test *x)
{
    if (isnan(x->odds_ratio))
        table_cell(t, "-");
    else
        table_cell(t, "%.2f", x->odds_ratio);
    if (isnan(x->odds_ci.low))
        table_cell(t, "-");
    else
        table_cell(t, "%.2f to %.2f", x->odds_ci.low, x->odds_ci.high);
}

static void row(struct table *t, const struct choice_factor_test *x)
{
    const char *indent = x->pair ? "  " : "";
    table_cell(t, "%s%s", indent, x->where[0] ? x->where : x->block);
    if (x->a)
        table_cell(t, "%s%s: %s - %s", indent, x->factor, x->a, x->b);
    else
        table_cell(t, "%s, %zu levels", x->factor, x->levels);
    table_cell(t, "%s", choice_factor_word(x->method));
    table_cell(t, "%zu", x->people);
    if (isnan(x->difference))
        table_cell(t, "-");
    else
        table_cell(t, "%.1f", 100 * x->difference);
    choices_range_cell(t, x->ci);
    odds_cells(t, x);
    choices_p_cell(t, x->p_value);
    choices_p_cell(t, x->holm);
    if (isnan(x->statistic))
        table_cell(t, "-");
    else
        table_cell(t, "%.3f", x->statistic);
    if (isnan(x->df))
        table_cell(t, "-");
    else
        table_cell(t, "%.0f", x->df);
    choices_p_cell(t, x->p_asymptotic);
}

bool choices_factors_print(const struct choice_factors *factors)
{
    char ci[32];
    if (factors->count == 0)
        return true;
    snprintf(ci, sizeof ci, "%g %% CI", 100 * factors->conf);
    const char *const headings[] = {"<where", "<levels", "<test", "people", "difference", ci,  "odds ratio", ci,
                                    "p",      "Holm p",  "chi2",  "df",     "chi2 p",     NULL};
    struct table t;
    table_init(&t, headings);
    for (size_t i = 0; i < factors->count; i++)
        row(&t, &factors->tests[i]);
    puts("\nLevels of factors, in cells that are otherwise the same");
    bool ok = table_print(&t, stdout);
    table_finish(&t);
    puts("difference: of the shares, in percentage points. Holm p: over the factors; of pairs of levels, over "
         "the "
         "pairs.\nInterval: Newcombe's between people, t else. A large p does not show that levels are equal.");
    for (size_t i = 0; i < factors->count; i++) {
        const struct choice_factor_test *x = &factors->tests[i];
        if (x->left_out && !x->pair)
            printf("%s%s%s: left out, people without an answer at every level: %zu.\n", x->factor,
                   x->where[0] ? ", " : "", x->where, x->left_out);
        if (x->p_error > 0)
            printf("%s%s%s: p by random arrangements, standard error %.2g.\n", x->factor,
                   x->where[0] ? ", " : "", x->where, x->p_error);
        if (isnan(x->p_value))
            printf("%s%s%s: no test; all answers are the same, or nobody answered at every level.\n", x->factor,
                   x->where[0] ? ", " : "", x->where);
    }
    return ok;
}

void choices_factors_json(struct json *json, const struct choice_factors *factors)
{
    json_open(json, "factor_tests", '[');
    for (size_t i = 0; i < factors->count; i++) {
        const struct choice_factor_test *x = &factors->tests[i];
        json_open(json, NULL, '{');
        json_text(json, "block", x->block);
        json_text(json, "factor", x->factor);
        json_text(json, "where", x->where);
        json_text(json, "a", x->a ? x->a : "");
        json_text(json, "b", x->b ? x->b : "");
        json_bool(json, "pair", x->pair);
        json_integer(json, "levels", (int64_t)x->levels);
        json_text(json, "method", choice_factor_word(x->method));
        json_integer(json, "people", (int64_t)x->people);
        json_integer(json, "people_left_out", (int64_t)x->left_out);
        json_number(json, "p_value", x->p_value);
        json_number(json, "p_error", x->p_error);
        json_number(json, "p_holm", x->holm);
        json_number(json, "statistic", x->statistic);
        json_number(json, "df", x->df);
        json_number(json, "p_asymptotic", x->p_asymptotic);
        json_number(json, "difference", x->difference);
        json_number(json, "ci_low", x->ci.low);
        json_number(json, "ci_high", x->ci.high);
        json_number(json, "odds_ratio", x->odds_ratio);
        json_number(json, "odds_low", x->odds_ci.low);
        json_number(json, "odds_high", x->odds_ci.high);
        json_close(json, '}');
    }
    json_close(json, ']');
}
