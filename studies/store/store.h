// The study file: everything a study yields, in one SQLite database that survives crashes (schema.sql describes
// it).
//
// Use: store_open -> store_participant_number (the plan needs it) -> store_create_session -> per trial
//      store_start_trial, store_push_* while it runs, store_answer_* -> store_end_session -> store_close.
// Does not: read clocks, draw random numbers, decide anything about a study, or compute statistics (read.h
// reads).
//
// Two ways to write:
// - Calls that return an enum store_result are synchronous: when they return STORE_OK, what they wrote and all
// that
//   was pushed before is on disk (commit and fsync). Otherwise nothing of the call was written, and after
//   STORE_FAILED the same call may be made again: nothing pushed or answered before is lost.
// - store_push_* never touches the disk and never waits: it copies into a fixed queue that a thread of the
// store
//   commits every desc.flush_ms. When the queue is full the row is dropped, counted, shown by store_status and
//   reported by an event row of kind "log_overflow" (JSON: rows dropped by kind) as soon as there is room.
//
// One program writes a file at a time: store_open holds a lock (flock) on the side file FILE-owner, which names
// the process, goes away with it however it ends, and is removed by store_close. Readers need no lock. Any
// thread may call anything except store_close. Strings and arrays need only live for the call. A child made by
// fork() must not use or close its parent's store.
//
// Unknown values: an id of 0, a NULL string, a NaN and STORE_UNKNOWN are stored as NULL. Where a column may not
// be NULL, the call is refused. Words of closed sets are those of schema.sql.
#ifndef STUDIES_STORE_STORE_H
#define STUDIES_STORE_STORE_H

#include "stimuli/viewing.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define STORE_UNKNOWN INT64_MIN // for integers that may be NULL: nanoseconds, shaded_px, triangles

enum {
    STORE_ERROR_SIZE = 512,
    STORE_DETAIL_SIZE = 256, // longest text in a pushed row, with its end
};

enum store_result {
    STORE_OK,
    STORE_REFUSED, // what was asked is wrong; asking again gives the same
    STORE_FAILED,  // the disk or another program is in the way; the call may be made again
};

// One sentence: what is wrong, where, what to do. Empty after STORE_OK.
struct store_error {
    char text[STORE_ERROR_SIZE];
};

enum store_slot { STORE_NO_SLOT, STORE_A, STORE_B, STORE_EQUAL }; // STORE_EQUAL only as an answer

struct store;

// --- open and close ---

enum store_access {
    STORE_WRITE,  // an existing study file
    STORE_CREATE, // an existing one, or a new one where there is none or an empty file
    STORE_READ, // an existing one, for read.h; nothing is written, no lock is taken, others may write meanwhile
};

struct store_desc {
    const char *path;
    enum store_access access;
    uint32_t busy_ms;       // how long a write waits for another program's; 0: 5000
    uint32_t flush_ms;      // longest time a pushed row waits for its commit, 1..1000; 0: 250
    uint32_t gaze_capacity; // samples that may wait; 0: 65536 (a minute at 1,000 Hz)
    uint32_t log_capacity;  // frames, exposures, events, adjust steps that may wait; 0: 16384 (three minutes at
                            // 90 Hz)
    const char *vfs;        // SQLite VFS by name, for tests; NULL: the system's
};

// Refuses what is not a database, another program's database, a newer version, a damaged file, a file or folder
// that cannot be written, and a file that another program writes. An older version is migrated. NULL: see
// error.
struct store *store_open(const struct store_desc *desc, struct store_error *error);

// Commits what waits, then closes. When the result is not STORE_OK, rows were lost and the error says how many.
// The store is gone in any case; NULL is fine.
enum store_result store_close(struct store *store, struct store_error *error);
// store_close for work that failed before a session was made: a file that this store_open made, and that holds
// no session, goes away again.
enum store_result store_abandon(struct store *store, struct store_error *error);

// From now on a write waits at most this long for another program's: a running session must not stand still.
void store_set_busy(struct store *store, uint32_t busy_ms);

