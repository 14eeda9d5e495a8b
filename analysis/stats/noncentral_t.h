// The noncentral t distribution and confidence limits of its noncentrality, for any noncentrality.
//
// pt() of R, AS 243, stops at |ncp| 37.62 and turns to a normal approximation there; this is an integral and
// has no such limit. Absolute error under 1e-13 for df >= 1 and |t|, |ncp| up to 1e6. NaN for df < 1, df above
// 1e9 and what is not finite.
#ifndef ANALYSIS_STATS_NONCENTRAL_T_H
#define ANALYSIS_STATS_NONCENTRAL_T_H

// P(T <= t).
double stat_noncentral_t_lower(double t, double df, double ncp);

// The noncentrality under which a T of at most t has the probability p, from 1e-10 to 0.5: the upper limit of a
// two-sided interval of confidence 1 - 2 p. The lower limit is minus that of -t. NaN for another p.
double stat_noncentral_t_limit(double t, double df, double p);

#endif
