// One eye's samples, one by one as the tracker sent them: counts, precision, fixations and saccades.
//
// Use: gaze_track_init(), for each recording gaze_track_begin() with the struct its numbers go to, then
// gaze_track_sample() for each sample and gaze_track_break() where samples stop belonging together (a trial's
// end); gaze_track_begin(NULL) and gaze_track_finish() at the end.
//
// A stretch of samples is broken by a sample that is not valid, by one not finite, by a time longer than the
// gap, and by a clock that jumps back farther than it. A sample whose time is not later than the one before it
// is counted and left out. A stretch of GAZE_TRACK_SAMPLES is broken too, so that memory stays bounded: at 250
// Hz that is more than four minutes without a blink.
//
// Precision is measured within fixations, about each one's own mean, horizontally in degrees on the great
// circle (x times the cosine of the fixation's y). Steps from sample to sample longer in time than one and a
// half mean steps of their fixation have samples missing between them and are left out. As the rules choose
// calm samples, precision measured so is a little better than the tracker's noise where that comes near the
// threshold. While `moving` is set, what the eyes follow moves: fixations are pursuit then (Holmqvist, Nystrom
// & Mulvey 2012, Eye tracker data quality, ETRA 2012, 45-52: precision is of a target at rest) and count as
// events alone.
#ifndef ANALYSIS_GAZE_TRACK_H
#define ANALYSIS_GAZE_TRACK_H

#include "analysis/gaze/bins.h"
#include "analysis/gaze/events.h"
#include "analysis/gaze/running.h"
#include "analysis/gaze/spread.h"

enum { GAZE_TRACK_SAMPLES = 65536 };

struct gaze_quality {
    int64_t samples;           // all of them
    int64_t invalid;           // not valid, or no finite direction
    int64_t disordered;        // valid, but not later than the sample before
    struct gaze_bins interval; // ms, between successive samples, valid or not; owned
    double step_xx, step_yy;   // sums of squared steps within fixations, deg^2
    int64_t steps;
    struct gaze_spread within; // of the fixations, pooled
    // Fixations and saccades that are cut are counted apart and not part of the other numbers.
    int64_t fixations_cut, saccades_cut;
    struct gaze_running fixation_ms, saccade_ms, amplitude_deg, peak_deg_s;
};

bool gaze_quality_init(struct gaze_quality *quality); // false where memory ran out
void gaze_quality_finish(struct gaze_quality *quality);
void gaze_quality_join(struct gaze_quality *to, const struct gaze_quality *from);
// Root mean square of the steps in degrees: horizontal, vertical, both; NaN where there is none.
double gaze_quality_rms_x(const struct gaze_quality *quality);
double gaze_quality_rms_y(const struct gaze_quality *quality);
double gaze_quality_rms(const struct gaze_quality *quality);
// The time from one sample to the next where none is lost, in ms, from the shortest times that are usual: right
// also where up to 80 % of the samples are missing at random. NaN where it cannot be measured: no time between
// samples, or times that are no multiples of one. It cannot know of samples missing by a rule, as each second
// one.
double gaze_quality_interval(const struct gaze_quality *quality);

struct gaze_track {
    struct gaze_rules rules;
    double gap_ms;
    gaze_event_fn each; // may be NULL
    void *user;
    struct gaze_quality *quality; // borrowed
    struct gaze_point *points;    // owned; the stretch so far
    double *velocity;             // owned
    size_t count;
    bool moving;  // set between gaze_track_break() and the next sample; see above
    bool follows; // a sample of the same trial came before
    int64_t last_ns;
};

bool gaze_track_init(struct gaze_track *track, const struct gaze_rules *rules, double gap_ms,
                     gaze_event_fn each,
                     void *user); // false where memory ran out
void gaze_track_finish(struct gaze_track *track);
void gaze_track_begin(struct gaze_track *track, struct gaze_quality *quality);
void gaze_track_break(struct gaze_track *track);
void gaze_track_sample(struct gaze_track *track, int64_t time_ns, double x_deg, double y_deg, bool valid);

#endif
