// fovstats gaze --json.
#include "analysis/tools/gaze_parts.h"

#include "analysis/tools/study_arguments.h"

#include <math.h>
#include <string.h>

static void estimate_json(struct json *json, const char *key, const struct stat_estimate *e)
{
    json_open(json, key, '{');
    json_number(json, "value", e->value);
    json_number(json, "ci_low", e->low);
    json_number(json, "ci_high", e->high);
    json_close(json, '}');
}

static void three_json(struct json *json, const char *key, double x, double y, double both)
{
    json_open(json, key, '{');
    json_number(json, "horizontal", x);
    json_number(json, "vertical", y);
    json_number(json, "both", both);
    json_close(json, '}');
}

static void running_json(struct json *json, const char *key, const struct gaze_running *r)
{
    json_open(json, key, '{');
    json_number(json, "mean", gaze_running_mean(r));
    json_number(json, "sd", gaze_running_sd(r));
    json_close(json, '}');
}

static void sequence_json(struct json *json, const struct gaze_record *r)
{
    static const char *const keys[] = {
        [GAZE_VMAX] = "not_estimable", [GAZE_C] = "c_not_estimable", [GAZE_POWER] = "power_not_estimable"};
    const struct stat_main_sequence *m = &r->main_sequence;
    char words[GAZE_REASON_SIZE];
    json_open(json, "main_sequence", '{');
    json_integer(json, "saccades", (int64_t)m->n);
    json_integer(json, "saccades_complete", r->quality.saccade_ms.n);
    json_number(json, "peak_span_ms", r->span_ms);
    for (int i = 0; i < 3; i++)
        if (gaze_sequence_problem(r, (enum gaze_part)i, words))
            json_text(json, keys[i], words);
    estimate_json(json, "vmax_deg_s", &m->vmax);
    estimate_json(json, "c_deg", &m->c);
    json_number(json, "residual_sd_deg_s", m->residual_sd);
    estimate_json(json, "power_k", &m->k);
    estimate_json(json, "power_b", &m->b);
    json_close(json, '}');
}

static void target_json(struct json *json, const struct gaze_target *t)
{
    json_open(json, NULL, '{');
    json_text(json, "fixation", t->fixation);
    json_integer(json, "samples", t->samples);
    json_integer(json, "outside_region", t->outside);
    json_integer(json, "target_not_known", t->unknown);
    json_integer(json, "target_distance_not_known", t->flat);
    json_number(json, "distance_mean_deg", gaze_running_mean(&t->distance));
    json_number(json, "distance_sd_deg", gaze_running_sd(&t->distance));
    json_number(json, "distance_median_deg", gaze_bins_quantile(&t->distances, 0.5));
    json_number(json, "offset_x_deg", t->error.n ? t->offset.mean_x : (double)NAN);
    json_number(json, "offset_y_deg", t->error.n ? t->offset.mean_y : (double)NAN);
    three_json(json, "offset_sd_deg", gaze_spread_sd_x(&t->offset), gaze_spread_sd_y(&t->offset),
               gaze_spread_sd(&t->offset));
    json_close(json, '}');
}

static void events_json(struct json *json, const struct gaze_quality *q, bool saccades)
{
    json_open(json, "fixations", '{');
    json_integer(json, "count", q->fixation_ms.n + q->fixations_cut);
    json_integer(json, "cut", q->fixations_cut);
    running_json(json, "duration_ms", &q->fixation_ms);
    json_close(json, '}');
    if (!saccades)
        return;
    json_open(json, "saccades", '{');
    json_integer(json, "count", q->saccade_ms.n + q->saccades_cut);
    json_integer(json, "cut", q->saccades_cut);
    running_json(json, "duration_ms", &q->saccade_ms);
    running_json(json, "amplitude_deg", &q->amplitude_deg);
    running_json(json, "peak_deg_s", &q->peak_deg_s);
    json_close(json, '}');
}

