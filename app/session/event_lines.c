#include "app/session/event_lines.h"

#include <errno.h>
#include <fcntl.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

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
    while ((found = strstr(found, "{\"seq\":"))) {
        last = found;
        found++;
    }
    return last ? strtoull(last + strlen("{\"seq\":"), NULL, 10) + 1 : 1;
}

bool event_lines_open(struct event_lines *lines, const char *path, char *error, size_t error_size)
{
    *lines = (struct event_lines){.file = -1, .next = 1};
    if (!path)
        return true;
    if (strcmp(path, "-") == 0) {
        lines->file = STDOUT_FILENO;
        return true;
    }
    lines->file = open(path, O_RDWR | O_APPEND | O_CREAT | O_CLOEXEC, 0644);
    if (lines->file < 0) {
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
        errno = written < 0 ? errno : ENOSPC;
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
