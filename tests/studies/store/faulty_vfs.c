#include "faulty_vfs.h"

#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

// The real file lies right behind this one in SQLite's memory.
struct faulty_file {
    sqlite3_file file;
    struct faulty_vfs *faulty;
};

static sqlite3_file *real_of(sqlite3_file *file)
{
    return (sqlite3_file *)((struct faulty_file *)file + 1);
}

// True where this operation is to fail.
static bool strikes(struct faulty_vfs *faulty)
{
    int left = atomic_load(&faulty->countdown);
    if (left == 0)
        return false;
    bool sticky = faulty->fault == FAULT_FULL || faulty->fault == FAULT_IO;
    if (atomic_load(&faulty->failed))
        return sticky;
    if (left > 1) {
        atomic_store(&faulty->countdown, left - 1);
        return false;
    }
    atomic_store(&faulty->failed, true);
    return true;
}

static uint32_t draw(struct faulty_vfs *faulty)
{
    faulty->random = faulty->random * 1664525u + 1013904223u;
    return faulty->random >> 16;
}

// Keeps what a write is about to cover, until a sync.
static void note_write(struct faulty_vfs *faulty, sqlite3_file *file, int size, sqlite3_int64 offset)
{
    if (faulty->fault != FAULT_POWER || atomic_load(&faulty->countdown) == 0)
        return;
    if (!faulty->unsynced)
        faulty->unsynced = calloc(FAULTY_UNSYNCED, sizeof *faulty->unsynced);
    if (!faulty->unsynced || faulty->unsynced_count == FAULTY_UNSYNCED)
        abort();
    struct faulty_write *write = &faulty->unsynced[faulty->unsynced_count++];
    *write = (struct faulty_write){file, offset, size, malloc((size_t)size)};
    if (!write->before)
        abort();
    file->pMethods->xRead(file, write->before, size, offset); // beyond the end: zeros
}

static void confirm_writes(struct faulty_vfs *faulty, const sqlite3_file *file)
{
    int kept = 0;
    for (int i = 0; i < faulty->unsynced_count; i++) {
        if (faulty->unsynced[i].file == file)
            free(faulty->unsynced[i].before);
        else
            faulty->unsynced[kept++] = faulty->unsynced[i];
    }
    faulty->unsynced_count = kept;
}

// A disk writes in any order: of three writes one is whole, one is gone, one is torn.
static void cut_power(struct faulty_vfs *faulty)
{
    for (int i = faulty->unsynced_count - 1; i >= 0; i--) {
        const struct faulty_write *write = &faulty->unsynced[i];
        uint32_t fate = draw(faulty) % 3;
        int kept = fate == 0 ? write->size : fate == 1 ? 0 : (int)(draw(faulty) % (uint32_t)write->size);
        write->file->pMethods->xWrite(write->file, (const char *)write->before + kept, write->size - kept,
                                      write->offset + kept);
    }
}

static int code_of(struct faulty_vfs *faulty, int io_code)
{
    if (faulty->fault == FAULT_POWER)
        cut_power(faulty);
    if (faulty->fault == FAULT_KILL || faulty->fault == FAULT_POWER)
        raise(SIGKILL);
    return faulty->fault == FAULT_FULL || faulty->fault == FAULT_FULL_ONCE ? SQLITE_FULL : io_code;
}

static int faulty_close(sqlite3_file *file)
{
    confirm_writes(((struct faulty_file *)file)->faulty,
                   real_of(file)); // the entries name a file that goes away
    return real_of(file)->pMethods ? real_of(file)->pMethods->xClose(real_of(file)) : SQLITE_OK;
}

static int faulty_read(sqlite3_file *file, void *bytes, int size, sqlite3_int64 offset)
{
    return real_of(file)->pMethods->xRead(real_of(file), bytes, size, offset);
}

static int faulty_write(sqlite3_file *file, const void *bytes, int size, sqlite3_int64 offset)
{
    struct faulty_vfs *faulty = ((struct faulty_file *)file)->faulty;
    note_write(faulty, real_of(file), size, offset);
    bool fails = strikes(faulty);
    int code = real_of(file)->pMethods->xWrite(real_of(file), bytes, fails ? size / 2 : size, offset);
    return fails ? code_of(faulty, SQLITE_IOERR_WRITE) : code;
}

static int faulty_truncate(sqlite3_file *file, sqlite3_int64 size)
{
    struct faulty_vfs *faulty = ((struct faulty_file *)file)->faulty;
    return strikes(faulty) ? code_of(faulty, SQLITE_IOERR_TRUNCATE)
                           : real_of(file)->pMethods->xTruncate(real_of(file), size);
}

static int faulty_sync(sqlite3_file *file, int flags)
{
    struct faulty_vfs *faulty = ((struct faulty_file *)file)->faulty;
    atomic_fetch_add(&faulty->syncs, 1);
    if (strikes(faulty))
        return code_of(faulty, SQLITE_IOERR_FSYNC);
    int code = real_of(file)->pMethods->xSync(real_of(file), flags);
    if (code == SQLITE_OK)
        confirm_writes(faulty, real_of(file));
    return code;
}

