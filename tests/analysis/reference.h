// Reading the reference tables of tests/reference, and comparing doubles.
#ifndef TESTS_ANALYSIS_REFERENCE_H
#define TESTS_ANALYSIS_REFERENCE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

FILE *reference_open(const char *name); // fails the test where it cannot
// The next field of a line, up to `separator`; the rest moves on. NULL after the last.
char *reference_field(char **rest, char separator);
double reference_number(const char *text);                            // NA and NaN become NaN
size_t reference_numbers(const char *text, double *out, size_t most); // by spaces

// Of a file of lines "name,value"; fails the test where there is none.
double reference_value(const char *file, const char *name);

// |a - b| within `relative` of |b|, or both NaN, or both the same infinity.
bool reference_close(double a, double b, double relative);
double reference_distance(double a, double b); // relative; 0 for both NaN or equal

#endif
