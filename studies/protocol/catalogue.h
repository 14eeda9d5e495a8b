// What a protocol may name: rendering modes with their parameters, scenes and rendering settings.
//
// The program fills one from its table of modes and its scenes, so that protocols are checked without a GPU and
// without the renderer. Everything is borrowed: it must outlive each protocol that was read against it.
#ifndef STUDIES_PROTOCOL_CATALOGUE_H
#define STUDIES_PROTOCOL_CATALOGUE_H

#include <stdbool.h>
#include <stdint.h>

enum { CATALOGUE_PARAMETERS = 16, CATALOGUE_SETTINGS = 8 }; // at most, per mode and in all

struct catalogue_parameter {
    const char *name;
    const char *unit;           // "deg", "" for a plain number
    double min, max, fallback;  // inclusive; fallback is the default
    const char *const *choices; // NULL-terminated words of a switch: its value is the word's index; else NULL
    const char *about;          // one phrase; NULL: none
};

struct catalogue_mode {
    const char *name;
    const struct catalogue_parameter *parameters;
    uint32_t parameter_count;
    const char *about; // what it is, one sentence; NULL: none
    bool foveated;     // what it draws depends on the gaze
};

struct catalogue {
    const struct catalogue_mode *modes;
    uint32_t mode_count;
    const char *const *missing_modes; // of the language, but not of this program; ends with NULL; NULL: none
    const char *const *scenes;        // built-in names and those bound on the command line
    uint32_t scene_count;
    const struct catalogue_parameter *settings; // of rendering, e.g. moving_objects {off, on}
    uint32_t setting_count;
};

const struct catalogue_mode *catalogue_find(const struct catalogue *catalogue,
                                            const char *mode); // NULL: unknown

#endif
