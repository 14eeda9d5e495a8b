// Scaling of pairwise choices in just-objectionable differences (JOD): Thurstone's case V by maximum
// likelihood.
//
// Sources: Thurstone, L. L. (1927), A law of comparative judgment, Psychological Review 34, 273-286;
// Perez-Ortiz, M. & Mantiuk, R. K. (2017), A practical guide and software for analysing pairwise comparison
// experiments, arXiv:1712.03686. P(i over j) = Phi((q_i - q_j) / sigma) with sigma = 1 / Phi^-1(0.75) = 1.4826,
// so that one JOD apart is 75 % preference; the reference is 0 and larger is better.
//
// Scores of two options have a maximum of the likelihood only where, by some chain of options, each was
// preferred to the other at least once (Ford, L. R. (1957), American Mathematical Monthly 64(8), part 2,
// 28-33, whose argument holds for every such model). Perez-Ortiz and Mantiuk put a prior on the differences to
// get a number all the same; here such an option is not estimable, and says so.
// Intervals: bootstrap over people, who are the unit: all answers of a person go together; percentiles (Efron &
// Tibshirani 1993, chapter 13). A replicate in which no chain prefers the reference to an option puts it at
// infinity, one in which none prefers it to the reference at minus infinity: such replicates count where they
// lie, so that an end of the interval may be infinite.
#ifndef ANALYSIS_STATS_THURSTONE_H
#define ANALYSIS_STATS_THURSTONE_H

#include "analysis/stats/binomial.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum { STAT_JOD_OPTIONS = 64 };

struct stat_preference {
    size_t person, winner, loser; // options by index, not the same
};

enum stat_jod_status {
    STAT_JOD_OK,
    STAT_JOD_REFERENCE, // 0 by definition
    STAT_JOD_ALONE,     // not compared with the reference, nor by way of others
    STAT_JOD_ALWAYS,    // unanimously preferred
    STAT_JOD_NEVER      // unanimously not preferred
};

struct stat_jod {
    enum stat_jod_status status;
    int64_t won, n; // comparisons
    double score;   // JOD; NaN unless OK or REFERENCE
    // NaN for fewer than two people, or alike; an infinite end is open.
    struct stat_interval interval;
    size_t below, above; // replicates in which it is at minus infinity, at infinity
    size_t failed;       // in which it is not compared with the reference: left out of the interval
    bool alike; // every replicate has the same score: people do not differ, and nothing tells how sure it is
    bool unreliable; // the interval misses the score, or more than 1 in 20 replicates failed
};

struct stat_jod_desc {
    size_t options, reference; // options up to STAT_JOD_OPTIONS
    double conf;               // 0 means 0.95
    size_t replicates;
    uint64_t seed;
};

// Fills out[options]. False for bad input or memory.
bool stat_jod_scale(const struct stat_preference *answers, size_t count, const struct stat_jod_desc *desc,
                    struct stat_jod *out);

// The log-likelihood of scores, for those who want to compare: sum of ln P.
double stat_jod_log_likelihood(const struct stat_preference *answers, size_t count, const double *scores);

#endif
