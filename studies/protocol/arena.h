// Memory that is handed out in pieces and given back all at once.
#ifndef STUDIES_PROTOCOL_ARENA_H
#define STUDIES_PROTOCOL_ARENA_H

#include <stddef.h>

struct arena_piece;
struct arena {
    struct arena_piece *pieces;
};

void *arena_zeroed(struct arena *arena, size_t size);                   // NULL: out of memory
char *arena_text(struct arena *arena, const char *text, size_t length); // a terminated copy
void arena_free(struct arena *arena);

#endif
