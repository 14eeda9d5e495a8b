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

void option_names(const struct reader *reader, const char *names[PROTOCOL_OPTIONS + 1])
{
    uint32_t count = 0;
    for (; count < reader->protocol->option_count; count++)
        names[count] = reader->protocol->options[count].name;
    names[count] = NULL;
}

void scene_names(const struct reader *reader, const char *names[PROTOCOL_SCENES + 1])
{
    uint32_t count = 0;
    for (; count < reader->protocol->scene_count; count++)
        names[count] = reader->protocol->scenes[count];
    names[count] = NULL;
}

// A scene's name is known to the program, or bound on the command line, or something stands in for it.
static bool scene_read(struct reader *reader, const struct yaml_node *node, uint32_t place)
{
    struct protocol *protocol = reader->protocol;
    const char *known[64] = {NULL};
    const struct yaml_node *name = node;
    for (uint32_t i = 0; i < reader->catalogue->scene_count && i < 63; i++)
        known[i] = reader->catalogue->scenes[i];
    if (node->kind == YAML_MAP) {
        if (!read_section(reader, node, &language_scene, NULL) ||
            !key_text(reader, node, "stand_in", "", &protocol->stand_ins[place]) ||
            !key_labels(reader, node, "labels", protocol->scene_labels[place]))
            return false;
        name = yaml_get(node, "name");
        const struct yaml_node *stand_in = yaml_get(node, "stand_in");
        if (stand_in)
            protocol->stand_in_places[place] = (struct protocol_place){stand_in->line, stand_in->column};
    } else if (!(protocol->stand_ins[place] = arena_text(reader->arena, "", 0))) {
        return read_fail(reader, node, "out of memory");
    }
    uint32_t index;
    protocol->scene_places[place] = (struct protocol_place){name->line, name->column};
    if (!read_name(reader, name, "scene", protocol->scenes[place]) ||
        (!*protocol->stand_ins[place] && !read_word(reader, name, "scene", known, &index)))
        return false;
    for (uint32_t i = 0; i < place; i++)
        if (strcmp(protocol->scenes[i], protocol->scenes[place]) == 0)
            return read_fail(reader, name, "scene '%s' stands here twice; keep one", protocol->scenes[place]);
    return true;
}

bool scenes_read(struct reader *reader, const struct yaml_node *root)
{
    struct protocol *protocol = reader->protocol;
    const struct yaml_node *list = yaml_get(root, "scenes");
    if (!read_is_list(reader, list, "scenes", 1, PROTOCOL_SCENES))
        return false;
    for (const struct yaml_node *node = list->first; node; node = node->next) {
        if (!scene_read(reader, node, protocol->scene_count))
            return false;
        protocol->scene_count++;
    }
    return true;
}

static bool mode_read(struct reader *reader, const struct yaml_node *node, uint32_t *out)
{
    const char *known[64] = {NULL};
    for (const char *const *each = reader->catalogue->missing_modes; each && *each; each++)
        if (node->kind == YAML_SCALAR && strcmp(*each, node->text) == 0)
            return read_fail(reader, node,
                             "mode '%s' does not exist in this program yet; `fovstudy modes` lists those "
                             "that do",
                             *each);
    for (uint32_t i = 0; i < reader->catalogue->mode_count && i < 63; i++)
        known[i] = reader->catalogue->modes[i].name;
    return read_word(reader, node, "mode", known, out);
}

static bool option_read(struct reader *reader, const struct yaml_node *node, struct protocol_option *option)
{
    uint32_t playback = PROTOCOL_LIVE;
    if (!read_key_name(reader, node, "option", option->name) ||
        !read_section(reader, node, &language_option, NULL) ||
        !mode_read(reader, yaml_get(node, "mode"), &option->mode) ||
        !key_word(reader, node, &language_option, "playback", &playback))
        return false;
    option->playback = (enum protocol_playback)playback;
    const struct catalogue_mode *found = &reader->catalogue->modes[option->mode];
    for (uint32_t i = 0; i < found->parameter_count && i < CATALOGUE_PARAMETERS; i++)
        option->values[i] = found->parameters[i].fallback;
    for (const struct yaml_node *each = node->first; each; each = each->next) {
        uint32_t index;
        if (language_find(&language_option, each->key))
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
    const struct yaml_node *map = yaml_get(root, "options");
    if (!read_is_map(reader, map, "options"))
        return false;
    if (map->count == 0 || map->count > PROTOCOL_OPTIONS)
        return read_fail_count(reader, map, "options", 1, PROTOCOL_OPTIONS);
    for (const struct yaml_node *node = map->first; node; node = node->next) {
        protocol->option_places[protocol->option_count] =
            (struct protocol_place){node->key_line, node->key_column};
        if (!option_read(reader, node, &protocol->options[protocol->option_count]))
            return false;
        protocol->option_count++;
    }
    const struct yaml_node *reference = yaml_get(root, "reference");
    char name[PROTOCOL_NAME];
    return read_name(reader, reference, "reference", name) &&
           option_find(reader, reference, false, name, &protocol->reference);
}
