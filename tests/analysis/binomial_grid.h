// The binomial family on the grid of tests/reference/binomial_exact.csv: how far from 256-bit arithmetic it is.
#ifndef TESTS_ANALYSIS_BINOMIAL_GRID_H
#define TESTS_ANALYSIS_BINOMIAL_GRID_H

#include <stddef.h>

struct binomial_grid {
    size_t rows;
    double ln_p;    // largest |d ln p| of the exact tests with p >= 1e-300, two-sided and one-sided
    double deep;    // largest |d ln p / ln p| below
    double mid_p;   // relative, where p >= 1e-300
    double clopper; // intervals: relative, two-sided and one-sided
    double wilson, jeffreys;
    double equivalence; // |d ln p| with p >= 1e-300
    double bayes;       // |d ln BF|, relative where |ln BF| > 1
};

// Fails the test where a row cannot be read. NaN and infinities agree with their like only; else an error is
// infinite.
struct binomial_grid binomial_grid_errors(void);

#endif
