// Scenes made by code: everything works without a file.
//
// Use: builtin_scene_open("town:triangles=200000,seed=3", error, sizeof error) -> read -> scene_destroy.
// A scene is a pure function of its parameters: the same specification gives the same bytes on every call.
// Light is in the scenes' own scale, 1 unit = 1 klx or 1 kcd/m^2, so that highlights stay within a half float.
// The renderer casts no shadows, so the sun's and the sky's visibility are baked into the vertex colours.
#ifndef STIMULI_BUILTIN_BUILTIN_H
#define STIMULI_BUILTIN_BUILTIN_H

#include "stimuli/scene.h"

#include <stdbool.h>
#include <stddef.h>

// Whole numbers only.
struct builtin_parameter {
    const char *name; // NULL ends a list
    const char *unit;
    double min, max, value; // range, both ends included, and default
    const char *description;
};

struct builtin_scene {
    const char *name; // NULL ends the table
    const char *description;
    const struct builtin_parameter *parameters;
    // `values` in the order of `parameters`. NULL: out of memory. Caller frees with scene_destroy.
    struct scene *(*make)(const double *values);
    bool (*path)(struct camera_path *out); // the made scene's, without making it
};

extern const struct builtin_scene builtin_scenes[];

// True for a name of the table; a specification's ":parameters" may follow.
bool builtin_scene_known(const char *name);

// Whether builtin_scene_open would take the specification, and the path of what it would make; nothing is made.
// False with a sentence as below.
bool builtin_scene_check(const char *spec, struct camera_path *out_path, char *error, size_t error_size);

// NAME or NAME:parameter=value,... On failure NULL and one sentence in `error` that names the valid names or
// range.
struct scene *builtin_scene_open(const char *spec, char *error, size_t error_size);

#endif
