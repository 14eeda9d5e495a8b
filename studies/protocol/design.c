// What a block runs through, resolved into cells: factors with levels, or trials listed one by one.
//
// Every form of a factor becomes a list of the long form's levels, {option, scene, parameters, settings}, which
// are laid over the block one factor after the other; those that say which option is shown come first, so that
// the order of factors in the file does not matter to parameters.
#include "studies/protocol/parts.h"

#include "studies/protocol/text.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct levels {
    const struct yaml_node *change[PROTOCOL_LEVELS];
    char varies[2 * PROTOCOL_NAME + 16]; // what: two factors may not vary the same; "" for the long form
};

// A mapping with one member, placed where the value stands.
static struct yaml_node *wrap(struct reader *reader, const char *key, const struct yaml_node *at,
                              const struct yaml_node *value)
{
    struct yaml_node *map = arena_zeroed(reader->arena, 2 * sizeof *map), *child = map + 1;
    if (!map || !value)
        return NULL;
    *child = *value;
    child->key = key;
    child->key_line = at->line;
    child->key_column = at->column;
    child->next = NULL;
    *map = (struct yaml_node){.kind = YAML_MAP,
                              .line = value->line,
                              .column = value->column,
                              .first = child,
                              .last = child,
                              .count = 1};
    return map;
}

// A value as JSON: the shortest number, or a string.
static bool level_name(struct reader *reader, const struct yaml_node *node, struct protocol_factor *factor)
{
    struct text text = {0};
    char *end = NULL, *out = factor->level[factor->level_count];
    if (node->kind != YAML_SCALAR || !*node->text)
        return read_fail(reader, node, "a level of '%s' is a plain value", factor->name);
    bool digits = !node->quoted && strspn(node->text, "+-.0123456789eE") == strlen(node->text);
    double number = digits ? strtod(node->text, &end) : 0;
    if (digits && !*end && isfinite(number))
        text_number(&text, number);
    else
        text_json_string(&text, node->text);
    if (!text_copy(&text, out, sizeof factor->level[0]))
        return read_fail(reader, node, "level '%.60s...' is too long; shorten it", node->text);
    for (uint32_t i = 0; i < factor->level_count; i++)
        if (strcmp(factor->level[i], out) == 0)
            return read_fail(reader, node, "level %.60s of '%s' stands here twice; keep one", node->text,
                             factor->name);
    factor->level_count++;
    return true;
}

// One level for each value of a list; `nest` names the members around the value, outermost first.
static bool list_levels(struct reader *reader, const struct yaml_node *list, const char *const *nest,
                        const struct yaml_node *at, struct protocol_factor *factor, struct levels *out)
{
    uint32_t depth = 0;
    char what[PROTOCOL_NAME + 16];
    while (nest[depth])
        depth++;
    snprintf(what, sizeof what, "factor '%s'", factor->name);
    if (!read_is_list(reader, list, what, 1, PROTOCOL_LEVELS))
        return false;
    for (const struct yaml_node *node = list->first; node; node = node->next) {
        const struct yaml_node *change = node;
        for (uint32_t i = depth; i > 0 && change; i--)
            change = wrap(reader, nest[i - 1], at, change);
        if (!change)
            return read_fail(reader, node, "out of memory");
        out->change[factor->level_count] = change;
        if (!level_name(reader, node, factor))
            return false;
    }
    return true;
}

// scenes: all
static const struct yaml_node *all_scenes(struct reader *reader, const struct yaml_node *node)
{
    if (node->kind != YAML_SCALAR || strcmp(node->text, "all") != 0)
        return node;
    const struct protocol *protocol = reader->protocol;
    struct yaml_node *list = arena_zeroed(reader->arena, (1 + protocol->scene_count) * sizeof *list);
    if (!list)
        return NULL;
    *list = (struct yaml_node){.kind = YAML_LIST,
                               .line = node->line,
                               .column = node->column,
                               .first = list + 1,
                               .last = list + protocol->scene_count,
                               .count = protocol->scene_count};
    for (uint32_t i = 0; i < protocol->scene_count; i++)
        list[1 + i] = (struct yaml_node){.kind = YAML_SCALAR,
                                         .line = node->line,
                                         .column = node->column,
                                         .text = protocol->scenes[i],
                                         .next = i + 1 < protocol->scene_count ? &list[2 + i] : NULL};
    return list;
}

