#include "analysis/tools/arguments.h"
#include "analysis/tools/json.h"
#include "analysis/tools/labs.h"

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
    int count = 0, code = labs_take(command, &argc, argv, labs);
    if (code < 0)
        code = arguments_parse(command, argc, argv, options, sizeof options / sizeof options[0], &count);
    if (code >= 0)
        return code;
    for (int i = 0; i < count; i++)
        inputs[desc.input_count++] = labs_input(argv[i], labs);
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
