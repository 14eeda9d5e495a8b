#include "analysis/gaze/track.h"

#include <math.h>
#include <stdlib.h>

#define RADIANS (M_PI / 180)

bool gaze_track_init(struct gaze_track *track, const struct gaze_rules *rules, double gap_ms,
                     gaze_event_fn each, void *user)
{
    *track = (struct gaze_track){.rules = *rules, .gap_ms = gap_ms, .each = each, .user = user};
    track->points = malloc(GAZE_TRACK_SAMPLES * sizeof track->points[0]);
    track->velocity = malloc(GAZE_TRACK_SAMPLES * sizeof track->velocity[0]);
    if (track->points && track->velocity)
        return true;
    gaze_track_finish(track);
    return false;
}

void gaze_track_finish(struct gaze_track *track)
{
    free(track->points);
    free(track->velocity);
    track->points = NULL;
    track->velocity = NULL;
}

static void add_precision(struct gaze_quality *q, const struct gaze_event *event,
                          const struct gaze_point *points)
{
    struct gaze_spread own = {.n = 0};
    double across = cos(event->y_deg * RADIANS);
    double longest_ns = 1.5 * (double)(event->end_ns - event->start_ns) / (double)(event->last - event->first);
    for (size_t i = event->first; i <= event->last; i++) {
        gaze_spread_add(&own, points[i].x_deg * across, points[i].y_deg);
        if (i == event->first || (double)(points[i].time_ns - points[i - 1].time_ns) > longest_ns)
            continue;
        double x = (points[i].x_deg - points[i - 1].x_deg) * across, y = points[i].y_deg - points[i - 1].y_deg;
        q->step_xx += x * x;
        q->step_yy += y * y;
        q->steps++;
    }
    gaze_spread_pool(&q->within, &own);
}

static void add_fixation(const struct gaze_track *track, const struct gaze_event *event,
                         const struct gaze_point *points)
{
    struct gaze_quality *q = track->quality;
    if (!track->moving)
        add_precision(q, event, points);
    if (event->cut)
        q->fixations_cut++;
    else
        gaze_running_add(&q->fixation_ms, (double)(event->end_ns - event->start_ns) / 1e6);
}

static void add_event(void *user, const struct gaze_event *event, const struct gaze_point *points)
{
    struct gaze_track *track = user;
    struct gaze_quality *q = track->quality;
    if (event->kind == GAZE_FIXATION) {
        add_fixation(track, event, points);
    } else if (event->cut) {
        q->saccades_cut++;
    } else {
        gaze_running_add(&q->saccade_ms, (double)(event->end_ns - event->start_ns) / 1e6);
        gaze_running_add(&q->amplitude_deg, event->amplitude_deg);
        if (!isnan(event->peak_deg_s))
            gaze_running_add(&q->peak_deg_s, event->peak_deg_s);
    }
    if (track->each)
        track->each(track->user, event, points);
}

static void end_stretch(struct gaze_track *track)
{
    if (track->count)
        gaze_events(&track->rules, track->points, track->count, track->velocity, add_event, track);
    track->count = 0;
}

void gaze_track_break(struct gaze_track *track)
{
    end_stretch(track);
    track->follows = false;
}

void gaze_track_begin(struct gaze_track *track, struct gaze_quality *quality)
{
    gaze_track_break(track);
    track->quality = quality;
}

void gaze_track_sample(struct gaze_track *track, int64_t time_ns, double x_deg, double y_deg, bool valid)
{
    struct gaze_quality *q = track->quality;
    double since_ms = track->follows ? ((double)time_ns - (double)track->last_ns) / 1e6 : (double)NAN;
    bool usable = valid && isfinite(x_deg) && isfinite(y_deg);
    q->samples++;
    q->invalid += !usable;
    if (since_ms <= 0 && since_ms >= -track->gap_ms) {
        q->disordered += usable;
        if (!usable)
            end_stretch(track);
        return;
    }
    if (since_ms > 0)
        gaze_bins_add(&q->interval, since_ms);
    track->follows = true;
    track->last_ns = time_ns;
    if (!usable || since_ms < 0 || since_ms > track->gap_ms || track->count == GAZE_TRACK_SAMPLES)
        end_stretch(track);
    if (usable)
        track->points[track->count++] = gaze_point(time_ns, x_deg, y_deg);
}
