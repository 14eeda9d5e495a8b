// A subcommand of fovstats: one line in main.c's table and one short file.
#ifndef ANALYSIS_TOOLS_COMMAND_H
#define ANALYSIS_TOOLS_COMMAND_H

#include <stdbool.h>

enum { EXIT_DONE = 0, EXIT_FAILED = 1, EXIT_USAGE = 2 };

struct command {
    const char *name;
    const char *summary; // one line
    const char *help;    // what --help prints
    // argv[0] is the subcommand's name. Returns the exit code.
    int (*run)(const struct command *command, int argc, char **argv);
};

struct sample;
// `fovstats frames --audit`: prints the audit of a loaded sample; returns the exit code.
int frames_audit(const struct command *command, struct sample *sample, bool json);

extern const struct command command_binom, command_choices, command_ratings, command_frames, command_report;
extern const struct command command_anova, command_export, command_gaze, command_jod, command_merge;
extern const struct command command_planned, command_power, command_thresholds;

#endif
