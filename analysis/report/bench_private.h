// Shared by bench*.c only.
#ifndef ANALYSIS_REPORT_BENCH_PRIVATE_H
#define ANALYSIS_REPORT_BENCH_PRIVATE_H

#include "analysis/report/bench.h"

#include <stdio.h>

// Rows and groups, without what follows from comparing them. False with a sentence; `error` holds one for lack
// of memory before.
bool bench_read(struct bench *bench, FILE *file, const char *path, char *error, size_t error_size);

#endif