static int faulty_size(sqlite3_file *file, sqlite3_int64 *size)
{
    return real_of(file)->pMethods->xFileSize(real_of(file), size);
}

static int faulty_lock(sqlite3_file *file, int level)
{
    return real_of(file)->pMethods->xLock(real_of(file), level);
}

static int faulty_unlock(sqlite3_file *file, int level)
{
    return real_of(file)->pMethods->xUnlock(real_of(file), level);
}

static int faulty_check_lock(sqlite3_file *file, int *out)
{
    return real_of(file)->pMethods->xCheckReservedLock(real_of(file), out);
}

static int faulty_control(sqlite3_file *file, int operation, void *argument)
{
    return real_of(file)->pMethods->xFileControl(real_of(file), operation, argument);
}

static int faulty_sector(sqlite3_file *file)
{
    return real_of(file)->pMethods->xSectorSize(real_of(file));
}

static int faulty_characteristics(sqlite3_file *file)
{
    return real_of(file)->pMethods->xDeviceCharacteristics(real_of(file));
}

static int faulty_shm_map(sqlite3_file *file, int page, int size, int extend, void volatile **out)
{
    return real_of(file)->pMethods->xShmMap(real_of(file), page, size, extend, out);
}

static int faulty_shm_lock(sqlite3_file *file, int offset, int n, int flags)
{
    return real_of(file)->pMethods->xShmLock(real_of(file), offset, n, flags);
}

static void faulty_shm_barrier(sqlite3_file *file)
{
    real_of(file)->pMethods->xShmBarrier(real_of(file));
}

static int faulty_shm_unmap(sqlite3_file *file, int remove)
{
    return real_of(file)->pMethods->xShmUnmap(real_of(file), remove);
}

static const sqlite3_io_methods methods = {2,
                                           faulty_close,
                                           faulty_read,
                                           faulty_write,
                                           faulty_truncate,
                                           faulty_sync,
                                           faulty_size,
                                           faulty_lock,
                                           faulty_unlock,
                                           faulty_check_lock,
                                           faulty_control,
                                           faulty_sector,
                                           faulty_characteristics,
                                           faulty_shm_map,
                                           faulty_shm_lock,
                                           faulty_shm_barrier,
                                           faulty_shm_unmap,
                                           NULL,
                                           NULL};

static int faulty_open(sqlite3_vfs *vfs, const char *name, sqlite3_file *file, int flags, int *out_flags)
{
    struct faulty_vfs *faulty = (struct faulty_vfs *)vfs;
    struct faulty_file *opened = (struct faulty_file *)file;
    memset(real_of(file), 0, sizeof(sqlite3_file));
    opened->faulty = faulty;
    int code = faulty->real->xOpen(faulty->real, name, real_of(file), flags, out_flags);
    // SQLite closes only files that have methods.
    file->pMethods = real_of(file)->pMethods ? &methods : NULL;
    return code;
}

static int faulty_delete(sqlite3_vfs *vfs, const char *name, int sync_folder)
{
    struct faulty_vfs *faulty = (struct faulty_vfs *)vfs;
    return strikes(faulty) ? code_of(faulty, SQLITE_IOERR_DELETE)
                           : faulty->real->xDelete(faulty->real, name, sync_folder);
}

void faulty_vfs_register(struct faulty_vfs *faulty, const char *name)
{
    *faulty = (struct faulty_vfs){.real = sqlite3_vfs_find(NULL)};
    // All other calls of the system's VFS look only at its pAppData and at their arguments.
    faulty->vfs = *faulty->real;
    faulty->vfs.pNext = NULL;
    faulty->vfs.zName = name;
    faulty->vfs.szOsFile = (int)sizeof(struct faulty_file) + faulty->real->szOsFile;
    faulty->vfs.xOpen = faulty_open;
    faulty->vfs.xDelete = faulty_delete;
    sqlite3_vfs_register(&faulty->vfs, 0);
}

void faulty_vfs_unregister(struct faulty_vfs *faulty)
{
    free(faulty->unsynced);
    sqlite3_vfs_unregister(&faulty->vfs);
}

void faulty_vfs_arm(struct faulty_vfs *faulty, enum fault fault, int n)
{
    faulty->fault = fault;
    atomic_store(&faulty->failed, false);
    atomic_store(&faulty->countdown, n);
}

void faulty_vfs_arm_power(struct faulty_vfs *faulty, int n, uint32_t seed)
{
    faulty->random = seed;
    faulty_vfs_arm(faulty, FAULT_POWER, n);
}

bool faulty_vfs_disarm(struct faulty_vfs *faulty)
{
    atomic_store(&faulty->countdown, 0);
    return atomic_load(&faulty->failed);
}
