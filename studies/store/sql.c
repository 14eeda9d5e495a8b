#include "studies/store/sql.h"
#include "studies/store/queue.h"
#include "studies/store/rows.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <sys/stat.h>

void sql_say(struct store_error *error, const char *format, ...)
{
    if (!error)
        return;
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(error->text, sizeof error->text, format, arguments);
    va_end(arguments);
}

enum store_result sql_failure(struct store *store, int code, struct store_error *error)
{
    const char *why = store->db ? sqlite3_errmsg(store->db) : sqlite3_errstr(code);
    switch (code & 0xff) { // the primary code of an extended one
    case SQLITE_CONSTRAINT:
        if (code == SQLITE_CONSTRAINT_TRIGGER)
            sql_say(error, "%s: %s", store->path, why);
        else
            sql_say(error, "%s: the row breaks a rule of the study file: %s", store->path, why);
        return STORE_REFUSED;
    case SQLITE_MISMATCH:
    case SQLITE_TOOBIG:
    case SQLITE_RANGE:
        sql_say(error, "%s: the row cannot be stored: %s", store->path, why);
        return STORE_REFUSED;
    case SQLITE_NOTADB:
        sql_say(error, "%s: not a database, or an encrypted one; give a study file", store->path);
        return STORE_FAILED;
    case SQLITE_CORRUPT:
        sql_say(error, "%s: the database is damaged (%s); restore it from a copy", store->path, why);
        return STORE_FAILED;
    case SQLITE_FULL:
        sql_say(error, "%s: the disk is full; free some space and go on", store->path);
        return STORE_FAILED;
    case SQLITE_BUSY:
    case SQLITE_LOCKED:
        sql_say(error, "%s: another program keeps the database locked (waited %u ms); close it and go on",
                store->path, store->busy_ms);
        return STORE_FAILED;
    case SQLITE_READONLY:
        sql_say(error, "%s: the file or its folder cannot be written; give yourself the right to", store->path);
        return STORE_FAILED;
    case SQLITE_IOERR:
        sql_say(error, "%s: the disk reports an error (%s, code %d); check it and go on", store->path, why,
                code);
        return STORE_FAILED;
    default:
        sql_say(error, "%s: the database cannot be used: %s (code %d)", store->path, why, code);
        return STORE_FAILED;
    }
}

enum store_result sql_execute(struct store *store, const char *sql, struct store_error *error)
{
    int code = sqlite3_exec(store->db, sql, NULL, NULL, NULL);
    return code == SQLITE_OK ? STORE_OK : sql_failure(store, sqlite3_extended_errcode(store->db), error);
}

struct sql_value sql_integer(int64_t value)
{
    return (struct sql_value){.kind = value == STORE_UNKNOWN ? SQL_NULL : SQL_INTEGER, .integer = value};
}

struct sql_value sql_id(int64_t id)
{
    return (struct sql_value){.kind = id == 0 ? SQL_NULL : SQL_INTEGER, .integer = id};
}

struct sql_value sql_seed(uint64_t seed)
{
    return (struct sql_value){.kind = SQL_INTEGER, .integer = (int64_t)seed};
}

struct sql_value sql_truth(bool value)
{
    return (struct sql_value){.kind = SQL_INTEGER, .integer = value};
}

struct sql_value sql_real(double value)
{
    return (struct sql_value){.kind = isnan(value) ? SQL_NULL : SQL_REAL, .real = value};
}

struct sql_value sql_text(const char *value)
{
    return (struct sql_value){.kind = value ? SQL_TEXT : SQL_NULL, .text = value};
}

struct sql_value sql_json(const char *value)
{
    return sql_text(value ? value : "{}");
}

struct sql_value sql_slot(enum store_slot slot)
{
    static const char *const words[] = {[STORE_A] = "a", [STORE_B] = "b", [STORE_EQUAL] = "equal"};
    // A number outside the set becomes a word outside the set, which the schema refuses.
    return sql_text((size_t)slot < countof(words) ? words[slot] : "?");
}

struct sql_value sql_eye(enum gaze_eye eye)
{
    static const char *const words[] = {[GAZE_LEFT] = "left", [GAZE_RIGHT] = "right", [GAZE_BOTH] = "both"};
    return sql_text((size_t)eye < countof(words) ? words[eye] : "?");
}

static int bind(sqlite3_stmt *statement, int index, const struct sql_value *value)
{
    switch (value->kind) {
    case SQL_INTEGER:
        return sqlite3_bind_int64(statement, index, value->integer);
    case SQL_REAL:
        return sqlite3_bind_double(statement, index, value->real);
    case SQL_TEXT:
        return sqlite3_bind_text(statement, index, value->text, -1, SQLITE_STATIC);
    case SQL_NULL:
        break;
    }
    return sqlite3_bind_null(statement, index);
}

// Prepares where needed, binds, makes the first step; returns SQLite's code of the first thing that failed.
static int start(struct store *store, enum sql_statement statement, const struct sql_value *values,
                 size_t count)
{
    sqlite3_stmt **prepared = &store->statements[statement];
    if (!*prepared) {
        int code = sqlite3_prepare_v3(store->db, sql_statements[statement], -1, SQLITE_PREPARE_PERSISTENT,
                                      prepared, NULL);
        if (code != SQLITE_OK)
            return sqlite3_extended_errcode(store->db);
    }
    if ((size_t)sqlite3_bind_parameter_count(*prepared) != count)
        return SQLITE_RANGE;
    for (size_t i = 0; i < count; i++)
        if (bind(*prepared, (int)i + 1, &values[i]) != SQLITE_OK)
            return sqlite3_extended_errcode(store->db);
    int code = sqlite3_step(*prepared);
    return code == SQLITE_DONE || code == SQLITE_ROW ? code : sqlite3_extended_errcode(store->db);
}

static void stop(struct store *store, enum sql_statement statement)
{
    sqlite3_reset(store->statements[statement]);
    sqlite3_clear_bindings(store->statements[statement]); // they point to the caller's memory
}

enum store_result sql_run(struct store *store, enum sql_statement statement, const struct sql_value *values,
                          size_t count, int64_t *out_id, struct store_error *error)
{
    int code = start(store, statement, values, count);
    // The sentence first: a reset may change SQLite's message.
    enum store_result result = code == SQLITE_DONE ? STORE_OK : sql_failure(store, code, error);
    stop(store, statement);
    if (result == STORE_OK && out_id)
        *out_id = sqlite3_last_insert_rowid(store->db);
    return result;
}

enum store_result sql_get(struct store *store, enum sql_statement statement, const struct sql_value *values,
                          size_t count, struct sql_value *out, size_t columns, bool *out_found,
                          struct store_error *error)
{
    int code = start(store, statement, values, count);
    enum store_result result = STORE_OK;
    *out_found = code == SQLITE_ROW;
    if (code != SQLITE_ROW && code != SQLITE_DONE)
        result = sql_failure(store, code, error);
    for (size_t i = 0; *out_found && i < columns; i++) {
        int column = (int)i;
        sqlite3_stmt *row = store->statements[statement];
        bool null = sqlite3_column_type(row, column) == SQLITE_NULL;
        out[i] = (struct sql_value){.kind = null ? SQL_NULL : SQL_REAL,
                                    .integer = sqlite3_column_int64(row, column),
                                    .real = sqlite3_column_double(row, column)};
    }
    stop(store, statement);
    return result;
}
