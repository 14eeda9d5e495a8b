// What protocols may name in this program: the renderer's modes, the scenes, and settings of rendering.
//
// Use: study_names_init with the bound scenes -> names.catalogue for protocol_load -> study_names_finish after
// the protocol is gone.
#ifndef APP_FOVSTUDY_CATALOGUE_H
#define APP_FOVSTUDY_CATALOGUE_H

#include "studies/protocol/catalogue.h"
#include "studies/protocol/protocol.h"

#include <stdbool.h>
#include <stddef.h>

enum { STUDY_BOUND_SCENES = 16, STUDY_PLANNED_MODES = 8 };

// --scene NAME=SPEC: a scene of the protocol stands for this built-in or file.
struct bound_scene {
    char name[64];
    const char *spec; // borrowed
};

struct study_names {
    struct catalogue catalogue;
    struct catalogue_mode *modes;                 // owned
    struct catalogue_parameter *parameters;       // owned, of all modes
    const char **scenes;                          // owned array of borrowed names
    const char *missing[STUDY_PLANNED_MODES + 1]; // modes that are planned and not here
};

// Settings of rendering, by their index in the catalogue: objects move, ambient occlusion, temporal
// antialiasing.
enum { STUDY_MOVING_OBJECTS, STUDY_SSAO, STUDY_TAA };

// "NAME=SPEC" into the list; false with a sentence.
bool study_bind_scene(struct bound_scene *bound, size_t *count, const char *text, char *error,
                      size_t error_size);
// What a scene of the protocol stands for: its binding, else its own name.
const char *study_scene_spec(const struct bound_scene *bound, size_t count, const char *name);
// What is shown for a scene of the protocol: its binding, else what stands in for it, else its own name.
const char *study_shown_scene(const struct protocol *protocol, uint32_t scene, const struct bound_scene *bound,
                              size_t count);

bool study_names_init(struct study_names *names, const struct bound_scene *bound,
                      size_t count); // false: no memory
void study_names_finish(struct study_names *names);

// Reads a protocol; asks the modes whether the parameters of every condition agree, and the protocol whether it
// has every scene that is bound. NULL after a sentence.
struct protocol *study_load(const char *path, const struct study_names *names, const struct bound_scene *bound,
                            size_t count, char *error, size_t error_size);

// The same from a text that a study file holds; `name` stands for the file in errors.
struct protocol *study_parse(const char *name, const char *text, const struct study_names *names,
                             const struct bound_scene *bound, size_t count, char *error, size_t error_size);

#endif