static bool named_levels(struct reader *reader, const struct yaml_node *map, struct protocol_factor *factor,
                         struct levels *out)
{
    if (map->count < 1 || map->count > PROTOCOL_LEVELS)
        return read_fail_count(reader, map, "levels", 1, PROTOCOL_LEVELS);
    for (const struct yaml_node *node = map->first; node; node = node->next) {
        struct yaml_node name = {
            .kind = YAML_SCALAR, .text = node->key, .line = node->key_line, .column = node->key_column};
        char checked[PROTOCOL_NAME];
        out->change[factor->level_count] = node;
        if (!read_name(reader, &name, "level", checked) || !level_name(reader, &name, factor))
            return false;
    }
    return true;
}

static bool long_form(struct reader *reader, const struct yaml_node *map, const struct yaml_node *key,
                      struct protocol_factor *factor, struct levels *out)
{
    uint32_t between = 0, forms = 0;
    static const char *const exclusive[] = {"options", "scenes", "setting", NULL};
    if (!read_section(reader, map, &language_factor, NULL) ||
        !key_word(reader, map, &language_factor, "between", &between))
        return false;
    factor->between = between == 1;
    const struct yaml_node *levels = yaml_get(map, "levels"), *options = yaml_get(map, "options"),
                           *scenes = yaml_get(map, "scenes"), *setting = yaml_get(map, "setting"),
                           *parameter = yaml_get(map, "parameter"), *option = yaml_get(map, "option");
    for (uint32_t i = 0; exclusive[i]; i++)
        forms += yaml_get(map, exclusive[i]) != NULL;
    forms += parameter || option;
    if (forms > 1)
        return read_fail(reader, map,
                         "factor '%s' varies one thing: parameter, options, scenes or setting; keep one",
                         factor->name);
    if (!levels && !options && !scenes)
        return read_required(reader, map, "the factor", "levels") != NULL;
    if (options) {
        strcpy(out->varies, "option");
        return list_levels(reader, options, (const char *const[]){"option", NULL}, options, factor, out);
    }
    if (scenes) {
        const struct yaml_node *list = all_scenes(reader, scenes);
        strcpy(out->varies, "scene");
        return list ? list_levels(reader, list, (const char *const[]){"scene", NULL}, scenes, factor, out)
                    : read_fail(reader, scenes, "out of memory");
    }
    if (levels->kind == YAML_MAP && !setting && !parameter && !option)
        return named_levels(reader, levels, factor, out);
    char name[PROTOCOL_NAME], place[PROTOCOL_NAME] = "tested";
    const struct yaml_node *what = setting ? setting : parameter ? parameter : key;
    if (!read_name(reader, what, setting ? "setting" : "parameter", name) ||
        (option && !read_name(reader, option, "option", place)))
        return false;
    char *kept = arena_text(reader->arena, name, strlen(name)),
         *where = arena_text(reader->arena, place, strlen(place));
    if (!kept || !where)
        return read_fail(reader, map, "out of memory");
    snprintf(out->varies, sizeof out->varies, "%s/%s", setting ? "settings" : where, kept);
    const char *const of_setting[] = {"settings", kept, NULL};
    const char *const of_option[] = {"parameters", where, kept, NULL};
    return list_levels(reader, levels, setting ? of_setting : of_option, option ? option : what, factor, out);
}

static bool factor_read(struct reader *reader, const struct yaml_node *node, struct protocol_factor *factor,
                        struct levels *out)
{
    struct yaml_node key = {
        .kind = YAML_SCALAR, .text = node->key, .line = node->key_line, .column = node->key_column};
    if (!read_name(reader, &key, "factor", factor->name))
        return false;
    if (node->kind == YAML_MAP)
        return long_form(reader, node, &key, factor, out);
    snprintf(out->varies, sizeof out->varies, "tested/%s", factor->name);
    return list_levels(reader, node, (const char *const[]){"parameters", "tested", node->key, NULL}, &key,
                       factor, out);
}

