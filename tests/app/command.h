// Runs the built program as a user would and keeps what it said.
#ifndef TESTS_APP_COMMAND_H
#define TESTS_APP_COMMAND_H

#include <stddef.h>

enum { COMMAND_TEXT = 65536 };

struct command_result {
    int status; // exit status; 128 + signal where it died
    char out[COMMAND_TEXT], err[COMMAND_TEXT];
};

// `line` is a shell command; "fovstudy" in it is the built program. Fills a result that lives until the next
// call.
const struct command_result *command(const char *line, ...) __attribute__((format(printf, 1, 2)));

// A fresh empty folder for a test's files, below the build folder.
void command_folder(const char *name, char *out, size_t size);

#endif
