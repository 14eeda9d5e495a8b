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

enum note { NOT_ESTIMABLE, ONE_PERSON, ALL_ZERO, OUT_OF_REACH, INCOMPLETE };

static bool holds(const struct effect *e, enum note note, double conf)
{
    switch (note) {
    case NOT_ESTIMABLE:
        return e->people == 0;
    case ONE_PERSON:
        return e->people == 1;
    case ALL_ZERO:
        return e->people > 1 && e->flip.uneven == 0;
    case OUT_OF_REACH:
        return e->people > 1 && e->flip.uneven > 0 && e->exact && e->flip.least_p > 1 - conf;
    default:
        return e->people && e->left_out;
    }
}

static void print_detail(const struct effect *e, enum effect_check check, enum note note)
{
    if (note == NOT_ESTIMABLE)
        printf(" (%s)", effect_null(check));
    else if (note == OUT_OF_REACH)
        printf(" (%.3g)", e->flip.least_p);
    else if (note == INCOMPLETE)
        printf(" (%zu)", e->left_out);
}

// One line for all checks of which it holds.
static void print_note(const struct effects *effects, enum note note, const char *heading)
{
    bool first = true;
    for (int i = 0; i < EFFECT_CHECKS; i++) {
        const struct effect *e = &effects->checks[i];
        if (!holds(e, note, effects->conf))
            continue;
        printf("%s%s", first ? heading : "; ", effect_words((enum effect_check)i));
        print_detail(e, (enum effect_check)i, note);
        first = false;
    }
    if (!first)
        puts(".");
}

static void print_notes(const struct effects *effects)
{
    char reach[96];
    snprintf(reach, sizeof reach,
             "Cannot reach %.4g (the smallest p that these people's values could give): ", 1 - effects->conf);
    print_note(effects, NOT_ESTIMABLE, "Not estimable: ");
    print_note(effects, ONE_PERSON, "Not tested, only one person has a value: ");
    print_note(effects, ALL_ZERO, "Not tested, every person's value is 0: ");
    print_note(effects, OUT_OF_REACH, reach);
    print_note(effects, INCOMPLETE, "People without a value, left out: ");
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
    if (effects->tested == 0)
        puts("These data permit none of the tests.");
    else
        printf(
            "Holm p: adjusted for the family of the %zu %s. d: mean over the SD of the people's values. Where "
            "p is large, an effect\nis not shown; nor is it shown to be absent. ",
            effects->tested, effects->tested == 1 ? "check that has a p" : "checks that have a p");
    puts("What was on screen last or longest may be so because it was preferred.");
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
