// What a planned test can show: power, the smallest effect it finds, the smallest margin within which it can
// say "no difference".
//
// alpha and power are in (0, 1), counts as in binomial.h, sample sizes at least 2. NaN for anything else, and
// where no effect, however large, is found that often. n counts independent answers: one per person.
#ifndef ANALYSIS_STATS_POWER_H
#define ANALYSIS_STATS_POWER_H

#include <stdint.h>

enum { STAT_POWER_MAX_N = 1000000 };

// How often the exact two-sided binomial test of p0 rejects at alpha (p <= alpha) where p is true. The answers
// jump, so power does not rise evenly with n.
double stat_binomial_power(int64_t n, double p0, double p, double alpha);
// The smallest share above one half that the test of one half finds with this power; one minus it below.
double stat_binomial_detectable(int64_t n, double alpha, double power);
// The smallest m for which two one-sided exact tests at alpha, of one half minus m and of one half plus m, both
// reject with this power where one half is true.
double stat_binomial_margin(int64_t n, double alpha, double power);

// How often the two-sided t-test of n differences rejects where their mean is d of their standard deviations.
double stat_paired_t_power(int64_t n, double d, double alpha);
double stat_paired_t_detectable(int64_t n, double alpha, double power); // the smallest such d > 0
// The same of two samples with one standard deviation; d is the difference of means in it.
double stat_two_sample_t_power(int64_t n_x, int64_t n_y, double d, double alpha);
double stat_two_sample_t_detectable(int64_t n_x, int64_t n_y, double alpha, double power);

#endif
