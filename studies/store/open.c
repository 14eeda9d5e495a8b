#include "schema_sql.h"
#include "studies/store/migrate.h"
#include "studies/store/queue.h"
#include "studies/store/sql.h"
#include "studies/store/writer.h"

#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum {
    DEFAULT_BUSY_MS = 5000,
    DEFAULT_FLUSH_MS = 250,
    MAX_FLUSH_MS = 1000,
    DEFAULT_GAZE = 65536,
    DEFAULT_LOG = 16384,
    OWNER_WAIT_MS = 600,
    OWNER_STEP_MS = 20
};

// --- the file ---

// Makes the file where there is none (out_made true) and turns its name into an absolute one without links, so
// that two names of one file have one owner. The file must not be opened and closed here where it exists:
// closing any descriptor of it would drop the locks of another store of this program.
static enum store_result name_file(struct store *store, const struct store_desc *desc, bool *out_made,
                                   struct store_error *error)
{
    *out_made = false;
    if (!desc->path || !*desc->path) {
        sql_say(error, "no study file is named; give its path");
        return STORE_REFUSED;
    }
    if (desc->access == STORE_CREATE) {
        int file = open(desc->path, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0644);
        *out_made = file >= 0;
        if (file >= 0) {
            close(file);
        } else if (errno != EEXIST) {
            sql_say(error, "%s: cannot be created: %s", desc->path, strerror(errno));
            return STORE_REFUSED;
        }
    }
    struct stat status;
    store->path = realpath(desc->path, NULL);
    if (!store->path || stat(store->path, &status) != 0) {
        sql_say(error, "%s: cannot be opened: %s", desc->path, strerror(errno));
        return STORE_REFUSED;
    }
    if (!S_ISREG(status.st_mode)) {
        sql_say(error, "%s: not a file; give the path of a study file", store->path);
        return STORE_REFUSED;
    }
    store->device = status.st_dev;
    store->inode = status.st_ino;
    return STORE_OK;
}

static enum store_result check_rights(struct store *store, struct store_error *error)
{
    if (access(store->path, R_OK) != 0) {
        sql_say(error, "%s: cannot be read: %s", store->path, strerror(errno));
        return STORE_REFUSED;
    }
    if (store->reading)
        return STORE_OK;
    if (access(store->path, W_OK) != 0) {
        sql_say(error, "%s: cannot be written: %s", store->path, strerror(errno));
        return STORE_REFUSED;
    }
    char *slash = strrchr(store->path, '/');
    *slash = '\0'; // an absolute path has one
    bool writable = access(*store->path ? store->path : "/", W_OK | X_OK) == 0;
    int reason = errno;
    *slash = '/';
    if (writable)
        return STORE_OK;
    sql_say(error, "%s: the folder cannot be written, where the database keeps its log: %s", store->path,
            strerror(reason));
    return STORE_REFUSED;
}

// A program that was just killed holds its lock until the system has cleared it away, which for one with a GPU
// takes a moment; who resumes at once must not be told to end it.
static enum owner_result wait_for_owner(struct store *store, long *out_pid)
{
    enum owner_result result = OWNER_OTHER;
    for (int left_ms = OWNER_WAIT_MS;; left_ms -= OWNER_STEP_MS) {
        result = owner_take(&store->owner, store->path, out_pid);
        if (result != OWNER_OTHER || left_ms <= 0)
            return result;
        usleep(OWNER_STEP_MS * 1000);
    }
}

static enum store_result take_owner(struct store *store, struct store_error *error)
{
    long pid = 0;
    switch (wait_for_owner(store, &pid)) {
    case OWNER_HELD:
        return STORE_OK;
    case OWNER_OTHER:
        sql_say(error, "%s: in use by another program (process %ld); end it first", store->path, pid);
        return STORE_REFUSED;
    case OWNER_ERROR:
        break;
    }
    sql_say(error, "%s: its lock file %s-owner cannot be made: %s", store->path, store->path, strerror(errno));
    return STORE_FAILED;
}

