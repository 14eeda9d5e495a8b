#include "app/session/event_lines.h"

#include <errno.h>
#include <fcntl.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#define SEQ "{\"seq\":"

// Whether the file is empty or has our lines: a protocol named by mistake is left alone. Pipes hold nothing.
static bool is_ours(int file)
{
    char head[sizeof SEQ - 1];
    ssize_t got = pread(file, head, sizeof head, 0);
    return got < 0 || memcmp(head, SEQ, (size_t)got) == 0;
}

static bool is_database(int file, const char *database)
{
    struct stat a, b;
    return fstat(file, &a) == 0 && stat(database, &b) == 0 && a.st_dev == b.st_dev && a.st_ino == b.st_ino;
}

// Takes a last line without an end away.
static bool mend(int file)
{
    char tail[EVENT_LINE];
    off_t size = lseek(file, 0, SEEK_END);
    off_t from = size > (off_t)sizeof tail ? size - (off_t)sizeof tail : 0;
    ssize_t got = size > 0 ? pread(file, tail, sizeof tail, from) : 0;
    if (got <= 0 || tail[got - 1] == '\n')
        return true;
    ssize_t start = got;
    while (start > 0 && tail[start - 1] != '\n')
        start--;
    return ftruncate(file, from + start) == 0;
}

// The number after the last line's, from the last EVENT_LINE bytes of the file.
static uint64_t following(int file)
{
    char tail[EVENT_LINE + 1];
    off_t size = lseek(file, 0, SEEK_END);
    if (size <= 0)
        return 1;
    off_t from = size > EVENT_LINE ? size - EVENT_LINE : 0;
    ssize_t got = pread(file, tail, EVENT_LINE, from);
    if (got <= 0)
        return 1;
    tail[got] = '\0';
    const char *last = NULL, *found = tail;
    while ((found = strstr(found, SEQ))) {
        last = found;
        found++;
    }
    return last ? strtoull(last + strlen(SEQ), NULL, 10) + 1 : 1;
}

// Standard output may be a file that lines are appended to (>>): its numbers go on as well. It cannot be read
// itself.
static uint64_t following_output(void)
{
    struct stat status;
    if (fstat(STDOUT_FILENO, &status) != 0 || !S_ISREG(status.st_mode))
        return 1;
    int file = open("/proc/self/fd/1", O_RDONLY | O_CLOEXEC);
    uint64_t next = file >= 0 ? following(file) : 1;
    if (file >= 0)
        close(file);
    return next;
}

bool event_lines_open(struct event_lines *lines, const char *path, const char *database, char *error,
                      size_t error_size)
{
    *lines = (struct event_lines){.file = -1, .next = 1};
    if (!path)
        return true;
    if (strcmp(path, "-") == 0) {
        lines->file = STDOUT_FILENO;
        lines->next = following_output();
        return true;
    }
    lines->file = open(path, O_RDWR | O_APPEND | O_CREAT | O_CLOEXEC, 0644);
    if (lines->file >= 0 && is_database(lines->file, database)) {
        if (lseek(lines->file, 0, SEEK_END) == 0) // made just now, under the study file's name
            unlink(path);
        snprintf(error, error_size, "the events file '%s' is the study file; name another", path);
        return false;
    }
    if (lines->file >= 0 && !is_ours(lines->file)) {
        snprintf(error, error_size,
                 "the events file '%s' holds something else; name a new file, or one of earlier events", path);
        return false;
    }
    if (lines->file < 0 || !mend(lines->file)) {
        snprintf(error, error_size, "the events file '%s' cannot be written: %s", path, strerror(errno));
        return false;
    }
    lines->next = following(lines->file);
    return true;
}

bool event_line(struct event_lines *lines, const char *event, int64_t at_ns, const char *details)
{
    char line[EVENT_LINE];
    if (lines->file < 0)
        return true;
    int length =
        snprintf(line, sizeof line, "{\"seq\":%" PRIu64 ",\"event\":\"%s\",\"t_ns\":%" PRId64 "%s%s}\n",
                 lines->next, event, at_ns, *details ? "," : "", details);
    if (length < 0 || (size_t)length >= sizeof line) {
        errno = EOVERFLOW;
        return false;
    }
    ssize_t written = write(lines->file, line, (size_t)length);
    if (written != length) {
        int reason = written < 0 ? errno : ENOSPC;
        off_t end = written > 0 ? lseek(lines->file, 0, SEEK_END) : -1; // no file: nothing can be taken back
        if (written > 0 && end >= written)
            (void)!ftruncate(lines->file, end - written);
        errno = reason;
        return false;
    }
    lines->next++;
    return true;
}

void event_lines_close(struct event_lines *lines)
{
    if (lines->file > STDOUT_FILENO)
        close(lines->file);
    lines->file = -1;
}
