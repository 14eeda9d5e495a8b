// How often an effect of the analysis of variance within people (anova.h) is found.
#ifndef ANALYSIS_STATS_POWER_ANOVA_H
#define ANALYSIS_STATS_POWER_ANOVA_H

#include <stdint.h>

// P(F > f) of the noncentral F distribution; ncp from 0 to 1e6, df from 1 to 1e9. NaN for anything else.
double stat_noncentral_f_upper(double f, double df, double df_error, double ncp);

// people: 2 to STAT_POWER_MAX_N (power.h), each rating in every one of `cells`; df: of the effect, the product
// of its factors' levels less one each, at least 1 and below `cells`; f: Cohen's f, the standard deviation of
// the effect's true values over the cells (divided by `cells`, not by one less) in standard deviations of the
// effect's error, 0 or more. For uncorrected p under sphericity. NaN for anything else, and where people *
// cells * f^2 exceeds 1e6.
double stat_anova_within_power(int64_t people, int64_t cells, int64_t df, double f, double alpha);

#endif
