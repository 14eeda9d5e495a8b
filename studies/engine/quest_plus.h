// QUEST+: the next stimulus is the one that is expected to leave the least doubt about the psychometric
// function.
//
// Source: Watson 2017, "QUEST+: A general multidimensional Bayesian adaptive psychometric method", Journal of
// Vision 17(3):10, with one stimulus parameter (the level x), a flat prior on the grids, and any number of
// outcomes from 2 on, numbered from 0 (2: wrong, right).
//
// With g the axis (ln for logarithmic levels and for the Weibull family, else the identity), F the family and
// s = +1, or -1 where larger levels are harder:
//     two outcomes    P(1 | x) = guess + (1 - guess - lapse) F(s slope (g(x) - g(threshold)))
//     K outcomes      P(at least k | x) = F(s slope (g(x) - g(threshold_k))), k = 1..K-1, one slope for all
//                     (Samejima 1969, graded response), thresholds strictly in order of difficulty and drawn
//                     from one grid; then each P(k) becomes (1 - lapse) P(k) + lapse / K
//     families        logistic F(z) = 1 / (1 + exp(-z)), normal the normal distribution function, gumbel
//                     F(z) = 1 - exp(-exp(z)), weibull the same on ln x: 1 - exp(-(x / threshold)^slope)
// F(0), the share of (1 - guess - lapse) at the threshold, is 1/2 for logistic and normal, 1 - 1/e for the
// others. Levels in dB with Watson's Weibull: gumbel on a linear axis with slope beta ln(10) / 20. Units:
// thresholds in the level's; slopes in one over the axis' unit; entropies in nats.
//
// The true value lies between grid values: a grid much coarser than the SD that is reached makes that SD too
// small.
//
// Use: quest_plus_check -> quest_plus_create -> { quest_plus_level, show it, quest_plus_outcome } -> estimates
// -> quest_plus_destroy. Does not: stop by itself, do I/O, allocate after creation, go on without an end (each
// call's work is fixed: levels x outcomes x parameter sets). Threads: one at a time.
//
// Numbers: probabilities below DBL_MIN (2.2e-308) count as DBL_MIN, so answers that no function on the grid can
// give lower every likelihood and leave a finite posterior. Log-posteriors are normalised by log-sum-exp after
// each outcome. Levels whose expected entropy is within QUEST_PLUS_TIE of the smallest are tied and the first
// (lowest) is taken: rounding does not decide, and once the grid has nothing more to tell, the first level
// stays. Sums have a fixed order and no operation is contracted, so GCC, Clang and their optimisation levels
// agree (bit for bit with one C library, -O0 to -O3) as far as exp, log, expm1 and erfc of the C library are
// the same; another library may differ in the last digits, and by that in a level only where two are tied to
// within them.
#ifndef STUDIES_ENGINE_QUEST_PLUS_H
#define STUDIES_ENGINE_QUEST_PLUS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define QUEST_PLUS_TIE 1e-12 // nats; above the sums' rounding: entropies agree with R's to 1.4e-13
// 64 MiB, the tables of one instance. Near it creation takes 0.3 s and an outcome 10 ms (2026, one shared
// core).
#define QUEST_PLUS_BYTES 67108864.0

enum quest_plus_spacing { QUEST_PLUS_LINEAR, QUEST_PLUS_LOG };

// `count` values from min to max, both of them among the values; a single value has min = max.
struct quest_plus_grid {
    double min, max;
    uint32_t count;
    enum quest_plus_spacing spacing; // LOG: equal ratios, min above 0
};

struct quest_plus_family;
// "logistic", "weibull", "normal", "gumbel"; NULL: none of that name.
const struct quest_plus_family *quest_plus_find_family(const char *name);
const char *quest_plus_family_name(const struct quest_plus_family *family);
extern const struct quest_plus_family *const quest_plus_families[]; // ends with NULL

struct quest_plus_model {
    const struct quest_plus_family *family;
    uint32_t outcomes;                // 2 or more
    struct quest_plus_grid threshold; // of more outcomes: each of them, all choices in order
    struct quest_plus_grid slope;     // above 0
    struct quest_plus_grid guess;     // 0..1; two outcomes only, otherwise left out (count 0)
    struct quest_plus_grid lapse;     // 0..1
};

struct quest_plus_desc {
    struct quest_plus_grid level; // the levels it may choose
    bool falling;                 // larger levels are harder: they make higher outcomes rarer
    struct quest_plus_model model;
};

// Places in a parameter set; threshold k (1..outcomes-1) is QUEST_PLUS_THRESHOLD + k - 1.
enum quest_plus_parameter { QUEST_PLUS_SLOPE, QUEST_PLUS_GUESS, QUEST_PLUS_LAPSE, QUEST_PLUS_THRESHOLD };

// False with a sentence where the description contradicts itself or its tables pass QUEST_PLUS_BYTES.
bool quest_plus_check(const struct quest_plus_desc *desc, char *error, size_t error_size);

double quest_plus_grid_value(const struct quest_plus_grid *grid, uint32_t index);
double quest_plus_sets(const struct quest_plus_model *model); // parameter sets on the grids
// The law above: out[outcomes] for one level and one parameter set (outcomes + 2 values).
void quest_plus_probabilities(const struct quest_plus_desc *desc, double level, const double *set, double *out);

struct quest_plus;
// NULL: out of memory, or the check fails.
struct quest_plus *quest_plus_create(const struct quest_plus_desc *desc);
void quest_plus_destroy(struct quest_plus *quest); // NULL is fine

double quest_plus_level(const struct quest_plus *quest); // to show next
// The answer to that level. outcome < outcomes.
void quest_plus_outcome(struct quest_plus *quest, uint32_t outcome);

// Posterior mean of the parameter's own values (arithmetic on logarithmic grids too) and its SD.
double quest_plus_mean(const struct quest_plus *quest, uint32_t parameter, double *out_sd);
double quest_plus_entropy(const struct quest_plus *quest);          // of the posterior
double quest_plus_expected_entropy(const struct quest_plus *quest); // after the next outcome

#endif
