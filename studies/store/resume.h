// How far a session came and what it was started with: what a program needs to go on with it.
//
// Use: store_open -> store_find_session -> rebuild the plan and compare it with store_read_planned ->
//      store_resume_session -> as after store_create_session. store_session_start_finish frees.
// Does not: decide whether the plan, the display or the protocol are still the same; the caller does.
#ifndef STUDIES_STORE_RESUME_H
#define STUDIES_STORE_RESUME_H

#include "studies/store/store.h"

enum { STORE_SCENES = 16 }; // most scenes that one session has; further ones are left out

struct store_bound_scene {
    char *name, *spec; // owned
};

// Texts are owned, "" where the file has none; numbers are 0 where not known.
struct store_session_start {
    int64_t session_id, participant_id, protocol_id, number;
    uint64_t seed;
    bool simulated;
    char *status, *code, *attributes, *started_at, *consent_at; // consent_at "": no consent yet
    char *protocol_name, *protocol_text;
    char *device, *display, *gaze;
    char *observer; // "sim:threshold=0.045,..." of a simulated participant
    char *errors_file, *protocol_file;
    double refresh_hz, fov_deg, step_hz;
    int64_t width_px, height_px;
    struct store_bound_scene scenes[STORE_SCENES];
    size_t scene_count;
    // The last segment, for the length of the gap: the clock's reading at the last time that was stored.
    int64_t segments, last_clock_ns;
    char *last_boot_id; // "" for a simulated clock
};

// `wanted` 0: the last session that is running, else the last one. out->session_id 0: there is none.
enum store_result store_find_session(struct store *store, int64_t wanted, struct store_session_start *out,
                                     struct store_error *error);
void store_session_start_finish(struct store_session_start *start); // a zeroed one is fine

// A trial as it was planned, and what became of it. Texts are borrowed until the function returns, "" for NULL.
struct store_planned {
    int64_t id, ordinal, attempt, repeat_of, option_a, option_b;
    const char *block, *kind, *scene, *settings, *factors, *test_slot, *first_shown, *fixation, *status;
    const char *mode_a, *parameters_a, *mode_b, *parameters_b;
    uint64_t seed;
    int64_t choices, ratings, responses; // rows of answers
    int64_t outcome;                     // of its staircase step, -1: none
};

// False stops the reading.
typedef bool (*store_planned_fn)(void *user, const struct store_planned *trial);
// In the order of their ordinals.
enum store_result store_read_planned(struct store *store, int64_t session_id, store_planned_fn each, void *user,
                                     struct store_error *error);

// A new segment and an event of kind "gap" at its time 0, both or neither.
enum store_result store_resume_session(struct store *store, int64_t session_id,
                                       const struct store_segment *segment, const char *gap_detail,
                                       int64_t *out_segment_id, struct store_error *error);

// How many sessions the code has in this file, and the last of them that is unfinished (0: none).
enum store_result store_count_sessions(struct store *store, const char *code, int64_t *out_count,
                                       int64_t *out_unfinished, struct store_error *error);

#endif