static void record_json(struct json *json, const struct sample *sample, const struct gaze_report *gaze,
                        const struct gaze_record *r)
{
    const struct gaze_quality *q = &r->quality;
    const struct gaze_target *accuracy = gaze_accuracy(r);
    bool saccades = gaze->options.rules.method == GAZE_IVT;
    json_open(json, NULL, '{');
    json_text(json, "participant", sample->people[r->person].code);
    if (r->session != SAMPLE_NONE)
        json_integer(json, "session", sample->sessions[r->session].id);
    json_text(json, "eye", gaze_eye_words(r->eye));
    json_integer(json, "samples", q->samples);
    json_integer(json, "samples_not_valid", q->invalid);
    json_number(json, "samples_missing", r->missing);
    json_number(json, "samples_due", gaze_due(r));
    json_integer(json, "samples_disordered", q->disordered);
    json_integer(json, "samples_between_trials", r->between);
    json_integer(json, "samples_of_interrupted_attempts", r->superseded);
    json_number(json, "rate_hz", r->rate_hz);
    json_number(json, "slowest_hz", r->slowest_hz);
    json_number(json, "fastest_hz", r->fastest_hz);
    json_number(json, "nominal_hz", r->nominal_hz);
    json_number(json, "accuracy_deg", accuracy ? accuracy->error.mean : (double)NAN);
    three_json(json, "rms_s2s_deg", gaze_quality_rms_x(q), gaze_quality_rms_y(q), gaze_quality_rms(q));
    three_json(json, "sd_deg", gaze_spread_sd_x(&q->within), gaze_spread_sd_y(&q->within),
               gaze_spread_sd(&q->within));
    json_number(json, "bcea_deg2", gaze_spread_bcea(&q->within, gaze->options.bcea_share));
    events_json(json, q, saccades);
    if (saccades && r->session == SAMPLE_NONE)
        sequence_json(json, r);
    json_open(json, "targets", '[');
    for (size_t i = 0; i < r->target_count; i++)
        target_json(json, &r->targets[i]);
    json_close(json, ']');
    json_close(json, '}');
}

static void bins_json(struct json *json, const char *key, const struct gaze_bins *bins)
{
    json_open(json, key, '{');
    json_number(json, "median", gaze_bins_quantile(bins, 0.5));
    json_number(json, "p95", gaze_bins_quantile(bins, 0.95));
    json_number(json, "p99", gaze_bins_quantile(bins, 0.99));
    json_close(json, '}');
}

static void latencies_json(struct json *json, const struct sample *sample, const struct gaze_report *gaze)
{
    json_open(json, "frames", '[');
    for (size_t i = 0; i < gaze->latency_count; i++) {
        const struct gaze_latency *l = &gaze->latencies[i];
        json_open(json, NULL, '{');
        json_text(json, "participant", sample->people[sample->sessions[l->session].person].code);
        json_integer(json, "session", sample->sessions[l->session].id);
        json_integer(json, "frames", l->frames);
        json_integer(json, "light_estimated", l->estimated);
        json_integer(json, "light_not_known", l->unknown);
        json_integer(json, "gaze_lost", l->lost);
        bins_json(json, "age_ms", &l->age);
        bins_json(json, "to_light_ms", &l->to_light);
        json_close(json, '}');
    }
    json_close(json, ']');
}

static void checks_json(struct json *json, const struct sample *sample, const struct gaze_report *gaze)
{
    json_open(json, "checks", '[');
    for (size_t i = 0; i < gaze->check_count; i++) {
        const struct gaze_check *c = &gaze->checks[i];
        json_open(json, NULL, '{');
        json_text(json, "participant", sample->people[sample->sessions[c->session].person].code);
        json_integer(json, "session", sample->sessions[c->session].id);
        json_text(json, "block", c->block);
        json_text(json, "eye", gaze_eye_words(c->eye));
        json_number(json, "x_deg", c->x_deg);
        json_number(json, "y_deg", c->y_deg);
        json_number(json, "accuracy_deg", c->accuracy_deg);
        json_number(json, "rms_s2s_deg", c->rms_s2s_deg);
        json_number(json, "sd_deg", c->sd_deg);
        json_number(json, "loss", c->loss);
        json_bool(json, "passed", c->passed);
        json_close(json, '}');
    }
    json_close(json, ']');
}

