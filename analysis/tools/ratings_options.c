// Ratings of both options of a trial as text and JSON, and what the parts share.
#include "analysis/report/level.h"
#include "analysis/tools/ratings_parts.h"
#include "analysis/tools/table.h"

#include <math.h>
#include <stdio.h>

void ratings_number(struct table *t, const char *format, double value)
{
    if (isnan(value))
        table_cell(t, "-");
    else
        table_cell(t, format, value);
}

void ratings_interval(struct table *t, double low, double high)
{
    if (isnan(low) || isnan(high))
        table_cell(t, "-");
    else
        table_cell(t, "%.2f to %.2f", low, high);
}

void ratings_p(struct table *t, double p)
{
    if (p < 0.0001)
        table_cell(t, "< 0.0001");
    else
        ratings_number(t, "%.4f", p);
}

bool ratings_print_options(const struct sample *sample, const struct rating_options *q, double conf)
{
    char ci[32], d_ci[32];
    snprintf(ci, sizeof ci, "%g %% CI", 100 * conf);
    snprintf(d_ci, sizeof d_ci, "%g %% CI d_z", 100 * conf);
    const char *const headings[] = {"<cell",       "<test",      "<reference", "n",  "M test",
                                    "M reference", "difference", ci,           "t",  "p",
                                    "p Holm",      "Wilcoxon p", "d_z",        d_ci, NULL};
    struct table t;
    table_init(&t, headings);
    for (size_t i = 0; i < q->cell_count; i++) {
        const struct rating_option_cell *c = &q->cells[i];
        char words[384];
        rating_option_words(sample, c, words);
        table_cell(&t, "%s", words);
        table_cell(&t, "%s", sample->conditions[c->test].label);
        table_cell(&t, "%s", sample->conditions[c->reference].label);
        table_cell(&t, "%zu", c->n);
        ratings_number(&t, "%.2f", c->test_of.mean);
        ratings_number(&t, "%.2f", c->reference_of.mean);
        ratings_number(&t, "%.2f", c->difference.estimate);
        ratings_interval(&t, c->difference.ci_low, c->difference.ci_high);
        ratings_number(&t, "%.3f", c->difference.t);
        ratings_p(&t, c->difference.p_value);
        ratings_p(&t, c->p_holm);
        ratings_p(&t, c->rank.p_value);
        ratings_number(&t, "%.2f", c->effect.d);
        ratings_interval(&t, c->effect.ci_low, c->effect.ci_high);
    }
    printf("%s (%g to %g): both options of a trial, test minus reference, paired\n", q->question, q->scale_min,
           q->scale_max);
    bool ok = table_print(&t, stdout);
    table_finish(&t);
    putchar('\n');
    return ok;
}

// --- JSON ---

void ratings_ttest_json(struct json *json, const char *key, const struct stat_ttest *t)
{
    json_open(json, key, '{');
    json_number(json, "estimate", t->estimate);
    json_number(json, "t", t->t);
    json_number(json, "df", t->df);
    json_number(json, "p_value", t->p_value);
    json_number(json, "ci_low", t->ci_low);
    json_number(json, "ci_high", t->ci_high);
    json_close(json, '}');
}

void ratings_rank_json(struct json *json, const char *key, const struct stat_wilcoxon *w)
{
    json_open(json, key, '{');
    json_integer(json, "n", (int64_t)w->n);
    json_integer(json, "zeros", (int64_t)w->zeros);
    json_number(json, "statistic", w->statistic);
    json_number(json, "p_value", w->p_value);
    json_bool(json, "exact", w->exact);
    json_number(json, "estimate", w->estimate);
    json_number(json, "ci_low", w->ci_low);
    json_number(json, "ci_high", w->ci_high);
    json_close(json, '}');
}

void ratings_effect_json(struct json *json, const char *key, const struct stat_effect *e)
{
    json_open(json, key, '{');
    json_number(json, "d", e->d);
    json_number(json, "g", e->g);
    json_number(json, "ci_low", e->ci_low);
    json_number(json, "ci_high", e->ci_high);
    json_close(json, '}');
}

static void cell_json(struct json *json, const struct sample *sample, const struct rating_option_cell *c)
{
    char words[256];
    level_all(sample, c->factors, words);
    json_open(json, NULL, '{');
    json_text(json, "block", c->block);
    json_text(json, "cell", words);
    json_text(json, "test", sample->conditions[c->test].label);
    json_text(json, "reference", sample->conditions[c->reference].label);
    json_integer(json, "participants", (int64_t)c->n);
    json_integer(json, "trials", c->trials);
    json_number(json, "test_mean", c->test_of.mean);
    json_number(json, "test_sd", c->test_of.sd);
    json_number(json, "reference_mean", c->reference_of.mean);
    json_number(json, "reference_sd", c->reference_of.sd);
    ratings_ttest_json(json, "test_minus_reference", &c->difference);
    json_number(json, "p_holm", c->p_holm);
    ratings_rank_json(json, "wilcoxon", &c->rank);
    ratings_effect_json(json, "d_z", &c->effect);
    ratings_effect_json(json, "d_av", &c->average);
    json_close(json, '}');
}

void ratings_options_json(struct json *json, const struct sample *sample, const struct rating_options *q)
{
    json_open(json, NULL, '{');
    json_text(json, "question", q->question);
    json_number(json, "scale_min", q->scale_min);
    json_number(json, "scale_max", q->scale_max);
    json_open(json, "cells", '[');
    for (size_t i = 0; i < q->cell_count; i++)
        cell_json(json, sample, &q->cells[i]);
    json_close(json, ']');
    json_close(json, '}');
}
