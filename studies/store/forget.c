#include "studies/store/forget.h"

#include "studies/store/queue.h"
#include "studies/store/sql.h"

#define SESSIONS "(SELECT id FROM session WHERE participant_id = ?1)"
#define TRIALS "(SELECT id FROM trial WHERE session_id IN " SESSIONS ")"
#define PENDING "rule = 'forgotten' AND reason = 'erased on request; the file is still to be rewritten'"

// What refers to a row goes before it.
static const char *const steps[] = {
    "DELETE FROM exclusion WHERE participant_id = ?1 OR session_id IN " SESSIONS " OR trial_id IN " TRIALS,
    "DELETE FROM event WHERE session_id IN " SESSIONS,
    "DELETE FROM frame WHERE session_id IN " SESSIONS,
    "DELETE FROM gaze WHERE session_id IN " SESSIONS,
    "DELETE FROM gaze_check WHERE session_id IN " SESSIONS,
    "DELETE FROM exposure WHERE trial_id IN " TRIALS,
    "DELETE FROM adjust_step WHERE trial_id IN " TRIALS,
    "DELETE FROM staircase_step WHERE trial_id IN " TRIALS,
    "DELETE FROM response WHERE trial_id IN " TRIALS,
    "DELETE FROM choice WHERE trial_id IN " TRIALS,
    "DELETE FROM rating WHERE session_id IN " SESSIONS " OR trial_id IN " TRIALS,
    "UPDATE trial SET repeat_of = NULL WHERE session_id IN " SESSIONS,
    "DELETE FROM trial WHERE session_id IN " SESSIONS,
    "DELETE FROM segment WHERE session_id IN " SESSIONS,
    "DELETE FROM session WHERE participant_id = ?1",
    "UPDATE participant SET code = 'forgotten-' || id, attributes = '{}' WHERE id = ?1",
};

static const char tombstone[] =
    "INSERT INTO exclusion (participant_id, rule, rule_set, reason, \"by\", applied_at) VALUES (?1, "
    "'forgotten', 'late', "
    "'erased on request; the file is still to be rewritten', 'fovstudy forget', ?2)";

static const char count[] =
    "SELECT number, (SELECT count(*) FROM session WHERE participant_id = ?1), (SELECT count(*) FROM trial "
    "WHERE "
    "session_id IN " SESSIONS "), (SELECT count(*) FROM choice WHERE trial_id IN " TRIALS
    ") + (SELECT count(*) FROM rating WHERE session_id IN " SESSIONS " OR trial_id IN " TRIALS
    ") + (SELECT count(*) FROM response WHERE trial_id IN " TRIALS
    "), (SELECT count(*) FROM frame WHERE session_id IN " SESSIONS
    "), (SELECT count(*) FROM gaze WHERE session_id IN " SESSIONS ") FROM participant WHERE id = ?1";

// One statement with up to two values; `columns` numbers of its first row, all 0 where there is none.
static enum store_result run(struct store *store, const char *sql, const struct sql_value *first,
                             const char *second, int64_t *out, int columns, struct store_error *error)
{
    sqlite3_stmt *statement = NULL;
    int code = sqlite3_prepare_v2(store->db, sql, -1, &statement, NULL);
    if (code == SQLITE_OK && first)
        code = first->kind == SQL_TEXT ? sqlite3_bind_text(statement, 1, first->text, -1, SQLITE_STATIC)
                                       : sqlite3_bind_int64(statement, 1, first->integer);
    if (code == SQLITE_OK && second)
        code = sqlite3_bind_text(statement, 2, second, -1, SQLITE_STATIC);
    if (code == SQLITE_OK)
        code = sqlite3_step(statement);
    for (int i = 0; i < columns; i++)
        out[i] = code == SQLITE_ROW ? sqlite3_column_int64(statement, i) : 0;
    enum store_result result = STORE_OK;
    if (code != SQLITE_ROW && code != SQLITE_DONE)
        result = sql_failure(store, sqlite3_extended_errcode(store->db), error);
    sqlite3_finalize(statement);
    return result;
}

static enum store_result erase(struct store *store, int64_t id, const char *applied_at,
                               struct store_forgotten *out, struct store_error *error)
{
    struct sql_value key = sql_id(id);
    int64_t counts[6];
    enum store_result result = run(store, count, &key, NULL, counts, (int)countof(counts), error);
    if (result == STORE_OK)
        *out = (struct store_forgotten){counts[0], counts[1], counts[2], counts[3], counts[4], counts[5]};
    for (size_t i = 0; result == STORE_OK && i < countof(steps); i++)
        result = run(store, steps[i], &key, NULL, NULL, 0, error);
    return result == STORE_OK ? run(store, tombstone, &key, applied_at, NULL, 0, error) : result;
}

// Freed pages were overwritten already (secure_delete), but what SQLite moved about earlier may still lie
// between rows: only a new file has none of it. VACUUM's copy is a file of its own, deleted as it is opened.
static enum store_result rewrite(struct store *store, struct store_error *error)
{
    enum store_result result = sql_execute(store, "PRAGMA temp_store = FILE; VACUUM", error);
    if (result == STORE_OK)
        result = run(store, "UPDATE exclusion SET reason = 'erased on request' WHERE " PENDING, NULL, NULL,
                     NULL, 0, error);
    int64_t busy[1] = {1};
    if (result == STORE_OK)
        result = run(store, "PRAGMA wal_checkpoint(TRUNCATE)", NULL, NULL, busy, 1, error);
    if (result != STORE_OK || !busy[0])
        return result;
    // Back to pending: the next call empties the log.
    run(store,
        "UPDATE exclusion SET reason = 'erased on request; the file is still to be rewritten' WHERE rule = "
        "'forgotten'",
        NULL, NULL, NULL, 0, NULL);
    sql_say(error,
            "%s: another program reads it, so its log still holds what was erased; close it and do this again",
            store->path);
    return STORE_FAILED;
}

enum store_result store_forget(struct store *store, const char *code, const char *applied_at,
                               struct store_forgotten *out, struct store_error *error)
{
    struct sql_value key = sql_text(code);
    int64_t id[1] = {0}, pending[1] = {0};
    *out = (struct store_forgotten){0};
    enum store_result result = sql_begin(store, error);
    if (result == STORE_OK)
        result = sql_execute(store, "PRAGMA secure_delete = ON", error);
    if (result == STORE_OK)
        result = run(store, "SELECT id FROM participant WHERE code = ?1", &key, NULL, id, 1, error);
    if (result == STORE_OK)
        result = run(store, "SELECT count(*) FROM exclusion WHERE " PENDING, NULL, NULL, pending, 1, error);
    if (result == STORE_OK && id[0])
        result = erase(store, id[0], applied_at, out, error);
    else if (result == STORE_OK && !pending[0]) {
        sql_say(error, "%s: there is no participant %s; nothing was erased", store->path, code);
        result = STORE_REFUSED;
    }
    result = sql_end(store, result, error);
    if (result != STORE_OK)
        return result;
    pthread_mutex_lock(&store->mutex);
    result = rewrite(store, error);
    pthread_mutex_unlock(&store->mutex);
    return result;
}
