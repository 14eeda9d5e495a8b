// What an audit of every frame asks of a study file. Reads only; same manners as read.h. Times are those of the
// row's segment.
#ifndef STUDIES_STORE_AUDIT_H
#define STUDIES_STORE_AUDIT_H

#include "studies/store/read.h"

struct store_segment_row { // by id
    int64_t id, session_id;
    int64_t submitted; // frames the program says it submitted; -1: it did not end by itself, or drew nothing
    int64_t dropped;   // frame rows that the store says it could not take
    bool drew;         // the session had a display to draw on
};

struct store_audit_trial_row { // by id
    int64_t id, session_id, ordinal;
    char foveate;            // 'g' gaze, 't' target
    bool switches;           // the participant switches between two options
    bool sequence;           // shows two options one after the other, gray between them
    int64_t fade_ns[3];      // to gray, gray, back
    int64_t view_ns, gap_ns; // of a sequence: each option full; gray between them, fades apart
};

enum store_audit_moment { STORE_MOMENT_TOGGLE, STORE_MOMENT_PAUSE }; // a pause, or the question whether to end

struct store_moment_row { // by trial and time
    int64_t session_id, segment_id, trial_id, at_ns;
    enum store_audit_moment what;
};

struct store_audit_frame_row {                                           // by id: in the order they were shown
    int64_t session_id, segment_id, trial_id, attempt, number, start_ns; // trial_id, attempt 0: none
    char option;                                                         // 'a', 'b', 0
    char phase; // 's' stimulus, 'f' fade, 'q' question, 'r' rest
    double fade_level;
    bool rendered, foveated; // something was drawn; by a mode that follows a fovea
    int late;                // 1, 0, -1: not known
    char source;             // of the fovea: 'g' gaze, 't' target, 'f' fixed, 'l' lost, 0
    int64_t gaze_id;         // 0: none
    double gaze_age_ms;      // NaN: none
    bool same_fovea;         // of both eyes, to the last digit
    bool differs;            // what was rendered was not what the condition says
};

struct store_gaze_after { // what came after the sample that a frame was drawn by
    bool blink;           // the samples right after it have no direction
    bool other_eye;       // the sample right after it is the other eye's, and has a direction
};

struct store_exposure_row { // by trial, attempt and time
    int64_t trial_id, segment_id, attempt;
    char option;
    int64_t full_start_ns, full_end_ns; // -1: never full
};

typedef bool (*store_segment_fn)(void *user, const struct store_segment_row *row);
typedef bool (*store_audit_trial_fn)(void *user, const struct store_audit_trial_row *row);
typedef bool (*store_moment_fn)(void *user, const struct store_moment_row *row);
typedef bool (*store_audit_frame_fn)(void *user, const struct store_audit_frame_row *row);
typedef bool (*store_exposure_fn)(void *user, const struct store_exposure_row *row);

bool store_read_segments(struct store_reader *reader, store_segment_fn each, void *user);
bool store_read_audit_trials(struct store_reader *reader, store_audit_trial_fn each, void *user);
bool store_read_moments(struct store_reader *reader, store_moment_fn each, void *user);
bool store_read_audit_frames(struct store_reader *reader, store_audit_frame_fn each, void *user);
// A lookup of its own, since few frames need it; also while frames are being read. All false without a sample
// (0).
bool store_read_gaze_after(struct store_reader *reader, int64_t gaze_id, int64_t segment_id,
                           struct store_gaze_after *out);
bool store_read_exposures(struct store_reader *reader, store_exposure_fn each, void *user);

#endif