// --- the database ---

static enum store_result connect(struct store *store, const char *name, const char *vfs,
                                 struct store_error *error)
{
    // Also for reading: only a connection that may write removes the log's files when it was the last one.
    // Where the file cannot be written SQLite falls back to reading by itself.
    int code = sqlite3_open_v2(
        name, &store->db,
        SQLITE_OPEN_READWRITE | SQLITE_OPEN_FULLMUTEX | SQLITE_OPEN_EXRESCODE | SQLITE_OPEN_URI, vfs);
    if (code != SQLITE_OK)
        return sql_failure(store, code, error);
    sqlite3_busy_timeout(store->db, (int)store->busy_ms);
    return STORE_OK;
}

static void disconnect(struct store *store)
{
    for (size_t i = 0; i < SQL_STATEMENTS; i++) {
        sqlite3_finalize(store->statements[i]);
        store->statements[i] = NULL;
    }
    sqlite3_close(store->db);
    store->db = NULL;
}

// A file on read-only ground has no place for the log's shared memory; SQLite reads it when told that nobody
// writes.
static enum store_result connect_immutable(struct store *store, const char *vfs, struct store_error *error)
{
    disconnect(store);
    sqlite3_str *name = sqlite3_str_new(NULL);
    sqlite3_str_appendall(name, "file:");
    for (const char *c = store->path; *c; c++) {
        if (*c == '?' || *c == '#' || *c == '%')
            sqlite3_str_appendf(name, "%%%02X", (unsigned)(unsigned char)*c);
        else
            sqlite3_str_appendchar(name, 1, *c);
    }
    sqlite3_str_appendall(name, "?immutable=1");
    char *uri = sqlite3_str_finish(name);
    enum store_result result = connect(store, uri, vfs, error);
    sqlite3_free(uri);
    return result;
}

static bool has_log(const struct store *store)
{
    char *name = sqlite3_mprintf("%s-wal", store->path);
    struct stat status;
    bool found = name && stat(name, &status) == 0 && status.st_size > 0;
    sqlite3_free(name);
    return found;
}

static enum store_result identify(struct store *store, const struct store_desc *desc,
                                  const struct migrate_ladder *ladder, enum migrate_state *out_state,
                                  struct store_error *error)
{
    enum store_result result = migrate_identify(store, ladder, out_state, error);
    if (result == STORE_FAILED && store->reading && !has_log(store)) {
        int code = sqlite3_extended_errcode(store->db) & 0xff;
        if (code == SQLITE_CANTOPEN || code == SQLITE_READONLY) {
            result = connect_immutable(store, desc->vfs, error);
            if (result == STORE_OK)
                result = migrate_identify(store, ladder, out_state, error);
        }
    }
    if (result != STORE_OK)
        return result;
    if (*out_state == MIGRATE_EMPTY && desc->access != STORE_CREATE) {
        sql_say(error, "%s: an empty file, not a study; give a study file", store->path);
        return STORE_REFUSED;
    }
    if (*out_state == MIGRATE_OLDER && store->reading) {
        sql_say(error,
                "%s: a study file of an older version; open it once with fovstudy to bring it up to date",
                store->path);
        return STORE_REFUSED;
    }
    return STORE_OK;
}

static const char writing[] =
    "PRAGMA journal_mode = WAL; PRAGMA synchronous = FULL; PRAGMA temp_store = MEMORY";

enum store_result sql_reconnect(struct store *store, struct store_error *error)
{
    disconnect(store);
    enum store_result result = connect(store, store->path, NULL, error);
    if (result == STORE_OK)
        result = sql_execute(store, writing, error);
    return result == STORE_OK ? sql_execute(store, "PRAGMA foreign_keys = ON", error) : result;
}

// From each version to the next one.
static const char *const steps[STORE_VERSION - 1] = {
    "ALTER TABLE frame ADD COLUMN target_m REAL CHECK (target_m > 0)",
};

