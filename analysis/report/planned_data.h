// The values of one plan, per cell and person. Shared by planned*.c only.
#ifndef ANALYSIS_REPORT_PLANNED_DATA_H
#define ANALYSIS_REPORT_PLANNED_DATA_H

#include "analysis/report/factor_design.h"
#include "analysis/report/planned.h"
#include "analysis/stats/people.h"

struct planned_cell {
    const char *series; // what must not be joined with others: a question, a parameter; "" where there is one
    const char *block, *factors;
    const char *scene;      // "" unless the plan is per scene
    size_t test, reference; // conditions; SAMPLE_NONE where they do not tell cells apart
    const char *words;
    bool difference;            // values are differences already, of a person's two ratings
    size_t minuend, subtrahend; // of differences: conditions; SAMPLE_NONE where several were
    double *sum;                // per person of the sample
    int64_t *count;
};

struct planned_data {
    struct sample *sample;
    bool counts; // sum of count: answers for the test option, or right ones
    const char *unit;
    size_t cell_count;
    struct planned_cell *cells;
};

bool planned_data_load(struct planned_data *out, struct sample *sample, const struct plan *plan,
                       const struct planned_sources *sources, char *error, size_t error_size);
void planned_data_free(struct planned_data *data);
// Adds to the cell that is the same in all that comes before `sum`, which is made where it is new; texts are
// copied. False where memory ran out.
bool planned_data_add(struct planned_data *data, const struct planned_cell *like, size_t person, double value,
                      int64_t count);
// planned_read.c: what sections do not keep per person.
bool planned_read_trials(struct planned_data *out, const struct plan *plan, char *error, size_t error_size);
bool planned_read_ratings(struct planned_data *out, const struct plan *plan, char *error, size_t error_size);

// The level of a factor in a cell, "scene" being its scene where the plan is per scene; NULL: none.
const char *planned_level(const struct planned_data *data, const struct planned_cell *cell, const char *factor);

// planned_groups.c: a row's cells.
struct planned_group {
    const char *series, *factor, *level; // factor NULL: cells or all of them
    char words[512];
    size_t *cells;
    size_t cell_count;
};

struct planned_groups {
    size_t count;
    struct planned_group *items;
};

bool planned_groups_load(struct planned_groups *out, const struct planned_data *data, const struct plan *plan);
void planned_groups_free(struct planned_groups *groups);

// planned_choices.c: a group's choices, and where the plan has a margin the row of equality after it. `room`: a
// struct stat_person for each person of the sample. False where memory ran out.
bool planned_choices(struct planned *out, const struct planned_data *data, const struct planned_group *group,
                     const struct plan *plan, size_t index, size_t partial, struct stat_person *room);
void planned_verdicts(struct planned *planned); // of the rows of equality, once Holm's p are known

// planned_pairs.c: rows of pairs of groups. Appends; false where memory ran out.
bool planned_pairs(struct planned *out, const struct planned_data *data, const struct planned_groups *groups,
                   const struct plan *plan, size_t index);
// planned_design.c: whether two groups lie within or between people.
struct planned_design {
    struct choice_design is;
    bool *stray; // of each person of the sample: has values at several levels of what lies between people
};

bool planned_design_load(struct planned_design *out, const struct planned_data *data,
                         const struct planned_group *a, const struct planned_group *b);
void planned_design_free(struct planned_design *design);
// Whether a paired, or an unpaired, test does not fit; the row then says so.
bool planned_design_refuses(struct planned_row *row, const struct planned_design *design, bool paired);
// Says how many row->left_out are, people "without ..." or "with ..."; nothing where they are none.
void planned_row_left_out(struct planned_row *row, const char *why);

// planned_anova.c
bool planned_anova(struct planned *out, const struct planned_data *data, const struct plan *plan, size_t index,
                   const struct planned_sources *sources);

// An empty row at the end; NULL where memory ran out.
struct planned_row *planned_row_add(struct planned *out, size_t plan);
void planned_row_t(struct planned_row *row, const struct stat_ttest *t, const char *unit, bool tested);

#endif
