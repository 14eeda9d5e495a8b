// What a protocol's planned analysis can show with so many participants: the tests that `fovstats planned`
// makes of it, and of each the people in it, from which follow the smallest effect and margin
// (analysis/stats/power.h).
#ifndef APP_FOVSTUDY_CHECK_POWER_H
#define APP_FOVSTUDY_CHECK_POWER_H

#include "app/fovstudy/check_values.h"

// Conventions, not properties of a study: Cohen 1988, "Statistical Power Analysis", section 2.4, for the power.
#define CHECK_ALPHA 0.05
#define CHECK_POWER 0.8

enum { CHECK_PAIRS = 200 }; // of one analysis, as PLANNED_PAIRS of analysis/report/planned.h

enum check_test { CHECK_ESTIMATE, CHECK_BINOMIAL, CHECK_PAIRED_T, CHECK_TWO_SAMPLE_T };

// One test: a row of `fovstats planned`.
struct check_part {
    char label[2 * PROTOCOL_LABELS]; // "epsilon=0.1", "epsilon=0.1 - epsilon=0.2"; "" for the whole
    bool pair;                       // of levels, scenes or cells
    bool margin;                     // the planned margin of equality is tested too, in a row of its own
    uint32_t people;                 // in the test; of two groups those of the first
    uint32_t second;                 // of two groups those of the other
    uint32_t both;                   // of two groups those in both, for whom there is no test
    uint32_t answers;                // of choices: of all of them
};

// One line of the file's `analysis`.
struct check_analysis {
    const struct protocol_analysis *planned;
    enum check_test test;
    const char *none;         // why it has no test; NULL: it has
    uint32_t too_many;        // pairs, where that is why; else 0
    struct check_part *parts; // a test each
    uint32_t part_count;
};

struct check_analyses {
    struct check_analysis each[PROTOCOL_ANALYSES];
    uint32_t count;
};

// Over participants 1 to `people`. False: out of memory; check_analyses_finish either way.
bool check_analyses_init(struct check_analyses *out, const struct protocol *protocol, uint64_t seed,
                         uint32_t people);
void check_analyses_finish(struct check_analyses *analyses);

// check_tests.c: the tests of an analysis from its values. False: out of memory.
bool check_tests(struct check_analysis *analysis, const struct check_values *values);

#endif