static enum store_result prepare_database(struct store *store, const struct store_desc *desc,
                                          struct store_error *error)
{
    char schema[sizeof schema_sql + 1];
    memcpy(schema, schema_sql, sizeof schema_sql);
    schema[sizeof schema_sql] = '\0';
    const struct migrate_ladder ladder = {.version = STORE_VERSION, .schema = schema, .steps = steps};
    enum migrate_state state = MIGRATE_EMPTY;
    enum store_result result = identify(store, desc, &ladder, &state, error);
    if (result == STORE_OK && store->reading)
        result = sql_execute(store, "PRAGMA query_only = ON", error);
    if (result == STORE_OK && !store->reading)
        result = sql_execute(store, writing, error);
    if (result == STORE_OK && !store->reading)
        result = migrate_apply(store, &ladder, state, error);
    if (result == STORE_OK)
        result = sql_execute(store, "PRAGMA foreign_keys = ON", error);
    if (result == STORE_OK)
        result = migrate_check_tables(store, &ladder, error);
    return result;
}

static enum store_result start_queue(struct store *store, const struct store_desc *desc,
                                     struct store_error *error)
{
    struct sql_value last = {0};
    bool found = false;
    enum store_result result = sql_get(store, SQL_LAST_GAZE, NULL, 0, &last, 1, &found, error);
    if (result != STORE_OK)
        return result;
    store->queue = queue_create(desc->gaze_capacity ? desc->gaze_capacity : DEFAULT_GAZE,
                                desc->log_capacity ? desc->log_capacity : DEFAULT_LOG, last.integer + 1);
    if (store->queue)
        store->writer = writer_start(store, desc->flush_ms ? desc->flush_ms : DEFAULT_FLUSH_MS);
    if (store->writer)
        return STORE_OK;
    sql_say(error, "%s: out of memory for the log's queue; close other programs", store->path);
    return STORE_FAILED;
}

// --- open and close ---

static void release(struct store *store)
{
    writer_stop(store->writer);
    queue_destroy(store->queue);
    disconnect(store);
    owner_release(&store->owner);
    pthread_mutex_destroy(&store->mutex);
    free(store->path);
    free(store);
}

// A file that we made and could not fill leaves nothing behind.
static void unmake(const char *path)
{
    static const char *const suffixes[] = {"-wal", "-shm", "-journal", ""};
    for (size_t i = 0; i < countof(suffixes); i++) {
        char *name = sqlite3_mprintf("%s%s", path, suffixes[i]);
        if (name)
            unlink(name);
        sqlite3_free(name);
    }
}

struct store *store_open(const struct store_desc *desc, struct store_error *error)
{
    sql_say(error, "%s", "");
    struct store *store = calloc(1, sizeof *store);
    if (!store) {
        sql_say(error, "out of memory");
        return NULL;
    }
    pthread_mutex_init(&store->mutex, NULL);
    store->owner.file = -1;
    store->reading = desc->access == STORE_READ;
    store->busy_ms = desc->busy_ms ? desc->busy_ms : DEFAULT_BUSY_MS;
    enum store_result result = desc->flush_ms <= MAX_FLUSH_MS ? STORE_OK : STORE_REFUSED;
    if (result != STORE_OK)
        sql_say(error, "flush_ms is %u; give 1 to %d, or 0 for the default", desc->flush_ms, MAX_FLUSH_MS);
    if (result == STORE_OK)
        result = name_file(store, desc, &store->made, error);
    if (result == STORE_OK)
        result = check_rights(store, error);
    if (result == STORE_OK && !store->reading)
        result = take_owner(store, error);
    if (result == STORE_OK)
        result = connect(store, store->path, desc->vfs, error);
    if (result == STORE_OK)
        result = prepare_database(store, desc, error);
    if (result == STORE_OK && !store->reading)
        result = start_queue(store, desc, error);
    if (result == STORE_OK)
        return store;
    disconnect(store);
    if (store->made && store->path)
        unmake(store->path); // while the owner's lock is held
    release(store);
    return NULL;
}

