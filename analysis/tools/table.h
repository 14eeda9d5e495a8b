// A plain text table: columns as wide as their widest cell, numbers to the right.
#ifndef ANALYSIS_TOOLS_TABLE_H
#define ANALYSIS_TOOLS_TABLE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

enum { TABLE_COLUMNS = 16 };

struct table {
    size_t columns;
    size_t count;
    char **cells; // owned; row by row, the headings first
    bool failed;  // memory
};

// Headings, NULL-terminated; one that begins with '<' is a column of words, set to the left (the '<' is not
// printed).
void table_init(struct table *table, const char *const *headings);
void table_cell(struct table *table, const char *format, ...) __attribute__((format(printf, 2, 3)));
bool table_print(const struct table *table, FILE *out); // false where memory ran out while filling it
void table_finish(struct table *table);

#endif
