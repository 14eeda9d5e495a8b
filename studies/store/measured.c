// Reads the image errors that earlier sessions measured.
#include "studies/store/sql.h"

static const char query[] = "SELECT c.mode, c.parameters, e.scene, e.metric, e.value FROM measured_error AS e "
                            "JOIN condition AS c ON c.id = e.condition_id WHERE e.reference_id = ?1 "
                            "ORDER BY e.condition_id, e.scene, e.metric";

static enum store_result read_rows(struct store *store, sqlite3_stmt *statement, store_measured_fn take,
                                   void *user, struct store_error *error)
{
    int code = SQLITE_DONE;
    bool more = true;
    while (more && (code = sqlite3_step(statement)) == SQLITE_ROW)
        more =
            take(user, &(struct store_measured){.mode = (const char *)sqlite3_column_text(statement, 0),
                                                .parameters = (const char *)sqlite3_column_text(statement, 1),
                                                .scene = (const char *)sqlite3_column_text(statement, 2),
                                                .metric = (const char *)sqlite3_column_text(statement, 3),
                                                .value = sqlite3_column_double(statement, 4)});
    return code == SQLITE_DONE || code == SQLITE_ROW ? STORE_OK : sql_failure(store, code, error);
}

enum store_result store_read_measured_errors(struct store *store, int64_t reference_id, store_measured_fn take,
                                             void *user, struct store_error *error)
{
    sqlite3_stmt *statement = NULL;
    sql_say(error, "%s", "");
    pthread_mutex_lock(&store->mutex);
    int code = sqlite3_prepare_v2(store->db, query, -1, &statement, NULL);
    if (code == SQLITE_OK)
        code = sqlite3_bind_int64(statement, 1, reference_id);
    enum store_result result =
        code == SQLITE_OK ? read_rows(store, statement, take, user, error) : sql_failure(store, code, error);
    sqlite3_finalize(statement);
    pthread_mutex_unlock(&store->mutex);
    return result;
}
