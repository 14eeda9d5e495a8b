// Shared by read*.c only.
#ifndef STUDIES_STORE_READ_PRIVATE_H
#define STUDIES_STORE_READ_PRIVATE_H

#include <sqlite3.h>
#include <stdbool.h>
#include <stdint.h>
#include <sys/stat.h>

struct store_reader {
    sqlite3 *db;
    char *path;
    char error[512];
    int version;          // of the file's schema
    bool at_rest;         // nobody wrote when it was opened
    struct stat info;     // as it was then
    sqlite3_stmt *after;  // of store_read_gaze_after; NULL before the first
    sqlite3_stmt *refers; // of store_reader_log_row; the same
};

void store_reader_fail(struct store_reader *reader, const char *format, ...)
    __attribute__((format(printf, 2, 3)));
// False with a sentence where the file is no longer the one that was opened.
bool store_reader_unchanged(struct store_reader *reader);
void store_reader_fail_sqlite(struct store_reader *reader, int code);
// Of a scan of gaze or frames in the order of ids: the columns of what a row refers to, -1 where there is none.
struct store_log_columns {
    int id, session, segment, trial, condition;
};
struct store_log_progress { // all 0 before the first row
    int64_t id, refers[4];
};
// False with a sentence where an id does not rise, which is a page that was overwritten (SQLite hands such rows
// out), or where the row refers to one that is not there: it would be taken for one of no trial or no
// condition.
bool store_reader_log_row(struct store_reader *reader, sqlite3_stmt *row,
                          const struct store_log_columns *columns, struct store_log_progress *at);

// Of an exclusion: it takes ratings out and leaves a choice alone (schema.sql).
#define RATINGS_ONLY(exclusion) "substr(" exclusion ".rule, -12) = ':rating_pair'"

// Of a frame: `effective` says what was not asked for. What a participant adjusts, pictures played back and
// pictures repeated at the common rate are as asked.
#define NOT_AS_ASKED(frame)                                                                                    \
    "(" frame "effective IS NOT NULL AND (" frame "effective ->> '$.fovea' IS NOT NULL OR (" frame             \
    "effective ->> '$.playback' IS NULL AND " frame "effective ->> '$.repeated' IS NULL AND "                  \
    "coalesce((SELECT settings ->> '$.procedure' FROM trial WHERE trial.id = " frame                           \
    "trial_id), '') <> 'adjust')))"

#endif
