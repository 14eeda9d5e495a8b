// McNemar's test: whether two yes-or-no answers of the same people differ. Only people whose answers differ
// count.
#ifndef ANALYSIS_STATS_MCNEMAR_H
#define ANALYSIS_STATS_MCNEMAR_H

#include "analysis/stats/binomial.h"

struct stat_mcnemar {
    double p_exact, p_mid;                     // binomial; 1 where nobody's answers differ
    double chi_squared, p_value;               // 1 degree of freedom; NaN where nobody's answers differ
    double chi_squared_corrected, p_corrected; // continuity corrected
    double odds_ratio;                         // b / c; infinite where c is 0, NaN where both are
    struct stat_interval ci;                   // of the odds ratio, exact
};

// b people said yes first and no then, c the other way round; b, c >= 0, b + c <= STAT_BINOMIAL_MAX_N, conf in
// (0, 1). NaN for anything else.
struct stat_mcnemar stat_mcnemar_test(int64_t b, int64_t c, double conf);

// Interval of the difference b / n - c / n over all n people, those whose answers agree too; within -1 and 1.
// It leaves 0 out exactly where p_exact < 1 - conf. n from 1 to STAT_BINOMIAL_MAX_N and at least b + c; the
// rest as above. One to three milliseconds, however large n is.
struct stat_interval stat_mcnemar_difference(int64_t b, int64_t c, int64_t n, double conf);

#endif
