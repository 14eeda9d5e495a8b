// Marginal densities known at points: mean, SD, quantiles. And the points and weights of Gauss and Legendre.
#ifndef ANALYSIS_STATS_MARGINAL_H
#define ANALYSIS_STATS_MARGINAL_H

#include "analysis/stats/psychometric_bayes.h"

// `count` nodes in (0, 1) with weights that sum to 1, by Newton's method on the Legendre polynomial: Abramowitz
// & Stegun 1964, 25.4.29. count is 1 to 64.
void stat_gauss_legendre(size_t count, double x[], double w[]);

// The i-th of `points` even points from low to high.
double stat_grid_at(double low, double high, size_t points, size_t i);

// Of densities at even points, cubics between them. exponential: the points are logarithms; mean and sd are
// then those of their exponentials, and so are the quantiles. NaN for fewer than two points, no mass or
// no memory.
struct stat_marginal stat_grid_marginal(const double *density, double low, double high, size_t points,
                                        double conf, bool exponential);

// Of masses at ascending nodes in (0, end), at most 64, whose prior mass is `prior`: the logarithm of the ratio
// of both is smooth and is read between nodes by cubics, times the prior Beta(1, 10). One node: a fixed value.
struct stat_marginal stat_node_marginal(const double *mass, const double *prior, const double *x, size_t count,
                                        double end, double conf);

#endif
