// Typed values out of the YAML tree, and the one place where a protocol's errors are worded and placed.
//
// Every function returns false after writing the error; callers pass that up at once, so the first error stays.
#ifndef STUDIES_PROTOCOL_READ_H
#define STUDIES_PROTOCOL_READ_H

#include "studies/protocol/protocol.h"
#include "studies/protocol/yaml.h"

struct reader {
    const char *file;
    const struct catalogue *catalogue;
    struct protocol *protocol;
    struct arena *arena; // the protocol's own memory
    char *error;
    size_t error_size;
};

bool read_fail(struct reader *reader, const struct yaml_node *node, const char *format, ...)
    __attribute__((format(printf, 3, 4)));
// The same, placed at the node's name in its mapping.
bool read_fail_key(struct reader *reader, const struct yaml_node *node, const char *format, ...)
    __attribute__((format(printf, 3, 4)));
// "WHAT 'word' is not known here; did you mean 'nearest'?" or the list of what is; known ends with NULL.
bool read_unknown(struct reader *reader, const struct yaml_node *node, bool at_key, const char *what,
                  const char *word, const char *const *known);
// The known word nearest to a misspelt one by edit distance, NULL where none is near (more than a third
// differs).
const char *read_nearest(const char *word, const char *const *known);

bool read_is_map(struct reader *reader, const struct yaml_node *node, const char *what);
bool read_is_list(struct reader *reader, const struct yaml_node *node, const char *what, uint32_t min,
                  uint32_t max);
// A mapping whose every key is one of `known`.
bool read_keys(struct reader *reader, const struct yaml_node *map, const char *what, const char *const *known);
const struct yaml_node *read_required(struct reader *reader, const struct yaml_node *map, const char *what,
                                      const char *key); // NULL after an error

bool read_name(struct reader *reader, const struct yaml_node *node, const char *what, char out[PROTOCOL_NAME]);
bool read_text(struct reader *reader, const struct yaml_node *node, const char *what, char **out);
bool read_number(struct reader *reader, const struct yaml_node *node, const char *what, double min, double max,
                 double *out);
bool read_integer(struct reader *reader, const struct yaml_node *node, const char *what, int64_t min,
                  int64_t max, int64_t *out);
bool read_seconds(struct reader *reader, const struct yaml_node *node, const char *what, double max,
                  int64_t *out_ns);
bool read_word(struct reader *reader, const struct yaml_node *node, const char *what, const char *const *words,
               uint32_t *out_index);

#endif