// For simulated participants: from now on a commit no longer waits until it is on disk. A program that ends
// however it ends still loses nothing; a power cut loses the last commits, whole ones, and damages nothing. A
// file that holds a person is left as it is.
enum store_result store_rehearse(struct store *store, struct store_error *error);

// Reads the whole file: SQLite's integrity_check and foreign_key_check. Minutes for gigabytes.
enum store_result store_check(struct store *store, struct store_error *error);

// --- a session and its plan ---

struct store_protocol {
    const char *name, *sha256, *text; // sha256: 64 lower-case hexadecimal digits
};

struct store_participant {
    const char *code;
    const char *kind;       // "person" or "simulated"
    const char *attributes; // JSON object; NULL: {}
    int64_t number;         // 1..; from store_participant_number
};

struct store_segment {
    const char *started_at; // ISO 8601 UTC
    int64_t mono_origin_ns;
    const char *clock; // "monotonic" or "simulated"
    const char *boot_id;
    const char *app_version;
    const char *reason; // "start", "resume"
};

struct store_condition {
    const char *mode;
    const char *parameters; // JSON object of every parameter, in the order of the mode's table
};

struct store_trial {
    int64_t ordinal; // 1..
    const char *block, *kind, *scene;
    const char *settings, *factors; // JSON objects; NULL: {}
    int32_t option_a, option_b;     // indices into the desc's conditions; -1: none
    enum store_slot test_slot, first_shown;
    const char *fixation;
    uint64_t seed;
    int64_t repeat_of; // trial id
};

struct store_session {
    struct store_protocol protocol;       // one row per distinct sha256
    struct store_participant participant; // one row per code; a known code must have the same number and kind
    struct store_segment segment;         // the first
    uint64_t seed;
    const char *started_at;
    const char *consent_at, *consent_version; // both or neither
    const char *device, *driver, *display;
    double refresh_hz; // 0 or NaN: not known, as for width_px, height_px, fov_deg
    int64_t width_px, height_px;
    double fov_deg;
    const char *settings; // JSON object; NULL: {}
    bool again;           // a participant may have an earlier session in this file

    const struct store_condition *conditions; // equal ones share a row
    uint32_t condition_count;
    const struct store_trial *trials;
    uint32_t trial_count;
};

struct store_session_ids {
    int64_t session_id, segment_id, participant_id, protocol_id;
    int64_t *condition_ids; // caller's, condition_count long; NULL: not wanted
    int64_t *trial_ids;     // caller's, trial_count long; NULL: not wanted
};

// The number of a participant: the one the code has in this file; else `wanted` where it is free; else, with
// wanted 0, the first free one. A number is free when nobody has it who was not excluded as a person, as
// planned or late.
enum store_result store_participant_number(struct store *store, const char *code, int64_t wanted,
                                           int64_t *out_number, struct store_error *error);

// Everything or nothing. Refused: another seed than the file's sessions have, people and simulated observers in
// one file, a number that is taken, a code that has a session (unless `again`).
enum store_result store_create_session(struct store *store, const struct store_session *session,
                                       struct store_session_ids *out_ids, struct store_error *error);

enum store_result store_set_consent(struct store *store, int64_t session_id, const char *consent_at,
                                    const char *consent_version, struct store_error *error);
enum store_result store_add_segment(struct store *store, int64_t session_id,
                                    const struct store_segment *segment, int64_t *out_id,
                                    struct store_error *error);
// A repetition after the plan. Its options are condition ids here, not indices, 0 for none.
enum store_result store_add_trial(struct store *store, int64_t session_id, const struct store_trial *trial,
                                  int64_t option_a_id, int64_t option_b_id, int64_t *out_id,
                                  struct store_error *error);
// The id of an equal condition, or of a new row.
enum store_result store_add_condition(struct store *store, const struct store_condition *condition,
                                      int64_t *out_id, struct store_error *error);
