// The arguments of a subcommand: options by table, the rest in order.
#ifndef ANALYSIS_TOOLS_ARGUMENTS_H
#define ANALYSIS_TOOLS_ARGUMENTS_H

#include "analysis/tools/command.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum option_kind { OPTION_FLAG, OPTION_NUMBER, OPTION_TEXT };

struct option {
    const char *name; // as typed, "--conf"
    enum option_kind kind;
    void *target; // bool, double or const char *, unchanged where the option is not given
};

// Takes the options out of argv and moves what is left to its front; out_count is how many are left. Returns -1
// to go on, else the exit code: after --help, or after a sentence on stderr. A word such as -3 is not an
// option, and nothing after -- is.
int arguments_parse(const struct command *command, int argc, char **argv, const struct option *options,
                    size_t option_count, int *out_count);

bool arguments_number(const char *text, double *out);   // finite, the whole text
bool arguments_integer(const char *text, int64_t *out); // the whole text; false for one that does not fit

// "fovstats NAME: ..." on stderr. The value is the exit code given.
int command_fail(const struct command *command, int exit_code, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

// EXIT_DONE where everything printed has reached stdout.
int command_finish(const struct command *command);

#endif
