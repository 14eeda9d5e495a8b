// The protocol's file against the text that a session was started with.
#include "app/fovstudy/resume_check.h"
#include "studies/protocol/text.h"

#include <errno.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { LINES_SHOWN = 12 }; // of each side

struct span {
    const char *start, *end;
};

// NULL: it cannot be read (errno). More than a protocol may have is a difference anyway.
static char *read_file(const char *path, size_t *out_size)
{
    FILE *file = fopen(path, "rb");
    char *text = file ? malloc(PROTOCOL_BYTES + 1) : NULL;
    if (text) {
        *out_size = fread(text, 1, PROTOCOL_BYTES, file);
        text[*out_size] = '\0';
    }
    int reason = errno;
    if (file)
        fclose(file);
    errno = reason;
    return text;
}

static const char *line_start(const char *text, const char *at)
{
    while (at > text && at[-1] != '\n')
        at--;
    return at;
}

static const char *line_end(const char *at, const char *end)
{
    while (at < end && *at != '\n')
        at++;
    return at < end ? at + 1 : end;
}

// What is left of both texts without the lines that they begin and end with together.
static void trim(struct span *a, struct span *b)
{
    const char *x = a->start, *y = b->start;
    while (x < a->end && y < b->end && *x == *y)
        x++, y++;
    x = line_start(a->start, x);
    y = b->start + (x - a->start);
    const char *p = a->end, *q = b->end;
    while (p > x && q > y && p[-1] == q[-1])
        p--, q--;
    // A piece that ends within a line goes on to its end, on both sides.
    bool whole = (p == x || p[-1] == '\n') && (q == y || q[-1] == '\n');
    *a = (struct span){x, whole ? p : line_end(p, a->end)};
    *b = (struct span){y, whole ? q : line_end(q, b->end)};
}

static void add_lines(struct text *out, char sign, const struct span *span)
{
    const char *at = span->start;
    for (int shown = 0; at < span->end; shown++) {
        const char *end = line_end(at, span->end);
        size_t length = (size_t)(end - at) - (end > at && end[-1] == '\n');
        if (shown == LINES_SHOWN) {
            text_add(out, "%c ...\n", sign);
            return;
        }
        text_add(out, "%c%.*s\n", sign, (int)length, at);
        at = end;
    }
}

// NULL: out of memory.
static char *difference(const char *path, const struct store_session_start *start, const char *text,
                        size_t size)
{
    struct text out = {0};
    struct span stored = {start->protocol_text, start->protocol_text + strlen(start->protocol_text)};
    struct span given = {text, text + size};
    trim(&stored, &given);
    unsigned line = 1;
    for (const char *c = start->protocol_text; c < stored.start; c++)
        line += *c == '\n';
    text_add(&out, "--- session %" PRId64 " line %u\n+++ %s\n", start->session_id, line, path);
    add_lines(&out, '-', &stored);
    add_lines(&out, '+', &given);
    return text_take(&out);
}

bool resume_protocol_file(const struct run_options *options, const struct store_session_start *start,
                          char **out_difference, char *error, size_t error_size)
{
    const char *path = options->protocol ? options->protocol : start->protocol_file;
    // The file of a study that moved to another computer is not missed: what counts is in the study file.
    if (strcmp(path, "-") == 0 || !*path || (!options->protocol && access(path, F_OK) != 0))
        return true;
    size_t size = 0;
    char *text = read_file(path, &size);
    if (!text) {
        snprintf(error, error_size, "%s: cannot be read: %s", path, strerror(errno));
        return false;
    }
    bool same = size == strlen(start->protocol_text) && memcmp(text, start->protocol_text, size) == 0;
    if (!same) {
        *out_difference = difference(path, start, text, size);
        snprintf(error, error_size,
                 "%s: was changed since session %" PRId64
                 " began, which can only go on as it began; put the lines "
                 "below back, or give --protocol - to go on with the text in the study file",
                 path, start->session_id);
    }
    free(text);
    return same;
}
