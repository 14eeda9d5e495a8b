#include "program.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmocka.h>

static char *read_all(FILE *file)
{
    fseek(file, 0, SEEK_END);
    long size = ftell(file);
    rewind(file);
    char *text = malloc((size_t)size + 1);
    assert_non_null(text);
    text[fread(text, 1, (size_t)size, file)] = '\0';
    fclose(file);
    return text;
}

struct program_result program_run(const char *const *argv, const char *path)
{
    FILE *out = tmpfile(), *err = tmpfile();
    assert_true(out && err);
    pid_t child = fork();
    assert_true(child >= 0);
    if (child == 0) {
        dup2(fileno(out), 1);
        dup2(fileno(err), 2);
        if (path)
            setenv("PATH", path, 1);
        execv(argv[0], (char *const *)argv);
        _exit(127);
    }
    int status = 0;
    waitpid(child, &status, 0);
    struct program_result result = {WIFEXITED(status) ? WEXITSTATUS(status) : -1, read_all(out), read_all(err)};
    return result;
}

void program_free(struct program_result *result)
{
    free(result->out);
    free(result->err);
}

int program_enter_folder(void **state)
{
    static char folder[] = "/tmp/fovstats-test-XXXXXX"; // of the whole program, which has one group of tests
    *state = mkdtemp(folder);
    return *state && chdir(folder) == 0 ? 0 : -1;
}

int program_leave_folder(void **state)
{
    struct program_result r = program_run((const char *const[]){"/bin/rm", "-rf", *state, NULL}, NULL);
    int code = chdir("/") == 0 ? r.code : -1;
    program_free(&r);
    return code;
}
