// A study file as flat tables, row after row, for exports. Reads only; same manners as read.h.
#ifndef STUDIES_STORE_EXPORT_H
#define STUDIES_STORE_EXPORT_H

#include "studies/store/read.h"

struct store_cell {
    const char *name; // of the column
    enum {
        STORE_CELL_NONE,
        STORE_CELL_INTEGER,
        STORE_CELL_REAL,
        STORE_CELL_TEXT
    } kind; // NONE: NULL in the file
    int64_t integer;
    double real;
    const char *text;
};

// First called once with `header`, where only the names are set, also for a table without rows.
typedef bool (*store_export_fn)(void *user, bool header, const struct store_cell *cells, size_t count);

// Names of the tables that there are, NULL-terminated.
const char *const *store_export_tables(void);
bool store_read_export(struct store_reader *reader, const char *table, store_export_fn each, void *user);

#endif
