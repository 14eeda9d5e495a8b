#include "studies/store/owner.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

static long read_pid(int file)
{
    char text[32] = {0};
    return pread(file, text, sizeof text - 1, 0) > 0 ? strtol(text, NULL, 10) : 0;
}

// The former owner may have removed the file between our open and our flock; then we hold a lock on a file that
// nobody else can find.
static bool still_named(int file, const char *path)
{
    struct stat opened, named;
    return fstat(file, &opened) == 0 && stat(path, &named) == 0 && opened.st_dev == named.st_dev &&
           opened.st_ino == named.st_ino;
}

static void write_pid(int file)
{
    char text[32];
    int length = snprintf(text, sizeof text, "%ld\n", (long)getpid());
    // The number only serves the message of a second program; a full disk must not stop the first.
    if (ftruncate(file, 0) == 0 && pwrite(file, text, (size_t)length, 0) != length)
        (void)!ftruncate(file, 0);
}

enum owner_result owner_take(struct owner *owner, const char *database_path, long *out_pid)
{
    static const char suffix[] = "-owner";
    *owner = (struct owner){.file = -1};
    *out_pid = 0;
    size_t length = strlen(database_path);
    char *path = malloc(length + sizeof suffix);
    if (!path)
        return OWNER_ERROR;
    memcpy(path, database_path, length);
    memcpy(path + length, suffix, sizeof suffix);
    for (;;) {
        int file = open(path, O_RDWR | O_CREAT | O_CLOEXEC, 0644);
        if (file < 0)
            break;
        if (flock(file, LOCK_EX | LOCK_NB) != 0) {
            bool other = errno == EWOULDBLOCK;
            *out_pid = read_pid(file);
            int error = errno;
            close(file);
            free(path);
            errno = error;
            return other ? OWNER_OTHER : OWNER_ERROR;
        }
        if (still_named(file, path)) {
            write_pid(file);
            *owner = (struct owner){.file = file, .path = path};
            return OWNER_HELD;
        }
        close(file);
    }
    int error = errno;
    free(path);
    errno = error;
    return OWNER_ERROR;
}

void owner_release(struct owner *owner)
{
    if (owner->path && owner->file >= 0) {
        unlink(owner->path); // while it is locked: a waiting program finds it gone and makes a new one
        close(owner->file);
    }
    free(owner->path);
    *owner = (struct owner){.file = -1};
}
