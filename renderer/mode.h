// What a rendering mode is: its name, source, typed parameters and the four calls that run it.
//
// The parameter list is the single truth: command line, protocol checker, database and documentation read it.
// Adding a mode: a room under modes/ that fills one `const struct mode`, and one line in modes.c.
#ifndef RENDERER_MODE_H
#define RENDERER_MODE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum { MODE_PARAMETERS = 16 };

struct mode_parameter {
    const char *name;
    const char *unit; // "deg", "" for a plain number
    const char *description;
    double min, max, fallback;  // inclusive; fallback is the default
    const char *const *choices; // NULL-terminated words for a switch: the value is the word's index; else NULL
};

struct gpu;
struct mode_state;
struct mode_setup;  // modes/room.h: what a mode is created with
struct mode_record; // modes/room.h: what it records a frame from

struct mode {
    const char *name;
    const char *description;
    const char *source;                      // the paper
    const struct mode_parameter *parameters; // NULL where there are none
    uint32_t parameter_count;
    bool foveated; // what it draws depends on the gaze
    // False with one sentence in `why` where the device lacks what the mode needs with these values. NULL: runs
    // anywhere.
    bool (*supported)(const struct gpu *gpu, const double *values, char *why, size_t why_size);
    // False with one sentence in `why` where values that are each in range contradict each other. NULL: none
    // can.
    bool (*agree)(const double *values, char *why, size_t why_size);
    struct mode_state *(*create)(const struct mode_setup *setup); // NULL after a logged sentence
    bool (*record)(struct mode_state *state, const struct mode_record *record);
    // New numbers for an option made with settings.adjustable; words (choices) stay as they are. Makes no
    // pipeline and no target. False: it cannot. NULL: the mode's values never change while it runs.
    bool (*set)(struct mode_state *state, const double *values);
    void (*destroy)(struct mode_state *state); // NULL is fine
};

// A mode with every parameter resolved.
struct mode_choice {
    const struct mode *mode;
    double values[MODE_PARAMETERS];
};

extern const struct mode *const modes[]; // NULL-terminated

const struct mode *mode_find(const char *name);                      // NULL for an unknown name
int mode_parameter_index(const struct mode *mode, const char *name); // -1 for an unknown name

// Sets one parameter from text; false with a sentence where it is unknown, malformed or out of range.
bool mode_set(struct mode_choice *choice, const char *name, const char *text, char *error, size_t error_size);

// False with a sentence where parameters contradict each other. mode_parse and renderer_option_create ask it
// too.
bool mode_check(const struct mode_choice *choice, char *error, size_t error_size);

// "time_warped:epsilon=0.1,fovea_deg=6"; unnamed parameters take their defaults.
bool mode_parse(const char *spec, struct mode_choice *out, char *error, size_t error_size);

// Every parameter as a JSON object in table order, e.g. {"epsilon":0.1,"fovea_deg":6,...}. False: too small.
bool mode_parameters_json(const struct mode_choice *choice, char *out, size_t out_size);

#endif
