#include "studies/store/queue.h"
#include "studies/store/rescue.h"
#include "studies/store/rows.h"
#include "studies/store/sql.h"

#include <sys/stat.h>

bool sql_file_there(const struct store *store)
{
    struct stat now;
    return stat(store->path, &now) == 0 && now.st_dev == store->device && now.st_ino == store->inode;
}

// SQLite goes on writing to a file that was removed or replaced under it, and nobody would ever see those rows.
static enum store_result check_file(struct store *store, struct store_error *error)
{
    char suffix[RESCUE_SUFFIX];
    if (sql_file_there(store) || rescue_returned(store, error))
        return STORE_OK;
    if (rescue_copy(store, suffix))
        sql_say(
            error,
            "%s: the file was removed or replaced while in use; all it held is in %s%s: give that its old name "
            "and go on",
            store->path, store->path, suffix);
    else
        sql_say(error, "%s: the file was removed or replaced while in use; put it back and go on", store->path);
    return STORE_FAILED;
}

enum store_result sql_begin(struct store *store, struct store_error *error)
{
    sql_say(error, "%s", "");
    pthread_mutex_lock(&store->mutex);
    if (store->reading) {
        sql_say(error, "%s: opened for reading only; open it with STORE_WRITE", store->path);
        return STORE_REFUSED;
    }
    enum store_result result = check_file(store, error);
    if (result == STORE_OK)
        result = sql_run(store, SQL_BEGIN, NULL, 0, NULL, error);
    if (result != STORE_OK)
        return result;
    queue_mark(store->queue);
    return rows_write(store, error);
}

enum store_result sql_end(struct store *store, enum store_result result, struct store_error *error)
{
    if (result == STORE_OK)
        result = sql_run(store, SQL_COMMIT, NULL, 0, NULL, error);
    if (result == STORE_OK)
        queue_committed(store->queue);
    else if (!sqlite3_get_autocommit(store->db)) // some errors have rolled back already
        sql_run(store, SQL_ROLLBACK, NULL, 0, NULL, NULL);
    if (result == STORE_FAILED)
        queue_failed(store->queue, error ? error->text : "the database cannot be written");
    pthread_mutex_unlock(&store->mutex);
    return result;
}
