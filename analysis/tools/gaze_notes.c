// What stands below the tables of fovstats gaze: rules, what was left out, limits exceeded.
#include "analysis/tools/gaze_parts.h"

#include "analysis/tools/study_arguments.h"

#include <inttypes.h>
#include <string.h>

void gaze_print_notes(const struct sample *sample, const struct gaze_report *gaze)
{
    const struct gaze_rules *rules = &gaze->options.rules;
    int64_t between = 0, superseded = 0, disordered = 0;
    if (rules->method == GAZE_IVT)
        printf(
            "I-VT: faster than %g deg/s over %g ms is a saccade; fixations from %g ms, saccades from %g ms;\n"
            "gaps over %g ms break events.",
            rules->velocity_deg_s, rules->window_ms, rules->min_fixation_ms, rules->min_saccade_ms,
            gaze->options.gap_ms);
    else
        printf("I-DT: fixations within %g deg, from %g ms; gaps over %g ms break them. Saccades need --method "
               "ivt.",
               rules->dispersion_deg, rules->min_fixation_ms, gaze->options.gap_ms);
    printf(" BCEA: P = %g. Head's frame, right and up positive.\n", gaze->options.bcea_share);
    puts("Accuracy is of all valid samples on a target at rest, saccades included; precision of fixations in "
         "trials\nwithout a moving target. The data's SHA-256 does not cover the rows of gaze and frames.");
    for (size_t i = 0; i < gaze->record_count; i++) {
        between += gaze->records[i].between;
        superseded += gaze->records[i].superseded;
        disordered += gaze->records[i].quality.disordered;
    }
    printf("Left out, samples between trials: %" PRId64 "; of interrupted attempts: %" PRId64 ".\n", between,
           superseded);
    if (disordered)
        printf("Left out of fixations and saccades, samples not later than the one before: %" PRId64 ".\n",
               disordered);
    for (size_t i = 0; i < gaze->silent_count; i++)
        printf("Session %" PRId64 " had a tracker and no sample in any trial: all its samples are missing.\n",
               sample->sessions[gaze->silent[i].session].id);
    for (size_t i = 0; i < sample->exclusion_count; i++) {
        const struct sample_exclusion *e = &sample->exclusions[i];
        if (strncmp(e->rule, "gaze_", 5) == 0)
            printf("Limit exceeded, %s, trial %" PRId64 ", %s (%s): %s.\n", e->code, e->trial_id, e->rule,
                   e->rule_set, e->reason);
    }
    study_notes(sample);
}
