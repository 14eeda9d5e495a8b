// What a block runs through: factors with levels, or trials listed one by one.
#include "studies/protocol/parts.h"

#include <stdio.h>
#include <string.h>

static bool levels_read(struct reader *reader, const struct yaml_node *list, struct protocol_factor *factor)
{
    const struct catalogue_mode *mode =
        &reader->catalogue->modes[reader->protocol->options[factor->option].mode];
    const struct catalogue_parameter *parameter = &mode->parameters[factor->parameter];
    if (!read_is_list(reader, list, "levels", 1, PROTOCOL_LEVELS))
        return false;
    for (const struct yaml_node *node = list->first; node; node = node->next) {
        double value;
        if (!parameter_read(reader, node, parameter, mode->name, &value))
            return false;
        for (uint32_t i = 0; i < factor->level_count; i++)
            if (factor->levels[i] <= value && factor->levels[i] >= value)
                return read_fail(reader, node, "level %.60s of '%s' stands here twice; keep one", node->text,
                                 factor->name);
        factor->levels[factor->level_count++] = value;
    }
    return true;
}

// Long form {option, parameter, levels} or short form: the list of levels of the tested option's parameter.
static bool factor_read(struct reader *reader, const struct yaml_node *node, const struct protocol_block *block,
                        struct protocol_factor *factor)
{
    static const char *const known[] = {"option", "parameter", "levels", NULL};
    struct yaml_node key = {
        .kind = YAML_SCALAR, .text = node->key, .line = node->key_line, .column = node->key_column};
    if (!read_name(reader, &key, "factor", factor->name))
        return false;
    factor->option = block->options[0];
    const struct yaml_node *levels = node, *parameter = &key;
    if (node->kind == YAML_MAP) {
        if (!read_keys(reader, node, "a factor", known))
            return false;
        const struct yaml_node *option = yaml_get(node, "option");
        char name[PROTOCOL_NAME];
        if (option && (!read_name(reader, option, "option", name) ||
                       !option_find(reader, option, false, name, &factor->option)))
            return false;
        if (factor->option != block->options[0] && factor->option != block->options[1])
            return read_fail(reader, option, "option '%s' is not shown in block '%s'; name one that is", name,
                             block->name);
        if (yaml_get(node, "parameter"))
            parameter = yaml_get(node, "parameter");
        levels = read_required(reader, node, "the factor", "levels");
        if (!levels)
            return false;
    }
    char name[PROTOCOL_NAME];
    return read_name(reader, parameter, "parameter", name) &&
           parameter_find(reader, parameter, false, name, reader->protocol->options[factor->option].mode,
                          &factor->parameter) &&
           levels_read(reader, levels, factor);
}

bool factors_read(struct reader *reader, const struct yaml_node *map, struct protocol_block *block)
{
    if (!read_is_map(reader, map, "factors"))
        return false;
    if (map->count > PROTOCOL_FACTORS)
        return read_fail(reader, map, "factors has %u entries; it takes up to %d", map->count,
                         PROTOCOL_FACTORS);
    for (const struct yaml_node *node = map->first; node; node = node->next) {
        struct protocol_factor *factor = &block->factors[block->factor_count];
        if (!factor_read(reader, node, block, factor))
            return false;
        for (uint32_t i = 0; i < block->factor_count; i++)
            if (block->factors[i].option == factor->option && block->factors[i].parameter == factor->parameter)
                return read_fail_key(reader, node, "factor '%s' varies the same parameter as '%s'; keep one",
                                     factor->name, block->factors[i].name);
        block->factor_count++;
    }
    return true;
}

// {option: {parameter: value}} laid over the block's two options.
static bool overrides_read(struct reader *reader, const struct yaml_node *map,
                           const struct protocol_block *block, struct protocol_trial *trial)
{
    if (!read_is_map(reader, map, "parameters"))
        return false;
    for (const struct yaml_node *node = map->first; node; node = node->next) {
        uint32_t option;
        if (!option_find(reader, node, true, node->key, &option))
            return false;
        if (option != block->options[0] && option != block->options[1])
            return read_fail_key(reader, node, "option '%s' is not shown in block '%s'; name one that is",
                                 node->key, block->name);
        if (!read_is_map(reader, node, "an option's parameters"))
            return false;
        struct protocol_option *target = option == block->options[0] ? &trial->a : &trial->b;
        const struct catalogue_mode *mode = &reader->catalogue->modes[target->mode];
        for (const struct yaml_node *each = node->first; each; each = each->next) {
            uint32_t index;
            if (!parameter_find(reader, each, true, each->key, target->mode, &index) ||
                !parameter_read(reader, each, &mode->parameters[index], mode->name, &target->values[index]))
                return false;
        }
    }
    return true;
}

static bool trial_read(struct reader *reader, const struct yaml_node *map, const struct protocol_block *block,
                       struct protocol_trial *trial)
{
    static const char *const known[] = {"name", "scene", "parameters", "settings", NULL};
    const struct protocol *protocol = reader->protocol;
    *trial = (struct protocol_trial){.scene = -1,
                                     .a = protocol->options[block->options[0]],
                                     .b = protocol->options[block->options[1]],
                                     .settings = block->settings};
    if (!read_keys(reader, map, "a trial", known))
        return false;
    const struct yaml_node *name = yaml_get(map, "name"), *scene = yaml_get(map, "scene"),
                           *parameters = yaml_get(map, "parameters");
    if (name && !read_name(reader, name, "trial", trial->name))
        return false;
    if (scene) {
        uint32_t index;
        if (!scene_find(reader, scene, &index))
            return false;
        trial->scene = (int32_t)index;
    }
    if (parameters && !overrides_read(reader, parameters, block, trial))
        return false;
    return settings_read(reader, yaml_get(map, "settings"), &trial->settings);
}

bool trials_read(struct reader *reader, const struct yaml_node *list, struct protocol_block *block)
{
    if (!read_is_list(reader, list, "trials", 1, PROTOCOL_TRIALS))
        return false;
    block->trials = arena_zeroed(reader->arena, list->count * sizeof *block->trials);
    if (!block->trials)
        return read_fail(reader, list, "out of memory");
    for (const struct yaml_node *node = list->first; node; node = node->next) {
        if (!trial_read(reader, node, block, &block->trials[block->listed_count]))
            return false;
        block->listed_count++;
    }
    return true;
}
