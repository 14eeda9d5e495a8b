// Shared by audit*.c only.
#ifndef ANALYSIS_REPORT_AUDIT_PRIVATE_H
#define ANALYSIS_REPORT_AUDIT_PRIVATE_H

#include "analysis/report/audit.h"
#include "studies/store/audit.h"

// A switch by the participant, or a pause.
struct audit_moment {
    struct store_moment_row row;
    int64_t toggle; // counted within its trial, from 1; 0: a pause
    bool judged, off;
};

// The fade under way, as frames show it.
struct audit_watch {
    int64_t segment_id, trial_id, attempt, last_number;
    char option;              // of the last full frame; 0: none since the trial or a pause began
    int64_t full_ns;          // that frame's time
    int64_t first_ns;         // the first frame of the fade, -1: not fading
    int64_t gray_ns, back_ns; // the first gray frame; the first one after it that is not
    bool gap;                 // a frame row is missing in it; of a sequential trial, since the showing began
    // Of a sequential trial only:
    int64_t view_ns; // the first full frame of the showing
    bool second;     // it is the second one
};

// One file's audit while its rows arrive.
struct audit_pass {
    struct audit *audit;
    struct sample *sample;
    size_t file;
    struct store_segment_row *segments;
    struct store_audit_trial_row *trials; // by id
    struct audit_moment *moments;         // by trial, segment, time
    size_t segment_count, trial_count, moment_count;
    struct audit_watch watch;
    struct store_exposure_row exposure;          // the last one
    int64_t segment_id, last_number, last_trial; // of the last frame
    size_t session;                              // of the last frame, into audit.sessions
    size_t trial;                                // of the last finding, into audit.trials
    int64_t gaze_id, gaze_first_ns;              // the sample in use and the first frame that used it
};

const struct store_audit_trial_row *audit_find_trial(const struct audit_pass *pass, int64_t id);
size_t audit_find_session(struct audit_pass *pass,
                          int64_t session_id); // SAMPLE_NONE: not of the sample, or no memory
// Counts for the session and for the trial (0: between trials).
bool audit_note(struct audit_pass *pass, size_t session, int64_t trial_id, enum audit_count what, int64_t by);

double audit_frame_ns(const struct audit_pass *pass, size_t session); // one refresh; NaN: not known
bool audit_paused_between(const struct audit_pass *pass, int64_t trial_id, int64_t segment_id, int64_t from_ns,
                          int64_t to_ns);
// How a corner of a fade is off, if it is.
bool audit_corner(const char *what, int64_t seen_ns, int64_t due_ns, double frame, char out[96]);
// A finding; `number` is the how manieth fade of the trial, 0 where that is not known.
bool audit_note_fade(struct audit_pass *pass, size_t session, const struct store_audit_trial_row *trial,
                     int64_t number, const char *what);

// Part of audit_watch_frame(): a frame of a sequential trial's pictures.
bool audit_watch_sequence(struct audit_pass *pass, const struct store_audit_trial_row *trial,
                          const struct store_audit_frame_row *row);

// Follow the frames, then the exposures; each judges the fades that it sees from end to end.
bool audit_watch_frame(struct audit_pass *pass, const struct store_audit_frame_row *row);
bool audit_take_exposure(void *user, const struct store_exposure_row *row);

#endif
