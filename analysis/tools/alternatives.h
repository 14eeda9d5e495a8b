// --alternative: its words, and reading one.
#ifndef ANALYSIS_TOOLS_ALTERNATIVES_H
#define ANALYSIS_TOOLS_ALTERNATIVES_H

#include "analysis/stats/alternative.h"
#include "analysis/tools/command.h"

extern const char *const alternative_words[3]; // by enum stat_alternative

// -1, or the exit code after a sentence.
int alternative_parse(const struct command *command, const char *word, enum stat_alternative *out);

#endif
