// Keys of a section, read by what language.c says of them.
#include "studies/protocol/read.h"

#include "studies/protocol/text.h"

#include <stdlib.h>
#include <string.h>

bool key_name(struct reader *reader, const struct yaml_node *map, const struct language_section *section,
              const char *key, char out[PROTOCOL_NAME])
{
    (void)section;
    const struct yaml_node *node = yaml_get(map, key);
    return !node || read_name(reader, node, key, out);
}

bool key_text(struct reader *reader, const struct yaml_node *map, const char *key, const char *fallback,
              char **out)
{
    const struct yaml_node *node = yaml_get(map, key);
    if (node)
        return read_text(reader, node, key, out);
    *out = arena_text(reader->arena, fallback, strlen(fallback));
    return *out ? true : read_fail(reader, map, "out of memory");
}

bool key_number(struct reader *reader, const struct yaml_node *map, const struct language_section *section,
                const char *key, double *out)
{
    const struct yaml_node *node = yaml_get(map, key);
    const struct language_key *known = language_find(section, key);
    return !node || read_number(reader, node, key, known->min, known->max, out);
}

bool key_integer(struct reader *reader, const struct yaml_node *map, const struct language_section *section,
                 const char *key, uint32_t *out)
{
    const struct yaml_node *node = yaml_get(map, key);
    const struct language_key *known = language_find(section, key);
    int64_t value = 0;
    if (!node)
        return true;
    if (!read_integer(reader, node, key, (int64_t)known->min, (int64_t)known->max, &value))
        return false;
    *out = (uint32_t)value;
    return true;
}

bool key_seconds(struct reader *reader, const struct yaml_node *map, const struct language_section *section,
                 const char *key, int64_t *out_ns)
{
    const struct yaml_node *node = yaml_get(map, key);
    return !node || read_seconds(reader, node, key, language_find(section, key)->max, out_ns);
}

bool key_word(struct reader *reader, const struct yaml_node *map, const struct language_section *section,
              const char *key, uint32_t *out_index)
{
    const struct yaml_node *node = yaml_get(map, key);
    return !node || read_word(reader, node, key, language_find(section, key)->words, out_index);
}

bool key_range(struct reader *reader, const struct yaml_node *map, const struct language_section *section,
               const char *key, int64_t out[2])
{
    const struct yaml_node *node = yaml_get(map, key);
    const struct language_key *known = language_find(section, key);
    if (!node)
        return true;
    int64_t min = (int64_t)known->item_min, max = (int64_t)known->item_max;
    if (!read_is_list(reader, node, key, 2, 2) || !read_integer(reader, node->first, key, min, max, &out[0]) ||
        !read_integer(reader, node->last, key, min, max, &out[1]))
        return false;
    if (out[0] > out[1])
        return read_fail(reader, node, "%s ends at %d, below its begin %d; swap them", key, (int)out[1],
                         (int)out[0]);
    return true;
}

static bool one_name(struct reader *reader, const struct yaml_node *node, const char *what,
                     const char *const *known, uint32_t *out, uint32_t count)
{
    if (!read_word(reader, node, what, known, &out[count]))
        return false;
    for (uint32_t i = 0; i < count; i++)
        if (out[i] == out[count])
            return read_fail(reader, node, "%s '%s' stands here twice; keep one", what, node->text);
    return true;
}

bool key_names(struct reader *reader, const struct yaml_node *map, const struct language_section *section,
               const char *key, const char *what, const char *const *known, uint32_t capacity, uint32_t *out,
               uint32_t *out_count)
{
    const struct yaml_node *node = yaml_get(map, key);
    const struct language_key *spec = language_find(section, key);
    if (!node)
        return true;
    *out_count = 0;
    if (node->kind == YAML_SCALAR) {
        *out_count = 1;
        return one_name(reader, node, what, known, out, 0);
    }
    uint32_t least = spec->type == LANGUAGE_NAME ? 1 : (uint32_t)spec->min;
    if (!read_is_list(reader, node, key, least, capacity))
        return false;
    for (const struct yaml_node *each = node->first; each; each = each->next)
        if (!one_name(reader, each, what, known, out, (*out_count)++))
            return false;
    return true;
}

bool read_key_name(struct reader *reader, const struct yaml_node *node, const char *what,
                   char out[PROTOCOL_NAME])
{
    struct yaml_node name = {
        .kind = YAML_SCALAR, .text = node->key, .line = node->key_line, .column = node->key_column};
    return read_name(reader, &name, what, out);
}

bool key_labels(struct reader *reader, const struct yaml_node *map, const char *key, char out[PROTOCOL_LABELS])
{
    const struct yaml_node *node = yaml_get(map, key);
    struct text text = {0};
    char name[PROTOCOL_NAME];
    if (!node)
        return true;
    if (!read_is_map(reader, node, key))
        return false;
    text_add(&text, "%s", out);
    for (const struct yaml_node *each = node->first; each; each = each->next) {
        if (!read_key_name(reader, each, "label", name))
            break;
        text_add(&text, ",\"%s\":", name);
        if (!read_name(reader, each, name, name))
            break;
        text_json_string(&text, name);
        if (!each->next)
            return text_copy(&text, out, PROTOCOL_LABELS)
                       ? true
                       : read_fail(reader, node, "the labels are longer than %d bytes; shorten them",
                                   PROTOCOL_LABELS - 1);
    }
    char *dropped = text_take(&text);
    free(dropped);
    return node->count == 0;
}
