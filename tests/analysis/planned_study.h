// A small study whose sessions planned something, and its table of planned analyses.
#ifndef TESTS_ANALYSIS_PLANNED_STUDY_H
#define TESTS_ANALYSIS_PLANNED_STUDY_H

#include "analysis/report/planned.h"

// A plan as JSON's members: "binomial", "choice", "cell", then further members.
#define PLAN(method, of, per, more) "{\"method\":\"" method "\",\"of\":\"" of "\",\"per\":\"" per "\"" more "}"

struct planned_study {
    struct sample sample;
    struct plans plans;
    struct ratings ratings;
    struct thresholds thresholds;
    struct adjusted adjusted;
    struct planned planned;
};

void planned_study_plan(const char *plans); // of s.db: PLANs with commas between them, in place of what it has
void planned_study_load(struct planned_study *study); // s.db; fails the test where it cannot
void planned_study_free(struct planned_study *study);

// The numbers of the line of that name in tests/reference/planned.csv: estimate, low, high, p, Holm's p.
void planned_study_known(const char *name, double out[5]);
// A row against them, to 1e-9; the largest relative difference so far goes up.
void planned_study_compare(const struct planned_row *row, const char *name, double *io_worst);

#endif
