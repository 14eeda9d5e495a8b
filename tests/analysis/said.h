// What fovstats said, held against what it should say.
#ifndef TESTS_ANALYSIS_SAID_H
#define TESTS_ANALYSIS_SAID_H

#include "program.h"

#include <stddef.h>

// The number after the first "key": that follows the first `after` in a JSON text.
double said_after(const char *json, const char *after, const char *key);
// That number against `name` of small_study.csv, to 1e-12.
void said_number(const char *json, const char *after, const char *key, const char *name);
// A text against tests/analysis/golden/`name`.
void said_golden(const char *text, const char *name);
// One line on stderr with `part` in it, nothing on stdout; frees the result.
void said_sentence(struct program_result r, int code, const char *part);

// Arguments of fovstats, and a part of the sentence that they get.
struct said_case {
    const char *arguments[8];
    const char *part;
};
void said_wrong_use(const struct said_case *cases, size_t count); // each: a sentence, and exit 2

#endif
