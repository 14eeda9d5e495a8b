// Every subcommand of fovstats that reads a study, run on a study file, and what is expected of all of them
// alike.
#ifndef TESTS_ANALYSIS_SUBCOMMAND_H
#define TESTS_ANALYSIS_SUBCOMMAND_H

#include "program.h"

#define SUBCOMMAND_FOVSTATS BUILD_DIR "/bin/fovstats"
#define FOVSTATS(...) program_run((const char *const[]){SUBCOMMAND_FOVSTATS, __VA_ARGS__, NULL}, NULL)

enum subcommand {
    CHOICES,
    RATINGS,
    ANOVA,
    THRESHOLDS,
    JOD,
    FRAMES,
    AUDIT, // frames --audit
    GAZE,
    EVENTS, // gaze --events
    PLANNED,
    POWER,
    REPORT,
    MERGE,
    EXPORT,
    SUBCOMMANDS
};

const char *subcommand_name(enum subcommand subcommand);
// `more` and `most`: further options, or NULL.
struct program_result subcommand_run(enum subcommand subcommand, const char *path, const char *more,
                                     const char *most);
// Exit 1, one line on stderr that begins with the name and `sentence`, nothing on stdout, no file left; with
// --json too.
void subcommand_fails(enum subcommand subcommand, const char *path, const char *sentence);
// Exit 0, nothing on stderr, no "nan" and no "inf" in text, JSON and HTML.
void subcommand_works(enum subcommand subcommand, const char *path);
// Each by its sentence: those that have one fail with it, the others work.
void subcommand_expect(const char *path, const char *const sentences[SUBCOMMANDS]);

#endif
