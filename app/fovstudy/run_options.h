// What `fovstudy run` and `fovstudy resume` were asked for.
#ifndef APP_FOVSTUDY_RUN_OPTIONS_H
#define APP_FOVSTUDY_RUN_OPTIONS_H

#include "app/fovstudy/catalogue.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum { RUN_ATTRIBUTES = 32, RUN_PARTICIPANTS = 999 };

// Strings are borrowed, from argv or from a resumed session; NULL where not given.
struct run_options {
    bool resume;
    int64_t session;      // resume: its id; 0: the last unfinished one
    const char *protocol; // resume: the file that must still be the session's, "-": none
    const char *database, *participant;
    const char *display, *gaze, *observer, *device, *events;
    const char *attributes[RUN_ATTRIBUTES]; // "name=value"
    size_t attribute_count;
    struct bound_scene scenes[STUDY_BOUND_SCENES];
    size_t scene_count;
    uint32_t width, height;     // per eye; 0: the display's choice
    double fov_deg, refresh_hz; // 0: not given
    double patience_s;          // 0: for ever
    uint64_t seed, number;
    bool has_seed, has_number;
    uint64_t preflight, playback_mb; // 0: not given
    bool unblind, again, no_preflight;
    bool new_protocol;     // the file may hold sessions of other protocols
    uint64_t participants; // simulated ones, one after the other; 0: the one named
};

// -1 to go on, else the exit status (help and wrong usage have been printed). For a resumed session what is not
// given stays unset, to be taken from the study file.
int run_options_read(struct run_options *out, bool resume, int argc, char **argv);
// Where nobody sees that a machine waits, it gives up in time to be noticed.
void run_options_patience(struct run_options *options);

// What a new participant may be called: 1 to 32 of A-Z, a-z, 0-9, '.', '_' and '-'. -1, else the exit status
// after a sentence. Codes that files hold already are not asked.
int run_options_code(const char *command, const char *code);

// The rate of a clock that no display keeps.
double run_step_hz(const struct run_options *options);

#endif
