// Factor levels in words for people: "ε 0.2", "fovea 17°".
#ifndef ANALYSIS_REPORT_LEVEL_H
#define ANALYSIS_REPORT_LEVEL_H

#include "analysis/report/choices.h"

// With the factor's name, or the value with its unit alone. Cut where it does not fit.
void level_words(const char *factor, const char *value, bool named, char out[96]);

// The factor's name with its unit: "fovea (°)".
void level_name(const char *factor, char out[96]);

// Levels `from` up to `to` (not included), joined by commas.
void level_join(const struct choice_cell *cell, size_t from, size_t to, char out[256]);

// The same of all factors of a trial, given by their JSON text; "" where there is none.
void level_all(const struct sample *sample, const char *factors, char out[256]);

// The order of two texts with levels in them: numbers by value, the largest first; the rest by alphabet.
int level_order(const char *a, const char *b);

#endif
