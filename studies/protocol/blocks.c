#include "studies/protocol/parts.h"

#include <stdio.h>
#include <string.h>

const char *protocol_kind_name(enum protocol_kind kind)
{
    return language_find(&language_block, "kind")->words[kind];
}

const char *protocol_role_name(enum protocol_role role)
{
    return language_find(&language_level, "role")->words[role];
}

bool protocol_kind_is_pair(enum protocol_kind kind)
{
    return kind != PROTOCOL_RATE && kind != PROTOCOL_TASK;
}

static bool block_options_read(struct reader *reader, const struct yaml_node *map, struct protocol_block *block)
{
    const struct yaml_node *list = yaml_get(map, "options");
    const char *names[PROTOCOL_OPTIONS + 1];
    char what[64];
    bool pair = protocol_kind_is_pair(block->kind);
    option_names(reader, names);
    snprintf(what, sizeof what, "options of a %s block", protocol_kind_name(block->kind));
    uint32_t least = pair ? 2 : 1, most = block->kind == PROTOCOL_TASK ? 1 : 2;
    if (!read_is_list(reader, list, what, least, most))
        return false;
    return key_names(reader, map, &language_block, "options", "option", names, most, block->options,
                     &block->option_count);
}

static bool block_scenes_read(struct reader *reader, const struct yaml_node *map, struct protocol_block *block)
{
    const char *names[PROTOCOL_SCENES + 1];
    uint32_t use = block->kind == PROTOCOL_RATE ? PROTOCOL_RANDOM : PROTOCOL_ALTERNATE;
    scene_names(reader, names);
    for (uint32_t i = 0; i < reader->protocol->scene_count; i++)
        block->scenes[block->scene_count++] = i;
    if (!key_names(reader, map, &language_block, "scenes", "scene", names, PROTOCOL_SCENES, block->scenes,
                   &block->scene_count) ||
        !key_word(reader, map, &language_block, "scene_use", &use))
        return false;
    block->scene_use = (enum protocol_scene_use)use;
    return true;
}

