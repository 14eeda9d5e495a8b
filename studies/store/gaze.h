// What an analysis of the gaze asks of a study file. Reads only; same manners as read.h. Each call is one pass
// over its table, or over one trial's frames.
#ifndef STUDIES_STORE_GAZE_H
#define STUDIES_STORE_GAZE_H

#include "studies/store/read.h"

struct store_gaze_sample {                    // in the order they were written
    int64_t session_id, segment_id, trial_id; // trial_id 0: between trials
    int64_t device_ns, host_ns;
    char eye;            // 'l', 'r', 'b'
    double x_deg, y_deg; // NaN where not valid
    bool valid;
};

struct store_gaze_trial {                        // by id
    int64_t id, session_id, segment_id, ordinal; // segment_id 0: never started
    int64_t started_ns, ended_ns;                // of its last attempt; -1: not known
    const char *fixation;                        // "" where there is none
    bool done, practice;
    bool tracker; // the session had one
    double ipd_m; // of the session, between the eyes; NaN: not known
};

struct store_target_row { // of one trial's stimulus frames that had a target, in the order they were shown
    int64_t segment_id, shown_ns; // when its light left the display
    double x_deg, y_deg;          // from the middle between the eyes
    double distance_m;            // from there; NaN: not known
};

struct store_gaze_use { // of a stimulus frame whose fovea follows the gaze, in the order they were shown
    int64_t session_id;
    bool lost;          // the gaze was lost or not known yet: nothing below is known
    double age_ms;      // of the sample when work on the frame began, since it arrived
    double to_light_ms; // from then until light left the display; NaN: not known
    bool estimated;     // the display did not report that time
};

struct store_gaze_check_row { // in the order they were made
    int64_t session_id;
    const char *block;
    double x_deg, y_deg;
    char eye;
    double accuracy_deg, rms_s2s_deg, sd_deg, loss; // NaN where not known
    bool passed;
};

typedef bool (*store_gaze_sample_fn)(void *user, const struct store_gaze_sample *row);
typedef bool (*store_gaze_trial_fn)(void *user, const struct store_gaze_trial *row);
typedef bool (*store_target_fn)(void *user, const struct store_target_row *row);
typedef bool (*store_gaze_use_fn)(void *user, const struct store_gaze_use *row);
typedef bool (*store_gaze_check_fn)(void *user, const struct store_gaze_check_row *row);

bool store_read_gaze(struct store_reader *reader, store_gaze_sample_fn each, void *user);
bool store_read_gaze_trials(struct store_reader *reader, store_gaze_trial_fn each, void *user);
// May be called from within another call's function.
bool store_read_targets(struct store_reader *reader, int64_t trial_id, store_target_fn each, void *user);
bool store_read_gaze_uses(struct store_reader *reader, store_gaze_use_fn each, void *user);
bool store_read_gaze_checks(struct store_reader *reader, store_gaze_check_fn each, void *user);

#endif
