// Typed values out of the YAML tree, and the one place where a protocol's errors are worded and placed.
//
// Every function returns false after writing the error; callers pass that up at once, so the first error stays.
#ifndef STUDIES_PROTOCOL_READ_H
#define STUDIES_PROTOCOL_READ_H

#include "studies/protocol/language.h"
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
// A sentence for protocol.remarks, placed at the node, or at its name where it has one.
void read_remark(struct reader *reader, const struct yaml_node *node, const char *format, ...)
    __attribute__((format(printf, 3, 4)));
// "WHAT 'word' is not known here; did you mean 'nearest'?" or the list of what is; known ends with NULL.
bool read_unknown(struct reader *reader, const struct yaml_node *node, bool at_key, const char *what,
                  const char *word, const char *const *known);
// The known word nearest to a misspelt one by edit distance, NULL where none is near (more than a third
// differs).
const char *read_nearest(const char *word, const char *const *known);

bool read_is_map(struct reader *reader, const struct yaml_node *node, const char *what);
// Says how many entries a list or a mapping takes.
bool read_fail_count(struct reader *reader, const struct yaml_node *node, const char *what, uint32_t min,
                     uint32_t max);
bool read_is_list(struct reader *reader, const struct yaml_node *node, const char *what, uint32_t min,
                  uint32_t max);
// A mapping whose keys are those of the section or, where it is open, of `more` (NULL: none), with all that are
// required.
bool read_section(struct reader *reader, const struct yaml_node *map, const struct language_section *section,
                  const char *const *more);
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

// A key of a section by its type, range and words; where the mapping lacks it, *out stays and the result is
// true.
bool key_name(struct reader *reader, const struct yaml_node *map, const struct language_section *section,
              const char *key, char out[PROTOCOL_NAME]);
bool key_text(struct reader *reader, const struct yaml_node *map, const char *key, const char *fallback,
              char **out);
bool key_number(struct reader *reader, const struct yaml_node *map, const struct language_section *section,
                const char *key, double *out);
bool key_integer(struct reader *reader, const struct yaml_node *map, const struct language_section *section,
                 const char *key, uint32_t *out);
bool key_seconds(struct reader *reader, const struct yaml_node *map, const struct language_section *section,
                 const char *key, int64_t *out_ns);
bool key_word(struct reader *reader, const struct yaml_node *map, const struct language_section *section,
              const char *key, uint32_t *out_index);
// Two whole numbers in order, both within the range of the list's items.
bool key_range(struct reader *reader, const struct yaml_node *map, const struct language_section *section,
               const char *key, int64_t out[2]);
// A name or a list of names, each one of `known`; at most `capacity` indices, none twice.
bool key_names(struct reader *reader, const struct yaml_node *map, const struct language_section *section,
               const char *key, const char *what, const char *const *known, uint32_t capacity, uint32_t *out,
               uint32_t *out_count);
// The key of a node in its mapping as a name of the file's own.
bool read_key_name(struct reader *reader, const struct yaml_node *node, const char *what,
                   char out[PROTOCOL_NAME]);
// {name: value, ...} as JSON members, each after a comma; values are names or numbers.
bool key_labels(struct reader *reader, const struct yaml_node *map, const char *key, char out[PROTOCOL_LABELS]);

#endif