static bool has_session(struct store *store)
{
    sqlite3_stmt *statement = NULL;
    int code = sqlite3_prepare_v2(store->db, "SELECT 1 FROM session LIMIT 1", -1, &statement, NULL);
    if (code == SQLITE_OK)
        code = sqlite3_step(statement);
    sqlite3_finalize(statement);
    return code != SQLITE_DONE; // also where it cannot be told
}

enum store_result store_abandon(struct store *store, struct store_error *error)
{
    if (!store || !store->made || store->reading)
        return store_close(store, error);
    sql_say(error, "%s", "");
    writer_stop(store->writer);
    store->writer = NULL;
    bool unused = !has_session(store);
    disconnect(store);
    if (unused)
        unmake(store->path); // while the owner's lock is held
    release(store);
    return STORE_OK;
}

enum store_result store_close(struct store *store, struct store_error *error)
{
    sql_say(error, "%s", "");
    if (!store)
        return STORE_OK;
    enum store_result result = STORE_OK;
    if (!store->reading) {
        writer_stop(store->writer);
        store->writer = NULL;
        struct store_error why = {""};
        result = queue_waiting(store->queue) > 0 ? store_flush(store, &why) : STORE_OK;
        if (result != STORE_OK)
            sql_say(error, "%llu log rows were lost: %s", (unsigned long long)queue_waiting(store->queue),
                    why.text);
    }
    release(store);
    return result;
}

enum store_result store_flush(struct store *store, struct store_error *error)
{
    return sql_end(store, sql_begin(store, error), error);
}

void store_set_busy(struct store *store, uint32_t busy_ms)
{
    pthread_mutex_lock(&store->mutex);
    store->busy_ms = busy_ms;
    sqlite3_busy_timeout(store->db, (int)busy_ms);
    pthread_mutex_unlock(&store->mutex);
}

enum store_result store_rehearse(struct store *store, struct store_error *error)
{
    static const char people[] = "SELECT 1 FROM participant WHERE kind = 'person' LIMIT 1";
    sqlite3_stmt *statement = NULL;
    sql_say(error, "%s", "");
    pthread_mutex_lock(&store->mutex);
    int code = sqlite3_prepare_v2(store->db, people, -1, &statement, NULL);
    if (code == SQLITE_OK)
        code = sqlite3_step(statement);
    enum store_result result =
        code == SQLITE_ROW || code == SQLITE_DONE ? STORE_OK : sql_failure(store, code, error);
    sqlite3_finalize(statement);
    // In WAL mode: the log is synchronised at checkpoints only.
    if (code == SQLITE_DONE)
        result = sql_execute(store, "PRAGMA synchronous = NORMAL", error);
    pthread_mutex_unlock(&store->mutex);
    return result;
}

enum store_result store_check(struct store *store, struct store_error *error)
{
    static const char *const checks[] = {
        "SELECT integrity_check FROM pragma_integrity_check WHERE integrity_check <> 'ok'",
        "SELECT 'a row of ' || \"table\" || ' refers to a row of ' || parent || ' that is not there' "
        "FROM pragma_foreign_key_check"};
    sql_say(error, "%s", "");
    pthread_mutex_lock(&store->mutex);
    enum store_result result = STORE_OK;
    for (size_t i = 0; result == STORE_OK && i < countof(checks); i++) {
        sqlite3_stmt *statement = NULL;
        int code = sqlite3_prepare_v2(store->db, checks[i], -1, &statement, NULL);
        if (code == SQLITE_OK)
            code = sqlite3_step(statement);
        if (code == SQLITE_ROW) {
            sql_say(error, "%s: the database is damaged: %s", store->path, sqlite3_column_text(statement, 0));
            result = STORE_REFUSED;
        } else if (code != SQLITE_DONE) {
            result = sql_failure(store, sqlite3_extended_errcode(store->db), error);
        }
        sqlite3_finalize(statement);
    }
    pthread_mutex_unlock(&store->mutex);
    return result;
}
