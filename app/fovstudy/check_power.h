// What a protocol's planned analysis can show with so many participants: for each planned test the number of
// independent answers, and from it the smallest effect and margin (analysis/stats/power.h).
#ifndef APP_FOVSTUDY_CHECK_POWER_H
#define APP_FOVSTUDY_CHECK_POWER_H

#include "studies/engine/plan.h"

#include <stdbool.h>
#include <stdint.h>

// Conventions, not properties of a study: Cohen 1988, "Statistical Power Analysis", section 2.4, for the power.
#define CHECK_ALPHA 0.05
#define CHECK_POWER 0.8

enum check_test { CHECK_ESTIMATE, CHECK_BINOMIAL, CHECK_PAIRED_T, CHECK_TWO_SAMPLE_T };

struct check_part {
    char label[PROTOCOL_LABELS]; // "epsilon=0.1 fovea_deg=6"; "" for the whole
    uint32_t people;             // who give at least one answer
    uint32_t answers;            // of all of them
    uint32_t last;               // internal: the last participant counted, from 1
};

// One line of the file's `analysis`.
struct check_analysis {
    const struct protocol_analysis *planned;
    enum check_test test;
    struct check_part *parts; // of a two-sample test the two samples; else a test each
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

#endif
