// The CSV files of fovbench: their columns, writing (RFC 4180 quoting) and reading back by the columns' names.
//
// Numbers are written with six digits, "inf" for an infinite PSNR, nothing where a measure was not taken.
#ifndef APP_FOVBENCH_CSV_H
#define APP_FOVBENCH_CSV_H

#include "app/fovbench/request.h"
#include "app/fovbench/row.h"

#include <stdio.h>

void csv_write_header(FILE *out);
void csv_write_row(FILE *out, const struct row *row);
void csv_write_frames_header(FILE *out);
void csv_write_frame(FILE *out, const struct row *row, uint64_t frame, const struct sample *sample);

// A file in memory; cells are texts of the table. Rows are numbered from 0 without the header.
struct csv_table {
    char *text;   // owned
    char **cells; // owned, [row][column], the header first
    size_t row_count, column_count;
};

// NULL text after a sentence: the file cannot be read, is empty, or a line has another number of cells.
bool csv_read(struct csv_table *out, const char *path, char *error, size_t error_size);
void csv_finish(struct csv_table *table);
int csv_column(const struct csv_table *table, const char *name);             // -1 for none
const char *csv_cell(const struct csv_table *table, size_t row, int column); // "" for column -1
double csv_number(const struct csv_table *table, size_t row, int column);    // NaN for no number

#endif
