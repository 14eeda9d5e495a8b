// Equivalence of each cell's preference with the null hypothesis, within a margin.
#ifndef ANALYSIS_TOOLS_CHOICES_EQUIVALENCE_H
#define ANALYSIS_TOOLS_CHOICES_EQUIVALENCE_H

#include "analysis/report/choices.h"
#include "analysis/tools/json.h"
#include "analysis/tools/planned_results.h"

struct choices_margin {
    double value;                   // NaN: none was given or planned
    const char *note;               // where it comes from, or why there is none; NULL: nothing to say
    struct planned_results results; // where that margin was planned about choices.p0
};

// `typed` is NaN where it was not. False with a sentence; free what was loaded then too.
bool choices_margin_load(struct choices_margin *out, double typed, struct sample *sample,
                         const struct choices *choices, char *error, size_t error_size);
void choices_margin_free(struct choices_margin *margin);

// Nothing where there is no margin, but for its note. False where memory ran out. The member is "equivalence".
bool choices_equivalence_print(const struct choices *choices, const struct choices_margin *margin);
bool choices_equivalence_json(struct json *json, const struct choices *choices,
                              const struct choices_margin *margin);

#endif
