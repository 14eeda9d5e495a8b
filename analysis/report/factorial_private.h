// Shared by factorial*.c only.
#ifndef ANALYSIS_REPORT_FACTORIAL_PRIVATE_H
#define ANALYSIS_REPORT_FACTORIAL_PRIVATE_H

#include "analysis/report/factorial.h"

// Factors, levels, complete people and their values; or a refusal. False where memory ran out.
bool factorial_design(struct factorial *f, const struct sample *sample);

#endif
