// Reads a study file for analysis, and never changes it.
//
// Use: store_reader_open(), any of the store_read_*() calls, store_reader_close(). Each call hands its rows,
// one after another, to a function of the caller; the row and its texts are borrowed until that function
// returns. The function returns false to stop; the call then returns false with an empty store_reader_error().
//
// Numbers that are NULL in the file come as NaN (double) or as said below, measurements also where they are not
// finite; texts that are NULL come as "".
// Times, units and angles are those of schema.sql. All rows come in an order that depends on nothing but the
// data.
//
// Does not: write, migrate, lock out a running session, filter by exclusion or by kind of participant. A file
// that is being written is read as of the moment it was opened. One thread per reader.
#ifndef STUDIES_STORE_READ_H
#define STUDIES_STORE_READ_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

struct store_reader;

// NULL with a sentence naming the file in `error` where it is missing, a folder, not SQLite, another program's,
// of a newer schema version than this program's, or damaged. What a file of an older version does not have is
// NULL; the file is left as it is.
struct store_reader *store_reader_open(const char *path, char *error, size_t error_size);
// False with a sentence where a table or an index is damaged, or a row refers to one that is not there: queries
// would then pass over rows without a word. Gaze samples and frames, which are many, only where `logs` asks for
// them.
bool store_reader_whole(struct store_reader *reader, bool logs);
void store_reader_close(struct store_reader *reader); // NULL is fine
const char *store_reader_path(const struct store_reader *reader);
int store_reader_version(const struct store_reader *reader); // of the file's schema
// A sentence naming the file after a call that returned false; "" where the caller's function stopped it.
const char *store_reader_error(const struct store_reader *reader);

struct store_session_row {
    int64_t id, participant_id;
    int64_t number;
    const char *code;
    bool simulated;
    const char *status; // 'running', 'complete', 'aborted'
    const char *started_at, *ended_at;
    uint64_t seed;
    const char *protocol_name, *protocol_sha256;
    const char *device, *driver, *display;
    double refresh_hz, width_px, height_px, fov_deg; // NaN where nothing was rendered
    const char *app_version;                         // of the first segment
    bool simulated_clock;                            // of any segment
    int64_t segments;
    const char *scenes; // the protocol's scenes and what was shown for them: "town: town:triangles=200000", ...
    const char *observer; // the simulated observer's parameters; "" for a person
    // The planned analyses, a line each: "METHOD OF PER", PER "-" where there is none, and " MARGIN" after it
    // where the protocol has one; "" where none was planned, or an earlier version recorded the session.
    const char *planned;
    const char *title; // of the study; "" where an earlier version recorded the session
    // The same for the same sitting, whatever file it stands in and under whatever laboratory's name.
    const char *sitting;
};

// A member of a JSON object: a factor, a parameter, an attribute.
struct store_member_row {
    int64_t owner;          // condition or participant id; 0 for factors
    const char *owner_text; // the factors' text, the condition's mode, the participant's code
    const char *key, *value;
    double number; // NaN where the value is not a number
};

struct store_trial_row {
    int64_t id, session_id, ordinal, repeat_of; // repeat_of 0: none
    int64_t attempt;                            // the last one
    const char *block, *kind, *scene, *factors, *status;
    int64_t test_id, reference_id; // conditions, through test_slot; 0: none
    // The answer, where there is one:
    int64_t choice_id; // 0: none
    char chosen;       // 't' test, 'r' reference, '=' equal, '?' no test slot; 0: no answer
    int chosen_first;  // the option that was shown first: 1, 0, or -1: not known
    bool chosen_a;     // slot a
    int correct;       // 1, 0, or -1: a preference, or no answer
    double reaction_s; // NaN: not known
    int64_t toggles;
};

struct store_rating_row {
    int64_t id, session_id, trial_id; // trial_id 0: of the session
    int64_t ordinal;                  // of the trial
    const char *trial_status;         // "" for a rating of the session
    const char *trial_kind;           // the same
    const char *question, *block, *scene;
    const char *order;    // "first" or "second" of a rate block and its complement; "" of others
    const char *factors;  // of the trial, the whole JSON text; "" of the session
    char subject;         // 't' the option under test, 'r' the other one, 's' neither, or no test slot
    int64_t condition_id; // 0: none
    double value, scale_min, scale_max;
};

struct store_frame_row {
    int64_t session_id, segment_id, trial_id, number;
    int64_t condition_id; // 0: gray or text
    const char *phase;
    int64_t start_ns;
    double cpu_us, gpu_us;
    bool late, late_known, simulated_clock;
    int64_t attempt; // of the trial
    double gaze_age_us, shaded_px;
};

struct store_exclusion_row {
    int64_t trial_id, session_id, participant_id; // two of them are 0
    const char *rule, *rule_set, *reason, *by;
    bool ratings_only; // a choice in the same trial stays
};

// A trial of a staircase that was answered: what was shown and what came of it.
struct store_step_row {
    int64_t trial_id, session_id, ordinal;
    const char *block, *factors, *status;
    int64_t test_id; // condition with the level in it; 0: none
    double level;
    int64_t outcome; // 0 wrong, 1 right; of more outcomes any from 0
    bool reversal;
    double estimate; // of the threshold after the step; NaN where there is none yet
    bool graded;     // not a choice between two, one of them right: a rating, or "equal" was answered
};

// What a participant set a parameter to in the end.
struct store_adjusted_row {
    int64_t trial_id, session_id, ordinal;
    const char *block, *factors, *status;
    int64_t test_id; // the condition before it was adjusted; 0: none
    const char *parameter;
    double value;
};

typedef bool (*store_session_fn)(void *user, const struct store_session_row *row);
typedef bool (*store_member_fn)(void *user, const struct store_member_row *row);
typedef bool (*store_trial_fn)(void *user, const struct store_trial_row *row);
typedef bool (*store_rating_fn)(void *user, const struct store_rating_row *row);
typedef bool (*store_frame_fn)(void *user, const struct store_frame_row *row);
typedef bool (*store_exclusion_fn)(void *user, const struct store_exclusion_row *row);
typedef bool (*store_step_fn)(void *user, const struct store_step_row *row);
typedef bool (*store_adjusted_fn)(void *user, const struct store_adjusted_row *row);

bool store_read_sessions(struct store_reader *reader, store_session_fn each, void *user);
bool store_read_factors(struct store_reader *reader, store_member_fn each, void *user); // distinct ones
bool store_read_conditions(struct store_reader *reader, store_member_fn each,
                           void *user); // key "" for no parameter
bool store_read_attributes(struct store_reader *reader, store_member_fn each, void *user);
bool store_read_trials(struct store_reader *reader, store_trial_fn each, void *user);
bool store_read_ratings(struct store_reader *reader, store_rating_fn each, void *user);
bool store_read_frames(struct store_reader *reader, store_frame_fn each, void *user);
bool store_read_exclusions(struct store_reader *reader, store_exclusion_fn each, void *user);
// Steps of main trials, by session, block, factors and ordinal: staircase after staircase.
bool store_read_staircase_steps(struct store_reader *reader, store_step_fn each, void *user);
// Of main adjust trials, by session and ordinal.
bool store_read_adjusted(struct store_reader *reader, store_adjusted_fn each, void *user);

#endif
