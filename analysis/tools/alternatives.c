#include "analysis/tools/alternatives.h"

#include "analysis/tools/arguments.h"

#include <string.h>

const char *const alternative_words[3] = {
    [STAT_TWO_SIDED] = "two-sided", [STAT_LESS] = "less", [STAT_GREATER] = "greater"};

int alternative_parse(const struct command *command, const char *word, enum stat_alternative *out)
{
    for (int i = 0; i < 3; i++)
        if (strcmp(alternative_words[i], word) == 0) {
            *out = (enum stat_alternative)i;
            return -1;
        }
    return command_fail(command, EXIT_USAGE, "--alternative is \"%s\" but must be two-sided, less or greater",
                        word);
}
