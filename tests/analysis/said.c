#include "said.h"

#include "reference.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

double said_after(const char *json, const char *after, const char *key)
{
    char quoted[64];
    snprintf(quoted, sizeof quoted, "\"%s\":", key);
    const char *at = strstr(json, after);
    if (!at || !(at = strstr(at, quoted)))
        fail_msg("no %s after %s in %s", key, after, json);
    return strtod(at + strlen(quoted), NULL);
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

void said_wrong_use(const struct said_case *cases, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        const char *argv[10] = {BUILD_DIR "/bin/fovstats"};
        memcpy(argv + 1, cases[i].arguments, sizeof cases[i].arguments);
        said_sentence(program_run(argv, NULL), 2, cases[i].part);
    }
}
