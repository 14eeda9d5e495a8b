// A block's staircase, by the description that engine/staircase.h takes.
#include "studies/protocol/parts.h"

#include <string.h>

static bool grid_read(struct reader *reader, const struct yaml_node *map, const char *key,
                      struct quest_plus_grid *out)
{
    const struct yaml_node *node = yaml_get(map, key);
    const struct language_section *section = &language_grid;
    uint32_t spacing = QUEST_PLUS_LINEAR;
    if (!node)
        return true;
    out->count = 1;
    if (!read_section(reader, node, section, NULL) || !key_number(reader, node, section, "min", &out->min) ||
        !key_number(reader, node, section, "max", &out->max) ||
        !key_integer(reader, node, section, "count", &out->count) ||
        !key_word(reader, node, section, "spacing", &spacing))
        return false;
    out->spacing = (enum quest_plus_spacing)spacing;
    return true;
}

static bool model_read(struct reader *reader, const struct yaml_node *map, struct quest_plus_model *model)
{
    const struct yaml_node *node = yaml_get(map, "model");
    uint32_t family = 0;
    if (!node)
        return true;
    if (!read_section(reader, node, &language_model, NULL) ||
        !key_word(reader, node, &language_model, "family", &family))
        return false;
    model->family = quest_plus_find_family(language_find(&language_model, "family")->words[family]);
    if (model->outcomes == 2)
        model->guess = (struct quest_plus_grid){.min = 0.5, .max = 0.5, .count = 1}; // two options
    model->lapse = (struct quest_plus_grid){.count = 1};
    if (!grid_read(reader, node, "threshold", &model->threshold) ||
        !grid_read(reader, node, "slope", &model->slope) || !grid_read(reader, node, "guess", &model->guess) ||
        !grid_read(reader, node, "lapse", &model->lapse))
        return false;
    if (model->outcomes == 2 && (model->guess.min != 0.5 || model->guess.max != 0.5))
        read_remark(reader, yaml_get(node, "guess"),
                    "who guesses between two options is right half of the time, so guess is 0.5; another one "
                    "makes another threshold");
    return true;
}

static bool steps_read(struct reader *reader, const struct yaml_node *map, struct staircase_desc *desc)
{
    const struct yaml_node *list = yaml_get(map, "steps");
    if (!list)
        return true;
    if (!read_is_list(reader, list, "steps", 1, STAIRCASE_STEPS))
        return false;
    for (const struct yaml_node *node = list->first; node; node = node->next)
        if (!read_number(reader, node, "a step", 0, 1e9, &desc->steps[desc->step_count++]))
            return false;
    return true;
}

static bool parameter_of(struct reader *reader, const struct yaml_node *map, struct protocol_block *block)
{
    struct protocol_staircase *staircase = &block->staircase;
    const struct yaml_node *node = yaml_get(map, "parameter");
    uint32_t mode = reader->protocol->options[block->options[0]].mode;
    char name[PROTOCOL_NAME];
    if (!read_name(reader, node, "parameter", name) ||
        !parameter_find(reader, node, false, name, mode, &staircase->parameter))
        return false;
    const struct catalogue_parameter *parameter =
        &reader->catalogue->modes[mode].parameters[staircase->parameter];
    if (parameter->choices)
        return read_fail(reader, node, "'%s' is a switch, which has no levels in between; name a number", name);
    for (uint32_t i = 0; i < block->cell_count; i++)
        if (block->cells[i].option[0].mode != mode)
            return read_fail(reader, node,
                             "a factor shows another mode than '%s', whose '%s' the staircase sets",
                             reader->catalogue->modes[mode].name, name);
    if (!parameter_is_free(reader, node, block, staircase->parameter, "the staircase"))
        return false;
    const struct quest_plus_grid *level = &staircase->desc.level;
    if (level->min < parameter->min || level->max > parameter->max)
        return read_fail(reader, yaml_get(map, "level"),
                         "levels from %g to %g leave the range of '%s', %g to %g", level->min, level->max, name,
                         parameter->min, parameter->max);
    return true;
}

// Every cell must give the same outcomes, each of which says how the answer was.
static bool outcomes_of(struct reader *reader, const struct yaml_node *map, const struct protocol_block *block,
                        uint32_t *out)
{
    for (uint32_t i = 0; i < block->cell_count; i++) {
        const struct protocol_question *question =
            &reader->protocol->questions[block->cells[i].settings.asked[0]];
        if (question->type == PROTOCOL_ASK_CHOICE && question->correct == PROTOCOL_NO_CORRECT)
            return read_fail(
                reader, map,
                "a staircase follows right and wrong answers, but question '%s' is a preference; give it "
                "'correct: reference', or ask one that has a scale",
                question->name);
        uint32_t outcomes = question->type == PROTOCOL_ASK_CHOICE
                                ? 2u + question->equal
                                : (uint32_t)(question->scale_max - question->scale_min + 1);
        if (i > 0 && outcomes != *out)
            return read_fail(reader, map, "the questions of block '%s' have different numbers of answers",
                             block->name);
        *out = outcomes;
    }
    return true;
}

