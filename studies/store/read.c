// Opening a study file read-only, and telling in a sentence why one cannot be read.
#include "studies/store/read.h"

#include "studies/store/migrate.h"
#include "studies/store/read_private.h"

#include <errno.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

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
    case SQLITE_READONLY: // nothing but undoing would write
        store_reader_fail(
            reader,
            "%s: another program was stopped while it wrote, and %s-journal knows how to undo it; open "
            "both with sqlite3 once",
            path, path);
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

// What an older version lacks, in the place of the table: a name without a schema's is looked for among the
// temporary ones first. So whole() names the schema: a view has no rows to check.
static bool complete_older(struct store_reader *reader)
{
    char *view = sqlite3_mprintf("CREATE TEMP VIEW frame AS SELECT %s FROM main.frame",
                                 migrate_frame_columns(reader->version));
    int code = view ? sqlite3_exec(reader->db, "PRAGMA query_only = OFF", NULL, NULL, NULL) : SQLITE_NOMEM;
    if (code == SQLITE_OK)
        code = sqlite3_exec(reader->db, view, NULL, NULL, NULL);
    sqlite3_free(view);
    if (code == SQLITE_OK)
        code = sqlite3_exec(reader->db, "PRAGMA query_only = ON", NULL, NULL, NULL);
    if (code != SQLITE_OK)
        store_reader_fail_sqlite(reader, code);
    return code == SQLITE_OK;
}

static bool is_study(struct store_reader *reader)
{
    int application = 0, version = 0;
    if (!pragma_int(reader, "PRAGMA application_id", &application) ||
        !pragma_int(reader, "PRAGMA user_version", &version))
        return false;
    if (application != STORE_APPLICATION_ID) {
        store_reader_fail(reader, "%s: is another program's database, not a study file", reader->path);
        return false;
    }
    if (version > STORE_VERSION) {
        store_reader_fail(reader,
                          "%s: was written by a newer program (version %d of the file, this program knows %d); "
                          "use that program",
                          reader->path, version, STORE_VERSION);
        return false;
    }
    if (version < 1) {
        store_reader_fail(
            reader, "%s: the study file is damaged (its version is %d, but the first was 1); use a backup",
            reader->path, version);
        return false;
    }
    reader->version = version;
    return version == STORE_VERSION || complete_older(reader);
}

static bool side_file(const struct store_reader *reader, const char *suffix)
{
    char *path = sqlite3_mprintf("%s%s", reader->path, suffix);
    bool found = !path || access(path, F_OK) == 0;
    sqlite3_free(path);
    return found;
}

// Nobody writes where there is neither a write-ahead log, nor a journal of another program, nor an owner's
// lock. Such a file is opened as one that does not change: SQLite then leaves no files of its own beside it,
// and a write-protected folder is no hindrance. Should somebody begin to write after all,
// store_reader_unchanged() finds out. A path with letters that mean something in a URI is opened the plain way.
static bool at_rest(const struct store_reader *reader)
{
    return !side_file(reader, "-wal") && !side_file(reader, "-journal") && !side_file(reader, "-owner") &&
           !strpbrk(reader->path, "?#%") && strncmp(reader->path, "//", 2) != 0;
}

// A reader belongs to one thread: without a mutex a sample is read in two thirds of the time.
static int open_file(struct store_reader *reader)
{
    if (!reader->at_rest)
        return sqlite3_open_v2(reader->path, &reader->db, SQLITE_OPEN_READONLY | SQLITE_OPEN_NOMUTEX, NULL);
    char *uri = sqlite3_mprintf("file:%s?immutable=1", reader->path);
    int code = uri ? sqlite3_open_v2(uri, &reader->db,
                                     SQLITE_OPEN_READONLY | SQLITE_OPEN_NOMUTEX | SQLITE_OPEN_URI, NULL)
                   : SQLITE_NOMEM;
    sqlite3_free(uri);
    return code;
}

bool store_reader_unchanged(struct store_reader *reader)
{
    struct stat now;
    const struct stat *then = &reader->info;
    if (!reader->at_rest ||
        (stat(reader->path, &now) == 0 && now.st_size == then->st_size && now.st_ino == then->st_ino &&
         now.st_mtim.tv_sec == then->st_mtim.tv_sec && now.st_mtim.tv_nsec == then->st_mtim.tv_nsec))
        return true;
    store_reader_fail(reader, "%s: was changed while it was read; run this again", reader->path);
    return false;
}

static bool begin(struct store_reader *reader)
{
    int code = open_file(reader);
    // One transaction for all calls: a session that is still being written cannot change between them.
    if (code == SQLITE_OK)
        code = sqlite3_exec(reader->db, "PRAGMA query_only = ON; BEGIN; SELECT count(*) FROM sqlite_schema",
                            NULL, NULL, NULL);
    if (code == SQLITE_OK)
        return true;
    store_reader_fail_sqlite(reader, code);
    return false;
}

