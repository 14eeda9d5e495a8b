// Null trials (both options the same) and catch trials (an obvious difference): what they say of sides and of
// attention. Done trials that no rule takes out; catch trials of excluded people too, since they are often why.
#ifndef ANALYSIS_REPORT_CHECKS_H
#define ANALYSIS_REPORT_CHECKS_H

#include "analysis/report/sample.h"
#include "analysis/stats/binomial.h"

struct check_person {
    size_t person; // index
    int64_t nulls, null_a, catches, missed;
    bool excluded; // all sessions
};

struct checks {
    size_t person_count;
    struct check_person *people;                   // those with a null or catch trial, as the sample has them
    int64_t nulls, null_a, null_first, null_equal; // nulls without "equal"; slot a, the first shown one chosen
    int64_t null_people;
    struct stat_binomial side, first; // NaN without a null trial
    int64_t catches, missed;          // of everybody
};

bool checks_load(struct checks *out, struct sample *sample, double conf, char *error, size_t error_size);
void checks_free(struct checks *checks);

#endif
