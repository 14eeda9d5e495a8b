// Opening a study file read-only, and telling in a sentence why one cannot be read.
#include "studies/store/read.h"

#include "studies/store/read_private.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

// schema.sql; a test compares them.
enum { APPLICATION_ID = 1180062548, USER_VERSION = 1 };

void store_reader_fail(struct store_reader *reader, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(reader->error, sizeof reader->error, format, arguments);
    va_end(arguments);
}

// SQLite's own words are not for people who do not know SQLite; the common cases get ours.
void store_reader_fail_sqlite(struct store_reader *reader, int code)
{
    const char *path = reader->path;
    switch (code & 0xff) {
    case SQLITE_NOTADB:
        store_reader_fail(reader, "%s: is not a study file (not an SQLite database)", path);
        return;
    case SQLITE_CORRUPT:
        store_reader_fail(
            reader, "%s: the study file is damaged; use a backup, or try sqlite3's .recover on a copy", path);
        return;
    case SQLITE_BUSY:
    case SQLITE_LOCKED:
        store_reader_fail(reader, "%s: another program keeps the file locked; close it and try again", path);
        return;
    case SQLITE_NOMEM:
        store_reader_fail(reader, "%s: not enough memory", path);
        return;
    default:
        store_reader_fail(reader, "%s: cannot be read: %s", path,
                          reader->db ? sqlite3_errmsg(reader->db) : sqlite3_errstr(code));
    }
}

static bool pragma_int(struct store_reader *reader, const char *sql, int *out)
{
    sqlite3_stmt *statement = NULL;
    int code = sqlite3_prepare_v2(reader->db, sql, -1, &statement, NULL);
    if (code == SQLITE_OK)
        code = sqlite3_step(statement);
    if (code == SQLITE_ROW)
        *out = sqlite3_column_int(statement, 0);
    else
        store_reader_fail_sqlite(reader, code == SQLITE_DONE ? SQLITE_CORRUPT : code);
    sqlite3_finalize(statement);
    return code == SQLITE_ROW;
}

static bool is_study(struct store_reader *reader)
{
    int application = 0, version = 0;
    if (!pragma_int(reader, "PRAGMA application_id", &application) ||
        !pragma_int(reader, "PRAGMA user_version", &version))
        return false;
    if (application != APPLICATION_ID) {
        store_reader_fail(reader, "%s: is another program's database, not a study file", reader->path);
        return false;
    }
    if (version > USER_VERSION) {
        store_reader_fail(reader,
                          "%s: was written by a newer program (version %d of the file, this program knows %d)",
                          reader->path, version, USER_VERSION);
        return false;
    }
    if (version < USER_VERSION) {
        store_reader_fail(reader, "%s: is of an older version (%d, now %d); open it once with fovstudy resume",
                          reader->path, version, USER_VERSION);
        return false;
    }
    return true;
}

// `immutable` is for a file on a medium where SQLite may not make its shared-memory file.
static int open_file(struct store_reader *reader, bool immutable)
{
    if (!immutable)
        return sqlite3_open_v2(reader->path, &reader->db, SQLITE_OPEN_READONLY, NULL);
    char *uri = sqlite3_mprintf("file:%s?immutable=1", reader->path);
    int code = uri && !strpbrk(reader->path, "?#%")
                   ? sqlite3_open_v2(uri, &reader->db, SQLITE_OPEN_READONLY | SQLITE_OPEN_URI, NULL)
                   : SQLITE_CANTOPEN;
    sqlite3_free(uri);
    return code;
}

static bool begin(struct store_reader *reader, bool immutable)
{
    int code = open_file(reader, immutable);
    // One transaction for all calls: a session that is still being written cannot change between them.
    if (code == SQLITE_OK)
        code = sqlite3_exec(reader->db, "PRAGMA query_only = ON; BEGIN; SELECT count(*) FROM sqlite_schema",
                            NULL, NULL, NULL);
    if (code == SQLITE_OK)
        return true;
    store_reader_fail_sqlite(reader, code);
    return false;
}

// Without a write-ahead log beside it the file is whole by itself.
static bool has_log(const char *path)
{
    struct stat info;
    char *log = sqlite3_mprintf("%s-wal", path);
    bool found = log && stat(log, &info) == 0 && info.st_size > 0;
    sqlite3_free(log);
    return found;
}

static bool open_reader(struct store_reader *reader)
{
    struct stat info;
    if (stat(reader->path, &info) != 0) {
        store_reader_fail(reader, "%s: there is no such file", reader->path);
        return false;
    }
    if (!S_ISREG(info.st_mode)) {
        store_reader_fail(reader, "%s: is not a file", reader->path);
        return false;
    }
    if (info.st_size == 0) {
        store_reader_fail(reader, "%s: is not a study file (the file is empty)", reader->path);
        return false;
    }
    bool ok = begin(reader, false);
    if (!ok && reader->db && (sqlite3_errcode(reader->db) & 0xff) == SQLITE_CANTOPEN &&
        !has_log(reader->path)) {
        sqlite3_close(reader->db);
        reader->db = NULL;
        ok = begin(reader, true);
    }
    return ok && is_study(reader);
}

struct store_reader *store_reader_open(const char *path, char *error, size_t error_size)
{
    struct store_reader *reader = calloc(1, sizeof *reader);
    char *copy = strdup(path);
    if (!reader || !copy) {
        snprintf(error, error_size, "%s: not enough memory", path);
        free(reader);
        free(copy);
        return NULL;
    }
    reader->path = copy;
    if (open_reader(reader))
        return reader;
    snprintf(error, error_size, "%s", reader->error);
    store_reader_close(reader);
    return NULL;
}

void store_reader_close(struct store_reader *reader)
{
    if (!reader)
        return;
    sqlite3_close(reader->db);
    free(reader->path);
    free(reader);
}

const char *store_reader_path(const struct store_reader *reader)
{
    return reader->path;
}

const char *store_reader_error(const struct store_reader *reader)
{
    return reader->error;
}
