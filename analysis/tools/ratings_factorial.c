// Analyses of variance as text and JSON.
#include "analysis/tools/ratings_parts.h"
#include "analysis/tools/table.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>

static bool print_effects(const struct factorial *f)
{
    static const char *const headings[] = {"<effect", "df", "error", "F",       "p",           "GG",
                                           "p GG",    "HF", "p HF",  "partial", "generalised", NULL};
    struct table t;
    table_init(&t, headings);
    for (size_t i = 0; i < f->anova.effect_count; i++) {
        const struct stat_anova_effect *e = &f->anova.effects[i];
        char name[256];
        factorial_effect_name(f, e->factors, " x ", name);
        table_cell(&t, "%s", name);
        ratings_number(&t, "%.0f", e->df);
        ratings_number(&t, "%.0f", e->df_error);
        ratings_number(&t, "%.3f", e->f);
        ratings_p(&t, e->p_value);
        ratings_number(&t, "%.3f", e->epsilon_gg);
        ratings_p(&t, e->p_gg);
        ratings_number(&t, "%.3f", e->epsilon_hf);
        ratings_p(&t, e->p_hf);
        ratings_number(&t, "%.3f", e->eta2_partial);
        ratings_number(&t, "%.3f", e->eta2_generalised);
    }
    bool ok = table_print(&t, stdout);
    table_finish(&t);
    puts("GG, HF: Greenhouse-Geisser and Huynh-Feldt epsilon, and p corrected by them; partial and generalised "
         "eta squared.\n");
    return ok;
}

static bool print_means(const struct factorial *f, double conf)
{
    char interval[48];
    snprintf(interval, sizeof interval, "%g %% within", 100 * conf);
    const char *const headings[] = {"<factor", "<level", "M", interval, NULL};
    struct table t;
    table_init(&t, headings);
    for (size_t j = 0; j < f->factor_count; j++)
        for (size_t k = 0; k < f->factors[j].level_count; k++) {
            const struct factorial_factor *factor = &f->factors[j];
            table_cell(&t, "%s", factor->name);
            table_cell(&t, "%s", factor->levels[k]);
            ratings_number(&t, "%.2f", factor->mean[k]);
            double half = isnan(f->anova.effects[j].p_gg) ? (double)NAN : factor->half_width[k]; // no spread
            ratings_interval(&t, factor->mean[k] - half, factor->mean[k] + half);
        }
    bool ok = table_print(&t, stdout);
    table_finish(&t);
    puts("The intervals are within people: they compare levels, they do not say where a mean lies.");
    return ok;
}

static bool print_pairs(const struct factorial_factor *factor, double conf)
{
    char ci[32], d_ci[32];
    snprintf(ci, sizeof ci, "%g %% CI", 100 * conf);
    snprintf(d_ci, sizeof d_ci, "%g %% CI d_z", 100 * conf);
    const char *const headings[] = {"<levels", "difference", ci, "t", "df", "p", "p Holm", "d_z", d_ci, NULL};
    struct table t;
    if (factor->pair_count == 0)
        return true;
    table_init(&t, headings);
    for (size_t i = 0; i < factor->pair_count; i++) {
        const struct factorial_pair *p = &factor->pairs[i];
        table_cell(&t, "%s - %s", factor->levels[p->a], factor->levels[p->b]);
        ratings_number(&t, "%.2f", p->test.estimate);
        ratings_interval(&t, p->test.ci_low, p->test.ci_high);
        ratings_number(&t, "%.3f", p->test.t);
        ratings_number(&t, "%.0f", p->test.df);
        ratings_p(&t, p->test.p_value);
        ratings_p(&t, p->p_holm);
        ratings_number(&t, "%.2f", p->effect.d);
        ratings_interval(&t, p->effect.ci_low, p->effect.ci_high);
    }
    printf("\nLevels of %s, paired t-tests\n", factor->name);
    bool ok = table_print(&t, stdout);
    table_finish(&t);
    return ok;
}

bool ratings_print_factorial(const struct sample *sample, const struct factorial *f, double conf)
{
    printf("%s (%g to %g), block %s: analysis of variance within participants\n", f->question, f->scale_min,
           f->scale_max, f->block);
    if (f->dropped[0])
        printf("Left out, factors: %s.\n", f->dropped);
    for (size_t i = 0; i < f->left_count; i++)
        printf("Left out: participant %s, who has no rating in %zu of %zu cells; nothing is filled.\n",
               sample->people[f->left[i].person].code, f->left[i].missing, f->cells);
    bool ok = true;
    if (f->refusal[0]) {
        char words[512];
        factorial_refusal(f, words);
        puts(words);
    } else {
        printf("%zu participants, %zu cells, ", f->people, f->cells);
        printf(f->least == f->most ? "%zu in each\n" : "%zu to %zu in each\n", f->least, f->most);
        ok = print_effects(f) && print_means(f, conf);
        for (size_t j = 0; ok && j < f->factor_count; j++)
            ok = print_pairs(&f->factors[j], conf);
        char names[256];
        if (factorial_untested(f, names))
            printf("\n%s cannot be tested: everybody's ratings differ by the same between levels, so that "
                   "there is "
                   "nothing to hold an effect against, however large it is; see the means.\n",
                   names);
    }
    putchar('\n');
    return ok;
}

