// What fovbench measured (its --csv), for the speed-error figure.
//
// Speed is regular's median GPU time over a mode's, of the same scene in the same file; error is wpsnr_db
// against regular in the same frame. A row is on the Pareto front where no other row of its scene is both at
// least as fast and at least as near, and better in one. `regular` itself has no finite error and is not drawn.
#ifndef ANALYSIS_REPORT_BENCH_H
#define ANALYSIS_REPORT_BENCH_H

#include <stdbool.h>
#include <stddef.h>

enum { BENCH_WORD = 256, BENCH_SCENES = 8 };

struct bench_row {
    char device[BENCH_WORD], scene[BENCH_WORD], mode[BENCH_WORD],
        parameters[2 * BENCH_WORD];         // parameters without quotes
    double gpu_ms, psnr_db, wpsnr_db, flip; // infinite for regular
    double speed;
    size_t number; // within its scene, from 1; 0: regular
    bool front;
};

struct bench {
    size_t count;
    struct bench_row *rows; // in the file's order
    size_t scene_count;     // at most BENCH_SCENES are kept
    const char *scenes[BENCH_SCENES];
};

// False with a sentence that names file and line.
bool bench_load(struct bench *out, const char *path, char *error, size_t error_size);
void bench_free(struct bench *bench);

#endif
