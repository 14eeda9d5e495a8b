// Preloaded into a program (LD_PRELOAD): the n-th call that changes a file (KILL_AT=n) is the last; a write
// leaves its first half behind, then the process is killed. With KILL_COUNT=FILE the number of such calls is
// written there when the program ends.
#include <dlfcn.h>
#include <signal.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/types.h>
#include <unistd.h>

static atomic_long calls;
static long last; // 0: none

static void *next_of(const char *name)
{
    return dlsym(((void *)-1L), name); // RTLD_NEXT, which needs _GNU_SOURCE
}

__attribute__((constructor)) static void begin(void)
{
    const char *text = getenv("KILL_AT");
    last = text ? strtol(text, NULL, 10) : 0;
}

__attribute__((destructor)) static void end(void)
{
    const char *path = getenv("KILL_COUNT");
    FILE *file = path ? fopen(path, "w") : NULL;
    if (file) {
        fprintf(file, "%ld\n", atomic_load(&calls));
        fclose(file);
    }
}

static bool strikes(void)
{
    return atomic_fetch_add(&calls, 1) + 1 == last;
}

#define FORWARD(type, name, parameters, arguments)                                                             \
    type name parameters;                                                                                      \
    type name parameters                                                                                       \
    {                                                                                                          \
        type(*real) parameters;                                                                                \
        *(void **)&real = next_of(#name);                                                                      \
        if (strikes()) {                                                                                       \
            TEAR(real);                                                                                        \
            raise(SIGKILL);                                                                                    \
        }                                                                                                      \
        return real arguments;                                                                                 \
    }

#define TEAR(real) (void)!real(file, bytes, size / 2)
FORWARD(ssize_t, write, (int file, const void *bytes, size_t size), (file, bytes, size))
#undef TEAR
#define TEAR(real) (void)!real(file, bytes, size / 2, at)
FORWARD(ssize_t, pwrite64, (int file, const void *bytes, size_t size, off_t at), (file, bytes, size, at))
FORWARD(ssize_t, pwrite, (int file, const void *bytes, size_t size, off_t at), (file, bytes, size, at))
#undef TEAR
#define TEAR(real) (void)real
FORWARD(int, fsync, (int file), (file))
FORWARD(int, fdatasync, (int file), (file))
FORWARD(int, ftruncate64, (int file, off_t size), (file, size))
FORWARD(int, ftruncate, (int file, off_t size), (file, size))
FORWARD(int, unlink, (const char *path), (path))
