// The session as lines of JSON for programs that watch it (`--events FILE|-`): one object a line,
// {"seq":N,"event":"trial|toggle|answer|gap|end","t_ns":N,...}. Each line is one write, made after what it
// tells was committed, so a reader never sees half a line or an answer that could still be lost.
//
// A line that a crash or a full disk cut off was never told: opening and event_line take such a piece away.
//
// Use: event_lines_open -> event_line for each -> event_lines_close. Does not: name the options' modes.
#ifndef APP_SESSION_EVENT_LINES_H
#define APP_SESSION_EVENT_LINES_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum { EVENT_LINE = 512 }; // bytes of the longest line

struct event_lines {
    int file; // -1: nobody listens
    uint64_t next;
};

// "-" is standard output, NULL nobody. A file of earlier lines is appended to, its numbers go on; any other,
// and the study file `database`, is refused. False with a sentence.
bool event_lines_open(struct event_lines *lines, const char *path, const char *database, char *error,
                      size_t error_size);
// `details` is further members, e.g. "\"trial\":3,\"slot\":\"a\"", or "". False with errno where it was not
// written: nothing of it is in the file, and the same line may be written again.
bool event_line(struct event_lines *lines, const char *event, int64_t at_ns, const char *details);
void event_lines_close(struct event_lines *lines);

#endif
