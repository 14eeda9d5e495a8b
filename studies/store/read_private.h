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
    int version;                    // of the file's schema
    bool at_rest;                   // nobody wrote when it was opened
    struct stat info;               // as it was then
    bool frames_refer, gaze_refers; // store_reader_refers() has said so
    sqlite3_stmt *after;            // of store_read_gaze_after; NULL before the first
};

void store_reader_fail(struct store_reader *reader, const char *format, ...)
    __attribute__((format(printf, 2, 3)));
// False with a sentence where the file is no longer the one that was opened.
bool store_reader_unchanged(struct store_reader *reader);
void store_reader_fail_sqlite(struct store_reader *reader, int code);
// Of a scan in the order of ids, from *last INT64_MIN on: false with a sentence where an id does not rise,
// which is a page that was overwritten. SQLite hands such rows out.
bool store_reader_rises(struct store_reader *reader, int64_t id, int64_t *last);

// Of frame or gaze: false with a sentence where a row refers to one that is not there. It would be taken for a
// row of no trial or no condition. `known` keeps a yes: the check takes as long as reading half of the rows.
bool store_reader_refers(struct store_reader *reader, const char *table, bool *known);

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
