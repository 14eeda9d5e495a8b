// A table of counts, rows by columns.
#ifndef ANALYSIS_STATS_COUNTS_TABLE_H
#define ANALYSIS_STATS_COUNTS_TABLE_H

#include <stdint.h>

struct stat_counts {
    const int64_t *counts; // row by row; borrowed for the call
    int rows, columns;     // at least 2, at most STAT_COUNTS_MOST
};

enum { STAT_COUNTS_MOST = 64 };
#define STAT_COUNTS_MAX_N INT64_C(1000000000) // all counts together

#endif
