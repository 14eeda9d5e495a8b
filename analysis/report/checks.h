// Null trials (both options the same) and catch trials (an obvious difference): what they say of sides and of
// attention. Done trials that no rule takes out; catch trials of excluded people too, since they are often why.
#ifndef ANALYSIS_REPORT_CHECKS_H
#define ANALYSIS_REPORT_CHECKS_H

#include "analysis/report/sample.h"
#include "analysis/stats/binomial.h"
#include "analysis/stats/signflip.h"

// Whether something that should not matter was chosen more often than one half of null trials. Where somebody
// answered several, people are tested: exact sign-flip, t interval of their shares. Else the binomial test.
struct check_bias {
    bool several;
    size_t people;                  // with an answer
    struct stat_binomial binomial;  // NaN without a null trial
    struct stat_signflip flip;      // NaN unless several
    struct stat_ttest t;            // the same
    double estimate, p_value, holm; // of the test that the data ask for; Holm's over the two checks
};

struct check_person {
    size_t person; // index
    int64_t nulls, null_a, catches, missed;
    int64_t first_known, null_first; // null trials of which it is known what was shown first
    bool excluded;                   // all sessions
};

struct checks {
    size_t person_count;
    struct check_person *people;   // those with a null or catch trial, as the sample has them
    int64_t nulls, null_equal;     // nulls without "equal"
    struct check_bias side, first; // slot a, the first shown one chosen
    int64_t first_unknown;         // null trials without "equal" of which it is not known what was shown first
    int64_t catches, missed;       // of everybody
    int64_t catch_unknown;         // catch trials left out: nothing tells which answer was right
};

bool checks_load(struct checks *out, struct sample *sample, double conf, char *error, size_t error_size);
void checks_free(struct checks *checks);

#endif