// A block that comes later, or itself, can be no complement's first half.
static bool later_check(struct reader *reader, const struct yaml_node *map, const struct yaml_node *node)
{
    bool later = false;
    for (; map && node->kind == YAML_SCALAR; map = map->next, later = true) {
        const struct yaml_node *name = map->kind == YAML_MAP ? yaml_get(map, "name") : NULL;
        if (!name || name->kind != YAML_SCALAR || strcmp(name->text, node->text) != 0)
            continue;
        return later ? read_fail(reader, node,
                                 "block '%.60s' comes later; a complement names an earlier one, so "
                                 "turn the two around",
                                 node->text)
                     : read_fail(reader, node,
                                 "block '%.60s' cannot be the complement of itself; name the block "
                                 "before it",
                                 node->text);
    }
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
    if (!later_check(reader, map, node) || !read_word(reader, node, "complement_of", names, &index))
        return false;
    const struct protocol_block *earlier = &protocol->blocks[index];
    if (block->kind != PROTOCOL_RATE || earlier->kind != PROTOCOL_RATE || earlier->complement_of >= 0)
        return read_fail(reader, node,
                         "a complement is a rate block that rates the other option of an earlier one; %s%s%s",
                         block->kind == PROTOCOL_RATE ? "block '" : "this is none",
                         block->kind != PROTOCOL_RATE ? "" : earlier->name,
                         block->kind != PROTOCOL_RATE     ? ""
                         : earlier->kind != PROTOCOL_RATE ? "' is none"
                                                          : "' is a complement itself");
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

// A rate block of two options is one rating, of the option drawn; one of a single option has a design as others
// have.
static bool drawn_rating_check(struct reader *reader, const struct yaml_node *map,
                               const struct protocol_block *block)
{
    static const char *const designs[] = {"factors", "trials", "repetitions", "order", NULL};
    for (uint32_t i = 0; designs[i] && block->kind == PROTOCOL_RATE && block->option_count == 2; i++) {
        const struct yaml_node *node = yaml_get(map, designs[i]);
        if (node)
            return read_fail_key(
                reader, node,
                "a rate block of two options is one rating of the option drawn; for %s name one "
                "option",
                designs[i]);
    }
    return true;
}

// A block without what makes it its kind: said before anything that follows from it.
static bool kind_check(struct reader *reader, const struct yaml_node *map, const struct protocol_block *block)
{
    if (block->kind == PROTOCOL_ADJUST)
        return read_required(reader, map, "the adjust block", "adjust") != NULL;
    return block->kind != PROTOCOL_STAIRCASE ||
           read_required(reader, map, "the staircase block", "staircase") != NULL;
}

static bool design_read(struct reader *reader, const struct yaml_node *map, struct protocol_block *block)
{
    uint32_t order = PROTOCOL_ORDER_RANDOM;
    block->repetitions = 1;
    if (!kind_check(reader, map, block) || !drawn_rating_check(reader, map, block) ||
        !key_integer(reader, map, &language_block, "repetitions", &block->repetitions) ||
        !key_word(reader, map, &language_block, "order", &order) || !cells_read(reader, map, block) ||
        !extras_read(reader, map, block) || !adjusts_read(reader, map, block))
        return false;
    block->order = (enum protocol_order)order;
    if (!staircase_read(reader, map, block))
        return false;
    if (protocol_block_trials(block) > PROTOCOL_TRIALS)
        return read_fail(reader, map, "block '%s' has %u trials; at most %d fit", block->name,
                         protocol_block_trials(block), PROTOCOL_TRIALS);
    return true;
}

static bool block_read(struct reader *reader, const struct yaml_node *map, struct protocol_block *block)
{
    struct protocol *protocol = reader->protocol;
    const struct language_section *section = &language_block;
    uint32_t kind = 0, role = 0;
    if (!read_section(reader, map, section, NULL) || !key_name(reader, map, section, "name", block->name))
        return false;
    for (uint32_t i = 0; i < protocol->block_count; i++)
        if (strcmp(protocol->blocks[i].name, block->name) == 0)
            return read_fail(reader, yaml_get(map, "name"), "block '%s' stands here twice; rename one",
                             block->name);
    if (!key_text(reader, map, "instructions", "", &block->instructions) ||
        !key_word(reader, map, section, "kind", &kind) || !key_word(reader, map, section, "role", &role) ||
        !key_integer(reader, map, section, "break_every", &block->break_every) ||
        !key_seconds(reader, map, section, "break_s", &block->break_ns))
        return false;
    block->kind = (enum protocol_kind)kind;
    block->role = (enum protocol_role)role;
    return settings_read(reader, yaml_get(map, "settings"), &block->settings) &&
           block_options_read(reader, map, block) && block_scenes_read(reader, map, block) &&
           complement_read(reader, map, block) && design_read(reader, map, block);
}

// Factors of one name assign people to the same groups, so they must have the same levels.
static bool groups_check(struct reader *reader, const struct yaml_node *map)
{
    const struct protocol *protocol = reader->protocol;
    const struct protocol_block *block = &protocol->blocks[protocol->block_count];
    for (uint32_t f = 0; f < block->factor_count; f++) {
        const struct protocol_factor *mine = &block->factors[f];
        for (uint32_t b = 0; b < protocol->block_count && mine->between; b++) {
            for (uint32_t g = 0; g < protocol->blocks[b].factor_count; g++) {
                const struct protocol_factor *other = &protocol->blocks[b].factors[g];
                if (!other->between || strcmp(other->name, mine->name) != 0)
                    continue;
                if (other->level_count != mine->level_count ||
                    memcmp(other->level, mine->level, sizeof mine->level) != 0)
                    return read_fail(reader, map,
                                     "factor '%s' has other levels here than in block '%s'; people have "
                                     "one level for the whole study",
                                     mine->name, protocol->blocks[b].name);
            }
        }
    }
    return true;
}

bool blocks_read(struct reader *reader, const struct yaml_node *root, const struct protocol_settings *study)
{
    struct protocol *protocol = reader->protocol;
    const struct yaml_node *list = yaml_get(root, "blocks");
    if (!read_is_list(reader, list, "blocks", 1, PROTOCOL_BLOCKS))
        return false;
    for (const struct yaml_node *node = list->first; node; node = node->next) {
        protocol->blocks[protocol->block_count].settings = *study;
        protocol->block_places[protocol->block_count] = (struct protocol_place){node->line, node->column};
        if (!block_read(reader, node, &protocol->blocks[protocol->block_count]) || !groups_check(reader, node))
            return false;
        protocol->block_count++;
    }
    if (protocol_groups(protocol) > PROTOCOL_GROUPS)
        return read_fail(reader, list, "factors between participants make %u groups of people; at most %d fit",
                         protocol_groups(protocol), PROTOCOL_GROUPS);
    return true;
}

// The next between-participant factor of another name than all before it; NULL: none is left. *at begins at 0.
static const struct protocol_factor *next_group_factor(const struct protocol *protocol, uint32_t *at)
{
    for (; *at < protocol->block_count * PROTOCOL_FACTORS; ++*at) {
        const struct protocol_block *block = &protocol->blocks[*at / PROTOCOL_FACTORS];
        const struct protocol_factor *factor = &block->factors[*at % PROTOCOL_FACTORS];
        bool known = *at % PROTOCOL_FACTORS >= block->factor_count || !factor->between;
        for (uint32_t i = 0; i < *at && !known; i++) {
            const struct protocol_factor *other =
                &protocol->blocks[i / PROTOCOL_FACTORS].factors[i % PROTOCOL_FACTORS];
            known = other->between && strcmp(other->name, factor->name) == 0;
        }
        if (!known) {
            ++*at;
            return factor;
        }
    }
    return NULL;
}

uint32_t protocol_groups(const struct protocol *protocol)
{
    uint32_t groups = 1, at = 0;
    for (const struct protocol_factor *factor;
         (factor = next_group_factor(protocol, &at)) && groups <= PROTOCOL_GROUPS;)
        groups *= factor->level_count;
    return groups;
}

uint32_t protocol_group_level(const struct protocol *protocol, uint32_t group, const char *name)
{
    uint32_t at = 0;
    for (const struct protocol_factor *factor; (factor = next_group_factor(protocol, &at));) {
        if (strcmp(factor->name, name) == 0)
            return group % factor->level_count;
        group /= factor->level_count;
    }
    return 0;
}

uint32_t protocol_block_cells(const struct protocol_block *block)
{
    uint32_t cells = block->cell_count;
    for (uint32_t f = 0; f < block->factor_count; f++)
        cells /= block->factors[f].between ? block->factors[f].level_count : 1;
    return cells;
}

uint32_t protocol_block_trials(const struct protocol_block *block)
{
    return protocol_block_cells(block) * block->repetitions + block->extras[0].count + block->extras[1].count;
}
