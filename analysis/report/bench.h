// What fovbench measured (its --csv, or several such files one after the other), for the speed-error figures.
//
// Rows are compared within a group only: one device, scene, size, gaze and set of effects. Speed is the group's
// `regular`'s median GPU time over a mode's; error is wpsnr_db against `regular` in the same frame. A row is on
// the Pareto front where no other row of its group is both at least as fast and at least as near, and better in
// one; `regular`, which has no error, counts. Rows without an error or a speed are not drawn.
#ifndef ANALYSIS_REPORT_BENCH_H
#define ANALYSIS_REPORT_BENCH_H

#include <stdbool.h>
#include <stddef.h>

enum { BENCH_WORD = 256, BENCH_PARAMETERS = 1024 };
enum { BENCH_FIGURES = 16 }; // groups drawn; further ones are in the tables only

struct bench_row {
    char mode[BENCH_WORD], parameters[BENCH_PARAMETERS]; // parameters without quotes
    double gpu_ms, psnr_db, wpsnr_db, flip; // NaN: not measured; decibels are infinite where there is no error
    double speed;                           // NaN: not known
    size_t group;
    size_t number; // as drawn, within its group, from 1; 0: not drawn
    bool front;
};

struct bench_group {
    char device[BENCH_WORD], scene[BENCH_WORD];
    char setting[BENCH_WORD]; // "640 × 720 px per eye, gaze centre, SSAO"; "" where the file says nothing of it
    size_t regulars;          // rows of `regular` with the first one's parameters; not 1: there is no speed
    size_t drawn;             // rows with a number
};

struct bench {
    size_t count, group_count;
    struct bench_row *rows;     // in the file's order
    struct bench_group *groups; // in the order of their first rows
};

// False with a sentence that names file and line.
bool bench_load(struct bench *out, const char *path, char *error, size_t error_size);
void bench_free(struct bench *bench);

#endif