// status "complete" or "aborted"; only a running session can end. A trial that runs has no answer and gets
// none: it is skipped, at ended_ns.
enum store_result store_end_session(struct store *store, int64_t session_id, const char *status,
                                    const char *ended_at, int64_t ended_ns, struct store_error *error);

// --- trials and answers ---

// Status running, next attempt. Refused where the trial is not planned or running.
enum store_result store_start_trial(struct store *store, int64_t trial_id, int64_t segment_id,
                                    int64_t started_ns, int64_t *out_attempt, struct store_error *error);
// What a trial shows in a slot that is known only when it starts, as of a staircase.
enum store_result store_set_trial_option(struct store *store, int64_t trial_id, enum store_slot slot,
                                         int64_t condition_id, struct store_error *error);
// Makes a trial invalid and plans it again at the end, at `ordinal`; both or neither. ordinal 0: not again,
// out_id 0.
enum store_result store_repeat_trial(struct store *store, int64_t trial_id, int64_t ordinal, int64_t ended_ns,
                                     int64_t *out_id, struct store_error *error);
// Status "done", "skipped", "invalid", or "planned" to give an interrupted one back. ended_ns may be
// STORE_UNKNOWN.
enum store_result store_end_trial(struct store *store, int64_t trial_id, const char *status, int64_t ended_ns,
                                  struct store_error *error);

enum store_verdict { STORE_NO_VERDICT, STORE_WRONG, STORE_CORRECT }; // NO_VERDICT for a preference

struct store_staircase_step {
    double level;
    int64_t outcome; // 0..
    bool reversal;
    double estimate;
};

struct store_choice {
    int64_t trial_id, segment_id;
    enum store_slot chosen;
    enum store_verdict correct;
    int64_t reaction_ns, answered_ns;
    int64_t toggles;
    bool ends_trial;                         // the trial becomes done at answered_ns, in the same transaction
    const struct store_staircase_step *step; // written in the same transaction; NULL: none
};

struct store_rating {
    int64_t trial_id, session_id; // exactly one, the other 0
    int64_t segment_id;
    const char *question;
    const char *subject; // "a", "b", "scene"
    int64_t condition_id;
    double value, scale_min, scale_max;
    int64_t answered_ns;
    bool ends_trial;
    const struct store_staircase_step *step; // written in the same transaction; NULL: none
};

struct store_response {
    int64_t trial_id, segment_id;
    const char *question;
    double value, expected;
    int64_t answered_ns;
    const char *device;
    bool ends_trial;
};

// A trial has at most one choice, one rating per question and subject, one response per question: an answer
// that was acknowledged stays, and a second one is refused.
enum store_result store_answer_choice(struct store *store, const struct store_choice *choice, int64_t *out_id,
                                      struct store_error *error);
enum store_result store_answer_rating(struct store *store, const struct store_rating *rating, int64_t *out_id,
                                      struct store_error *error);
// One answer of one or several values, all or none of them; ends_trial of the last one counts. out_id: of the
// first.
enum store_result store_answer_responses(struct store *store, const struct store_response *responses,
                                         uint32_t count, int64_t *out_id, struct store_error *error);
enum store_result store_add_staircase_step(struct store *store, int64_t trial_id,
                                           const struct store_staircase_step *step, int64_t *out_id,
                                           struct store_error *error);

// --- what goes with it ---

struct store_gaze_check {
    int64_t session_id, segment_id, at_ns;
    const char *block;
    double x_deg, y_deg;
    enum gaze_eye eye;
    double accuracy_deg, rms_s2s_deg, sd_deg;
    double loss; // 0..1
    bool passed;
};

struct store_exclusion {
    int64_t trial_id, session_id, participant_id; // exactly one, the others 0
    const char *rule, *rule_set, *reason, *by, *applied_at;
};

struct store_error_key {
    int64_t condition_id, reference_id;
    const char *scene, *metric;
};

enum store_result store_add_gaze_check(struct store *store, const struct store_gaze_check *check,
                                       int64_t *out_id, struct store_error *error);
enum store_result store_add_exclusion(struct store *store, const struct store_exclusion *exclusion,
                                      int64_t *out_id, struct store_error *error);
