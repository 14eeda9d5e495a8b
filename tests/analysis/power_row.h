// A line of tests/reference/power_plan.csv.
#ifndef TESTS_ANALYSIS_POWER_ROW_H
#define TESTS_ANALYSIS_POWER_ROW_H

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

struct power_row {
    char what[32];
    int64_t n, cells, df;
    double x, sd, margin, alpha, power, value, error; // NaN where R has NA
};

FILE *power_rows_open(void); // fails the test where it cannot
bool power_row_next(FILE *file, struct power_row *out);

// The value of the only line with these; a NaN power is any. Fails the test where there is none.
double power_row_value(const char *what, int64_t n, int64_t cells, int64_t df, double x, double alpha,
                       double power);

#endif
