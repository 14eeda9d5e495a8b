// The results of what the protocol planned: a row per cell, level or pair of levels.
//
// People are the unit. A person's answers in a cell are averaged, then the cells of a row, and the test is over
// people; choices of a row are summed per person and tested as a cell is (choices.h). Pairs of levels are
// compared within people, in cells that are otherwise the same, or between people, as the plan says; where the
// factor lies the other way by the design (factor_design.h) there is a sentence and no number. A row of
// differences names what is subtracted from what, and who was left out.
//
// Holm's p is over every row that has a p: the planned family. A margin of equivalence is a claim of its own,
// so its test has a row of its own in that family, and equality counts as shown by Holm's p alone. No
// difference and a difference beyond the margin cannot both be true, so that both tests of a preference count
// once, as Shaffer's form of Holm's procedure permits (stats/multiple.h): a margin costs the other tests
// little. What cannot be computed has a row that says why.
#ifndef ANALYSIS_REPORT_PLANNED_H
#define ANALYSIS_REPORT_PLANNED_H

#include "analysis/report/adjusted.h"
#include "analysis/report/plans.h"
#include "analysis/report/ratings.h"
#include "analysis/report/thresholds.h"
#include "analysis/stats/equivalence.h"

enum { PLANNED_PAIRS = 200 }; // of one plan; more are a table that nobody reads

struct planned_row {
    size_t plan;                // index
    char words[512];            // which cell, level or pair; "" where the plan has none
    size_t people;              // with a value
    size_t partial;             // of them, those that lack some of its cells
    size_t left_out;            // with a value, but not among the people; the note says why
    double estimate, low, high; // NaN where there is none
    double conf;                // of the interval: planned.conf; of a row of equality 1 - 2 (1 - planned.conf)
    bool difference;            // of two levels, or of a person's two ratings
    double margin; // the row tests equality within one half -+ margin, and follows the row that tests a
                   // difference; NaN: it does not
    enum stat_verdict verdict; // of both rows by Holm's p; of rows of equality with a p
    bool share, effect_size;   // the estimate is a share of choices; partial eta squared, without an interval
    // Of a row of equality about all of one cell of choices.h; block NULL: it is not.
    const char *block, *factors;
    size_t option, reference; // conditions
    const char *unit;         // "" for none
    char test[96];            // "exact binomial, 6 of 22", "t(21) = 2.10", "" for an estimate
    double p_value, holm;     // NaN where nothing was tested
    char note[256];           // why not, or the verdict; "" for none
};

// Where values come from, beside the sample. Loaded, and borrowed for the call.
struct planned_sources {
    const struct ratings *ratings;
    const struct thresholds *thresholds;
    const struct adjusted *adjusted;
};

struct planned {
    double conf;
    size_t row_count;
    struct planned_row *rows; // in the order of the plans
    size_t tested;            // rows with a p
};

// False with a sentence.
bool planned_load(struct planned *out, struct sample *sample, const struct plans *plans,
                  const struct planned_sources *sources, double conf, char *error, size_t error_size);
void planned_free(struct planned *planned);
size_t planned_equality(const struct planned *planned); // how many of the tests are of equality

#endif
