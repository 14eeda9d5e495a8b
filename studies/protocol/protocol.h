// A study as its protocol file states it, read from YAML, checked, every default filled in.
//
// Use: protocol_load -> read the struct (nothing changes it) -> protocol_destroy.
// Settings cascade study > block > trial: protocol_block and protocol_trial hold theirs already resolved.
// Does not: order trials (engine/plan.h), know the renderer (the caller hands a catalogue), read the clock.
// Errors: one sentence "file:line:column: what is wrong; what to do". The first error only.
#ifndef STUDIES_PROTOCOL_PROTOCOL_H
#define STUDIES_PROTOCOL_PROTOCOL_H

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
    PROTOCOL_TRIALS = 512, // per block, repetitions included
    PROTOCOL_ATTRIBUTES = 16,
    PROTOCOL_CHOICES = 16, // per attribute
    PROTOCOL_ANALYSES = 16,
    PROTOCOL_ERROR = 1024 // bytes that hold any error sentence
};

enum protocol_kind { PROTOCOL_TOGGLE, PROTOCOL_RATE, PROTOCOL_KINDS };
const char *protocol_kind_name(enum protocol_kind kind); // "toggle", "rate": the `kind` column of the store

// How a block's trials get their scenes: ALTERNATE: each cell's scene steps through the list from participant
// to participant; RANDOM: one scene drawn for the participant, the same for the whole block.
enum protocol_scene_use { PROTOCOL_ALTERNATE, PROTOCOL_RANDOM };

enum protocol_order { PROTOCOL_ORDER_RANDOM, PROTOCOL_ORDER_FIXED };
enum protocol_camera {
    PROTOCOL_CAMERA_PATH,
    PROTOCOL_CAMERA_STILL
}; // fly the scene's path, or stay at its start
enum protocol_fixation { PROTOCOL_FIXATION_FREE };
enum protocol_foveate { PROTOCOL_FOVEATE_GAZE };
enum protocol_advance { PROTOCOL_ADVANCE_KEY, PROTOCOL_ADVANCE_AUTO }; // what ends the rest between trials
const char *protocol_fixation_name(enum protocol_fixation fixation);
const char *protocol_foveate_name(enum protocol_foveate foveate);
const char *protocol_camera_name(enum protocol_camera camera);

// What cascades. Times in nanoseconds; the file has seconds.
struct protocol_settings {
    enum protocol_camera camera;
    enum protocol_fixation fixation;
    enum protocol_foveate foveate;
    enum protocol_advance advance;
    int64_t fade_to_gray_ns, fade_gray_ns, fade_from_gray_ns;
    int64_t view_ns; // `rate`: how long the scene is shown before the question; 0: until the participant asks
    int64_t confirm_ns;                // how long an answer's confirmation stays
    int64_t rest_ns;                   // gray between trials, at least
    uint32_t question;                 // index into protocol.questions
    double render[CATALOGUE_SETTINGS]; // value of catalogue.settings[i]: a number, or a word's index
};

// A mode with every parameter resolved; values as in catalogue_parameter.
struct protocol_option {
    char name[PROTOCOL_NAME];
    uint32_t mode; // index into catalogue.modes
    double values[CATALOGUE_PARAMETERS];
};

struct protocol_question {
    char name[PROTOCOL_NAME];
    char *text;                   // UTF-8, shown to the participant
    int32_t scale_min, scale_max; // of a rating
    char *label_min, *label_max;  // what the ends mean; "" where not given
};

// One parameter of one option, run through levels. Full factorial with the block's other factors.
struct protocol_factor {
    char name[PROTOCOL_NAME]; // key in the store's factors JSON
    uint32_t option;          // index into protocol.options
    uint32_t parameter;       // index into that mode's parameters
    double levels[PROTOCOL_LEVELS];
    uint32_t level_count;
};

// One listed trial of a block: parameters that differ from the block's options, and its own settings.
struct protocol_trial {
    int32_t scene; // index into protocol.scenes, -1: as the block's scenes go
    struct protocol_option a, b;
    char name[PROTOCOL_NAME]; // in the factors JSON as "trial"; "" where not given
    struct protocol_settings settings;
};

struct protocol_block {
    char name[PROTOCOL_NAME];
    enum protocol_kind kind;
    uint32_t
        options[2]; // indices into protocol.options; [0] is the tested one, [1] the reference. rate: the two of
    uint32_t option_count;            // which one is rated, or one
    uint32_t scenes[PROTOCOL_SCENES]; // indices into protocol.scenes
    uint32_t scene_count;
    enum protocol_scene_use scene_use;
    int32_t complement_of; // rate: an earlier rate block whose scene it repeats with the other option; -1: none
    struct protocol_factor factors[PROTOCOL_FACTORS];
    uint32_t factor_count;
    struct protocol_trial *trials; // listed trials instead of factors; NULL where there are none
    uint32_t listed_count;
    uint32_t repetitions;
    enum protocol_order order;
    struct protocol_settings settings;
    char *instructions; // shown before the block; "" where not given
};

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
};

struct protocol {
    const struct catalogue *catalogue;
    char name[PROTOCOL_NAME];
    char *title;
    uint64_t seed; // 0 .. 2^63-1, so that it fits the store's signed column
    char scenes[PROTOCOL_SCENES][PROTOCOL_NAME];
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
    struct protocol_block blocks[PROTOCOL_BLOCKS];
    uint32_t block_count;
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

uint32_t
protocol_block_trials(const struct protocol_block *block); // how many trials a participant gets from it

// An option as JSON, parameters in the catalogue's order, switches as words: {"epsilon":0.1,"splat":"atomic"}.
// False: too small.
bool protocol_option_json(const struct protocol *protocol, const struct protocol_option *option, char *out,
                          size_t out_size);
// The trial table's settings:
// {"camera":"path","foveate":"gaze","moving_objects":"off","fade_s":[0.125,0.25,0.125]}.
bool protocol_settings_json(const struct protocol *protocol, const struct protocol_settings *settings,
                            char *out, size_t out_size);

// Checks an attribute's value as entered; on success writes it as a JSON value (18, "female"). False with a
// sentence.
bool protocol_attribute_json(const struct protocol_attribute *attribute, const char *value, char *out,
                             size_t out_size, char *error, size_t error_size);
const struct protocol_attribute *protocol_attribute_find(const struct protocol *protocol, const char *name);

#endif
