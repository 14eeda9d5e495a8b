#include "tests/app/command.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

static void read_whole(const char *path, char *out)
{
    FILE *file = fopen(path, "r");
    size_t size = file ? fread(out, 1, COMMAND_TEXT - 1, file) : 0;
    out[size] = '\0';
    if (file)
        fclose(file);
}

const struct command_result *command(const char *line, ...)
{
    static struct command_result result;
    char text[4096], full[8192], out[64], err[64];
    va_list arguments;
    va_start(arguments, line);
    vsnprintf(text, sizeof text, line, arguments);
    va_end(arguments);
    snprintf(out, sizeof out, "/tmp/fovstudy-test-%d.out", (int)getpid());
    snprintf(err, sizeof err, "/tmp/fovstudy-test-%d.err", (int)getpid());
    snprintf(full, sizeof full, "fovstudy() { '%s/bin/fovstudy' \"$@\"; }; { %s; } >%s 2>%s </dev/null",
             BUILD_DIR, text, out, err);
    int status = system(full);
    result.status = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    read_whole(out, result.out);
    read_whole(err, result.err);
    unlink(out);
    unlink(err);
    return &result;
}

void command_folder(const char *name, char *out, size_t size)
{
    char line[4096];
    snprintf(out, size, "%s/tests/%s.files", BUILD_DIR, name);
    snprintf(line, sizeof line, "rm -rf '%s' && mkdir -p '%s'", out, out);
    if (system(line) != 0) {
        fprintf(stderr, "cannot make %s\n", out);
        exit(1);
    }
}
