#include "studies/store/rescue.h"

#include <dirent.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

enum { COPIES = 9 };

// Looks at our own open files without opening any: closing a second descriptor would drop SQLite's locks.
static bool is_deleted(const struct store *store)
{
    DIR *folder = opendir("/proc/self/fd");
    bool deleted = false;
    for (struct dirent *entry; folder && !deleted && (entry = readdir(folder));) {
        struct stat status;
        if (fstatat(dirfd(folder), entry->d_name, &status, 0) == 0 && status.st_dev == store->device &&
            status.st_ino == store->inode)
            deleted = status.st_nlink == 0;
    }
    if (folder)
        closedir(folder);
    return deleted;
}

static bool copy_to(struct store *store, const char *path)
{
    sqlite3 *copy = NULL;
    struct stat status;
    bool done = false;
    if (sqlite3_open(path, &copy) == SQLITE_OK) {
        sqlite3_backup *backup = sqlite3_backup_init(copy, "main", store->db, "main");
        if (backup) {
            done = sqlite3_backup_step(backup, -1) == SQLITE_DONE;
            done = sqlite3_backup_finish(backup) == SQLITE_OK && done;
        }
    }
    sqlite3_close(copy);
    if (!done || stat(path, &status) != 0) {
        remove(path);
        return false;
    }
    store->rescued_device = status.st_dev;
    store->rescued_inode = status.st_ino;
    return true;
}

bool rescue_copy(struct store *store, char out_suffix[RESCUE_SUFFIX])
{
    struct stat status;
    if (store->rescued > 0)
        snprintf(out_suffix, RESCUE_SUFFIX, ".rescued%d", store->rescued);
    if (store->rescued || !is_deleted(store))
        return store->rescued > 0;
    store->rescued = -1; // a disk that has no room is not asked again
    for (int number = 1; number <= COPIES; number++) {
        snprintf(out_suffix, RESCUE_SUFFIX, ".rescued%d", number);
        char *path = sqlite3_mprintf("%s%s", store->path, out_suffix);
        bool free_name = path && stat(path, &status) != 0;
        if (free_name && copy_to(store, path))
            store->rescued = number;
        sqlite3_free(path);
        if (free_name)
            break;
    }
    return store->rescued > 0;
}

bool rescue_returned(struct store *store, struct store_error *error)
{
    struct stat status;
    if (store->rescued <= 0 || stat(store->path, &status) != 0 || status.st_dev != store->rescued_device ||
        status.st_ino != store->rescued_inode)
        return false;
    if (sql_reconnect(store, error) != STORE_OK)
        return false;
    store->device = status.st_dev;
    store->inode = status.st_ino;
    store->rescued = 0;
    return true;
}
