// Adjusting p-values for how many tests were made.
//
// `out` holds n values in the order of `p` and may be `p` itself. NaN, and what lies outside [0, 1], is no
// test: it stays NaN and does not count, as p.adjust of R leaves NA out. Where memory runs out all are NaN.
#ifndef ANALYSIS_STATS_MULTIPLE_H
#define ANALYSIS_STATS_MULTIPLE_H

#include <stddef.h>

// The chance of any false rejection stays under alpha, whatever ties the tests to each other.
void stat_adjust_holm(const double *p, size_t n, double *out);
// The same where hypotheses of one set exclude each other, such as "no difference" and "a difference beyond the
// margin": one of them at most is true, so that a set counts once while it has a test left. `set` holds a
// number below n for each; with sets of one test each it is Holm's, and never larger than it.
void stat_adjust_exclusive(const double *p, const size_t *set, size_t n, double *out);
// As Holm's for tests that are independent or positively dependent; never larger.
void stat_adjust_hochberg(const double *p, size_t n, double *out);
// The expected share of false rejections among all rejections (Benjamini and Hochberg); same assumption.
void stat_adjust_bh(const double *p, size_t n, double *out);

#endif
