#include "analysis/tools/choices_factors.h"

#include "analysis/tools/choices_people.h"

#include <math.h>
#include <string.h>

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

static void levels_cell(struct table *t, const struct choice_factor_test *x, const char *indent)
{
    char words[CHOICE_FACTOR_WORDS];
    snprintf(words, sizeof words, "%s%s: %s", indent, x->factor, x->level[0]);
    for (size_t i = 1; i < x->levels; i++) {
        size_t used = strlen(words);
        snprintf(words + used, sizeof words - used, "%s%s", x->levels == 2 ? " - " : ", ", x->level[i]);
    }
    table_cell(t, "%s", words);
}

static void row(struct table *t, const struct choice_factor_test *x)
{
    const char *indent = x->pair ? "  " : "";
    bool both = x->name_block && x->where[0];
    table_cell(t, "%s%s%s%s", indent, both || !x->where[0] ? x->block : "", both ? ": " : "", x->where);
    levels_cell(t, x, indent);
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

static void notes(const struct choice_factor_test *x)
{
    char words[CHOICE_FACTOR_WORDS], note[CHOICE_FACTOR_NOTE];
    choice_factor_words(x, words);
    choice_factor_note(x, note);
    if (note[0] && !x->pair)
        printf("%s: %s.\n", words, note);
    if (x->p_error > 0)
        printf("%s: p by random arrangements, standard error %.2g.\n", words, x->p_error);
    if (x->none[0])
        printf("%s: no test; %s.\n", words, x->none);
}

static void legend(const struct choice_factors *factors)
{
    bool pairs = false, between = false, difference = false;
    for (size_t i = 0; i < factors->count; i++) {
        const struct choice_factor_test *x = &factors->tests[i];
        pairs = pairs || x->pair;
        between = between || !x->design.within;
        difference = difference || (x->design.within && x->levels == 2);
    }
    printf("difference: of the shares, in percentage points. Holm p: over the factors%s.\n",
           pairs ? "; of pairs of levels, over the pairs" : "");
    puts("A factor lies within people (McNemar, Cochran) where at least half of them were to answer at\n"
         "several of its levels, else between people (Fisher, exchange of people).");
    if (difference)
        printf("Interval within people: Fay and Lumbard's, which leaves 0 out exactly where McNemar's p\n"
               "is below %.4g.\n",
               1 - factors->conf);
    if (between)
        puts("Interval between people: Newcombe's of one answer each, Welch's else; near its limit the\n"
             "exact p may say otherwise.");
    puts("A large p does not show that levels are equal.");
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
    legend(factors);
    for (size_t i = 0; i < factors->count; i++)
        notes(&factors->tests[i]);
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
        json_text(json, "a", x->levels == 2 ? x->level[0] : "");
        json_text(json, "b", x->levels == 2 ? x->level[1] : "");
        json_bool(json, "pair", x->pair);
        json_integer(json, "levels", (int64_t)x->levels);
        json_open(json, "level_names", '[');
        for (size_t k = 0; k < x->levels; k++)
            json_text(json, NULL, x->level[k]);
        json_close(json, ']');
        json_bool(json, "within_people", x->design.within);
        json_integer(json, "people_planned_at_one_level", (int64_t)x->design.one);
        json_integer(json, "people_planned_at_several_levels", (int64_t)x->design.several);
        json_text(json, "method", choice_factor_word(x->method));
        json_integer(json, "people", (int64_t)x->people);
        json_integer(json, "people_left_out", (int64_t)x->left_out);
        json_text(json, "no_test", x->none);
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
