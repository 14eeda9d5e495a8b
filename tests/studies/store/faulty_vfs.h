// An SQLite VFS that passes everything to the system's and, when armed, lets the n-th write, truncation, sync
// or deletion from then on go wrong. A failing write leaves its first half behind.
#ifndef TESTS_STORE_FAULTY_VFS_H
#define TESTS_STORE_FAULTY_VFS_H

#include <sqlite3.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stdint.h>

enum fault {
    FAULT_FULL,      // SQLITE_FULL, from then on
    FAULT_IO,        // SQLITE_IOERR_*, from then on
    FAULT_FULL_ONCE, // and then there is room again
    FAULT_IO_ONCE,
    FAULT_KILL,  // SIGKILL to the own process
    FAULT_POWER, // SIGKILL, and of what no sync has confirmed each write may be gone, whole or torn
    FAULTS
};

enum { FAULTY_UNSYNCED = 8192 }; // writes that may wait for a sync

struct faulty_write {
    sqlite3_file *file; // the real one; NULL: confirmed
    sqlite3_int64 offset;
    int size;
    void *before; // owned; what was there
};

struct faulty_vfs {
    sqlite3_vfs vfs; // first: SQLite hands it back
    sqlite3_vfs *real;
    enum fault fault;
    atomic_int countdown;          // 1: the next operation; 0: not armed
    atomic_bool failed;            // the fault has happened
    atomic_int syncs;              // of the log or the database, since registration
    uint32_t random;               // FAULT_POWER: the seed of what is lost
    struct faulty_write *unsynced; // owned, FAULTY_UNSYNCED long; NULL before the first
    int unsynced_count;
};

void faulty_vfs_register(struct faulty_vfs *faulty, const char *name);
void faulty_vfs_unregister(struct faulty_vfs *faulty);
void faulty_vfs_arm(struct faulty_vfs *faulty, enum fault fault, int n);
// FAULT_POWER with the seed of what is lost.
void faulty_vfs_arm_power(struct faulty_vfs *faulty, int n, uint32_t seed);
bool faulty_vfs_disarm(struct faulty_vfs *faulty); // whether the fault had happened

#endif
