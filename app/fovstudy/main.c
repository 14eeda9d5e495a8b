// fovstudy: runs perceptual studies of foveated rendering. A table of subcommands, nothing more.
#include "app/command/options.h"
#include "app/fovstudy/commands.h"

#include <stdio.h>
#include <string.h>

static const struct {
    const char *name;
    const char *line;
    int (*run)(int argc, char **argv);
} commands[] = {
    {"run", "run a protocol with a participant and record it", command_run},
    {"resume", "go on with an interrupted session", command_resume},
    {"check", "check a protocol and print a participant's trials, without a GPU", command_check},
    {"exclude", "apply exclusion rules, take out by hand, list what is out", command_exclude},
    {"modes", "list the rendering modes with their parameters", command_modes},
    {"scenes", "list the built-in scenes with their parameters", command_scenes},
    {"render", "walk a camera path and write pictures", command_render},
    {"strip", "walk a camera path in several modes and put them side by side", command_strip},
    {"forget", "erase a person's rows from a study file", command_forget},
    {"schema", "print the protocol language, for editors or as a reference page", command_schema},
    {"devices", "list GPUs and monitors", command_devices},
};
enum { COMMANDS = sizeof commands / sizeof commands[0] };

static void help(FILE *out)
{
    fprintf(out, "usage: fovstudy COMMAND [options]\n\nperceptual studies of foveated rendering\n\n");
    for (int i = 0; i < COMMANDS; i++)
        fprintf(out, "  %-10s %s\n", commands[i].name, commands[i].line);
    fprintf(out, "\n'fovstudy COMMAND --help' says more; 'fovstudy --version' names the version.\n");
}

int main(int argc, char **argv)
{
    if (argc < 2) {
        fprintf(stderr, "fovstudy: a command is missing; see fovstudy --help\n");
        return EXIT_USAGE;
    }
    if (strcmp(argv[1], "--help") == 0 || strcmp(argv[1], "-h") == 0) {
        help(stdout);
        return EXIT_DONE;
    }
    if (strcmp(argv[1], "--version") == 0) {
        printf("fovstudy %s\n", FOVSTUDY_VERSION);
        return EXIT_DONE;
    }
    for (int i = 0; i < COMMANDS; i++)
        if (strcmp(argv[1], commands[i].name) == 0)
            return commands[i].run(argc - 1, argv + 1);
    fprintf(stderr, "fovstudy: there is no command '%s'; see fovstudy --help\n", argv[1]);
    return EXIT_USAGE;
}