// What each method takes beyond what all take; what it lacks, or cannot use, is said by name.
static bool keys_check(struct reader *reader, const struct yaml_node *map, const char *method)
{
    static const struct {
        const char *key, *methods, *needed, *about;
    } rules[] = {
        {"start", "1up2down weighted", "1up2down weighted", "the first level, as 'start: 0.5'"},
        {"steps", "1up2down weighted", "1up2down weighted", "the sizes of its steps, as 'steps: [0.1, 0.05]'"},
        {"target", "weighted", "weighted", "the share of right answers to settle at, as 'target: 0.75'"},
        {"reversals", "1up2down weighted", "", ""},
        {"model", "quest_plus", "quest_plus",
         "the psychometric functions it weighs, with family, threshold and slope"},
    };
    for (size_t i = 0; i < sizeof rules / sizeof rules[0]; i++) {
        const struct yaml_node *node = yaml_get(map, rules[i].key);
        if (!node && strstr(rules[i].needed, method))
            return read_fail(reader, map, "method '%s' has no '%s'; add %s", method, rules[i].key,
                             rules[i].about);
        if (node && !strstr(rules[i].methods, method))
            return read_fail_key(reader, node, "method '%s' takes no '%s'%s; remove it", method, rules[i].key,
                                 strcmp(rules[i].key, "target") == 0 && strcmp(method, "1up2down") == 0
                                     ? ", it settles at 70.7 % right answers"
                                     : "");
    }
    const struct yaml_node *level = yaml_get(map, "level"),
                           *count = level->kind == YAML_MAP ? yaml_get(level, "count") : NULL;
    bool chosen = strcmp(method, "quest_plus") == 0;
    if (level->kind == YAML_MAP && chosen && !count)
        return read_fail(reader, level,
                         "method 'quest_plus' chooses among levels; add how many, as 'count: 25'");
    if (count && !chosen)
        return read_fail_key(
            reader, count, "method '%s' steps from level to level, so it takes no 'count'; remove it", method);
    return true;
}

// Where a sentence of staircase_check begins with the name of a key, that key.
static const struct yaml_node *blamed(const struct yaml_node *map, const char *why)
{
    static const char *const words[][2] = {
        {"start ", "start"}, {"step ", "steps"}, {"target ", "target"}, {"levels ", "level"}};
    for (size_t i = 0; i < sizeof words / sizeof words[0]; i++)
        if (strncmp(why, words[i][0], strlen(words[i][0])) == 0 && yaml_get(map, words[i][1]))
            return yaml_get(map, words[i][1]);
    static const char *const grids[] = {"threshold", "slope", "guess", "lapse"};
    static const char grid[] = "the grid of ";
    const struct yaml_node *model = yaml_get(map, "model");
    for (size_t i = 0; model && strncmp(why, grid, sizeof grid - 1) == 0 && i < sizeof grids / sizeof grids[0];
         i++)
        if (strncmp(why + sizeof grid - 1, grids[i], strlen(grids[i])) == 0 && yaml_get(model, grids[i]))
            return yaml_get(model, grids[i]);
    return map;
}

bool staircase_read(struct reader *reader, const struct yaml_node *block_map, struct protocol_block *block)
{
    static const char *const taken[] = {"repetitions", "order", NULL};
    const struct language_section *section = &language_staircase;
    const struct yaml_node *map = yaml_get(block_map, "staircase");
    struct staircase_desc *desc = &block->staircase.desc;
    uint32_t method = 0, larger = 0;
    char why[256];
    if (block->kind != PROTOCOL_STAIRCASE)
        return map ? read_fail_key(reader, map, "'staircase' belongs to blocks of 'kind: staircase'") : true;
    for (uint32_t i = 0; taken[i]; i++)
        if (yaml_get(block_map, taken[i]))
            return read_fail_key(reader, yaml_get(block_map, taken[i]),
                                 "a staircase has its own %s; remove this key and set 'trials' in it",
                                 taken[i]);
    if (!read_section(reader, map, section, NULL) || !key_word(reader, map, section, "method", &method) ||
        !keys_check(reader, map, language_find(section, "method")->words[method]) ||
        !key_word(reader, map, section, "larger", &larger) || !grid_read(reader, map, "level", &desc->level) ||
        !key_integer(reader, map, section, "trials", &desc->trials) ||
        !key_integer(reader, map, section, "reversals", &desc->reversals) ||
        !key_number(reader, map, section, "start", &desc->start) || !steps_read(reader, map, desc) ||
        !key_number(reader, map, section, "target", &desc->target) ||
        !outcomes_of(reader, map, block, &desc->model.outcomes))
        return false;
    desc->method = staircase_find_method(language_find(section, "method")->words[method]);
    desc->larger = larger ? STAIRCASE_LARGER_HARDER : STAIRCASE_LARGER_EASIER;
    bool adaptive = strcmp(staircase_method_name(desc->method), "quest_plus") == 0;
    if (!adaptive && desc->model.outcomes != 2)
        return read_fail(reader, map, "'%s' knows right and wrong only; with %u answers use quest_plus",
                         staircase_method_name(desc->method), desc->model.outcomes);
    if (!adaptive)
        desc->model.outcomes = 0;
    if (!adaptive)
        desc->level.count = 0;
    if (!model_read(reader, map, &desc->model) || !parameter_of(reader, map, block))
        return false;
    const struct quest_plus_grid *threshold = &desc->model.threshold, *level = &desc->level;
    if (adaptive && (threshold->max < level->min || threshold->min > level->max))
        return read_fail(
            reader, yaml_get(yaml_get(map, "model"), "threshold"),
            "the thresholds (%g to %g) all lie outside the levels (%g to %g), so no answer tells them apart",
            threshold->min, threshold->max, level->min, level->max);
    if (!staircase_check(desc, why, sizeof why))
        return read_fail(reader, blamed(map, why), "%s", why);
    block->repetitions = desc->trials;
    block->order = PROTOCOL_ORDER_BLOCK_RANDOM;
    return true;
}