static bool factors_read(struct reader *reader, const struct yaml_node *map, struct protocol_block *block,
                         struct levels *levels)
{
    if (!map)
        return true;
    if (!read_is_map(reader, map, "factors"))
        return false;
    if (map->count > PROTOCOL_FACTORS)
        return read_fail_count(reader, map, "factors", 0, PROTOCOL_FACTORS);
    for (const struct yaml_node *node = map->first; node; node = node->next) {
        struct levels *mine = &levels[block->factor_count];
        if (!factor_read(reader, node, &block->factors[block->factor_count], mine))
            return false;
        for (uint32_t i = 0; i < block->factor_count; i++)
            if (*mine->varies && strcmp(levels[i].varies, mine->varies) == 0)
                return read_fail_key(reader, node, "factor '%s' varies the same as '%s'; keep one",
                                     block->factors[block->factor_count].name, block->factors[i].name);
        block->factor_count++;
    }
    return true;
}

// A null trial shows the reference twice.
static void finish_cell(const struct protocol_block *block, struct protocol_cell *cell)
{
    if (cell->role == PROTOCOL_NULL && protocol_kind_is_pair(block->kind)) {
        cell->shown[0] = cell->shown[1];
        cell->option[0] = cell->option[1];
    }
}

static bool names_option(const struct yaml_node *change)
{
    return yaml_get(change, "option") || yaml_get(change, "options");
}

static bool factorial(struct reader *reader, const struct yaml_node *map, struct protocol_block *block,
                      const struct levels *levels)
{
    for (uint32_t i = 0; i < block->cell_count; i++) {
        struct protocol_cell *cell = &block->cells[i];
        uint32_t rest = i;
        cell_init(reader->protocol, block, cell);
        for (uint32_t f = block->factor_count; f > 0; f--) {
            cell->level[f - 1] = (uint8_t)(rest % block->factors[f - 1].level_count);
            rest /= block->factors[f - 1].level_count;
        }
        for (uint32_t k = 0; k < 2 * block->factor_count; k++) {
            uint32_t f = k % block->factor_count;
            const struct yaml_node *change = levels[f].change[cell->level[f]];
            bool now = names_option(change) == (k < block->factor_count);
            if (now && !cell_change(reader, change, block, cell))
                return false;
        }
        finish_cell(block, cell);
        if (!cell_check(reader, map, block, cell))
            return false;
    }
    return true;
}

static bool listed(struct reader *reader, const struct yaml_node *list, struct protocol_block *block)
{
    const struct yaml_node *node = list->first;
    for (uint32_t i = 0; i < block->cell_count; i++, node = node->next) {
        struct protocol_cell *cell = &block->cells[i];
        char name[PROTOCOL_NAME] = "";
        cell_init(reader->protocol, block, cell);
        if (!read_is_map(reader, node, "a trial") || !key_name(reader, node, &language_level, "name", name))
            return false;
        if (*name)
            snprintf(cell->labels, sizeof cell->labels, ",\"trial\":\"%s\"", name);
        else
            snprintf(cell->labels, sizeof cell->labels, ",\"trial\":%u", i + 1);
        if (!cell_change(reader, node, block, cell))
            return false;
        finish_cell(block, cell);
        if (!cell_check(reader, node, block, cell))
            return false;
    }
    return true;
}

bool cells_read(struct reader *reader, const struct yaml_node *map, struct protocol_block *block)
{
    struct levels levels[PROTOCOL_FACTORS] = {0};
    const struct yaml_node *factors = yaml_get(map, "factors"), *trials = yaml_get(map, "trials");
    if (factors && trials)
        return read_fail_key(reader, trials, "a block has either factors or trials; remove one");
    if (!factors_read(reader, factors, block, levels) ||
        (trials && !read_is_list(reader, trials, "trials", 1, PROTOCOL_TRIALS)))
        return false;
    uint64_t cells = trials ? trials->count : 1;
    for (uint32_t i = 0; i < block->factor_count; i++)
        cells *= block->factors[i].level_count; // at most 16^6
    block->listed = trials != NULL;
    if (cells > PROTOCOL_TRIALS)
        return read_fail(reader, map, "block '%s' has %llu cells; at most %d fit", block->name,
                         (unsigned long long)cells, PROTOCOL_TRIALS);
    block->cells = arena_zeroed(reader->arena, (size_t)cells * sizeof *block->cells);
    if (!block->cells)
        return read_fail(reader, map, "out of memory");
    block->cell_count = (uint32_t)cells;
    return trials ? listed(reader, trials, block) : factorial(reader, map, block, levels);
}
