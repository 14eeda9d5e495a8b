// An SQLite VFS that passes everything to the system's and, when armed, lets the n-th write, truncation, sync
// or deletion from then on go wrong. A failing write leaves its first half behind.
#ifndef TESTS_STORE_FAULTY_VFS_H
#define TESTS_STORE_FAULTY_VFS_H

#include <sqlite3.h>
#include <stdatomic.h>
#include <stdbool.h>

enum fault {
    FAULT_FULL,      // SQLITE_FULL, from then on
    FAULT_IO,        // SQLITE_IOERR_*, from then on
    FAULT_FULL_ONCE, // and then there is room again
    FAULT_IO_ONCE,
    FAULT_KILL, // SIGKILL to the own process
    FAULTS
};

struct faulty_vfs {
    sqlite3_vfs vfs; // first: SQLite hands it back
    sqlite3_vfs *real;
    enum fault fault;
    atomic_int countdown; // 1: the next operation; 0: not armed
    atomic_bool failed;   // the fault has happened
    atomic_int syncs;     // of the log or the database, since registration
};

void faulty_vfs_register(struct faulty_vfs *faulty, const char *name);
void faulty_vfs_unregister(struct faulty_vfs *faulty);
void faulty_vfs_arm(struct faulty_vfs *faulty, enum fault fault, int n);
bool faulty_vfs_disarm(struct faulty_vfs *faulty); // whether the fault had happened

#endif
