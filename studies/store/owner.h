// The lock that makes one program the owner of a study file: flock on FILE-owner, which holds the owner's
// process id.
//
// The kernel releases it however the program ends, so a lock that is held means a live owner. It works between
// programs and between two stores of one program; on network file systems it is only as good as their flock.
#ifndef STUDIES_STORE_OWNER_H
#define STUDIES_STORE_OWNER_H

#include <stdbool.h>

struct owner {
    int file;   // -1: not held
    char *path; // owned
};

enum owner_result {
    OWNER_HELD,  // ours now
    OWNER_OTHER, // another program's; out_pid its process id, 0 where not known
    OWNER_ERROR, // see errno
};

enum owner_result owner_take(struct owner *owner, const char *database_path, long *out_pid);
void owner_release(struct owner *owner); // removes the side file; a zeroed or not held one is fine

#endif
