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

// The factors within people of an analysis of variance.
struct power_design {
    const char *question, *block; // of a rehearsal; NULL where the levels were typed
    char refusal[256];            // why a rehearsal's ratings have no design; "" where they have one
    char left_out[256];           // factors of it that are not analysed, and why; "" for none
    size_t most;                  // ratings of a person in a cell, which are averaged
    size_t factors;               // 0: none
    const char *names[POWER_FACTORS];
    int64_t levels[POWER_FACTORS], cells;
};

struct power_plan {
    double share, sd, margin, d, difference, f; // NaN: not given
    double alpha, power, studies, seed, choices;
    int64_t from, to; // people; 0: no sizes asked
    bool unpaired, json, simulated;
    struct power_design design; // as typed
};

// What the cases were taken from.
struct power_source {
    const char *hash; // of a rehearsal's data; NULL: options alone
    bool simulates;   // one of the cases at least is simulated
    const struct power_design *designs;
    size_t design_count;
};

// One row of answers: a cell of choices, a t-test, an effect.
struct power_case {
    const char *name;       // "" for the only one
    const int64_t *choices; // of choices: those of each person in turn, 0 or more
    size_t count;
    int64_t df;     // of an effect
    int64_t in, of; // of every `of` participants of the study `in` are the case's; 0 and 0: all are
};

struct power_test {
    const char *method;                                                                      // as printed
    double (*at)(const struct power_plan *plan, const struct power_case *c, int64_t people); // NULL: simulated
    // 0: not reached by any size that was looked at
    struct stat_sample_size (*needed)(const struct power_plan *plan, const struct power_case *c);
};

bool power_plan_ratings(const struct power_plan *plan);
bool power_design_fits(const struct power_plan *plan, const struct power_design *design); // f is not too large
// Of so many participants of the study those in the case: people * in / of, rounded, halves down, for of two
// groups of an odd number's halves one has the smaller. And the fewest participants with so many in it; 0 for
// 0.
int64_t power_case_people(const struct power_case *c, int64_t participants);
int64_t power_case_participants(const struct power_case *c, int64_t people);
// The choices of so many participants: those in the case take its in turn. Somebody may have none, as who
// answers "equal".
int64_t power_case_choices(const struct power_case *c, int64_t participants);
const struct power_test *power_plan_test(const struct power_plan *plan, const struct power_case *c);

// Usage errors in one sentence each, and what follows from the options. -1, or the exit code.
int power_plan_check(const struct command *command, const char *people, const char *levels, bool rehearsal,
                     struct power_plan *plan);

// To stdout.
void power_begin(const struct power_plan *plan, const struct power_source *source, struct json *json);
int power_show(const struct command *command, const struct power_plan *plan, const struct power_case *c,
               struct json *json); // -1, or the exit code
void power_end(const struct power_plan *plan, struct json *json);

// power_design.c: every effect of a design, named by its question and block too where there are `several` of
// them.
int power_show_design(const struct command *command, const struct power_plan *plan,
                      const struct power_design *design, bool several,
                      struct json *json);                                  // -1, or the exit code
void power_design_words(const struct power_design *design, char out[256]); // "scene 3 x region 2 (6 cells)"

// power_rehearsal.c: all cases of a study file. -1, or the exit code.
int power_rehearsal(const struct command *command, const struct power_plan *plan, char **files, int count,
                    struct json *json);

#endif
