#include "analysis/tools/thresholds_json.h"

#include "analysis/tools/json.h"
#include "analysis/tools/study_arguments.h"

#include <math.h>

static void interval_json(struct json *json, const char *key, double low, double high)
{
    json_open(json, key, '[');
    json_number(json, NULL, low);
    json_number(json, NULL, high);
    json_close(json, ']');
}

static void mean_json(struct json *json, const char *key, const struct threshold_mean *m)
{
    json_open(json, key, '{');
    json_integer(json, "n", (int64_t)m->of.n);
    json_number(json, "mean", m->of.mean);
    json_number(json, "sd", m->of.sd);
    json_number(json, "median", m->median);
    json_number(json, "ci_low", m->t.ci_low);
    json_number(json, "ci_high", m->t.ci_high);
    json_close(json, '}');
}

static void fit_json(struct json *json, const struct stat_fit *fit)
{
    bool ok = fit->status == STAT_FIT_OK;
    const double none = (double)NAN;
    json_open(json, "maximum_likelihood", '{');
    json_bool(json, "estimable", ok);
    json_text(json, "reason", stat_fit_reason(fit->status));
    json_number(json, "threshold", ok ? fit->function.threshold : none);
    interval_json(json, "threshold_profile", ok ? fit->threshold.low : none, ok ? fit->threshold.high : none);
    json_number(json, "slope", ok ? fit->function.slope : none);
    interval_json(json, "slope_profile", ok ? fit->slope.low : none, ok ? fit->slope.high : none);
    json_number(json, "guess", ok ? fit->function.guess : none);
    json_number(json, "lapse", ok ? fit->function.lapse : none);
    json_number(json, "log_likelihood", fit->log_likelihood);
    json_number(json, "deviance", fit->deviance);
    interval_json(json, "jump_between", fit->step.low, fit->step.high);
    json_close(json, '}');
}

static void bootstrap_json(struct json *json, const struct stat_fit_bootstrap *b)
{
    json_open(json, "bootstrap", '{');
    json_integer(json, "replicates", (int64_t)b->replicates);
    json_integer(json, "without_threshold", (int64_t)b->failed);
    json_number(json, "deviance_p", b->deviance_p);
    interval_json(json, "threshold", b->threshold.low, b->threshold.high);
    json_bool(json, "low_open", isinf(b->threshold.low));
    json_bool(json, "high_open", isinf(b->threshold.high));
    json_integer(json, "at_minus_infinity", (int64_t)b->below);
    json_integer(json, "at_infinity", (int64_t)b->above);
    json_bool(json, "unreliable", b->unreliable);
    json_close(json, '}');
}

static void marginal_json(struct json *json, const char *key, const struct stat_marginal *m)
{
    json_open(json, key, '{');
    json_number(json, "mean", m->mean);
    json_number(json, "sd", m->sd);
    json_number(json, "median", m->median);
    interval_json(json, "credible", m->credible.low, m->credible.high);
    json_close(json, '}');
}

static void bayes_json(struct json *json, const struct stat_bayes *b)
{
    json_open(json, "bayes", '{');
    marginal_json(json, "threshold", &b->threshold);
    marginal_json(json, "width", &b->width);
    marginal_json(json, "guess", &b->guess);
    marginal_json(json, "lapse", &b->lapse);
    marginal_json(json, "eta", &b->eta);
    json_bool(json, "interval_bound_by_prior", b->prior_bound);
    json_bool(json, "rough", b->rough);
    json_close(json, '}');
}

static void person_json(struct json *json, const struct sample *sample, const struct threshold_person *p)
{
    json_open(json, NULL, '{');
    json_text(json, "participant", p->person == SAMPLE_NONE ? "all" : sample->people[p->person].code);
    json_integer(json, "steps", (int64_t)p->step_count);
    json_integer(json, "staircases", (int64_t)p->staircases);
    json_integer(json, "reversals", p->reversals);
    json_number(json, "staircase_estimate", p->estimate);
    fit_json(json, &p->fit);
    bootstrap_json(json, &p->bootstrap);
    bayes_json(json, &p->bayes);
    json_close(json, '}');
}

static void cell_json(struct json *json, const struct sample *sample, const struct threshold_cell *cell)
{
    json_open(json, NULL, '{');
    json_text(json, "block", cell->block);
    json_text(json, "cell", cell->label);
    json_text(json, "parameter", cell->parameter);
    json_text(json, "method",
              cell->source == THRESHOLD_LEVELS ? "constant"
              : cell->quest                    ? "quest_plus"
                                               : "up_down");
    json_bool(json, "preference", cell->preference);
    json_integer(json, "people_together", (int64_t)cell->pooled);
    json_text(json, "larger", cell->undirected ? "unknown" : cell->falling ? "harder" : "easier");
    json_bool(json, "graded", cell->graded);
    mean_json(json, "over_people_staircase", &cell->by_staircase);
    mean_json(json, "over_people_maximum_likelihood", &cell->by_fit);
    mean_json(json, "over_people_bayes", &cell->by_bayes);
    json_integer(json, "bayes_bound_by_prior", (int64_t)cell->prior_bound);
    json_open(json, "people", '[');
    for (size_t i = 0; i < cell->person_count; i++)
        person_json(json, sample, &cell->people[i]);
    json_close(json, ']');
    json_close(json, '}');
}

static void adjusted_json(struct json *json, const struct sample *sample, const struct adjusted_cell *cell)
{
    json_open(json, NULL, '{');
    json_text(json, "block", cell->block);
    json_text(json, "cell", cell->label);
    json_text(json, "parameter", cell->parameter);
    mean_json(json, "over_people", &cell->over_people);
    json_open(json, "people", '[');
    for (size_t i = 0; i < cell->person_count; i++) {
        const struct adjusted_person *p = &cell->people[i];
        json_open(json, NULL, '{');
        json_text(json, "participant", sample->people[p->person].code);
        json_integer(json, "values", (int64_t)p->count);
        json_number(json, "mean", p->mean);
        json_number(json, "least", p->low);
        json_number(json, "most", p->high);
        json_close(json, '}');
    }
    json_close(json, ']');
    json_close(json, '}');
}

void thresholds_json(FILE *out, const struct sample *sample, const struct thresholds *t,
                     const struct adjusted *a)
{
    struct json json = {out, false};
    json_open(&json, NULL, '{');
    study_title_json(&json, sample);
    json_number(&json, "conf", t->options.conf);
    json_text(&json, "family", stat_family_name(t->options.family));
    json_bool(&json, "logarithmic", t->options.logarithmic);
    json_open(&json, "thresholds", '[');
    for (size_t i = 0; i < t->cell_count; i++)
        cell_json(&json, sample, &t->cells[i]);
    json_close(&json, ']');
    json_open(&json, "adjusted", '[');
    for (size_t i = 0; i < a->cell_count; i++)
        adjusted_json(&json, sample, &a->cells[i]);
    json_close(&json, ']');
    json_open(&json, "left_out", '{');
    json_integer(&json, "excluded", t->excluded + a->excluded);
    json_integer(&json, "not_finite", t->not_finite);
    json_integer(&json, "not_done", t->not_done + a->not_done);
    json_close(&json, '}');
    json_close(&json, '}');
    fputc('\n', out);
}
