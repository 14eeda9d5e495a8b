// fovstats: statistics, figures and reports from study files. One file per subcommand.
#include "analysis/tools/command.h"

#include <stdio.h>
#include <string.h>

// Adding a subcommand: its file, its declaration in command.h, its line here.
static const struct command *const commands[] = {&command_binom,      &command_choices,
                                                 &command_ratings,    &command_anova, //
                                                 &command_thresholds, &command_jod,
                                                 &command_frames,     &command_power, //
                                                 &command_gaze,       &command_report,
                                                 &command_merge,      &command_export, //
                                                 &command_planned,    NULL};

static void print_help(FILE *out)
{
    fputs("usage: fovstats SUBCOMMAND ...   (fovstats SUBCOMMAND --help tells more)\n\n", out);
    for (int i = 0; commands[i]; i++)
        fprintf(out, "  %-10s  %s\n", commands[i]->name, commands[i]->summary);
    fputs("\nExit: 0 done, 1 the work failed, 2 wrong usage. Study files are never changed.\n", out);
}

int main(int argc, char **argv)
{
    if (argc < 2) {
        fputs("fovstats: which subcommand? One of", stderr);
        for (const struct command *const *each = commands; *each; each++)
            fprintf(stderr, "%s %s", each == commands ? "" : ",", (*each)->name);
        fputs("; see fovstats --help\n", stderr);
        return EXIT_USAGE;
    }
    if (strcmp(argv[1], "--help") == 0 || strcmp(argv[1], "-h") == 0) {
        print_help(stdout);
        return fflush(stdout) == 0 ? EXIT_DONE : EXIT_FAILED;
    }
    if (strcmp(argv[1], "--version") == 0) {
        puts("fovstats " FOVSTUDY_VERSION);
        return fflush(stdout) == 0 ? EXIT_DONE : EXIT_FAILED;
    }
    for (int i = 0; commands[i]; i++)
        if (strcmp(argv[1], commands[i]->name) == 0)
            return commands[i]->run(commands[i], argc - 1, argv + 1);
    fprintf(stderr, "fovstats: there is no subcommand \"%s\"; see fovstats --help\n", argv[1]);
    return EXIT_USAGE;
}
