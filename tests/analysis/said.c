#include "said.h"

#include "reference.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

const char *said_place(const char *text, const char *const *marks)
{
    for (; *marks; marks++) {
        const char *at = strstr(text, *marks);
        if (!at)
            fail_msg("no %s in %s", *marks, text);
        text = at + strlen(*marks);
    }
    return text;
}

double said_after(const char *json, const char *after, const char *key)
{
    char quoted[64];
    snprintf(quoted, sizeof quoted, "\"%s\":", key);
    const char *at = strstr(json, after);
    if (!at)
        fail_msg("no %s in %s", after, json);
    const char *value = SAID_PLACE(at, quoted);
    return strncmp(value, "null", 4) == 0 ? (double)NAN : strtod(value, NULL);
}

void said_number(const char *json, const char *after, const char *key, const char *name)
{
    double got = said_after(json, after, key), want = reference_value("small_study.csv", name);
    if (!reference_close(got, want, 1e-12))
        fail_msg("%s: %.17g, R %.17g", name, got, want);
}

void said_golden(const char *text, const char *name)
{
    char path[512];
    static char golden[65536];
    snprintf(path, sizeof path, "%s/tests/analysis/golden/%s", SOURCE_DIR, name);
    FILE *file = fopen(path, "r");
    if (!file)
        fail_msg("%s is missing; it should read:\n%s", path, text);
    golden[fread(golden, 1, sizeof golden - 1, file)] = '\0';
    fclose(file);
    // The golden files have HASH for the data's: provenance has its own test.
    char *copy = strdup(text), *hash = copy ? strstr(copy, "SHA-256 ") : NULL;
    assert_non_null(copy);
    if (hash) {
        assert_int_equal(strspn(hash + 8, "0123456789abcdef"), 64);
        memmove(hash + 8 + 4, hash + 8 + 64, strlen(hash + 8 + 64) + 1);
        memcpy(hash + 8, "HASH", 4);
    }
    assert_string_equal(copy, golden);
    free(copy);
}

void said_sentence(struct program_result r, int code, const char *part)
{
    if (r.code != code || !strstr(r.err, part) || r.out[0])
        fail_msg("exit %d, \"%s\", out \"%s\"; expected exit %d and \"%s\"", r.code, r.err, r.out, code, part);
    const char *end = strchr(r.err, '\n');
    assert_true(end && end[1] == '\0'); // one line
    program_free(&r);
}

void said_done(struct program_result r, const char *part)
{
    if (r.code != 0 || !strstr(r.out, part))
        fail_msg("exit %d: %s%s", r.code, r.out, r.err);
    program_free(&r);
}

void said_same(const char *a, const char *b)
{
    while (*a && *b) {
        char *end_a, *end_b;
        double x = strtod(a, &end_a), y = strtod(b, &end_b);
        if (end_a == a || end_b == b) {
            if (*a++ != *b++)
                fail_msg("%.80s\n%.80s", a - 1, b - 1);
            continue;
        }
        if (!reference_close(x, y, 1e-12))
            fail_msg("%.80s\n%.80s", a, b);
        a = end_a;
        b = end_b;
    }
    assert_int_equal(*a, *b);
}

void said_wrong_use(const struct said_case *cases, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        const char *argv[10] = {BUILD_DIR "/bin/fovstats"};
        memcpy(argv + 1, cases[i].arguments, sizeof cases[i].arguments);
        said_sentence(program_run(argv, NULL), 2, cases[i].part);
    }
}
