// How often the test of a cell would reject, by simulating the study: for several choices a person, where no
// formula holds.
//
// Person i of N makes choices[i mod count] choices, each for the option under test with probability
// 1 / (1 + exp(-(b + sd z_i))), z_i standard normal, once a person: the model of mixed_logit.h. b is the number
// for which the mean over people is `share`. The test is the one that analyses make by default: where nobody
// has more than one choice the exact binomial test, else the sign-flip test, both two-sided against one half;
// with a margin the test of equivalence, exact of one choice each (equivalence.h), else the t-tests of
// people_equivalence.h. Draws are draw.h's: a function of the seed.
#ifndef ANALYSIS_STATS_POWER_SIMULATION_H
#define ANALYSIS_STATS_POWER_SIMULATION_H

#include "analysis/stats/binomial.h"

#include <stddef.h>
#include <stdint.h>

enum {
    STAT_SIMULATED_PEOPLE = 10000,
    STAT_SIMULATED_CHOICES = 10000,
    STAT_SIMULATED_STUDIES = 1000000
}; // at most

struct stat_simulation {
    const int64_t *choices; // 0 or more, of the people in turn; borrowed
    size_t choices_count;
    size_t people;
    double share; // in (0, 1): the mean preference over people
    double sd;    // between people, in logits; 0 or more, at most 10
    double alpha; // in (0, 1)
    int64_t studies;
    uint64_t seed;
    double margin; // 0: how often a difference is found; else, up to 0.5, how often equality within it is shown
                   // at alpha below 0.5
};

struct stat_simulated_power {
    double power;            // rejected / studies
    struct stat_interval ci; // Clopper-Pearson, 95 %, of the simulation's own error
    int64_t rejected;
    double intercept; // b
};

// NaN for bad input, and where nobody has a choice to make or memory ran out.
struct stat_simulated_power stat_simulate_power(const struct stat_simulation *simulation);

// The b above: by bisection on the mean over the normal distribution, by the trapezoid rule on -8.5 to 8.5 SD
// with steps of 1/16, whose error for such smooth functions is below 1e-12.
double stat_logit_of_mean(double share, double sd);

#endif
