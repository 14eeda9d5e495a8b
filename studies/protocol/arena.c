#include "studies/protocol/arena.h"

#include <stdlib.h>
#include <string.h>

struct arena_piece {
    struct arena_piece *next;
    max_align_t data[];
};

void *arena_zeroed(struct arena *arena, size_t size)
{
    struct arena_piece *piece = calloc(1, sizeof(*piece) + size);
    if (!piece)
        return NULL;
    piece->next = arena->pieces;
    arena->pieces = piece;
    return piece->data;
}

char *arena_text(struct arena *arena, const char *text, size_t length)
{
    char *copy = arena_zeroed(arena, length + 1);
    if (copy && length)
        memcpy(copy, text, length);
    return copy;
}

void arena_free(struct arena *arena)
{
    while (arena->pieces) {
        struct arena_piece *next = arena->pieces->next;
        free(arena->pieces);
        arena->pieces = next;
    }
}