static bool open_reader(struct store_reader *reader)
{
    if (stat(reader->path, &reader->info) != 0) {
        if (errno == ENOENT)
            store_reader_fail(reader, "%s: there is no such file", reader->path);
        else
            store_reader_fail(reader, "%s: cannot be opened: %s", reader->path, strerror(errno));
        return false;
    }
    if (!S_ISREG(reader->info.st_mode)) {
        store_reader_fail(reader, "%s: is not a file", reader->path);
        return false;
    }
    if (reader->info.st_size == 0) {
        store_reader_fail(reader, "%s: is not a study file (the file is empty)", reader->path);
        return false;
    }
    reader->at_rest = at_rest(reader);
    return begin(reader) && is_study(reader);
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

bool store_reader_log_row(struct store_reader *reader, sqlite3_stmt *row,
                          const struct store_log_columns *columns, struct store_log_progress *at)
{
    // 0 is NULL: no row has it.
    static const char sql[] = "SELECT (?1 = 0 OR EXISTS (SELECT 1 FROM session WHERE id = ?1)) AND"
                              " (?2 = 0 OR EXISTS (SELECT 1 FROM segment WHERE id = ?2)) AND"
                              " (?3 = 0 OR EXISTS (SELECT 1 FROM trial WHERE id = ?3)) AND"
                              " (?4 = 0 OR EXISTS (SELECT 1 FROM condition WHERE id = ?4))";
    const int of[4] = {columns->session, columns->segment, columns->trial, columns->condition};
    const int64_t id = sqlite3_column_int64(row, columns->id);
    bool new_references = false;
    if (id <= at->id && at->id) {
        store_reader_fail_sqlite(reader, SQLITE_CORRUPT);
        return false;
    }
    at->id = id;
    for (int i = 0; i < 4; i++) {
        int64_t refers = of[i] < 0 ? 0 : sqlite3_column_int64(row, of[i]);
        new_references = new_references || refers != at->refers[i];
        at->refers[i] = refers;
    }
    if (!new_references)
        return true;
    int code = reader->refers ? SQLITE_OK : sqlite3_prepare_v2(reader->db, sql, -1, &reader->refers, NULL);
    for (int i = 0; i < 4 && code == SQLITE_OK; i++)
        code = sqlite3_bind_int64(reader->refers, i + 1, at->refers[i]);
    if (code == SQLITE_OK)
        code = sqlite3_step(reader->refers);
    bool all = code == SQLITE_ROW && sqlite3_column_int(reader->refers, 0);
    if (code != SQLITE_ROW)
        store_reader_fail_sqlite(reader, code);
    else if (!all)
        store_reader_fail(
            reader,
            "%s: the study file is damaged (table %s refers to rows that are not there); use a backup, or "
            "try sqlite3's .recover on a copy",
            reader->path, columns->condition < 0 ? "gaze" : "frame");
    sqlite3_reset(reader->refers);
    return all;
}

// SQLite finds a row by its index without comparing the two.
static bool whole(struct store_reader *reader, const char *table)
{
    static const char sql[] =
        "SELECT (SELECT count(*) FROM pragma_integrity_check(?1, 'main') WHERE integrity_check <> 'ok') + "
        "(SELECT count(*) FROM pragma_foreign_key_check(?1, 'main'))";
    sqlite3_stmt *statement = NULL;
    int64_t faults = 0;
    int code = sqlite3_prepare_v2(reader->db, sql, -1, &statement, NULL);
    if (code == SQLITE_OK)
        code = sqlite3_bind_text(statement, 1, table, -1, SQLITE_STATIC);
    if (code == SQLITE_OK)
        code = sqlite3_step(statement);
    if (code == SQLITE_ROW)
        faults = sqlite3_column_int64(statement, 0);
    else
        store_reader_fail_sqlite(reader, code);
    sqlite3_finalize(statement);
    if (code == SQLITE_ROW && faults)
        store_reader_fail(
            reader,
            "%s: the study file is damaged (table %s); use a backup, or try sqlite3's .recover on a copy",
            reader->path, table);
    return code == SQLITE_ROW && faults == 0;
}

bool store_reader_whole(struct store_reader *reader, bool logs)
{
    static const char *const tables[] = {
        "protocol",       "participant", "session",    "segment",     "condition", "trial",
        "choice",         "rating",      "response",   "adjust_step", "exposure",  "staircase_step",
        "measured_error", "event",       "gaze_check", "exclusion",   NULL};
    for (int i = 0; tables[i]; i++)
        if (!whole(reader, tables[i]))
            return false;
    return !logs || (whole(reader, "gaze") && whole(reader, "frame"));
}

void store_reader_close(struct store_reader *reader)
{
    if (!reader)
        return;
    sqlite3_finalize(reader->after);
    sqlite3_finalize(reader->refers);
    sqlite3_close(reader->db);
    free(reader->path);
    free(reader);
}

int store_reader_version(const struct store_reader *reader)
{
    return reader->version;
}

const char *store_reader_path(const struct store_reader *reader)
{
    return reader->path;
}

const char *store_reader_error(const struct store_reader *reader)
{
    return reader->error;
}
