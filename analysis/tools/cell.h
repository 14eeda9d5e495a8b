// A value of a study file in a table of text.
#ifndef ANALYSIS_TOOLS_CELL_H
#define ANALYSIS_TOOLS_CELL_H

#include "studies/store/export.h"

#include <stdio.h>

enum { CELL_NUMBER_SIZE = 40, CELL_SECONDS_SIZE = 32 };

// The shortest of 15 to 17 digits that reads back as the same bits.
const char *cell_number(double value, char text[CELL_NUMBER_SIZE]);
// Nanoseconds as seconds, exactly: "-0.000000005".
const char *cell_seconds(int64_t ns, char text[CELL_SECONDS_SIZE]);

// The column of that name; NULL where the table has none or the value is missing.
const struct store_cell *cell_find(const struct store_cell *cells, size_t count, const char *name);
const char *cell_text(const struct store_cell *cells, size_t count, const char *name); // "": missing
int64_t cell_integer(const struct store_cell *cells, size_t count, const char *name, int64_t missing);

// As BIDS has tab-separated values: "n/a" for NULL (missing), for an empty text and for what is not finite;
// tabs and line ends, which a cell cannot hold, become spaces.
void cell_write_tsv(FILE *out, const struct store_cell *cell);

#endif
