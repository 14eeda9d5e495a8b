#include "app/command/options.h"

#include <errno.h>
#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

void options_start(struct options *options, int argc, char **argv, const char *command,
                   const struct option_spec *specs)
{
    *options = (struct options){.argc = argc, .argv = argv, .next = 1, .command = command, .specs = specs};
}

int options_wrong(const char *command, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    fprintf(stderr, "%s: ", command);
    vfprintf(stderr, format, arguments);
    fprintf(stderr, "; see %s --help\n", command);
    va_end(arguments);
    return EXIT_USAGE;
}

static int find(const struct option_spec *specs, const char *name, size_t length)
{
    for (int i = 0; specs[i].name; i++)
        if (strlen(specs[i].name) == length && strncmp(specs[i].name, name, length) == 0)
            return i;
    return -1;
}

static int read_option(struct options *options, const char *word)
{
    const char *name = word + 2;
    size_t length = strcspn(name, "=");
    int found = find(options->specs, name, length);
    if (found < 0) {
        options_wrong(options->command, "there is no option '--%.*s'", (int)length, name);
        return OPTIONS_ERROR;
    }
    bool given = name[length] == '=';
    if (!options->specs[found].argument) {
        if (!given)
            return found;
        options_wrong(options->command, "option '--%.*s' takes no value", (int)length, name);
        return OPTIONS_ERROR;
    }
    if (given)
        options->value = name + length + 1;
    else if (options->next < options->argc)
        options->value = options->argv[options->next++];
    else {
        options_wrong(options->command, "option '--%s' wants a value (%s)", name,
                      options->specs[found].argument);
        return OPTIONS_ERROR;
    }
    return found;
}

int options_next(struct options *options)
{
    options->value = NULL;
    if (options->next >= options->argc)
        return OPTIONS_DONE;
    const char *word = options->argv[options->next++];
    if (!options->words_only && strcmp(word, "--") == 0) {
        options->words_only = true;
        return options_next(options);
    }
    if (!options->words_only && (strcmp(word, "--help") == 0 || strcmp(word, "-h") == 0))
        return OPTIONS_HELP;
    if (!options->words_only && strncmp(word, "--", 2) == 0)
        return read_option(options, word);
    if (!options->words_only && word[0] == '-' && word[1]) {
        options_wrong(options->command, "there is no option '%s'", word);
        return OPTIONS_ERROR;
    }
    options->value = word;
    return OPTIONS_WORD;
}

void options_help(FILE *out, const char *usage, const char *about, const struct option_spec *specs)
{
    fprintf(out, "usage: %s\n\n%s\n", usage, about);
    if (specs && specs[0].name)
        fprintf(out, "\n");
    for (int i = 0; specs && specs[i].name; i++) {
        char left[64];
        snprintf(left, sizeof left, "--%s%s%s", specs[i].name, specs[i].argument ? " " : "",
                 specs[i].argument ? specs[i].argument : "");
        fprintf(out, "  %-26s %s\n", left, specs[i].help);
    }
}

bool options_uint64(const char *text, uint64_t min, uint64_t max, uint64_t *out)
{
    if (*text < '0' || *text > '9')
        return false;
    char *end = NULL;
    errno = 0;
    unsigned long long value = strtoull(text, &end, 10);
    if (errno || *end || value < min || value > max)
        return false;
    *out = value;
    return true;
}

bool options_double(const char *text, double min, double max, double *out)
{
    char *end = NULL;
    double value = strtod(text, &end);
    if (end == text || *end || !isfinite(value) || value < min || value > max)
        return false;
    *out = value;
    return true;
}

bool options_size(const char *text, uint32_t *out_width, uint32_t *out_height)
{
    char first[16];
    uint64_t width = 0, height = 0;
    size_t length = strcspn(text, "x");
    if (text[length] != 'x' || length >= sizeof first)
        return false;
    memcpy(first, text, length);
    first[length] = '\0';
    if (!options_uint64(first, 16, 16384, &width) || !options_uint64(text + length + 1, 16, 16384, &height))
        return false;
    *out_width = (uint32_t)width;
    *out_height = (uint32_t)height;
    return true;
}
