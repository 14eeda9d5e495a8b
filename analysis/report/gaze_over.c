#include "analysis/report/gaze_over.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const struct gaze_target *target_of(const struct gaze_record *record, const char *fixation)
{
    for (size_t i = 0; i < record->target_count; i++)
        if (strcmp(record->targets[i].fixation, fixation) == 0 && record->targets[i].samples)
            return &record->targets[i];
    return NULL;
}

static void options_of(const struct gaze_report *report, struct stat_ttest_options *out)
{
    *out = (struct stat_ttest_options){.conf = report->options.conf};
}

// `values` has room for every person.
static bool over_target(struct gaze_over_target *out, const struct gaze_report *report, double *values)
{
    struct gaze_bins bins = {.width = 0};
    size_t count = 0;
    for (size_t i = 0; i < report->person_count;) {
        struct gaze_running person = {.n = 0};
        size_t who = report->people[i].person;
        for (; i < report->person_count && report->people[i].person == who; i++) {
            const struct gaze_target *target = target_of(&report->people[i], out->fixation);
            if (!target)
                continue;
            if (!bins.values && !gaze_bins_init(&bins, target->distances.width, target->distances.count))
                return false;
            gaze_running_join(&person, &target->distance);
            gaze_bins_join(&bins, &target->distances);
        }
        gaze_running_join(&out->samples, &person);
        if (person.n)
            values[count++] = person.mean;
    }
    struct stat_ttest_options options;
    options_of(report, &options);
    out->median = bins.values ? gaze_bins_quantile(&bins, 0.5) : (double)NAN;
    out->people = stat_moments(values, count);
    out->t = stat_ttest_one_sample(values, count, &options);
    gaze_bins_finish(&bins);
    return true;
}

static bool over_targets(struct gaze_over *out, const struct gaze_report *report, double *values)
{
    for (size_t i = 0; i < report->person_count; i++)
        for (size_t j = 0; j < report->people[i].target_count; j++) {
            const char *fixation = report->people[i].targets[j].fixation;
            bool known = report->people[i].targets[j].samples == 0;
            for (size_t k = 0; k < out->target_count && !known; k++)
                known = strcmp(out->targets[k].fixation, fixation) == 0;
            if (known || out->target_count == GAZE_TARGETS)
                continue;
            struct gaze_over_target *target = &out->targets[out->target_count++];
            target->fixation = fixation;
            if (!over_target(target, report, values))
                return false;
        }
    return true;
}

static void over_sequences(struct gaze_over *out, const struct gaze_report *report, double *values)
{
    struct stat_ttest_options options;
    options_of(report, &options);
    for (int e = 0; e < GAZE_EYES; e++) {
        struct gaze_over_sequence s = {.eye = "lrb"[e]};
        for (int which = 0; which < 2; which++) {
            size_t count = 0;
            for (size_t i = 0; i < report->person_count; i++) {
                const struct stat_main_sequence *fit = &report->people[i].main_sequence;
                double value = which ? fit->c.value : fit->vmax.value;
                if (report->people[i].eye == s.eye && isfinite(value))
                    values[count++] = value;
            }
            *(which ? &s.c : &s.vmax) = stat_moments(values, count);
            *(which ? &s.c_t : &s.vmax_t) = stat_ttest_one_sample(values, count, &options);
        }
        if (s.vmax.n > 1)
            out->sequences[out->sequence_count++] = s;
    }
}

bool gaze_over_people(struct gaze_over *out, const struct gaze_report *report)
{
    double *values = calloc(report->person_count + 1, sizeof values[0]);
    *out = (struct gaze_over){.target_count = 0};
    bool ok = values && over_targets(out, report, values);
    if (ok)
        over_sequences(out, report, values);
    free(values);
    return ok;
}
