// Shared by thresholds*.c only.
#ifndef ANALYSIS_REPORT_THRESHOLDS_PRIVATE_H
#define ANALYSIS_REPORT_THRESHOLDS_PRIVATE_H

#include "analysis/report/thresholds.h"

// Fills in cells and people with their steps and the staircases' own estimates.
bool thresholds_read(struct thresholds *out, struct sample *sample, char *error, size_t error_size);
// Adds the cells of constant levels.
bool thresholds_read_levels(struct thresholds *out, struct sample *sample, char *error, size_t error_size);

// What threshold_label() keeps.
void threshold_label_text(const struct sample *sample, const char *factors, const char *without, bool words,
                          char label[512]);

void threshold_cell_free(struct threshold_cell *cell); // what it owns

// A person's entry, made where there is none; NULL where memory ran out.
struct threshold_person *threshold_find_person(struct threshold_cell *cell, size_t person);

#endif
