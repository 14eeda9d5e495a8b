// A YAML text as a small tree whose every node knows its line and column.
//
// libfyaml's events make the tree; of YAML it takes what a protocol needs: mappings with plain names, lists,
// scalars. Refused with a sentence: anchors, aliases (so no file can unfold), tags, several documents, keys
// that are not scalars, keys that come twice, nesting deeper than PROTOCOL_DEPTH, more than YAML_NODES nodes,
// text that is not UTF-8.
#ifndef STUDIES_PROTOCOL_YAML_H
#define STUDIES_PROTOCOL_YAML_H

#include "studies/protocol/arena.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum { YAML_NODES = 20000 };

enum yaml_kind { YAML_SCALAR, YAML_LIST, YAML_MAP };

struct yaml_node {
    enum yaml_kind kind;
    uint32_t line, column; // from 1
    const char *text;      // of a scalar, terminated
    bool quoted;           // a scalar in quotes or a block: never a number, a switch or nothing
    const char *key;       // its name in the mapping above; NULL in a list
    uint32_t key_line, key_column;
    struct yaml_node *first, *last, *next; // children in order
    uint32_t count;
};

struct yaml_error {
    uint32_t line, column;
    char sentence[512]; // without a position
};

// NULL with the error filled. Nodes live in the arena.
struct yaml_node *yaml_parse(const char *text, size_t size, struct arena *arena, struct yaml_error *error);
const struct yaml_node *yaml_get(const struct yaml_node *map, const char *key); // NULL: not there

#endif
