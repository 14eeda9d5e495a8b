// What every subcommand that reads study files takes: DB..., --simulated, --conf, --json.
#ifndef ANALYSIS_TOOLS_STUDY_ARGUMENTS_H
#define ANALYSIS_TOOLS_STUDY_ARGUMENTS_H

#include "analysis/report/sample.h"
#include "analysis/tools/arguments.h"
#include "analysis/tools/command.h"
#include "analysis/tools/json.h"

enum { STUDY_OPTIONS = 16 };

struct study_arguments {
    bool simulated, json;
    const char *protocol; // NULL: the one of most sessions
    double conf;
    const char *output; // -o; NULL where not given
};

// Parses and loads. Returns -1 with a sample that the caller frees, else the exit code.
int study_arguments_load(const struct command *command, int argc, char **argv, bool takes_output,
                         struct study_arguments *out, struct sample *out_sample);
// The same with at most STUDY_OPTIONS options of the subcommand's own. What they hold is for the caller to
// check, which frees the sample then too.
int study_arguments_load_with(const struct command *command, int argc, char **argv, bool takes_output,
                              const struct option *own, size_t own_count, struct study_arguments *out,
                              struct sample *out_sample);

// For subcommands that take no option of their own: parses and loads, hands the sample over, frees it.
// `analyse` returns the exit code.
typedef int (*study_analyse_fn)(const struct command *command, const struct study_arguments *arguments,
                                struct sample *sample);
int study_arguments_run(const struct command *command, int argc, char **argv, study_analyse_fn analyse);

// The heading of the text output: files, sessions, participants; SIMULATED DATA where it is.
void study_title(const struct sample *sample, const char *what);
// The same as the first members of a JSON object.
void study_title_json(struct json *json, const struct sample *sample);
// Sentences on what was left out before any row was counted.
void study_notes(const struct sample *sample);

#endif
