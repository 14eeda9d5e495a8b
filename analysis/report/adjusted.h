// What people set parameters to: the method of adjustment.
//
// A cell is one combination of block, factor levels and parameter. Counted are the final values of main trials
// that are done and not excluded. People are the unit: a person's repeats are averaged first, and the mean, its
// t interval and the median are over people.
#ifndef ANALYSIS_REPORT_ADJUSTED_H
#define ANALYSIS_REPORT_ADJUSTED_H

#include "analysis/report/thresholds.h"

struct adjusted_person {
    size_t person; // index into the sample
    size_t count;  // values
    double mean, low, high;
};

struct adjusted_cell {
    const char *block, *factors, *label, *words, *parameter; // as of threshold_cell
    size_t person_count;
    struct adjusted_person *people;
    struct threshold_mean over_people;
};

struct adjusted {
    double conf;
    size_t cell_count;
    struct adjusted_cell *cells; // by block, parameter and factors
    int64_t values;              // used
    int64_t not_done, excluded;  // left out, by the first reason that holds
};

// False with a sentence. No value at all is not an error: cell_count is 0.
bool adjusted_load(struct adjusted *out, struct sample *sample, double conf, char *error, size_t error_size);
void adjusted_free(struct adjusted *adjusted);

#endif
