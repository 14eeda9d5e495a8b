// Who and what is analysed: the sessions of one or more study files after leaving out simulated observers and
// what exclusion rules took out.
//
// Use: sample_load(), then any of choices.h, ratings.h and frames.h, then sample_free().
// A file given twice, and a session found in two files, are refused rather than counted twice. Exclusions of
// the rule sets 'planned' and 'late' are applied, 'stricter' ones are only listed, unless sample_apply() says
// otherwise. Does not: change a file, decide on exclusions, or draw anything. All texts are owned by the
// sample.
#ifndef ANALYSIS_REPORT_SAMPLE_H
#define ANALYSIS_REPORT_SAMPLE_H

#include "studies/store/digest.h"
#include "studies/store/read.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define SAMPLE_NONE SIZE_MAX

enum { SAMPLE_ERROR_SIZE = 640 };

// Which exclusions hold: none, those of the sets 'planned' and 'late', or all.
enum sample_rules { SAMPLE_ALL_DATA, SAMPLE_RULES, SAMPLE_STRICTER };

struct sample_session {
    size_t file;
    int64_t id, participant_id;
    size_t person; // index
    const char *status, *started_at, *ended_at;
    uint64_t seed;
    const char *protocol_name, *protocol_sha256;
    const char *device, *driver, *display, *app_version; // "" where not known
    double refresh_hz, width_px, height_px, fov_deg;     // NaN where nothing was rendered
    bool simulated_clock;
    int64_t segments;
    const char *scenes, *observer; // "" where not known
    const char *planned, *title;   // as store_session_row has them
    const char *sitting;           // the same
    bool excluded;                 // or its participant
};

struct sample_person {
    size_t file;
    int64_t id, number;
    const char *code;
};

struct sample_attribute {
    size_t person;
    const char *key, *value;
    double number; // NaN where the value is not a number
};

struct sample_condition {
    const char *mode;
    const char *parameters; // "epsilon=0.2 fovea_deg=10", "" for none
    const char
        *label; // the mode, with those parameters that differ within it in this sample, as modes name them
    const char *words; // the same for people: "time_warped ε 0.2, fovea 17°"
};

// A condition's number in its file, or a member of a trial's factors.
struct sample_condition_id {
    size_t file;
    int64_t id;
    size_t condition; // index
};

struct sample_parameter {
    size_t condition;
    const char *key, *value;
};

struct sample_factor {
    const char *factors; // the whole JSON text, as trials carry it
    const char *key, *value;
    double number; // NaN where the level is not a number
};

// Trials of a block with these factors in one scene, that sessions planned, whatever became of them; of
// practice, catch and null trials none.
struct sample_cell {
    const char *block, *factors, *scene; // factors: the whole JSON text
    size_t session_count;
    size_t *sessions; // indices, excluded ones too
};

struct sample_exclusion {
    size_t file;
    int64_t trial_id, session_id, participant_id;
    const char *rule, *rule_set, *reason, *by;
    const char *code; // of the participant; "" where the session is not part of the sample
    bool applied;
    bool ratings_only; // a choice in the same trial stays
};

struct sample {
    bool simulated; // the sessions analysed are simulated ones
    size_t left_out_simulated;
    const char *protocol;     // the name of the one whose sessions are analysed
    size_t left_out_protocol; // sessions of others
    // SHA-256 of what the sessions say, excluded ones too (digest.h); the same for the same sittings in other
    // files, in whatever order.
    char data_hash[STORE_DIGEST_HEX];
    size_t file_count;
    struct store_reader **files;
    size_t session_count, person_count, attribute_count, condition_count, condition_id_count, parameter_count,
        factor_count, cell_count, exclusion_count;
    struct sample_session *sessions;
    struct sample_person *people;
    struct sample_attribute *attributes;
    struct sample_condition *conditions;
    struct sample_condition_id *condition_ids;
    struct sample_parameter *parameters;
    struct sample_factor *factors;
    struct sample_cell *cells;
    struct sample_exclusion *exclusions;
    char **texts;
    size_t text_count;
};

// False with a sentence in `error`; the sample is then empty. With `simulated`, simulated sessions are
// analysed; they are refused together with sessions of people. No session left is an error too. Sessions of one
// protocol, by its name, are analysed: `protocol`, or where that is NULL the one with most of them, of as many
// the first.
bool sample_load(struct sample *out, const char *const *paths, size_t path_count, bool simulated,
                 const char *protocol, char *error, size_t error_size);
void sample_free(struct sample *sample);

// Index of a session that is analysed, SAMPLE_NONE for any other.
size_t sample_find_session(const struct sample *sample, size_t file, int64_t id);
// Index of a condition; SAMPLE_NONE for id 0.
size_t sample_find_condition(const struct sample *sample, size_t file, int64_t id);
// People with more than one session that is analysed.
size_t sample_repeaters(const struct sample *sample);
// Codes of people that are analysed from more than one file: they count as different people.
size_t sample_shared_codes(const struct sample *sample);
// Whether a choice, and whether ratings, made in a trial are left out.
bool sample_trial_excluded(const struct sample *sample, size_t file, int64_t trial_id);
bool sample_ratings_excluded(const struct sample *sample, size_t file, int64_t trial_id);
// From now on these exclusions hold; what was loaded before stays as it is.
void sample_apply(struct sample *sample, enum sample_rules rules);
// As sample_find_session, also of excluded ones.
size_t sample_any_session(const struct sample *sample, size_t file, int64_t id);

// A copy owned by the sample; NULL where memory ran out.
const char *sample_keep(struct sample *sample, const char *text);

// Makes room for one more item, for all growing arrays here: false where memory ran out.
bool sample_grow(void *items_address, size_t count, size_t item_size);

#endif
