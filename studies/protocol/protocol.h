// A study as its protocol file states it, read from YAML, checked, every default filled in.
//
// Use: protocol_load -> read the struct (nothing changes it) -> protocol_destroy.
// Settings cascade study > block > trial: protocol_block and protocol_cell hold theirs already resolved.
// Does not: order trials (engine/plan.h), know the renderer (the caller hands a catalogue), read the clock.
// Errors: one sentence "file:line:column: what is wrong; what to do". The first error only. What can be run but
// hardly is what was meant (a break that never comes, an option that nobody sees) is not an error: see remarks.
#ifndef STUDIES_PROTOCOL_PROTOCOL_H
#define STUDIES_PROTOCOL_PROTOCOL_H

#include "studies/engine/staircase.h"
#include "studies/protocol/catalogue.h"
#include "studies/protocol/sha256.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum {
    PROTOCOL_NAME = 64,       // bytes of a name with its end
    PROTOCOL_BYTES = 1 << 20, // a larger file is refused
    PROTOCOL_DEPTH = 16,      // a deeper nesting is refused
    PROTOCOL_SCENES = 16,
    PROTOCOL_OPTIONS = 16,
    PROTOCOL_QUESTIONS = 16,
    PROTOCOL_BLOCKS = 16,
    PROTOCOL_FACTORS = 6,  // per block
    PROTOCOL_LEVELS = 16,  // per factor
    PROTOCOL_TRIALS = 512, // per block and participant, repetitions included; and cells, of all participants
    PROTOCOL_ASKED = 4,    // questions after one trial
    PROTOCOL_ADJUSTED = 4, // parameters that one trial lets the participant set
    PROTOCOL_LABELS = 256, // bytes of a cell's or a scene's labels as JSON members
    PROTOCOL_RULES = 16,
    PROTOCOL_GROUPS = 64, // of people
    PROTOCOL_ATTRIBUTES = 16,
    PROTOCOL_CHOICES = 16, // per attribute
    PROTOCOL_ANALYSES = 16,
    PROTOCOL_REMARKS = 64, // more are not kept
    PROTOCOL_ERROR = 1024  // bytes that hold any error sentence
};

struct protocol_place {
    uint32_t line, column; // in the file, from 1
};

// What is done in a trial. The `kind` column of the store has these words for PROTOCOL_MAIN trials, and else
// the role's.
enum protocol_kind {
    PROTOCOL_TOGGLE,     // switch freely between two options, choose one
    PROTOCOL_SEQUENTIAL, // one option after the other, each once, then compare
    PROTOCOL_RATE,       // one option, then a rating
    PROTOCOL_ADJUST,     // switch freely, set parameters of the option under test
    PROTOCOL_STAIRCASE,  // as toggle; each answer decides the parameter of the next trial
    PROTOCOL_TASK,       // one option and something to do, e.g. to count
    PROTOCOL_KINDS
};
const char *protocol_kind_name(enum protocol_kind kind);
bool protocol_kind_is_pair(enum protocol_kind kind); // two options are shown

// What a trial is for. Only PROTOCOL_MAIN trials answer the study's question.
enum protocol_role {
    PROTOCOL_MAIN,
    PROTOCOL_PRACTICE, // to learn the procedure
    PROTOCOL_CATCH,    // an obvious difference: whoever misses it did not look
    PROTOCOL_NULL,     // both options are the same
    PROTOCOL_ROLES
};
const char *protocol_role_name(enum protocol_role role);

// How a block's trials get their scenes, unless its cells name them: ALTERNATE: each cell's scene steps through
// the list from participant to participant; RANDOM: one scene drawn for the participant, the same for the whole
// block.
enum protocol_scene_use { PROTOCOL_ALTERNATE, PROTOCOL_RANDOM };

