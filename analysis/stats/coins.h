// Sums of weights, each counted or not by a fair coin: the null distribution of sign-flip and signed-rank
// tests.
#ifndef ANALYSIS_STATS_COINS_H
#define ANALYSIS_STATS_COINS_H

#include <stddef.h>
#include <stdint.h>

// P(sum = 0) to P(sum = most) into `chance`, which has room for most + 1. Person by person, by convolution
// instead of by listing the signs: Pagano, M. & Tritchler, D. (1983), J. Am. Stat. Assoc. 78, 435-440. Halving
// is exact in a double and only positive numbers are added, so that each is good to n times 1.1e-16, relative,
// down to about 1e-300.
void stat_coin_sums(const uint64_t *weights, size_t n, double *chance, uint64_t most);

#endif
