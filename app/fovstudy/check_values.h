// Which values of which people a planned analysis gets: per cell, how many of each participant. What counts and
// which cells are told apart is as `fovstats planned` has it (analysis/report/planned_read.c), if everybody
// answers everything and nothing is excluded.
#ifndef APP_FOVSTUDY_CHECK_VALUES_H
#define APP_FOVSTUDY_CHECK_VALUES_H

#include "studies/engine/plan.h"

#include <stdbool.h>
#include <stdint.h>

enum { CHECK_MEMBERS = 16, CHECK_SERIES = 256 };

struct check_level {
    char factor[PROTOCOL_NAME], level[PROTOCOL_NAME + 8];
};

struct check_cell {
    char series[CHECK_SERIES]; // what is not joined with others: a question, a parameter; "" for none
    char block[PROTOCOL_NAME];
    struct check_level levels[CHECK_MEMBERS]; // the trial's factors, but for a listed trial's name
    uint32_t level_count;
    char trial[PROTOCOL_NAME + 8]; // a listed trial's name; "" for none
    char scene[PROTOCOL_NAME];     // "" unless the plan is per scene
    uint32_t tested, reference;    // options told apart, from 1; 0 where they do not tell cells apart
    char rated[PROTOCOL_NAME]; // of ratings before and after: the option, and the block is the order; else ""
    bool difference;           // of a person's two ratings
    uint8_t *count;            // of each participant, 255 and more alike
};

// A mode with its values, which participants' plans number differently.
struct check_option {
    uint32_t mode;
    double values[CATALOGUE_PARAMETERS];
};

struct check_values {
    uint32_t people;
    struct check_cell *cells;
    uint32_t cell_count;
    struct check_option *options;
    uint32_t option_count;
};

// Those of one participant, from 0. False: out of memory.
bool check_values_add(struct check_values *values, const struct protocol_analysis *analysis,
                      const struct plan *plan, uint32_t person);
void check_values_finish(struct check_values *values);

// A factor's level in a cell, "scene" being its scene where the plan is per scene; NULL: none.
const char *check_level_of(const struct check_cell *cell, const char *factor);

#endif
