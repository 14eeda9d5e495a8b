// --lab NAME=DB, which may come several times: a study file whose participants become NAME-CODE.
#ifndef ANALYSIS_TOOLS_LABS_H
#define ANALYSIS_TOOLS_LABS_H

#include "analysis/tools/command.h"
#include "studies/store/merge.h"

// Takes the words --lab out of the arguments and marks the NAME=DB after each in `labs`, which has room for
// argc + 1 and is NULL-terminated, so that the files keep their order. -1, or the exit code.
int labs_take(const struct command *command, int *argc, char **argv, char **labs);
// A file's argument, as marked or not; cuts NAME from DB.
struct store_merge_input labs_input(char *word, char **labs);

#endif
