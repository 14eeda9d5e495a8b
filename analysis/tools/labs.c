#include "analysis/tools/labs.h"

#include "analysis/tools/arguments.h"

#include <ctype.h>
#include <string.h>

int labs_take(const struct command *command, int *argc, char **argv, char **labs)
{
    int kept = 0;
    size_t count = 0;
    bool options = true;
    for (int i = 0; i < *argc; i++) {
        options = options && strcmp(argv[i], "--") != 0;
        if (!options || strcmp(argv[i], "--lab") != 0) {
            argv[kept++] = argv[i];
            continue;
        }
        const char *equals = i + 1 < *argc ? strchr(argv[i + 1], '=') : NULL;
        if (!equals || equals == argv[i + 1] || !equals[1])
            return command_fail(command, EXIT_USAGE, "--lab needs NAME=DB; see --help");
        for (const char *c = argv[i + 1]; c < equals; c++)
            if (!isalnum((unsigned char)*c))
                return command_fail(command, EXIT_USAGE, "--lab's name must be letters and digits");
        argv[kept++] = labs[count++] = argv[++i];
    }
    *argc = kept;
    return -1;
}

struct store_merge_input labs_input(char *word, char **labs)
{
    size_t i = 0;
    while (labs[i] && labs[i] != word)
        i++;
    if (!labs[i])
        return (struct store_merge_input){word, NULL};
    char *equals = strchr(word, '=');
    *equals = '\0';
    return (struct store_merge_input){equals + 1, word};
}
