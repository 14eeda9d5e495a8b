// The numbers of one eye, of a session or of a person.
#include "analysis/report/gaze_private.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

// Edges to 100 ms at a tenth; distances to 60 degrees, which no display's middle is farther than, at a
// hundredth.
#define EDGE_MS 0.1
#define DISTANCE_DEG 0.01
enum { EDGE_BINS = 1000, DISTANCE_BINS = 6000 };

bool gaze_record_init(struct gaze_record *record)
{
    if (gaze_quality_init(&record->quality) && gaze_bins_init(&record->edges, EDGE_MS, EDGE_BINS))
        return true;
    gaze_record_finish(record);
    return false;
}

void gaze_record_finish(struct gaze_record *record)
{
    gaze_quality_finish(&record->quality);
    gaze_bins_finish(&record->edges);
    for (size_t i = 0; i < record->target_count; i++)
        gaze_bins_finish(&record->targets[i].distances);
    free(record->amplitude);
    free(record->peak);
    *record = (struct gaze_record){.eye = 0};
}

struct gaze_target *gaze_record_target(struct gaze_record *record, const char *fixation)
{
    for (size_t i = 0; i < record->target_count; i++)
        if (strcmp(record->targets[i].fixation, fixation) == 0)
            return &record->targets[i];
    if (record->target_count == GAZE_TARGETS)
        return NULL;
    struct gaze_target *target = &record->targets[record->target_count];
    *target = (struct gaze_target){.fixation = fixation};
    if (!gaze_bins_init(&target->distances, DISTANCE_DEG, DISTANCE_BINS))
        return NULL;
    record->target_count++;
    return target;
}

void gaze_record_close(struct gaze_record *record, const struct gaze_options *options)
{
    double interval_ms = gaze_quality_interval(&record->quality);
    record->rate_hz = 1000 / interval_ms;
    record->nominal_hz = options->rate_hz > 0 ? options->rate_hz : record->rate_hz;
    double due_ms = 1000 / record->nominal_hz;
    record->missing = gaze_bins_missing(&record->quality.interval, due_ms);
    // At an edge a sample is due once an interval has passed, and no sample ends it.
    for (size_t i = 0; i < record->edges.count + 1; i++)
        if (record->edges.values[i])
            record->missing += floor(record->edges.sums[i] / (double)record->edges.values[i] / due_ms) *
                               (double)record->edges.values[i];
    if (record->session == SAMPLE_NONE)
        record->main_sequence =
            stat_main_sequence(record->amplitude, record->peak, record->saccade_count, options->conf);
}

static bool join_target(struct gaze_record *record, const struct gaze_target *from)
{
    struct gaze_target *to = gaze_record_target(record, from->fixation);
    if (!to)
        return false;
    to->samples += from->samples;
    to->outside += from->outside;
    to->unknown += from->unknown;
    gaze_spread_join(&to->offset, &from->offset);
    gaze_running_join(&to->distance, &from->distance);
    gaze_bins_join(&to->distances, &from->distances);
    return true;
}

static bool append(double **to, size_t count, const double *from, size_t more)
{
    double *room = realloc(*to, (count + more + 1) * sizeof room[0]);
    if (!room)
        return false;
    *to = room;
    if (more)
        memcpy(room + count, from, more * sizeof room[0]);
    return true;
}

bool gaze_record_join(struct gaze_record *to, const struct gaze_record *from)
{
    gaze_quality_join(&to->quality, &from->quality);
    gaze_bins_join(&to->edges, &from->edges);
    to->received += from->received;
    to->received_invalid += from->received_invalid;
    to->between += from->between;
    to->superseded += from->superseded;
    if (!append(&to->amplitude, to->saccade_count, from->amplitude, from->saccade_count) ||
        !append(&to->peak, to->saccade_count, from->peak, from->saccade_count))
        return false;
    to->saccade_count += from->saccade_count;
    for (size_t i = 0; i < from->target_count; i++)
        if (!join_target(to, &from->targets[i]))
            return false;
    return true;
}

const char *gaze_eye_words(char eye)
{
    return eye == 'l' ? "left" : eye == 'r' ? "right" : "both";
}

// On a target that moves the eyes are behind it, which is not the tracker's error.
const struct gaze_target *gaze_accuracy(const struct gaze_record *record)
{
    for (size_t i = 0; i < record->target_count; i++)
        if (strcmp(record->targets[i].fixation, "moving") != 0 && record->targets[i].samples)
            return &record->targets[i];
    return NULL;
}

double gaze_due(const struct gaze_record *record)
{
    return (double)record->quality.samples + record->missing;
}
