#include "renderer/modes/room.h"

#include <stdarg.h>
#include <stdio.h>

void mode_explain(struct mode_explanation *e, uint64_t bytes, const char *format, ...)
{
    char what[512];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(what, sizeof what, format, arguments);
    va_end(arguments);
    e->bytes += bytes;
    int n =
        snprintf(e->text + e->used, sizeof e->text - e->used, "%9.2f MiB  %s\n", (double)bytes / 1048576, what);
    if (n > 0 && e->used + (size_t)n < sizeof e->text)
        e->used += (size_t)n;
}