enum protocol_order {
    PROTOCOL_ORDER_RANDOM,       // all trials of the block in one shuffle
    PROTOCOL_ORDER_FIXED,        // as listed, repetition after repetition
    PROTOCOL_ORDER_BLOCK_RANDOM, // each repetition shuffled by itself
    PROTOCOL_ORDER_LATIN // Williams 1949: over a group of participants each cell follows each other equally
                         // often
};
enum protocol_camera { PROTOCOL_CAMERA_PATH, PROTOCOL_CAMERA_STILL };
enum protocol_fixation { PROTOCOL_FIXATION_FREE, PROTOCOL_FIXATION_CROSS, PROTOCOL_FIXATION_MOVING };
enum protocol_foveate { PROTOCOL_FOVEATE_GAZE, PROTOCOL_FOVEATE_TARGET };
enum protocol_advance { PROTOCOL_ADVANCE_KEY, PROTOCOL_ADVANCE_AUTO }; // what ends the rest between trials
enum protocol_pace { PROTOCOL_PACE_REFUSE, PROTOCOL_PACE_COMMON };
enum protocol_playback { PROTOCOL_LIVE, PROTOCOL_PRERENDERED };
const char *protocol_fixation_name(enum protocol_fixation fixation);
const char *protocol_foveate_name(enum protocol_foveate foveate);
const char *protocol_camera_name(enum protocol_camera camera);

// What cascades. Times in nanoseconds; the file has seconds. What each means stands in language.c.
struct protocol_settings {
    enum protocol_camera camera;
    int64_t path_start_ns;
    enum protocol_fixation fixation;
    enum protocol_foveate foveate;
    enum protocol_advance advance;
    enum protocol_pace pace;
    int64_t fade_to_gray_ns, fade_gray_ns, fade_from_gray_ns;
    int64_t view_ns; // 0: until the participant ends it
    int64_t gap_ns;
    int64_t min_exposure_ns;
    int64_t deadline_ns; // 0: none
    int64_t confirm_ns, rest_ns;
    uint32_t asked[PROTOCOL_ASKED]; // indices into protocol.questions
    uint32_t asked_count;
    uint32_t ratings[PROTOCOL_ASKED]; // asked of each of two options after the answer
    uint32_t rating_count;
    uint32_t spheres[2];               // how many to count, from and to; 0: none
    int32_t count_question;            // -1: none
    double render[CATALOGUE_SETTINGS]; // value of catalogue.settings[i]: a number, or a word's index
};

// A mode with every parameter resolved; values as in catalogue_parameter.
struct protocol_option {
    char name[PROTOCOL_NAME];
    uint32_t mode; // index into catalogue.modes
    enum protocol_playback playback;
    double values[CATALOGUE_PARAMETERS];
};

enum protocol_question_type { PROTOCOL_ASK_CHOICE, PROTOCOL_ASK_RATING, PROTOCOL_ASK_COUNT };
enum protocol_correct { PROTOCOL_NO_CORRECT, PROTOCOL_CORRECT_REFERENCE, PROTOCOL_CORRECT_TESTED };

struct protocol_question {
    char name[PROTOCOL_NAME];
    enum protocol_question_type type;
    char *text;                    // UTF-8, shown to the participant
    int32_t scale_min, scale_max;  // of a rating or a count; inclusive
    char *label_min, *label_max;   // what the ends mean; "" where not given
    bool equal;                    // a choice may be "equal"
    enum protocol_correct correct; // a choice's right answer
};

// What a block runs through. With others, full factorial.
struct protocol_factor {
    char name[PROTOCOL_NAME];                       // key in the store's factors JSON
    char level[PROTOCOL_LEVELS][PROTOCOL_NAME + 8]; // as JSON values: 0.2, "small"
    uint32_t level_count;
    bool between; // a participant gets one level, the same in every block with a factor of this name
};

// One combination of factor levels, or one listed trial: everything resolved.
struct protocol_cell {
    enum protocol_role role;
    uint8_t level[PROTOCOL_FACTORS];
    int32_t scene;                    // index into protocol.scenes, -1: as the block's scenes go
    uint32_t shown[2];                // indices into protocol.options: the tested one and the reference
    struct protocol_option option[2]; // the same with this cell's parameters; of one-option kinds only [0]
    struct protocol_settings settings;
    char labels[PROTOCOL_LABELS]; // more members for the factors JSON: "trial":"one","test":"IV"
};

