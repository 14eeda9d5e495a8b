// Shared by choices*.c only.
#ifndef ANALYSIS_REPORT_CHOICES_PRIVATE_H
#define ANALYSIS_REPORT_CHOICES_PRIVATE_H

#include "analysis/report/choices.h"

// Adds the people whose sessions in a file planned trials of the cells that there are. False where memory ran
// out or the file could not be read.
bool choices_plan(struct choices *choices, const struct sample *sample, size_t file);

#endif
