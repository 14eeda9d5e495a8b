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
    free(record->span);
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

bool gaze_silent_init(struct gaze_silent *silent, size_t session)
{
    *silent = (struct gaze_silent){.session = session};
    return gaze_bins_init(&silent->time, EDGE_MS, EDGE_BINS);
}

// At an edge a sample is due once an interval has passed, and no sample ends it.
static double missing_at_edges(const struct gaze_bins *edges, double due_ms)
{
    double missing = 0;
    for (size_t i = 0; i < edges->count + 1; i++)
        if (edges->values[i])
            missing += floor(edges->sums[i] / (double)edges->values[i] / due_ms) * (double)edges->values[i];
    return missing;
}

// One rule for mean and main sequence. Of a tracker fast enough for c, a peak that samples are missing at would
// bend the curve: it must tell c itself.
static void keep_known_peaks(struct gaze_record *record, double due_ms)
{
    // a missing sample adds an interval, an error of time less than half of one
    bool shape = record->span_ms <= GAZE_SHAPE_SPAN_MS;
    double longest = shape ? record->span_ms + due_ms / 2 : GAZE_VMAX_SPAN_MS;
    size_t kept = 0;
    record->quality.peak_deg_s = (struct gaze_running){.n = 0};
    for (size_t i = 0; i < record->saccade_count; i++)
        if (record->span_ms <= GAZE_VMAX_SPAN_MS && record->span[i] <= longest) {
            record->amplitude[kept] = record->amplitude[i];
            record->peak[kept] = record->peak[i];
            record->span[kept++] = record->span[i];
            gaze_running_add(&record->quality.peak_deg_s, record->peak[i]);
        }
    record->saccade_count = kept;
}

void gaze_record_close(struct gaze_record *record, const struct gaze_options *options)
{
    double due_ms = 1000 / record->nominal_hz;
    record->missing = due_ms > 0 ? gaze_bins_missing(&record->quality.interval, due_ms) +
                                       missing_at_edges(&record->edges, due_ms)
                                 : (double)NAN;
    record->span_hz = record->nominal_hz;
    record->span_ms = gaze_velocity_span_ms(due_ms, options->rules.peak_ms);
    keep_known_peaks(record, due_ms);
}

static bool join_target(struct gaze_record *record, const struct gaze_target *from)
{
    struct gaze_target *to = gaze_record_target(record, from->fixation);
    if (!to)
        return false;
    to->samples += from->samples;
    to->outside += from->outside;
    to->unknown += from->unknown;
    to->flat += from->flat;
    gaze_spread_join(&to->offset, &from->offset);
    gaze_running_join(&to->error, &from->error);
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

// The longest span of sittings whose peaks tell something; where none does, the shortest.
static void join_span(struct gaze_record *to, const struct gaze_record *from)
{
    bool ours = to->span_ms <= GAZE_VMAX_SPAN_MS, theirs = from->span_ms <= GAZE_VMAX_SPAN_MS;
    bool worse = theirs ? from->span_ms > to->span_ms : from->span_ms < to->span_ms;
    if (isnan(to->span_ms) || (theirs && !ours) || (theirs == ours && worse)) {
        to->span_ms = from->span_ms;
        to->span_hz = from->span_hz;
    }
}

bool gaze_record_join(struct gaze_record *to, const struct gaze_record *from)
{
    size_t saccades = from->saccade_count;
    join_span(to, from);
    gaze_quality_join(&to->quality, &from->quality);
    gaze_bins_join(&to->edges, &from->edges);
    to->received += from->received;
    to->received_invalid += from->received_invalid;
    to->between += from->between;
    to->superseded += from->superseded;
    if (!append(&to->amplitude, to->saccade_count, from->amplitude, saccades) ||
        !append(&to->peak, to->saccade_count, from->peak, saccades))
        return false;
    to->saccade_count += saccades;
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
        if (strcmp(record->targets[i].fixation, "moving") != 0 && record->targets[i].error.n)
            return &record->targets[i];
    return NULL;
}

double gaze_due(const struct gaze_record *record)
{
    return (double)record->quality.samples + record->missing;
}
