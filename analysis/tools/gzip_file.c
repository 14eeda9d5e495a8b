#include "analysis/tools/gzip_file.h"

#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <unistd.h>
#include <zlib.h>

struct gzip_file {
    gzFile stream;
    int descriptor;
    bool failed;
};

struct gzip_file *gzip_file_open(const char *path)
{
    struct gzip_file *file = calloc(1, sizeof *file);
    if (!file)
        return NULL;
    file->descriptor = open(path, O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0666);
    // Level 4 takes half of the time of level 6 and 3 % more room, measured on rows of gaze.
    int copy = file->descriptor < 0 ? -1 : dup(file->descriptor); // zlib closes its own before fsync
    file->stream = copy < 0 ? NULL : gzdopen(copy, "ab4");
    if (file->stream)
        return file;
    int reason = errno;
    if (copy >= 0)
        close(copy);
    if (file->descriptor >= 0)
        close(file->descriptor);
    free(file);
    errno = reason ? reason : ENOMEM;
    return NULL;
}

bool gzip_file_write(struct gzip_file *file, const char *text, size_t size)
{
    file->failed = file->failed || gzwrite(file->stream, text, (unsigned)size) != (int)size;
    return !file->failed;
}

bool gzip_file_close(struct gzip_file *file)
{
    if (!file)
        return true;
    errno = EIO; // where zlib says no more
    bool ok = gzclose(file->stream) == Z_OK && !file->failed && fsync(file->descriptor) == 0;
    int reason = errno;
    ok = close(file->descriptor) == 0 && ok;
    free(file);
    errno = reason;
    return ok;
}
