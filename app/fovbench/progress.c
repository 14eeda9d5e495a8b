#include "app/fovbench/progress.h"

#include <stdio.h>
#include <unistd.h>

void progress_show(const char *what, const char *part, uint64_t done, uint64_t all)
{
    if (isatty(STDERR_FILENO))
        fprintf(stderr, "\r\033[K%s: %s %llu of %llu", what, part, (unsigned long long)done,
                (unsigned long long)all);
}

void progress_clear(void)
{
    if (isatty(STDERR_FILENO))
        fprintf(stderr, "\r\033[K");
}
