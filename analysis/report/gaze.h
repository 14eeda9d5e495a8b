// The eye tracker's quality, and what the eyes did, per person and per session, for each eye apart.
//
// Of samples in the last attempt of a trial; those between trials and of interrupted attempts are counted and
// left out. Intervals, velocities and events go by the tracker's clock; targets and frames by ours, when the
// sample arrived. Angles are degrees of visual angle in the head's frame.
//
// Data loss in two parts: samples that came and are not valid, of those that came; and samples that did not
// come, of those that were due at the nominal rate: between two samples of a trial, from its start to the first
// and from the last to its end, and throughout trials without any; right to one sample at each end of a
// trial. A sitting whose own rate cannot be measured, as one without any sample, has that of the person's
// others.
//
// The target is where the frame on the display at the sample's arrival had it, in trials that are done, and
// neither practice nor excluded. It stands at a depth, and each eye is beside the middle that the frame's
// direction is from, so that one eye's sample is compared with where that eye sees it: by the frame's distance
// and the session's interpupillary distance, as the program's own fovea on a target. Where a file does not have
// these, one eye's distance is not estimable. Accuracy is the mean distance of all valid samples from a target
// at rest, saccades and looks elsewhere included. Distance as in Weier et al. 2016, section 4.2.2, leaves out
// samples outside `region` (10.3 degrees left and right, 11.68 up and down there: what their tracker's
// calibration covers).
//
// Does not: know the tracker's own delay (its clock is not ours), or average the two eyes.
#ifndef ANALYSIS_REPORT_GAZE_H
#define ANALYSIS_REPORT_GAZE_H

#include "analysis/gaze/track.h"
#include "analysis/report/sample.h"
#include "analysis/stats/main_sequence.h"

enum { GAZE_TARGETS = 4 }; // kinds of fixation: the protocol knows cross and moving

// One event as it is found. The trial is its id in the file.
typedef void (*gaze_report_event_fn)(void *user, size_t session, int64_t trial_id, char eye,
                                     const struct gaze_event *event);

struct gaze_options {
    struct gaze_rules rules;
    double gap_ms;                     // longer times without a sample break an event
    double rate_hz;                    // nominal; 0: as measured
    double region_x_deg, region_y_deg; // of samples compared with the target
    double bcea_share;
    double conf;
    gaze_report_event_fn each; // may be NULL
    void *user;
};

struct gaze_options gaze_options(enum gaze_method method);

struct gaze_target {
    const char *fixation;         // as the trial names it; owned by the sample
    int64_t unknown;              // no frame with a target was on the display
    int64_t flat;                 // of one eye: how far away the target was, or where the eye is, is not known
    struct gaze_spread offset;    // gaze less target, of all others
    struct gaze_running error;    // degrees between the two
    int64_t samples, outside;     // of these, within the region and not
    struct gaze_running distance; // degrees between the two, within the region
    struct gaze_bins distances;   // owned
};

struct gaze_record {
    size_t person, session; // session SAMPLE_NONE: of all the person's sessions
    char eye;               // 'l', 'r', 'b'
    struct gaze_quality quality;
    int64_t received, received_invalid; // all samples of the session, also those left out
    int64_t between, superseded;        // samples left out: between trials, of attempts that were not the last
    struct gaze_bins edges;             // ms without a sample at the ends of trials; owned
    size_t target_count;
    struct gaze_target targets[GAZE_TARGETS];
    double rate_hz;                          // measured; NaN where it is not, or where sittings differ
    double slowest_hz, fastest_hz;           // of a person's sittings; NaN where none is measured
    double nominal_hz;                       // at which samples are due; NaN where it is not known
    double missing;                          // samples that did not come; NaN where the rate is not known
    size_t saccade_count;                    // complete ones whose peak is known
    double *amplitude, *peak;                // owned
    double *span;                            // that each peak is really taken over; owned; not of people
    double span_ms, span_hz;                 // that a peak is taken over where no sample is missing, at which
                                             // rate; NaN: not known
    struct stat_main_sequence main_sequence; // of people only; NaN where the span is too long
};

struct gaze_latency { // of one session
    size_t session;
    int64_t lost;                       // stimulus frames drawn while the gaze was lost, not part of `frames`
    int64_t frames, estimated, unknown; // frames that followed the gaze; time of light estimated, not known
    struct gaze_bins age, to_light;     // ms; to_light from the sample's arrival to its frame's light; owned
};

struct gaze_check { // a point of an independent check of the tracker
    size_t session;
    const char *block; // owned by the sample
    double x_deg, y_deg, accuracy_deg, rms_s2s_deg, sd_deg, loss;
    char eye;
    bool passed;
};

struct gaze_silent { // a session with a tracker and no sample in any trial
    size_t session;
    struct gaze_bins time; // ms of its trials; owned
};

struct gaze_report {
    struct gaze_options options;
    size_t record_count; // of sessions, then eyes
    struct gaze_record *records;
    size_t person_count;
    struct gaze_record *people; // of people, then eyes
    size_t latency_count;
    struct gaze_latency *latencies;
    size_t check_count;
    struct gaze_check *checks;
    size_t silent_count;
    struct gaze_silent *silent;
};

// Two passes over each file at once, on two threads: gaze, and frames. Memory grows with people, trials and
// saccades, not with samples.
bool gaze_load(struct gaze_report *out, struct sample *sample, const struct gaze_options *options, char *error,
               size_t error_size);
void gaze_free(struct gaze_report *report);

// "left", "right", "both".
const char *gaze_eye_words(char eye);
// The kind of target where the eyes rest, whose mean error is the accuracy; NULL where none was compared.
const struct gaze_target *gaze_accuracy(const struct gaze_record *record);
// Samples due: those that came and those that did not.
double gaze_due(const struct gaze_record *record);
// One eye's samples on targets of unknown depth, of all people.
int64_t gaze_flat_samples(const struct gaze_report *report);
// Frames that should follow the gaze and had none, of all sessions, and all frames that should.
int64_t gaze_lost_frames(const struct gaze_report *report, int64_t *out_all);

// What is measured of saccades but cannot be estimated at the tracker's rate.
enum { GAZE_REASON_SIZE = 96, GAZE_WORDS_SIZE = 960 };
enum gaze_part { GAZE_VMAX, GAZE_C, GAZE_POWER };
// Why a person's part of the main sequence is not estimable; false where it is.
bool gaze_sequence_problem(const struct gaze_record *record, enum gaze_part part, char out[GAZE_REASON_SIZE]);
// All of them in one line, "" where every part is.
void gaze_sequence_remark(const struct gaze_record *record, char out[GAZE_WORDS_SIZE]);
// What a peak is, at which rates and over which time, and how wrong the fits to it may be.
void gaze_sequence_words(const struct gaze_report *report, char out[GAZE_WORDS_SIZE]);
// "250.0"; "60.0 to 250.0" where sittings differ; "" where it cannot be measured.
void gaze_rate_words(const struct gaze_record *record, char out[GAZE_REASON_SIZE]);

#endif