// --- JSON ---

static void effect_json(struct json *json, const struct factorial *f, const struct stat_anova_effect *e)
{
    char name[256];
    factorial_effect_name(f, e->factors, " x ", name);
    json_open(json, NULL, '{');
    json_text(json, "effect", name);
    json_number(json, "ss", e->ss);
    json_number(json, "ss_error", e->ss_error);
    json_number(json, "df", e->df);
    json_number(json, "df_error", e->df_error);
    json_number(json, "f", e->f);
    json_number(json, "p_value", e->p_value);
    json_number(json, "epsilon_gg", e->epsilon_gg);
    json_number(json, "p_gg", e->p_gg);
    json_number(json, "epsilon_hf", e->epsilon_hf);
    json_number(json, "p_hf", e->p_hf);
    json_number(json, "eta2_partial", e->eta2_partial);
    json_number(json, "eta2_generalised", e->eta2_generalised);
    json_close(json, '}');
}

static void factor_json(struct json *json, const struct factorial_factor *factor)
{
    json_open(json, NULL, '{');
    json_text(json, "factor", factor->name);
    json_open(json, "levels", '[');
    for (size_t k = 0; k < factor->level_count; k++) {
        json_open(json, NULL, '{');
        json_text(json, "level", factor->levels[k]);
        json_number(json, "mean", factor->mean[k]);
        json_number(json, "within_half_width", factor->half_width[k]);
        json_close(json, '}');
    }
    json_close(json, ']');
    json_open(json, "pairs", '[');
    for (size_t i = 0; i < factor->pair_count; i++) {
        const struct factorial_pair *p = &factor->pairs[i];
        json_open(json, NULL, '{');
        json_text(json, "a", factor->levels[p->a]);
        json_text(json, "b", factor->levels[p->b]);
        ratings_ttest_json(json, "a_minus_b", &p->test);
        json_number(json, "p_holm", p->p_holm);
        ratings_effect_json(json, "d_z", &p->effect);
        json_close(json, '}');
    }
    json_close(json, ']');
    json_close(json, '}');
}

static void cell_json(struct json *json, const struct factorial *f, size_t cell)
{
    json_open(json, NULL, '{');
    json_open(json, "levels", '[');
    size_t stride = f->cells;
    for (size_t j = 0; j < f->factor_count; j++) {
        stride /= f->factors[j].level_count;
        json_text(json, NULL, f->factors[j].levels[cell / stride % f->factors[j].level_count]);
    }
    json_close(json, ']');
    json_number(json, "mean", f->cell_of[cell].mean);
    json_number(json, "sd", f->cell_of[cell].sd);
    json_close(json, '}');
}

void ratings_factorial_json(struct json *json, const struct sample *sample, const struct factorial *f)
{
    json_open(json, NULL, '{');
    json_text(json, "question", f->question);
    json_text(json, "block", f->block);
    json_text(json, "refused", f->refusal);
    json_text(json, "factors_left_out", f->dropped);
    json_integer(json, "ratings", (int64_t)f->rating_count);
    json_integer(json, "participants", (int64_t)f->people);
    json_number(json, "overall_mean", f->overall.mean);
    json_number(json, "overall_sd", f->overall.sd);
    json_open(json, "incomplete", '[');
    for (size_t i = 0; i < f->left_count; i++) {
        json_open(json, NULL, '{');
        json_text(json, "participant", sample->people[f->left[i].person].code);
        json_integer(json, "cells_missing", (int64_t)f->left[i].missing);
        json_close(json, '}');
    }
    json_close(json, ']');
    json_open(json, "effects", '[');
    for (size_t i = 0; i < f->anova.effect_count; i++)
        effect_json(json, f, &f->anova.effects[i]);
    json_close(json, ']');
    json_open(json, "factors", '[');
    for (size_t j = 0; !f->refusal[0] && j < f->factor_count; j++)
        factor_json(json, &f->factors[j]);
    json_close(json, ']');
    json_open(json, "cells", '[');
    for (size_t c = 0; f->cell_of && c < f->cells; c++)
        cell_json(json, f, c);
    json_close(json, ']');
    json_close(json, '}');
}
