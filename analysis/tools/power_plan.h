// What `fovstats power` is asked, the tests it can plan, and what it says of one.
#ifndef ANALYSIS_TOOLS_POWER_PLAN_H
#define ANALYSIS_TOOLS_POWER_PLAN_H

#include "analysis/stats/binomial_sample_size.h"
#include "analysis/tools/command.h"
#include "analysis/tools/json.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum { POWER_SIZES = 200, POWER_FACTORS = 6, POWER_CELLS = 4096 };

struct power_plan {
    double share, sd, margin, d, difference, f; // NaN: not given
    double alpha, power, studies, seed, choices;
    int64_t from, to; // people; 0: no sizes asked
    bool unpaired, json, simulated;
    size_t factors;
    int64_t levels[POWER_FACTORS], cells; // of the analysis of variance
};

// One row of answers: a cell of choices, a t-test, an effect.
struct power_case {
    const char *name;       // "" for the only one
    const int64_t *choices; // of choices: those of each person in turn
    size_t count;
    int64_t df; // of an effect
};

struct power_test {
    const char *method;                                                                      // as printed
    double (*at)(const struct power_plan *plan, const struct power_case *c, int64_t people); // NULL: simulated
    // 0: not reached by any size that was looked at
    struct stat_sample_size (*needed)(const struct power_plan *plan, const struct power_case *c);
};

bool power_plan_ratings(const struct power_plan *plan);
const struct power_test *power_plan_test(const struct power_plan *plan, const struct power_case *c);

// Usage errors in one sentence each, and what follows from the options. -1, or the exit code.
int power_plan_check(const struct command *command, const char *people, const char *levels, bool rehearsal,
                     struct power_plan *plan);

// To stdout. hash: of a rehearsal's data, or NULL.
void power_begin(const struct power_plan *plan, const char *hash, struct json *json);
int power_show(const struct command *command, const struct power_plan *plan, const struct power_case *c,
               struct json *json); // -1, or the exit code
void power_end(const struct power_plan *plan, struct json *json);

#endif
