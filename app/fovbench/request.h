// What a run of fovbench measures, as its command line said.
//
// Texts are borrowed from the command line.
#ifndef APP_FOVBENCH_REQUEST_H
#define APP_FOVBENCH_REQUEST_H

#include "app/command/walk.h"
#include "renderer/mode.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum { REQUEST_MODES = 64, REQUEST_SCENES = 32, REQUEST_SIZES = 16, REQUEST_GAZES = 8 };

struct request_mode {
    const char *text; // as it was written
    struct mode_choice choice;
};

struct request_size {
    uint32_t width, height;
};

struct request_gaze {
    const char *text;
    struct walk_gaze gaze;
};

struct request_outputs {
    const char *csv, *json, *plot, *frames_csv; // NULL: none
};

struct request {
    struct request_mode modes[REQUEST_MODES]; // the first is `regular`, what all are held against
    size_t mode_count;
    const char *scenes[REQUEST_SCENES];
    size_t scene_count;
    struct request_size sizes[REQUEST_SIZES];
    size_t size_count;
    struct request_gaze gazes[REQUEST_GAZES];
    size_t gaze_count;
    uint64_t frames;       // measured, after REQUEST_WARM_UP
    uint64_t error_every;  // 0: no errors
    uint64_t still_frames; // 0: no flicker_still
    uint64_t supersampled; // frames compared with the supersampled reference
    double fov_deg, start_s;
    bool ssao, taa, rest, pass_times;
    const char *device; // NULL: the best
    struct request_outputs outputs;
};

enum { REQUEST_WARM_UP = 10 }; // DESIGN section 3: unmeasured

// -1 to go on, else the exit status after what had to be said.
int request_read(struct request *out, int argc, char **argv);

#endif
