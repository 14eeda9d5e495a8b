// What fovstats said, held against what it should say.
#ifndef TESTS_ANALYSIS_SAID_H
#define TESTS_ANALYSIS_SAID_H

#include "program.h"

#include <stddef.h>

// The place after each of the marks in turn, up to NULL; fails the test where one is missing.
const char *said_place(const char *text, const char *const *marks);
#define SAID_PLACE(text, ...) said_place(text, (const char *const[]){__VA_ARGS__, NULL})
// The number after the first "key": that follows the first `after` in a JSON text; NaN for null.
double said_after(const char *json, const char *after, const char *key);
// That number against `name` of small_study.csv, to 1e-12.
void said_number(const char *json, const char *after, const char *key, const char *name);
// A text against tests/analysis/golden/`name`.
void said_golden(const char *text, const char *name);
// One line on stderr with `part` in it, nothing on stdout; frees the result.
void said_sentence(struct program_result r, int code, const char *part);
// Exit 0 and `part` on stdout; frees the result.
void said_done(struct program_result r, const char *part);
// Two texts that are equal but for the last digits of numbers: sums go over sessions in a file's order.
void said_same(const char *a, const char *b);

// Arguments of fovstats, and a part of the sentence that they get.
struct said_case {
    const char *arguments[8];
    const char *part;
};
void said_wrong_use(const struct said_case *cases, size_t count); // each: a sentence, and exit 2

#endif
