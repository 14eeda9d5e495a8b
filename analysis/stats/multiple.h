// Adjusting p-values for how many tests were made.
//
// `out` holds n values in the order of `p` and may be `p` itself. NaN, and what lies outside [0, 1], is no
// test: it stays NaN and does not count, as p.adjust of R leaves NA out. Where memory runs out all are NaN.
#ifndef ANALYSIS_STATS_MULTIPLE_H
#define ANALYSIS_STATS_MULTIPLE_H

#include <stddef.h>

// The chance of any false rejection stays under alpha, whatever ties the tests to each other.
void stat_adjust_holm(const double *p, size_t n, double *out);
// The same for tests that are independent or positively dependent; never larger than Holm's.
void stat_adjust_hochberg(const double *p, size_t n, double *out);
// The expected share of false rejections among all rejections (Benjamini and Hochberg); same assumption.
void stat_adjust_bh(const double *p, size_t n, double *out);

#endif
