#include "studies/protocol/parts.h"

#include <stdio.h>
#include <string.h>

static const char *const kinds[] = {"toggle", "rate", NULL};
static const char *const scene_uses[] = {"alternate", "random", NULL};
static const char *const orders[] = {"random", "fixed", NULL};

const char *protocol_kind_name(enum protocol_kind kind)
{
    return kinds[kind];
}

static bool kind_read(struct reader *reader, const struct yaml_node *map, struct protocol_block *block)
{
    // Kinds of DESIGN section 4 that are no misspelling, only not for this version.
    static const char *const later[] = {"sequential", "adjust", "staircase", "task",
                                        "practice",   "catch",  "null",      NULL};
    const struct yaml_node *node = read_required(reader, map, "the block", "kind");
    if (!node)
        return false;
    for (uint32_t i = 0; node->kind == YAML_SCALAR && later[i]; i++)
        if (strcmp(later[i], node->text) == 0)
            return read_fail(reader, node, "kind '%s' is not run by this version; it runs toggle and rate",
                             later[i]);
    uint32_t index;
    if (!read_word(reader, node, "kind", kinds, &index))
        return false;
    block->kind = (enum protocol_kind)index;
    return true;
}

static bool block_options_read(struct reader *reader, const struct yaml_node *map, struct protocol_block *block)
{
    const struct yaml_node *list = read_required(reader, map, "the block", "options");
    bool toggle = block->kind == PROTOCOL_TOGGLE;
    if (!list || !read_is_list(reader, list, toggle ? "options of a toggle block" : "options of a rate block",
                               toggle ? 2 : 1, 2))
        return false;
    for (const struct yaml_node *node = list->first; node; node = node->next) {
        char name[PROTOCOL_NAME];
        uint32_t index;
        if (!read_name(reader, node, "option", name) || !option_find(reader, node, false, name, &index))
            return false;
        block->options[block->option_count++] = index;
    }
    if (block->option_count == 2 && block->options[0] == block->options[1])
        return read_fail(reader, list, "both options are '%s'; name two",
                         reader->protocol->options[block->options[0]].name);
    return true;
}

static bool block_scenes_read(struct reader *reader, const struct yaml_node *map, struct protocol_block *block)
{
    const struct yaml_node *list = yaml_get(map, "scenes"), *use = yaml_get(map, "scene_use");
    if (!list) {
        for (uint32_t i = 0; i < reader->protocol->scene_count; i++)
            block->scenes[block->scene_count++] = i;
    } else {
        if (!read_is_list(reader, list, "scenes", 1, PROTOCOL_SCENES))
            return false;
        for (const struct yaml_node *node = list->first; node; node = node->next) {
            if (!scene_find(reader, node, &block->scenes[block->scene_count]))
                return false;
            for (uint32_t i = 0; i < block->scene_count; i++)
                if (block->scenes[i] == block->scenes[block->scene_count])
                    return read_fail(reader, node, "scene '%s' stands here twice; keep one", node->text);
            block->scene_count++;
        }
    }
    uint32_t index = block->kind == PROTOCOL_RATE ? PROTOCOL_RANDOM : PROTOCOL_ALTERNATE;
    if (use && !read_word(reader, use, "scene_use", scene_uses, &index))
        return false;
    block->scene_use = (enum protocol_scene_use)index;
    return true;
}

static bool complement_read(struct reader *reader, const struct yaml_node *map, struct protocol_block *block)
{
    struct protocol *protocol = reader->protocol;
    const struct yaml_node *node = yaml_get(map, "complement_of");
    block->complement_of = -1;
    if (!node)
        return true;
    const char *names[PROTOCOL_BLOCKS + 1] = {NULL};
    for (uint32_t i = 0; i < protocol->block_count; i++)
        names[i] = protocol->blocks[i].name;
    uint32_t index;
    if (!read_word(reader, node, "complement_of", names, &index))
        return false;
    const struct protocol_block *earlier = &protocol->blocks[index];
    if (block->kind != PROTOCOL_RATE || earlier->kind != PROTOCOL_RATE || earlier->complement_of >= 0)
        return read_fail(reader, node,
                         "a complement is a rate block of an earlier rate block that is none itself");
    if (block->option_count != 2 || memcmp(block->options, earlier->options, sizeof block->options) != 0)
        return read_fail(reader, node,
                         "block '%s' and its complement need the same two options in the same order",
                         earlier->name);
    if (yaml_get(map, "scenes") || yaml_get(map, "scene_use"))
        return read_fail(reader, node, "a complement repeats the scene of '%s'; remove its own scenes",
                         earlier->name);
    block->complement_of = (int32_t)index;
    return true;
}

