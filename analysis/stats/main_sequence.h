// The main sequence of saccades: how peak velocity grows with amplitude.
//
// exponential  V = vmax (1 - exp(-A / c)), the form of Bahill, A. T., Clark, M. R. & Stark, L. (1975), The main
//              sequence, Math. Biosci. 24, 191-204, as Dai et al. 2016 (doi:10.1109/SPMB.2016.7846860) fit it:
//              vmax in deg/s, c in degrees. Least squares on V.
// power law    V = k A^b: least squares on the logarithms.
//
// Intervals are estimate -/+ t(n - 2) standard errors, of the linearised model for the exponential; k's on the
// log scale. They take a person's saccades as independent.
#ifndef ANALYSIS_STATS_MAIN_SEQUENCE_H
#define ANALYSIS_STATS_MAIN_SEQUENCE_H

#include <stddef.h>

struct stat_estimate {
    double value, std_error, low, high;
};

struct stat_main_sequence {
    size_t n;                     // saccades used: amplitude and velocity above 0 and finite
    const char *problem;          // why vmax and c are not estimable; NULL where they are
    struct stat_estimate vmax, c; // NaN where not estimable
    double residual_sd;           // deg/s, of the exponential
    const char *power_problem;
    struct stat_estimate k, b; // k's std_error is that of ln k
};

enum { STAT_MAIN_SEQUENCE_LEAST = 10 }; // fewer saccades fit nothing worth printing

// conf in (0, 1). The same number of both arrays.
struct stat_main_sequence stat_main_sequence(const double *amplitude_deg, const double *peak_deg_s, size_t n,
                                             double conf);

#endif
