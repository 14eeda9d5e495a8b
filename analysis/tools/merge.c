#include "studies/store/merge.h"

#include "analysis/tools/arguments.h"
#include "analysis/tools/json.h"

#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char help[] =
    "usage: fovstats merge DB... [--lab NAME=DB]... -o OUT.db [--new-protocol] [--json]\n"
    "\n"
    "Joins study files into a new one. A session that is in several of them (copies, later copies) is counted\n"
    "once, as the copy that goes on further has it; copies that went on differently are refused, as are "
    "people\n"
    "beside simulated observers, other protocols, other seeds, and a code that two files have without a "
    "session\n"
    "in common. The files are only read; every session gets an event that names its file and its hash.\n"
    "  --lab NAME=DB   a file whose participants become NAME-CODE\n"
    "  -o OUT.db       where to; must not exist; written whole or not at all\n"
    "  --new-protocol  sessions of several protocols may share the file\n"
    "  --json          one object with the counts\n";

static void say(void *user, const char *sentence)
{
    const struct command *command = user;
    fprintf(stderr, "fovstats %s: %s\n", command->name, sentence);
}

// Takes the word --lab, which may come several times, out of the arguments and marks the NAME=DB after it in
// `labs`, so that the files keep their order. -1, or the exit code.
static int take_labs(const struct command *command, int *argc, char **argv, char **labs)
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

static struct store_merge_input as_input(char *word, char **labs)
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

static void print_counts(const struct store_merge_desc *desc, const struct store_merge_counts *counts)
{
    printf("%s: %zu %s, %lld %s, %lld %s; %lld %s counted once.\n", desc->output, desc->input_count,
           desc->input_count == 1 ? "file" : "files", counts->participants,
           counts->participants == 1 ? "participant" : "participants", counts->sessions,
           counts->sessions == 1 ? "session" : "sessions", counts->twice,
           counts->twice == 1 ? "was in several files and is" : "were in several files and are");
}

static int merge(const struct command *command, int argc, char **argv, struct store_merge_input *inputs,
                 char **labs)
{
    struct store_merge_desc desc = {.inputs = inputs, .say = say};
    union {
        const struct command *in;
        void *out;
    } user = {.in = command};
    desc.user = user.out;
    bool json = false;
    const struct option options[] = {{"-o", OPTION_TEXT, &desc.output},
                                     {"--new-protocol", OPTION_FLAG, &desc.new_protocol},
                                     {"--json", OPTION_FLAG, &json}};
    int count = 0, code = take_labs(command, &argc, argv, labs);
    if (code < 0)
        code = arguments_parse(command, argc, argv, options, sizeof options / sizeof options[0], &count);
    if (code >= 0)
        return code;
    for (int i = 0; i < count; i++)
        inputs[desc.input_count++] = as_input(argv[i], labs);
    if (desc.input_count == 0)
        return command_fail(command, EXIT_USAGE, "needs at least one study file; see --help");
    if (!desc.output)
        return command_fail(command, EXIT_USAGE, "needs -o OUT.db");
    char error[1024];
    struct store_merge_counts counts;
    if (!store_merge(&desc, &counts, error, sizeof error))
        return command_fail(command, EXIT_FAILED, "%s", error);
    if (json) {
        struct json out = {stdout, false};
        json_open(&out, NULL, '{');
        json_integer(&out, "files", (int64_t)desc.input_count);
        json_integer(&out, "participants", counts.participants);
        json_integer(&out, "sessions", counts.sessions);
        json_integer(&out, "sessions_counted_once", counts.twice);
        json_close(&out, '}');
        putchar('\n');
    } else {
        print_counts(&desc, &counts);
    }
    return command_finish(command);
}

static int run(const struct command *command, int argc, char **argv)
{
    struct store_merge_input *inputs = calloc((size_t)argc + 1, sizeof *inputs);
    char **labs = calloc((size_t)argc + 1, sizeof *labs);
    int code = inputs && labs ? merge(command, argc, argv, inputs, labs)
                              : command_fail(command, EXIT_FAILED, "not enough memory");
    free(labs);
    free(inputs);
    return code;
}

const struct command command_merge = {"merge", "joins study files, each session once", help, run};
