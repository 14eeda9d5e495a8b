#include "analysis/tools/choices_effects.h"

#include "analysis/tools/choices_people.h"
#include "analysis/tools/table.h"

#include <math.h>
#include <stdio.h>

static void number(struct table *t, double value, const char *format_of_two)
{
    if (isnan(value))
        table_cell(t, "-");
    else
        table_cell(t, format_of_two[0] == '2' ? "%.2f" : "%.1f", value);
}

static void effect_row(struct table *t, enum effect_check check, const struct effect *e)
{
    table_cell(t, "%s", effect_words(check));
    table_cell(t, "%zu", e->people);
    number(t, effect_shown(check, e->estimate), "1");
    if (isnan(e->t.ci_low))
        table_cell(t, "-");
    else
        table_cell(t, "%.1f to %.1f", effect_shown(check, e->t.ci_low), effect_shown(check, e->t.ci_high));
    table_cell(t, "%s", effect_unit(check));
    number(t, e->d, "2");
    table_cell(t, "%s", isnan(e->p_value) ? "-" : e->exact ? "sign-flip" : "t");
    choices_p_cell(t, e->p_value);
    choices_p_cell(t, e->holm);
}

static void print_notes(const struct effects *effects)
{
    for (int i = 0; i < EFFECT_CHECKS; i++) {
        const struct effect *e = &effects->checks[i];
        const char *words = effect_words((enum effect_check)i);
        if (e->people == 0)
            printf("Not estimable, %s: %s.\n", words, effect_null((enum effect_check)i));
        else if (e->people == 1)
            printf("Not tested, %s: only one person has a value.\n", words);
        else if (e->flip.uneven == 0)
            printf("Not tested, %s: every person's value is 0.\n", words);
        else if (e->exact && e->flip.least_p > 1 - effects->conf)
            printf("Cannot reach %.4g, %s: the smallest p that these people's values could give is %.3g.\n",
                   1 - effects->conf, words, e->flip.least_p);
        if (e->people && e->left_out)
            printf("Without a value, %s: %zu %s.\n", words, e->left_out,
                   e->left_out == 1 ? "person" : "people");
    }
}

bool choices_effects_print(const struct effects *effects)
{
    char ci[32];
    snprintf(ci, sizeof ci, "%g %% CI", 100 * effects->conf);
    const char *const headings[] = {"<effect", "people", "mean", ci,       "<unit",
                                    "d",       "<test",  "p",    "Holm p", NULL};
    struct table t;
    table_init(&t, headings);
    for (int i = 0; i < EFFECT_CHECKS; i++)
        effect_row(&t, (enum effect_check)i, &effects->checks[i]);
    puts("\nEffects on choices that are no preference: one value per person, tested over people, two-sided");
    bool ok = table_print(&t, stdout);
    table_finish(&t);
    printf(
        "Holm p: adjusted for this family of %zu %s. d: mean over the SD of the people's values. Where p is "
        "large, an effect is\nnot shown; nor is it shown to be absent. What was on screen last or longest may "
        "be so because it was preferred.\n",
        effects->tested, effects->tested == 1 ? "check" : "checks");
    print_notes(effects);
    return ok;
}

void choices_effects_json(struct json *json, const struct effects *effects)
{
    json_open(json, "effects", '[');
    for (int i = 0; i < EFFECT_CHECKS; i++) {
        enum effect_check check = (enum effect_check)i;
        const struct effect *e = &effects->checks[i];
        json_open(json, NULL, '{');
        json_text(json, "check", effect_key(check));
        json_text(json, "unit", effect_unit(check));
        json_integer(json, "people", (int64_t)e->people);
        json_integer(json, "left_out", (int64_t)e->left_out);
        json_number(json, "estimate", effect_shown(check, e->estimate));
        json_number(json, "ci_low", effect_shown(check, e->t.ci_low));
        json_number(json, "ci_high", effect_shown(check, e->t.ci_high));
        json_number(json, "d", e->d);
        json_text(json, "method", isnan(e->p_value) ? "not estimable" : e->exact ? "sign-flip" : "t");
        json_number(json, "p_value", e->p_value);
        json_number(json, "p_holm", e->holm);
        json_number(json, "least_p", e->people > 1 ? e->flip.least_p : (double)NAN);
        json_close(json, '}');
    }
    json_close(json, ']');
    json_integer(json, "effects_tested", (int64_t)effects->tested);
}