// Replaces an earlier value of the same key.
enum store_result store_set_measured_error(struct store *store, const struct store_error_key *key, double value,
                                           struct store_error *error);
// Every error against the reference, in the order of conditions; texts live for the call, which returns false
// to stop. The store must not be used in it.
struct store_measured {
    const char *mode, *parameters; // of the condition
    const char *scene, *metric;
    double value;
};
typedef bool (*store_measured_fn)(void *user, const struct store_measured *measured);
enum store_result store_read_measured_errors(struct store *store, int64_t reference_id, store_measured_fn take,
                                             void *user, struct store_error *error);

// --- logs, pushed ---

struct store_gaze {
    int64_t session_id, segment_id, trial_id; // trial 0 between trials
    struct gaze_sample sample;
};

enum store_phase { STORE_STIMULUS, STORE_FADE, STORE_QUESTION, STORE_REST };
enum store_fovea { STORE_NO_FOVEA, STORE_FOVEA_GAZE, STORE_FOVEA_TARGET, STORE_FOVEA_FIXED, STORE_FOVEA_LOST };

struct store_frame {
    int64_t session_id, segment_id, trial_id; // trial 0 between trials
    int64_t attempt;                          // 0: none
    uint64_t number;
    enum store_slot option;
    int64_t condition_id; // 0: nothing rendered
    enum store_phase phase;
    double fade_level;
    int64_t start_ns;
    double cpu_us, gpu_us;
    int64_t present_ns;
    bool present_estimated;
    int64_t late;    // 1, 0, or STORE_UNKNOWN where the refresh rate is not known
    int64_t gaze_id; // from store_push_gaze
    double gaze_age_us;
    double fovea_deg[EYES][2]; // x, y; all NaN: none
    enum store_fovea fovea_source;
    const char *effective; // JSON, copied; NULL: as the condition says
    double target_x_deg, target_y_deg;
    double target_m;       // from the middle between the eyes, as the direction is; NaN: no target
    struct pose head_pose; // an orientation of all zero: not known
    int64_t shaded_px, triangles;
};

struct store_exposure {
    int64_t trial_id, segment_id, attempt;
    enum store_slot option;
    int64_t start_ns, end_ns, full_start_ns, full_end_ns; // the last two may be STORE_UNKNOWN, together
};

struct store_event {
    int64_t session_id, segment_id, trial_id; // trial 0: none
    int64_t at_ns;
    const char *kind, *detail;
};

struct store_adjust_step {
    int64_t trial_id, segment_id, at_ns;
    const char *parameter;
    double value;
};

// The id that the row will have, or 0 where it was dropped. Rows get ids in the order of the pushes.
int64_t store_push_gaze(struct store *store, const struct store_gaze *gaze);
// False where the row was dropped: the queue is full, or a text is longer than STORE_DETAIL_SIZE - 1.
bool store_push_frame(struct store *store, const struct store_frame *frame);
bool store_push_exposure(struct store *store, const struct store_exposure *exposure);
bool store_push_event(struct store *store, const struct store_event *event);
bool store_push_adjust_step(struct store *store, const struct store_adjust_step *step);

// The same rows, committed before the call returns, texts of any length.
enum store_result store_add_event(struct store *store, const struct store_event *event, int64_t *out_id,
                                  struct store_error *error);
// Commits all that was pushed before.
enum store_result store_flush(struct store *store, struct store_error *error);

struct store_status {
    uint64_t gaze_pushed, log_pushed;       // taken into the queue since the file was opened
    uint64_t gaze_committed, log_committed; // of these, on disk
    uint64_t gaze_dropped, log_dropped;     // not taken: queue full or text too long
    uint64_t refused;         // taken, but against the schema's rules; each left an event "log_refused"
    bool failing;             // the last commit did not succeed; pushes wait in the queue
    struct store_error error; // why, where failing
};

// Cheap enough for every frame; never waits for the disk.
void store_status(struct store *store, struct store_status *out);

#endif