static bool question_check(struct reader *reader, const struct yaml_node *node,
                           const struct protocol_block *block, const struct protocol_settings *settings)
{
    const struct protocol *protocol = reader->protocol;
    if (settings->question >= protocol->question_count)
        return read_fail(reader, node, "block '%s' asks no question; set 'question' in its settings",
                         block->name);
    const struct protocol_question *question = &protocol->questions[settings->question];
    bool scale = question->scale_min < question->scale_max;
    if (block->kind == PROTOCOL_RATE && !scale)
        return read_fail(reader, node, "block '%s' rates, but question '%s' has no 'scale'; add one",
                         block->name, question->name);
    if (block->kind == PROTOCOL_TOGGLE && scale)
        return read_fail(reader, node, "block '%s' lets one choose, but question '%s' has a scale; ask another",
                         block->name, question->name);
    return true;
}

static bool design_read(struct reader *reader, const struct yaml_node *map, struct protocol_block *block)
{
    const struct yaml_node *factors = yaml_get(map, "factors"), *trials = yaml_get(map, "trials"),
                           *repetitions = yaml_get(map, "repetitions"), *order = yaml_get(map, "order");
    if (factors && trials)
        return read_fail_key(reader, trials, "a block has either factors or trials; remove one");
    if (block->kind == PROTOCOL_RATE && (factors || trials || repetitions))
        return read_fail_key(reader,
                             factors  ? factors
                             : trials ? trials
                                      : repetitions,
                             "a rate block is one rating; factors, trials and repetitions need 'kind: toggle'");
    int64_t count = 1;
    uint32_t index = 0;
    if (repetitions && !read_integer(reader, repetitions, "repetitions", 1, PROTOCOL_TRIALS, &count))
        return false;
    block->repetitions = (uint32_t)count;
    if (order && !read_word(reader, order, "order", orders, &index))
        return false;
    block->order = (enum protocol_order)index;
    if (factors && !factors_read(reader, factors, block))
        return false;
    if (trials && !trials_read(reader, trials, block))
        return false;
    if (protocol_block_trials(block) > PROTOCOL_TRIALS)
        return read_fail(reader, map, "block '%s' has %u trials; at most %d fit", block->name,
                         protocol_block_trials(block), PROTOCOL_TRIALS);
    for (uint32_t i = 0; i < block->listed_count; i++)
        if (!question_check(reader, map, block, &block->trials[i].settings))
            return false;
    return true;
}

static bool block_read(struct reader *reader, const struct yaml_node *map, struct protocol_block *block)
{
    static const char *const known[] = {"name",          "kind",         "options", "scenes",      "scene_use",
                                        "complement_of", "factors",      "trials",  "repetitions", "order",
                                        "settings",      "instructions", NULL};
    struct protocol *protocol = reader->protocol;
    if (!read_keys(reader, map, "a block", known))
        return false;
    const struct yaml_node *name = read_required(reader, map, "the block", "name");
    if (!name || !read_name(reader, name, "block", block->name))
        return false;
    for (uint32_t i = 0; i < protocol->block_count; i++)
        if (strcmp(protocol->blocks[i].name, block->name) == 0)
            return read_fail(reader, name, "block '%s' stands here twice; rename one", block->name);
    const struct yaml_node *instructions = yaml_get(map, "instructions");
    if (instructions ? !read_text(reader, instructions, "instructions", &block->instructions)
                     : !(block->instructions = arena_text(reader->arena, "", 0)))
        return false;
    return settings_read(reader, yaml_get(map, "settings"), &block->settings) &&
           kind_read(reader, map, block) && block_options_read(reader, map, block) &&
           block_scenes_read(reader, map, block) && complement_read(reader, map, block) &&
           design_read(reader, map, block) &&
           (block->listed_count > 0 || question_check(reader, map, block, &block->settings));
}

bool blocks_read(struct reader *reader, const struct yaml_node *root, const struct protocol_settings *study)
{
    struct protocol *protocol = reader->protocol;
    const struct yaml_node *list = read_required(reader, root, "the protocol", "blocks");
    if (!list || !read_is_list(reader, list, "blocks", 1, PROTOCOL_BLOCKS))
        return false;
    for (const struct yaml_node *node = list->first; node; node = node->next) {
        protocol->blocks[protocol->block_count].settings = *study;
        if (!block_read(reader, node, &protocol->blocks[protocol->block_count]))
            return false;
        protocol->block_count++;
    }
    return true;
}

uint32_t protocol_block_trials(const struct protocol_block *block)
{
    uint64_t cells = block->trials ? block->listed_count : 1;
    for (uint32_t i = 0; i < block->factor_count; i++)
        cells *= block->factors[i].level_count; // at most 16^6
    cells *= block->repetitions;
    return cells > UINT32_MAX ? UINT32_MAX : (uint32_t)cells;
}
