// Shared by merge*.c only. `main` is the file being made, `src` the input at hand.
#ifndef STUDIES_STORE_MERGE_PRIVATE_H
#define STUDIES_STORE_MERGE_PRIVATE_H

#include "studies/store/merge.h"

#include <sqlite3.h>
#include <stdint.h>

struct merging {
    const struct store_merge_desc *desc;
    const struct store_merge_input *input; // at hand
    sqlite3 *db;                           // owned
    int64_t offset;                        // added to every id of the input
    long long twice;
    char *error; // the caller's
    size_t error_size;
};

// Writes the sentence; always false.
bool merge_fail(struct merging *m, const char *format, ...) __attribute__((format(printf, 2, 3)));
// SQLite's last error as a sentence; always false.
bool merge_fail_sqlite(struct merging *m);
void merge_say(struct merging *m, const char *format, ...) __attribute__((format(printf, 2, 3)));
bool merge_run(struct merging *m, const char *sql);
// False with the sentence of refuse() where the query has a row.
bool merge_none(struct merging *m, const char *sql, bool (*refuse)(struct merging *m, sqlite3_stmt *row));

// Fills temp.take (sessions of src to copy) and temp.twin (src, main); sessions of main that src has further
// are deleted.
bool merge_choose(struct merging *m);
bool merge_copy(struct merging *m); // what temp.take names

#endif