// A parameter of the option under test that participants set by themselves.
struct protocol_adjust {
    uint32_t parameter; // index into that mode's parameters
    double start_min, start_max, step, min, max;
};

// How answers choose the level of a parameter of the option under test. The outcomes are those of the question:
// wrong and right; wrong, equal and right; or the points of a scale.
struct protocol_staircase {
    uint32_t parameter; // index into that mode's parameters
    struct staircase_desc desc;
};

// Null or catch trials among a block's own.
struct protocol_extra {
    struct protocol_cell cell;
    uint32_t count;
};

struct protocol_block {
    char name[PROTOCOL_NAME];
    enum protocol_kind kind;
    enum protocol_role role;
    // [0] is the tested one, [1] the reference. rate: the two of which one is rated, or one
    uint32_t options[2]; // indices into protocol.options
    uint32_t option_count;
    uint32_t scenes[PROTOCOL_SCENES]; // indices into protocol.scenes
    uint32_t scene_count;
    enum protocol_scene_use scene_use;
    int32_t complement_of; // rate: an earlier rate block whose scene it repeats with the other option; -1: none
    struct protocol_factor factors[PROTOCOL_FACTORS];
    uint32_t factor_count;
    struct protocol_cell *cells; // the last factor changes fastest
    uint32_t cell_count;
    bool listed; // the cells are listed trials
    uint32_t repetitions;
    enum protocol_order order;
    struct protocol_extra extras[2]; // null trials and catch trials; count 0: none
    struct protocol_adjust adjusts[PROTOCOL_ADJUSTED];
    uint32_t adjust_count;
    struct protocol_staircase
        staircase;        // of PROTOCOL_STAIRCASE; each cell is one staircase, its trials repetitions
    uint32_t break_every; // trials; 0: no breaks
    int64_t break_ns;     // least length of one
    struct protocol_settings settings;
    char *instructions; // shown before the block; "" where not given
};

// What takes a trial, a pair of ratings or a person out of the analysis.
enum protocol_rule {
    PROTOCOL_UNSEEN_OPTION,
    PROTOCOL_GAZE_LOSS,
    PROTOCOL_GAZE_GAP,
    PROTOCOL_LATE_FRAMES,
    PROTOCOL_REACTION,
    PROTOCOL_FAILED_CATCH,
    PROTOCOL_FALLBACK,
    PROTOCOL_RULE_KINDS
};
enum protocol_rule_of { PROTOCOL_OF_TRIAL, PROTOCOL_OF_RATING_PAIR, PROTOCOL_OF_PERSON };

struct protocol_exclusion {
    enum protocol_rule rule;
    enum protocol_rule_of of;
    double above, below; // the rule holds above the one or below the other; NaN where not given
    double share;        // of a person: the share of trials, above which the person goes
    bool stricter;       // of the second rule set, for the "what if" table
};
const char *protocol_rule_name(enum protocol_rule rule);

enum protocol_attribute_type { PROTOCOL_INTEGER, PROTOCOL_NUMBER, PROTOCOL_TEXT, PROTOCOL_CHOICE };

struct protocol_attribute {
    char name[PROTOCOL_NAME];
    enum protocol_attribute_type type;
    bool required;
    char unit[PROTOCOL_NAME]; // "" where none
    char *prompt;             // what the experimenter is asked; the name where not given
    double min, max;          // of a number; -+1e15 where not given
    char choices[PROTOCOL_CHOICES][PROTOCOL_NAME];
    uint32_t choice_count;
};

// What the study planned to compute before its first participant.
struct protocol_analysis {
    char method[PROTOCOL_NAME]; // binomial, paired_t, unpaired_t, mean
    char of[PROTOCOL_NAME];     // choice, rating, toggles, reaction
    char per[PROTOCOL_NAME];    // cell, study, order; "" where not given
    double margin;              // of equivalence, share of choices in (0, 0.5); 0: none
};

