// Shared by merge*.c only. `main` is the file being made, `src` the input at hand.
#ifndef STUDIES_STORE_MERGE_PRIVATE_H
#define STUDIES_STORE_MERGE_PRIVATE_H

#include "studies/store/merge.h"

#include <sqlite3.h>
#include <stdint.h>

struct merging {
    const struct store_merge_desc *desc;
    const struct store_merge_input *input; // at hand
    int version;                           // of its schema
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

enum further { FURTHER_NONE, FURTHER_MAIN, FURTHER_SRC, FURTHER_APART, FURTHER_ERROR };

struct merge_verdict {
    enum further further; // which of two copies of a session goes on further
    char table[24];       // where they differ
    int64_t invalid;      // place of a trial that is invalid in one copy and done in the other; 0: none
};

// What two parts of a session say together.
enum further merge_further(enum further a, enum further b);
// merge_progress.c: adds what the copies' statuses say to the verdict.
bool merge_progress(struct merging *m, int64_t src, int64_t main_id, struct merge_verdict *out);

// merge_attributes.c: of people in both files, as temp.people names them, the fuller attributes hold.
bool merge_attributes(struct merging *m);

// Fills temp.take (sessions of src to copy) and temp.twin (src, main); sessions of main that src has further
// are deleted.
bool merge_choose(struct merging *m);
bool merge_copy(struct merging *m); // what temp.take names

#endif