static void over_json(struct json *json, const struct gaze_over *over)
{
    json_open(json, "targets_over_people", '[');
    for (size_t i = 0; i < over->target_count; i++) {
        const struct gaze_over_target *t = &over->targets[i];
        json_open(json, NULL, '{');
        json_text(json, "fixation", t->fixation);
        json_integer(json, "samples", t->samples.n);
        json_number(json, "samples_mean_deg", gaze_running_mean(&t->samples));
        json_number(json, "samples_sd_deg", gaze_running_sd(&t->samples));
        json_number(json, "samples_median_deg", t->median);
        json_integer(json, "people", (int64_t)t->people.n);
        json_number(json, "people_mean_deg", t->people.mean);
        json_number(json, "people_sd_deg", t->people.sd);
        json_number(json, "ci_low", t->t.ci_low);
        json_number(json, "ci_high", t->t.ci_high);
        json_close(json, '}');
    }
    json_close(json, ']');
}

static void limits_json(struct json *json, const struct sample *sample)
{
    json_open(json, "limits_exceeded", '[');
    for (size_t i = 0; i < sample->exclusion_count; i++) {
        const struct sample_exclusion *e = &sample->exclusions[i];
        if (strncmp(e->rule, "gaze_", 5) != 0)
            continue;
        json_open(json, NULL, '{');
        json_text(json, "participant", e->code);
        json_integer(json, "trial", e->trial_id);
        json_text(json, "rule", e->rule);
        json_text(json, "set", e->rule_set);
        json_text(json, "reason", e->reason);
        json_bool(json, "applied", e->applied);
        json_close(json, '}');
    }
    json_close(json, ']');
}

void gaze_print_json(const struct sample *sample, const struct gaze_report *gaze, const struct gaze_over *over)
{
    struct json json = {stdout, false};
    const struct gaze_rules *rules = &gaze->options.rules;
    json_open(&json, NULL, '{');
    study_title_json(&json, sample);
    json_text(&json, "frame", "degrees in the head's frame, right and up positive");
    json_text(&json, "method", rules->method == GAZE_IVT ? "ivt" : "idt");
    json_number(&json, rules->method == GAZE_IVT ? "velocity_deg_s" : "dispersion_deg",
                rules->method == GAZE_IVT ? rules->velocity_deg_s : rules->dispersion_deg);
    if (rules->method == GAZE_IVT) {
        json_number(&json, "window_ms", rules->window_ms);
        json_number(&json, "peak_ms", rules->peak_ms);
    }
    json_number(&json, "min_fixation_ms", rules->min_fixation_ms);
    json_number(&json, "bcea_share", gaze->options.bcea_share);
    json_number(&json, "region_x_deg", gaze->options.region_x_deg);
    json_number(&json, "region_y_deg", gaze->options.region_y_deg);
    for (int of_people = 1; of_people >= 0; of_people--) {
        size_t count = of_people ? gaze->person_count : gaze->record_count;
        json_open(&json, of_people ? "people" : "by_session", '[');
        for (size_t i = 0; i < count; i++)
            record_json(&json, sample, gaze, of_people ? &gaze->people[i] : &gaze->records[i]);
        json_close(&json, ']');
    }
    over_json(&json, over);
    latencies_json(&json, sample, gaze);
    checks_json(&json, sample, gaze);
    limits_json(&json, sample);
    json_open(&json, "sessions_without_a_sample", '[');
    for (size_t i = 0; i < gaze->silent_count; i++)
        json_integer(&json, NULL, sample->sessions[gaze->silent[i].session].id);
    json_close(&json, ']');
    json_close(&json, '}');
    putchar('\n');
}
