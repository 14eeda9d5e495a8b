#include "gaze_said.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#define FOVSTATS BUILD_DIR "/bin/fovstats"
#define MAKER BUILD_DIR "/tests/gaze_study"

void gaze_said_make(const char *trials, const char *seconds, const char *gaze_hz, const char *frame_hz)
{
    const char *argv[] = {MAKER, "s.db", "1", trials, seconds, gaze_hz, frame_hz, NULL};
    struct program_result made = program_run(argv, NULL);
    assert_int_equal(made.code, 0);
    program_free(&made);
}

struct program_result gaze_said(const char *option)
{
    const char *argv[] = {FOVSTATS, "gaze", "s.db", "--simulated", option, NULL};
    struct program_result r = program_run(argv, NULL);
    if (r.code != 0)
        fail_msg("exit %d: %s", r.code, r.err);
    return r;
}

void gaze_said_close(double value, double expected, double within)
{
    if (!(fabs(value - expected) <= within))
        fail_msg("%.9g is not within %g of %g", value, within, expected);
}

// The number after the first "key": that follows the first `after`; NaN for null.
double gaze_said_after(const char *json, const char *after, const char *key)
{
    char quoted[64];
    snprintf(quoted, sizeof quoted, "\"%s\":", key);
    const char *at = json ? strstr(json, after) : NULL;
    at = at ? strstr(at + strlen(after), quoted) : NULL;
    if (!at)
        fail_msg("no %s after %s in %s", key, after, json);
    at += strlen(quoted);
    return strncmp(at, "null", 4) == 0 ? (double)NAN : strtod(at, NULL);
}

// The number of the first person's (or session's) first record.
double gaze_said_number(const struct program_result *r, const char *key)
{
    return gaze_said_after(r->out, "\"people\":", key);
}

void gaze_said_part(const char *option, const char *part)
{
    struct program_result r = gaze_said(option);
    if (!strstr(r.out, part))
        fail_msg("does not say \"%s\":\n%s", part, r.out);
    program_free(&r);
}
