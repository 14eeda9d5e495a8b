// Psychometric functions: the share of answers "yes", or of right ones, by the level of a stimulus.
//
//     P(x) = guess + (1 - guess - lapse) F(z),  z = +/- slope (g(x) - g(threshold))
//
// g is the identity or, on a logarithmic axis, ln; the sign is - where larger levels make the answer rarer (as
// studies/engine/quest_plus.h has it). Every family is scaled so that F(0) = 1/2 and F'(0) = 1: the threshold
// is the level midway between the asymptotes, and the slope is that of F there, in one over the axis' unit.
//     logistic  F(z) = 1 / (1 + exp(-4 z))
//     normal    F(z) = Phi(sqrt(2 pi) z), the cumulative Gaussian with SD 1 / (sqrt(2 pi) slope)
//     gumbel    F(z) = 1 - exp(-ln 2 exp(2 z / ln 2)), the log-Weibull: at the threshold 1/2 and not 1 - 1/e
//     weibull   the same on ln x, so on levels above 0 only: 1 - exp(-ln 2 (x / threshold)^(2 slope / ln 2))
// Source: Schuett, H. H., Harmeling, S., Macke, J. H. & Wichmann, F. A. (2016), Painfree and accurate Bayesian
// estimation of psychometric functions for (potentially) overdispersed data, Vision Research 122, 105-123;
// Wichmann, F. A. & Hill, N. J. (2001), Perception & Psychophysics 63, 1293-1313.
#ifndef ANALYSIS_STATS_PSYCHOMETRIC_H
#define ANALYSIS_STATS_PSYCHOMETRIC_H

#include <stdbool.h>

enum stat_family { STAT_LOGISTIC, STAT_WEIBULL, STAT_NORMAL, STAT_GUMBEL, STAT_FAMILIES };

struct stat_psychometric {
    enum stat_family family;
    bool logarithmic; // axis of logistic, normal and gumbel; weibull always has it
    bool falling;     // larger levels make the answer rarer
    double threshold; // above 0 on a logarithmic axis
    double slope;     // above 0
    double guess;     // the lower asymptote, 0..1
    double lapse;     // 1 - the upper asymptote, 0..1; guess + lapse < 1
};

// F(z) and 1 - F(z), each to its own relative precision.
struct stat_tails {
    double lower, upper;
};
struct stat_tails stat_family_tails(enum stat_family family, double z);
// z with F(z) = p; NaN for p outside (0, 1).
double stat_family_quantile(enum stat_family family, double p);
bool stat_family_logarithmic(enum stat_family family); // whatever the caller wants

// P(x). NaN where x or a parameter is outside its range, x = 0 on a logarithmic axis among them.
double stat_psychometric(const struct stat_psychometric *function, double x);
// The level of probability p; NaN outside the asymptotes.
double stat_psychometric_level(const struct stat_psychometric *function, double p);

const char *stat_family_name(enum stat_family family); // "logistic", ...
bool stat_family_find(const char *name, enum stat_family *out);

#endif
