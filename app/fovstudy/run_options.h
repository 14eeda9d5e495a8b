// What `fovstudy run` was asked for.
#ifndef APP_FOVSTUDY_RUN_OPTIONS_H
#define APP_FOVSTUDY_RUN_OPTIONS_H

#include "app/fovstudy/catalogue.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum { RUN_ATTRIBUTES = 32 };

// Strings are borrowed from argv; NULL where not given.
struct run_options {
    const char *protocol, *database, *participant;
    const char *display, *gaze, *observer, *device, *events;
    const char *attributes[RUN_ATTRIBUTES]; // "name=value"
    size_t attribute_count;
    struct bound_scene scenes[STUDY_BOUND_SCENES];
    size_t scene_count;
    uint32_t width, height;     // per eye; 0: the display's choice
    double fov_deg, refresh_hz; // refresh 0: the display's choice
    uint64_t seed, number;
    bool has_seed, has_number;
    bool unblind;
};

// -1 to go on, else the exit status (help and wrong usage have been printed).
int run_options_read(struct run_options *out, int argc, char **argv);

#endif