struct protocol {
    const struct catalogue *catalogue;
    char name[PROTOCOL_NAME];
    char *title;
    uint64_t seed;         // 0 .. 2^63-1, so that it fits the store's signed column
    uint32_t participants; // planned; 0: not said
    bool several_sessions; // a participant may come again
    char scenes[PROTOCOL_SCENES][PROTOCOL_NAME];
    char *stand_ins[PROTOCOL_SCENES]; // what is shown where the name is not bound; "" for none
    char scene_labels[PROTOCOL_SCENES][PROTOCOL_LABELS]; // members for the factors JSON
    struct protocol_place scene_places[PROTOCOL_SCENES], stand_in_places[PROTOCOL_SCENES];
    uint32_t scene_count;
    struct protocol_option options[PROTOCOL_OPTIONS];
    uint32_t option_count;
    uint32_t reference; // index into options: what the others are measured against
    struct protocol_question questions[PROTOCOL_QUESTIONS];
    uint32_t question_count;
    char *instructions;
    char *consent_text, *consent_version;
    struct protocol_attribute attributes[PROTOCOL_ATTRIBUTES];
    uint32_t attribute_count;
    struct protocol_analysis analyses[PROTOCOL_ANALYSES];
    uint32_t analysis_count;
    struct protocol_exclusion exclusions[PROTOCOL_RULES];
    uint32_t exclusion_count;
    struct protocol_block blocks[PROTOCOL_BLOCKS];
    struct protocol_place block_places[PROTOCOL_BLOCKS], option_places[PROTOCOL_OPTIONS];
    uint32_t block_count;
    char *remarks[PROTOCOL_REMARKS]; // sentences as errors are, in the order of the file's sections
    uint32_t remark_count;
    char *text; // the file as it is, terminated; what the store keeps
    size_t text_size;
    uint8_t sha256[SHA256_BYTES]; // of the text's bytes
    char sha256_hex[SHA256_HEX];
};

// NULL after one sentence in `error` (PROTOCOL_ERROR bytes suffice).
struct protocol *protocol_load(const char *path, const struct catalogue *catalogue, char *error,
                               size_t error_size);
// The same from memory; `name` stands for the file in errors.
struct protocol *protocol_parse(const char *name, const char *text, size_t size,
                                const struct catalogue *catalogue, char *error, size_t error_size);
void protocol_destroy(struct protocol *protocol); // NULL is fine

// Between-participant factors, each name once, make groups of people: every combination of their levels. 1:
// none.
uint32_t protocol_groups(const struct protocol *protocol);
uint32_t protocol_group_level(const struct protocol *protocol, uint32_t group, const char *factor);

// How many cells and how many trials one participant gets from a block; the trials with null and catch trials.
uint32_t protocol_block_cells(const struct protocol_block *block);
uint32_t protocol_block_trials(const struct protocol_block *block);

// An option as JSON, parameters in the catalogue's order, switches as words: {"epsilon":0.1,"splat":"atomic"}.
// False: too small.
bool protocol_option_json(const struct protocol *protocol, const struct protocol_option *option, char *out,
                          size_t out_size);
// The trial table's settings:
// {"procedure":"toggle","camera":"path","foveate":"gaze","moving_objects":"off","fade_s":[0.125,0.25,0.125],...}.
// more: further members, e.g. ",\"target_seed\":7"; or "".
bool protocol_settings_json(const struct protocol *protocol, enum protocol_kind kind,
                            const struct protocol_settings *settings, const char *more, char *out,
                            size_t out_size);

// Checks an attribute's value as entered; on success writes it as a JSON value (18, "female"). False with a
// sentence.
bool protocol_attribute_json(const struct protocol_attribute *attribute, const char *value, char *out,
                             size_t out_size, char *error, size_t error_size);
const struct protocol_attribute *protocol_attribute_find(const struct protocol *protocol, const char *name);

#endif
