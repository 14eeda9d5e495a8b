// What the sessions' protocols planned, each analysis once.
//
// Sessions that are left out plan nothing. The same analysis with another margin is another plan: protocols of
// one name may have had two versions.
#ifndef ANALYSIS_REPORT_PLANS_H
#define ANALYSIS_REPORT_PLANS_H

#include "analysis/report/sample.h"

struct plan {
    const char *method, *of, *per; // as protocols have them; per "-" where there is none
    double margin;                 // of equivalence, a share of choices in (0, 0.5); NaN: none
};

struct plans {
    size_t count;
    struct plan *items; // texts are the sample's
};

// False where memory ran out.
bool plans_load(struct plans *out, struct sample *sample);
void plans_free(struct plans *plans);
// Why there is no plan, a sentence without a full stop.
const char *plans_none(const struct sample *sample);
bool plan_is(const struct plan *plan, const char *method, const char *of, const char *per); // NULL: any

// The margin that cells are tested with: of the binomial test of choices per cell, else of any other. NaN where
// none has one; with *out_differ, because sessions plan different ones, which is for people to settle.
double plans_margin(const struct plans *plans, bool *out_differ);

#endif
