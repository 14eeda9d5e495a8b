#include "analysis/tools/arguments.h"

#include <ctype.h>
#include <errno.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

int command_fail(const struct command *command, int exit_code, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    fprintf(stderr, "fovstats %s: ", command->name);
    vfprintf(stderr, format, arguments);
    fputc('\n', stderr);
    va_end(arguments);
    return exit_code;
}

int command_finish(const struct command *command)
{
    if (fflush(stdout) == 0 && !ferror(stdout))
        return EXIT_DONE;
    return command_fail(command, EXIT_FAILED, "the output cannot be written: %s", strerror(errno));
}

bool arguments_number(const char *text, double *out)
{
    char *end;
    if (text[0] == '\0' || isspace((unsigned char)text[0]))
        return false;
    double value = strtod(text, &end);
    if (*end != '\0' || !isfinite(value))
        return false;
    *out = value;
    return true;
}

bool arguments_integer(const char *text, int64_t *out)
{
    char *end;
    if (text[0] == '\0' || isspace((unsigned char)text[0]))
        return false;
    errno = 0;
    long long value = strtoll(text, &end, 10);
    if (*end != '\0' || errno == ERANGE)
        return false;
    *out = value;
    return true;
}

static const struct option *find_option(const char *name, const struct option *options, size_t count)
{
    for (size_t i = 0; i < count; i++)
        if (strcmp(options[i].name, name) == 0)
            return &options[i];
    return NULL;
}

// -1, or the exit code after a sentence.
static int set_option(const struct command *command, const struct option *option, const char *value)
{
    if (option->kind == OPTION_FLAG) {
        *(bool *)option->target = true;
        return -1;
    }
    if (!value)
        return command_fail(command, EXIT_USAGE, "%s needs a value; see --help", option->name);
    if (option->kind == OPTION_TEXT)
        *(const char **)option->target = value;
    else if (!arguments_number(value, option->target))
        return command_fail(command, EXIT_USAGE, "%s is \"%s\" but must be a number", option->name, value);
    return -1;
}

static bool is_option(const char *word)
{
    return word[0] == '-' && word[1] != '\0' && !isdigit((unsigned char)word[1]) && word[1] != '.';
}

int arguments_parse(const struct command *command, int argc, char **argv, const struct option *options,
                    size_t option_count, int *out_count)
{
    int left = 0;
    bool only_words = false;
    for (int i = 1; i < argc; i++) {
        if (only_words || !is_option(argv[i])) {
            argv[left++] = argv[i];
            continue;
        }
        if (strcmp(argv[i], "--") == 0) {
            only_words = true;
            continue;
        }
        if (strcmp(argv[i], "--help") == 0 || strcmp(argv[i], "-h") == 0) {
            fputs(command->help, stdout);
            return command_finish(command);
        }
        const struct option *option = find_option(argv[i], options, option_count);
        if (!option)
            return command_fail(command, EXIT_USAGE, "%s is not an option of it; see --help", argv[i]);
        int code = set_option(command, option, i + 1 < argc ? argv[i + 1] : NULL);
        if (code >= 0)
            return code;
        if (option->kind != OPTION_FLAG)
            i++;
    }
    *out_count = left;
    return -1;
}
