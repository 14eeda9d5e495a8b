// Long options of a program or a subcommand of it: one table says what there is, for reading and for --help.
//
// Use: struct options o; options_start(&o, argc, argv, "fovstudy run", specs); while ((i = options_next(&o)) >=
// 0) use
//      o.value; stop on OPTIONS_ERROR (one sentence was printed; exit 2) and OPTIONS_HELP (the caller prints;
//      exit 0).
// "--name value", "--name=value", flags, words between and after; "--" ends the options.
#ifndef APP_COMMAND_OPTIONS_H
#define APP_COMMAND_OPTIONS_H

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

enum { OPTIONS_DONE = -1, OPTIONS_ERROR = -2, OPTIONS_HELP = -3, OPTIONS_WORD = 1000 };
enum { EXIT_DONE = 0, EXIT_FAILED = 1, EXIT_USAGE = 2 }; // DESIGN section 6

struct option_spec {
    const char *name;     // without the dashes; NULL ends the table
    const char *argument; // "FILE", "WxH"; NULL: a flag
    const char *help;
};

struct options {
    int argc;
    char **argv; // borrowed; argv[0] is the command
    int next;
    bool words_only;
    const char *command; // as messages name it: "fovstudy run"
    const struct option_spec *specs;
    const char *value; // the argument, or the word
};

void options_start(struct options *options, int argc, char **argv, const char *command,
                   const struct option_spec *specs);
// The index into specs; OPTIONS_WORD for a word that is no option; else one of the negative numbers above.
int options_next(struct options *options);

// One sentence on stderr, "COMMAND: ...; see COMMAND --help"; returns EXIT_USAGE.
int options_wrong(const char *command, const char *format, ...) __attribute__((format(printf, 2, 3)));
// "usage: USAGE", a paragraph, and the table.
void options_help(FILE *out, const char *usage, const char *about, const struct option_spec *specs);

// Whole values; false where the text is anything else or out of range.
bool options_uint64(const char *text, uint64_t min, uint64_t max, uint64_t *out);
bool options_double(const char *text, double min, double max, double *out);     // both ends included
bool options_size(const char *text, uint32_t *out_width, uint32_t *out_height); // "640x720", 16..16384 each

#endif
