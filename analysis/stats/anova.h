// Full factorial analysis of variance within participants: any number of factors, all interactions.
//
// Use: fill `values` with one number for every participant and cell (means of repetitions), call
// stat_anova_within(), read `effects`. values[(person * cells) + cell], the last factor's level running
// fastest. Does not: fill what is missing (a value that is not finite gives NaN throughout), handle factors
// between people, or test for sphericity: the corrected p-values are there to be used always.
//
// NaN: F and p where the error is 0, or so small against the values that rounding makes it up; epsilons the
// same, and where the effect has one degree of freedom they are 1; Huynh-Feldt's for two participants.
#ifndef ANALYSIS_STATS_ANOVA_H
#define ANALYSIS_STATS_ANOVA_H

#include <stdbool.h>
#include <stddef.h>

enum { STAT_ANOVA_FACTORS = 6, STAT_ANOVA_EFFECTS = (1 << STAT_ANOVA_FACTORS) - 1 };

struct stat_anova_effect {
    unsigned factors; // bit j: factor j takes part; one bit: a main effect
    double ss, ss_error, df, df_error;
    double f, p_value;
    double epsilon_gg, epsilon_hf; // Greenhouse-Geisser; Huynh-Feldt, 1 where it would be larger
    double p_gg, p_hf;             // with both degrees of freedom times epsilon
    double eta2_partial;           // SS / (SS + its error)
    double eta2_generalised;       // SS / (SS + people + all errors): comparable between designs
};

struct stat_anova {
    size_t effect_count;                                  // 2^factors - 1
    struct stat_anova_effect effects[STAT_ANOVA_EFFECTS]; // main effects first, then by number of factors
    double ss_people, df_people;
};

// 1 to STAT_ANOVA_FACTORS factors of at least two levels each, at least two people. False where that does not
// hold or memory ran out; `out` then has no effect.
bool stat_anova_within(const double *values, size_t people, const size_t *levels, size_t factors,
                       struct stat_anova *out);

// Confidence intervals of `columns` means of the same people, without what differs between people:
// values[person * columns + column]. half_width[i] is what to go up and down from mean[i]. They are for looking
// at differences between columns within people, not at where a mean lies. NaN for less than two people or
// columns, for a value that is not finite and for a conf outside (0, 1).
bool stat_within_intervals(const double *values, size_t people, size_t columns, double conf, double *mean,
                           double *half_width);

#endif
