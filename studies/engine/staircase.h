// Adaptive methods: the next level of one parameter from the answers so far.
//
//     1up2down    Levitt 1971, "Transformed up-down methods in psychoacoustics", JASA 49(2B): two right answers
//                 in a row at a level make it harder, a wrong one easier; settles where P(right)^2 = 1/2, so at
//                 70.7 % right.
//     weighted    Kaernbach 1991, "Simple adaptive testing with the weighted up-down method", Perception &
//                 Psychophysics 49(3): a right answer makes it harder by the step, a wrong one easier by
//                 step x target / (1 - target) (on logarithmic levels that is the exponent of the factor);
//                 settles at P(right) = target.
//     quest_plus  quest_plus.h.
//
// Use: staircase_check -> staircase_create -> until staircase_done: { show staircase_level; staircase_outcome }
// -> staircase_destroy. To resume, create it from the same description and hand it the outcomes stored so far,
// in order: its state is a function of those and of nothing else. Does not: read a clock, draw at random, do
// I/O, allocate after creation. Threads: one at a time. Numbers: as quest_plus.h says; up-down levels need +, x
// and / only (weighted on logarithmic levels also one pow).
//
// Up-down, in detail. Levels never leave level.min..level.max: a step that would is cut there. Step i (from 1)
// is used until the i-th reversal, the last one from then on. A reversal is a move in the other direction than
// the move before; it belongs to the trial whose answer turned the direction, so its level is a peak or valley
// of the levels shown. A step that the bound swallows whole is no move. The estimate is the mean (geometric on
// logarithmic levels) of the levels of the last even number of reversals among those made with the last step
// size, that is after the first step_count - 1; NaN before there are two. To leave out more, repeat the last
// step size in the list. It is off where the psychometric function bends within a step: keep the last steps,
// the wrong answer's too, below the function's spread (figures:
// tests/studies/engine/test_staircase_observer.c). Levels are reached by adding steps (multiplying factors), so
// what is the same level on paper may differ in its last digits.
#ifndef STUDIES_ENGINE_STAIRCASE_H
#define STUDIES_ENGINE_STAIRCASE_H

#include "studies/engine/quest_plus.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum {
    STAIRCASE_STEPS = 16,
    // With reversals alone as the stop rule: someone who answers at random or always the same must get out too.
    STAIRCASE_TRIALS = 1000,
    STAIRCASE_TRIALS_MOST = 100000
};

struct staircase_method;
// "1up2down", "weighted", "quest_plus"; NULL: none of that name.
const struct staircase_method *staircase_find_method(const char *name);
const char *staircase_method_name(const struct staircase_method *method);
extern const struct staircase_method *const staircase_methods[]; // ends with NULL

// A protocol must say it: the wrong one drives a staircase to its end.
enum staircase_larger { STAIRCASE_LARGER_UNSAID, STAIRCASE_LARGER_EASIER, STAIRCASE_LARGER_HARDER };

// Zeroed fields are not given.
struct staircase_desc {
    const struct staircase_method *method;
    enum staircase_larger larger;
    struct quest_plus_grid level; // min..max of what may be shown; count for QUEST+ only
    uint32_t trials;              // stop after so many; 0 (up-down with reversals): STAIRCASE_TRIALS
    // up-down
    uint32_t reversals; // stop after so many, of every step size; 0: trials alone stop
    double start;       // first level
    // In the level's unit; on logarithmic levels factors above 1. Usually falling.
    double steps[STAIRCASE_STEPS];
    uint32_t step_count;
    double target; // weighted: share of right answers, above 0 and below 1
    // QUEST+
    struct quest_plus_model model;
    uint32_t threshold; // which one the estimate is of, from 1 (between outcomes 0 and 1); 0: that one
};

// False with a sentence where the description contradicts itself.
bool staircase_check(const struct staircase_desc *desc, char *error, size_t error_size);

// What the store's staircase_step keeps, and the SD.
struct staircase_step {
    double level;     // shown in this trial, not the next one
    uint32_t outcome; // 0 wrong, 1 right; QUEST+ may have more
    bool reversal;    // this answer turned the direction; never with QUEST+
    double estimate;  // of the threshold after this answer; NaN before there is one
    double sd;        // of the posterior; NaN for up-down
};

struct staircase;
// NULL: out of memory, or the check fails. Nothing of `desc` need live on.
struct staircase *staircase_create(const struct staircase_desc *desc);
void staircase_destroy(struct staircase *staircase); // NULL is fine

double staircase_level(const struct staircase *staircase); // to show next
bool staircase_done(const struct staircase *staircase);
// The answer to the level shown. False, with nothing changed: it is done, or there is no such outcome.
bool staircase_outcome(struct staircase *staircase, uint32_t outcome, struct staircase_step *out_step);
uint32_t staircase_outcomes(const struct staircase *staircase); // how many kinds there are: 2 for up-down
uint32_t staircase_trials(const struct staircase *staircase);   // answered
// Its posterior, for slope, lapse and further thresholds; NULL for up-down.
const struct quest_plus *staircase_quest(const struct staircase *staircase);

#endif
