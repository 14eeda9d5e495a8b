#include "studies/protocol/parts.h"

#include <stdio.h>
#include <string.h>

const struct catalogue_mode *catalogue_find(const struct catalogue *catalogue, const char *mode)
{
    for (uint32_t i = 0; i < catalogue->mode_count; i++)
        if (strcmp(catalogue->modes[i].name, mode) == 0)
            return &catalogue->modes[i];
    return NULL;
}

bool parameter_read(struct reader *reader, const struct yaml_node *node,
                    const struct catalogue_parameter *parameter, const char *mode, double *out)
{
    char what[160];
    snprintf(what, sizeof what, "%.60s.%.60s", mode, parameter->name);
    if (!parameter->choices)
        return read_number(reader, node, what, parameter->min, parameter->max, out);
    uint32_t index;
    if (!read_word(reader, node, what, parameter->choices, &index))
        return false;
    *out = index;
    return true;
}

bool parameter_find(struct reader *reader, const struct yaml_node *node, bool at_key, const char *word,
                    uint32_t mode, uint32_t *out)
{
    const struct catalogue_mode *found = &reader->catalogue->modes[mode];
    const char *names[CATALOGUE_PARAMETERS + 1] = {NULL};
    for (uint32_t i = 0; i < found->parameter_count && i < CATALOGUE_PARAMETERS; i++) {
        names[i] = found->parameters[i].name;
        if (strcmp(names[i], word) == 0) {
            *out = i;
            return true;
        }
    }
    char what[PROTOCOL_NAME + 32];
    snprintf(what, sizeof what, "parameter of %.60s", found->name);
    for (uint32_t i = 0; i < found->parameter_count && i < CATALOGUE_PARAMETERS; i++)
        names[i] = found->parameters[i].name;
    return read_unknown(reader, node, at_key, what, word, names);
}

bool option_find(struct reader *reader, const struct yaml_node *node, bool at_key, const char *word,
                 uint32_t *out)
{
    const char *names[PROTOCOL_OPTIONS + 1] = {NULL};
    for (uint32_t i = 0; i < reader->protocol->option_count; i++) {
        names[i] = reader->protocol->options[i].name;
        if (strcmp(names[i], word) == 0) {
            *out = i;
            return true;
        }
    }
    return read_unknown(reader, node, at_key, "option", word, names);
}

bool scene_find(struct reader *reader, const struct yaml_node *node, uint32_t *out)
{
    const char *names[PROTOCOL_SCENES + 1] = {NULL};
    for (uint32_t i = 0; i < reader->protocol->scene_count; i++)
        names[i] = reader->protocol->scenes[i];
    return read_word(reader, node, "scene", names, out);
}

bool scenes_read(struct reader *reader, const struct yaml_node *root)
{
    struct protocol *protocol = reader->protocol;
    const struct yaml_node *list = read_required(reader, root, "the protocol", "scenes");
    if (!list || !read_is_list(reader, list, "scenes", 1, PROTOCOL_SCENES))
        return false;
    const char *known[64] = {NULL};
    for (uint32_t i = 0; i < reader->catalogue->scene_count && i < 63; i++)
        known[i] = reader->catalogue->scenes[i];
    for (const struct yaml_node *node = list->first; node; node = node->next) {
        char *name = protocol->scenes[protocol->scene_count];
        uint32_t index;
        if (!read_name(reader, node, "scene", name) || !read_word(reader, node, "scene", known, &index))
            return false;
        for (uint32_t i = 0; i < protocol->scene_count; i++)
            if (strcmp(protocol->scenes[i], name) == 0)
                return read_fail(reader, node, "scene '%s' stands here twice; keep one", name);
        protocol->scene_count++;
    }
    return true;
}

static bool mode_read(struct reader *reader, const struct yaml_node *node, uint32_t *out)
{
    const char *known[64] = {NULL};
    for (uint32_t i = 0; i < reader->catalogue->mode_count && i < 63; i++)
        known[i] = reader->catalogue->modes[i].name;
    return read_word(reader, node, "mode", known, out);
}

static bool option_read(struct reader *reader, const struct yaml_node *node, struct protocol_option *option)
{
    struct yaml_node name = *node;
    name.kind = YAML_SCALAR;
    name.text = node->key;
    name.line = node->key_line;
    name.column = node->key_column;
    if (!read_name(reader, &name, "option", option->name) || !read_is_map(reader, node, "an option"))
        return false;
    const struct yaml_node *mode = read_required(reader, node, "the option", "mode");
    if (!mode || !mode_read(reader, mode, &option->mode))
        return false;
    const struct catalogue_mode *found = &reader->catalogue->modes[option->mode];
    for (uint32_t i = 0; i < found->parameter_count && i < CATALOGUE_PARAMETERS; i++)
        option->values[i] = found->parameters[i].fallback;
    for (const struct yaml_node *each = node->first; each; each = each->next) {
        uint32_t index;
        if (each == mode)
            continue;
        if (!parameter_find(reader, each, true, each->key, option->mode, &index) ||
            !parameter_read(reader, each, &found->parameters[index], found->name, &option->values[index]))
            return false;
    }
    return true;
}

bool options_read(struct reader *reader, const struct yaml_node *root)
{
    struct protocol *protocol = reader->protocol;
    const struct yaml_node *map = read_required(reader, root, "the protocol", "options");
    if (!map || !read_is_map(reader, map, "options"))
        return false;
    if (map->count == 0 || map->count > PROTOCOL_OPTIONS)
        return read_fail(reader, map, "options has %u entries; it takes 1 to %d", map->count, PROTOCOL_OPTIONS);
    for (const struct yaml_node *node = map->first; node; node = node->next) {
        if (!option_read(reader, node, &protocol->options[protocol->option_count]))
            return false;
        protocol->option_count++;
    }
    const struct yaml_node *reference = read_required(reader, root, "the protocol", "reference");
    char name[PROTOCOL_NAME];
    return reference && read_name(reader, reference, "reference", name) &&
           option_find(reader, reference, false, name, &protocol->reference);
}
