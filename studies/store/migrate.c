#include "studies/store/migrate.h"

#include <stdio.h>

const char *migrate_frame_columns(int version)
{
    return version < 2 ? "*, NULL AS target_m" : "*";
}

static int read_number(sqlite3 *db, const char *sql, int64_t *out)
{
    sqlite3_stmt *statement = NULL;
    int code = sqlite3_prepare_v2(db, sql, -1, &statement, NULL);
    if (code == SQLITE_OK)
        code = sqlite3_step(statement);
    if (code == SQLITE_ROW)
        *out = sqlite3_column_int64(statement, 0);
    sqlite3_finalize(statement);
    return code == SQLITE_ROW ? SQLITE_OK : code;
}

static int read_version(struct store *store, int64_t *out_version)
{
    return read_number(store->db, "PRAGMA user_version", out_version);
}

enum store_result migrate_identify(struct store *store, const struct migrate_ladder *ladder,
                                   enum migrate_state *out_state, struct store_error *error)
{
    int64_t application = 0, version = 0, objects = 0;
    int code = read_number(store->db, "SELECT count(*) FROM sqlite_schema", &objects);
    if (code == SQLITE_OK)
        code = read_number(store->db, "PRAGMA application_id", &application);
    if (code == SQLITE_OK)
        code = read_version(store, &version);
    if (code != SQLITE_OK)
        return sql_failure(store, sqlite3_extended_errcode(store->db), error);
    if (objects == 0 && application == 0 && version == 0) {
        *out_state = MIGRATE_EMPTY;
        return STORE_OK;
    }
    if (application != STORE_APPLICATION_ID) {
        sql_say(error,
                "%s: another program's database (application id 0x%08llx); give a study file or a new name",
                store->path, (unsigned long long)application & 0xffffffffu);
        return STORE_REFUSED;
    }
    if (version > ladder->version) {
        sql_say(error,
                "%s: a study file of version %lld, newer than this program knows (%d); use a newer program",
                store->path, (long long)version, ladder->version);
        return STORE_REFUSED;
    }
    if (version < 1) {
        sql_say(error, "%s: the database is damaged (version %lld); restore it from a copy", store->path,
                (long long)version);
        return STORE_REFUSED;
    }
    *out_state = version == ladder->version ? MIGRATE_CURRENT : MIGRATE_OLDER;
    return STORE_OK;
}

static enum store_result climb(struct store *store, const struct migrate_ladder *ladder,
                               struct store_error *error)
{
    int64_t version = 0;
    enum store_result result = STORE_OK;
    if (read_version(store, &version) != SQLITE_OK)
        result = sql_failure(store, sqlite3_extended_errcode(store->db), error);
    for (; result == STORE_OK && version < ladder->version; version++)
        result = sql_execute(store, ladder->steps[version - 1], error);
    // A pragma takes no bound value; the number is ours.
    char set_version[48];
    snprintf(set_version, sizeof set_version, "PRAGMA user_version = %d", ladder->version);
    if (result == STORE_OK)
        result = sql_execute(store, set_version, error);
    int64_t violations = 0;
    if (result == STORE_OK &&
        read_number(store->db, "SELECT count(*) FROM pragma_foreign_key_check", &violations) != SQLITE_OK)
        result = sql_failure(store, sqlite3_extended_errcode(store->db), error);
    if (result == STORE_OK && violations > 0) {
        sql_say(error, "%s: migrating it would leave %lld rows that refer to nothing; it was left as it is",
                store->path, (long long)violations);
        result = STORE_REFUSED;
    }
    return result;
}

enum store_result migrate_apply(struct store *store, const struct migrate_ladder *ladder,
                                enum migrate_state state, struct store_error *error)
{
    if (state == MIGRATE_CURRENT)
        return STORE_OK;
    // A step may rebuild a table that others refer to, which needs foreign keys off until the commit.
    enum store_result result = sql_execute(store, "PRAGMA foreign_keys = OFF", error);
    if (result == STORE_OK)
        result = sql_execute(store, "BEGIN IMMEDIATE", error);
    if (result != STORE_OK)
        return result;
    result = state == MIGRATE_EMPTY ? sql_execute(store, ladder->schema, error) : climb(store, ladder, error);
    if (result == STORE_OK)
        result = sql_execute(store, "COMMIT", error);
    if (result != STORE_OK && !sqlite3_get_autocommit(store->db))
        sqlite3_exec(store->db, "ROLLBACK", NULL, NULL, NULL);
    return result;
}

enum store_result migrate_check_tables(struct store *store, const struct migrate_ladder *ladder,
                                       struct store_error *error)
{
    // The same schema in memory tells which columns there must be.
    static const char columns[] =
        "SELECT t.name, c.name FROM sqlite_schema AS t, pragma_table_info(t.name) AS c "
        "WHERE t.type = 'table'";
    static const char wanted[] = "SELECT 1 FROM pragma_table_info(?1) WHERE name = ?2";
    sqlite3 *model = NULL;
    sqlite3_stmt *list = NULL, *find = NULL;
    int code = sqlite3_open(":memory:", &model);
    if (code == SQLITE_OK)
        code = sqlite3_exec(model, ladder->schema, NULL, NULL, NULL);
    if (code == SQLITE_OK)
        code = sqlite3_prepare_v2(model, columns, -1, &list, NULL);
    enum store_result result = STORE_OK;
    if (code != SQLITE_OK) {
        sql_say(error, "%s: the schema cannot be read: %s", store->path, sqlite3_errmsg(model));
        result = STORE_FAILED;
    } else if (sqlite3_prepare_v2(store->db, wanted, -1, &find, NULL) != SQLITE_OK) {
        result = sql_failure(store, sqlite3_extended_errcode(store->db), error);
    }
    while (result == STORE_OK && sqlite3_step(list) == SQLITE_ROW) {
        const char *table = (const char *)sqlite3_column_text(list, 0);
        const char *column = (const char *)sqlite3_column_text(list, 1);
        sqlite3_bind_text(find, 1, table, -1, SQLITE_STATIC);
        sqlite3_bind_text(find, 2, column, -1, SQLITE_STATIC);
        code = sqlite3_step(find);
        if (code == SQLITE_DONE) {
            sql_say(error, "%s: the database is damaged (%s.%s is missing); restore it from a copy",
                    store->path, table, column);
            result = STORE_REFUSED;
        } else if (code != SQLITE_ROW) {
            result = sql_failure(store, sqlite3_extended_errcode(store->db), error);
        }
        sqlite3_reset(find);
    }
    sqlite3_finalize(find);
    sqlite3_finalize(list);
    sqlite3_close(model);
    return result;
}
