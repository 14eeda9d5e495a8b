// One cell of a block: the block's options, scene and settings with what factor levels or a listed trial
// change.
#include "studies/protocol/parts.h"

#include "studies/protocol/text.h"

#include <string.h>

void cell_init(const struct protocol *protocol, const struct protocol_block *block, struct protocol_cell *out)
{
    *out = (struct protocol_cell){.role = block->role, .scene = -1, .settings = block->settings};
    for (uint32_t i = 0; i < block->option_count; i++) {
        out->shown[i] = block->options[i];
        out->option[i] = protocol->options[block->options[i]];
    }
}

static bool place_option(struct reader *reader, const struct yaml_node *node, struct protocol_cell *cell,
                         uint32_t place)
{
    char name[PROTOCOL_NAME];
    if (!read_name(reader, node, "option", name) ||
        !option_find(reader, node, false, name, &cell->shown[place]))
        return false;
    cell->option[place] = reader->protocol->options[cell->shown[place]];
    return true;
}

static bool change_options(struct reader *reader, const struct yaml_node *map,
                           const struct protocol_block *block, struct protocol_cell *cell)
{
    const struct yaml_node *one = yaml_get(map, "option"), *both = yaml_get(map, "options");
    if (one && both)
        return read_fail_key(reader, both, "'option' and 'options' both name what is shown; remove one");
    if (one)
        return place_option(reader, one, cell, 0);
    if (!both)
        return true;
    if (!protocol_kind_is_pair(block->kind))
        return read_fail_key(reader, both, "block '%s' shows one option at a time; write 'option: NAME'",
                             block->name);
    return read_is_list(reader, both, "options", 2, 2) && place_option(reader, both->first, cell, 0) &&
           place_option(reader, both->last, cell, 1);
}

// {option: {parameter: value}}; `tested` and `reference` name the places, whatever option holds them.
static bool change_parameters(struct reader *reader, const struct yaml_node *map,
                              const struct protocol_block *block, struct protocol_cell *cell)
{
    uint32_t places = protocol_kind_is_pair(block->kind) ? 2 : 1;
    const char *names[] = {reader->protocol->options[cell->shown[0]].name,
                           reader->protocol->options[cell->shown[places - 1]].name, "tested",
                           places == 2 ? "reference" : NULL, NULL};
    if (!read_is_map(reader, map, "parameters"))
        return false;
    for (const struct yaml_node *node = map->first; node; node = node->next) {
        uint32_t found = 0;
        while (names[found] && strcmp(names[found], node->key) != 0)
            found++;
        if (!names[found])
            return read_fail_key(reader, node, "option '%.60s' is not shown in block '%s'; name one that is",
                                 node->key, block->name);
        struct protocol_option *option = &cell->option[found % 2];
        const struct catalogue_mode *mode = &reader->catalogue->modes[option->mode];
        if (!read_is_map(reader, node, "an option's parameters"))
            return false;
        for (const struct yaml_node *each = node->first; each; each = each->next) {
            uint32_t index;
            if (!parameter_find(reader, each, true, each->key, option->mode, &index) ||
                !parameter_read(reader, each, &mode->parameters[index], mode->name, &option->values[index]))
                return false;
        }
    }
    return true;
}

bool cell_change(struct reader *reader, const struct yaml_node *map, const struct protocol_block *block,
                 struct protocol_cell *cell)
{
    const char *names[PROTOCOL_SCENES + 1];
    uint32_t scene = 0, found = 0, role = cell->role;
    scene_names(reader, names);
    struct language_section section = language_level;
    if (block->listed)
        section.title = "the trial";
    if (!read_section(reader, map, &section, NULL) || !change_options(reader, map, block, cell) ||
        !key_names(reader, map, &language_level, "scene", "scene", names, 1, &scene, &found) ||
        !key_word(reader, map, &language_level, "role", &role) ||
        !key_labels(reader, map, "labels", cell->labels) ||
        !settings_read(reader, yaml_get(map, "settings"), &cell->settings))
        return false;
    if (found)
        cell->scene = (int32_t)scene;
    cell->role = (enum protocol_role)role;
    const struct yaml_node *parameters = yaml_get(map, "parameters");
    return !parameters || change_parameters(reader, parameters, block, cell);
}

static bool question_check(struct reader *reader, const struct yaml_node *node,
                           const struct protocol_block *block, const struct protocol_cell *cell)
{
    const struct protocol *protocol = reader->protocol;
    const struct protocol_settings *settings = &cell->settings;
    bool rates = block->kind == PROTOCOL_RATE || block->kind == PROTOCOL_TASK;
    if (settings->asked_count == 0 && block->kind != PROTOCOL_ADJUST && block->kind != PROTOCOL_TASK)
        return read_fail(reader, node, "block '%s' asks no question; set 'question' in its settings",
                         block->name);
    if (settings->asked_count > 1 && !rates && block->kind != PROTOCOL_ADJUST)
        return read_fail(
            reader, node,
            "block '%s' lets one choose, which is one question; name one, and the others as 'ratings'",
            block->name);
    for (uint32_t i = 0; i < settings->asked_count && block->kind != PROTOCOL_ADJUST; i++) {
        const struct protocol_question *question = &protocol->questions[settings->asked[i]];
        if (rates && question->type != PROTOCOL_ASK_RATING)
            return read_fail(reader, node,
                             "block '%s' rates, but question '%s' has no 'scale'; add one, or ask another",
                             block->name, question->name);
        bool scale_too = block->kind == PROTOCOL_STAIRCASE && question->type == PROTOCOL_ASK_RATING;
        if (!rates && question->type != PROTOCOL_ASK_CHOICE && !scale_too)
            return read_fail(reader, node,
                             "block '%s' lets one choose, but question '%s' has a scale; ask another",
                             block->name, question->name);
    }
    for (uint32_t i = 0; i < settings->rating_count; i++) {
        const struct protocol_question *question = &protocol->questions[settings->ratings[i]];
        if (question->type != PROTOCOL_ASK_RATING)
            return read_fail(reader, node,
                             "block '%s' asks for ratings, but question '%s' has no 'scale'; add one",
                             block->name, question->name);
    }
    return true;
}

static bool count_check(struct reader *reader, const struct yaml_node *node, const struct protocol_block *block,
                        const struct protocol_settings *settings)
{
    bool spheres = settings->spheres[1] > 0, counts = settings->count_question >= 0;
    if (block->kind == PROTOCOL_TASK && !counts)
        return read_fail(reader, node,
                         "block '%s' is a task without one; set 'spheres' and 'count' in its settings",
                         block->name);
    if (spheres != counts)
        return read_fail(reader, node, "block '%s' needs both 'spheres' and 'count', or none of them",
                         block->name);
    if (!counts)
        return true;
    const struct protocol_question *question = &reader->protocol->questions[settings->count_question];
    if (question->type != PROTOCOL_ASK_COUNT)
        return read_fail(reader, node, "question '%s' asks for no number; give it 'count: [0, 20]'",
                         question->name);
    int32_t most = (int32_t)settings->spheres[1] * (block->kind == PROTOCOL_SEQUENTIAL ? 2 : 1);
    if ((int32_t)settings->spheres[0] < question->scale_min || most > question->scale_max)
        return read_fail(reader, node, "question '%s' counts from %d to %d, but %d spheres may come; widen it",
                         question->name, question->scale_min, question->scale_max, most);
    return true;
}

// What is rendered beforehand must be known beforehand: how long it is shown, and where it is sharp.
static bool playback_check(struct reader *reader, const struct yaml_node *node,
                           const struct protocol_block *block, const struct protocol_cell *cell)
{
    bool timed =
        block->kind == PROTOCOL_SEQUENTIAL || block->kind == PROTOCOL_RATE || block->kind == PROTOCOL_TASK;
    for (uint32_t i = 0; i < block->option_count; i++) {
        const struct protocol_option *option = &cell->option[i];
        const struct catalogue_mode *mode = &reader->catalogue->modes[option->mode];
        if (option->playback != PROTOCOL_PRERENDERED)
            continue;
        if (!timed || cell->settings.view_ns == 0)
            return read_fail(
                reader, node,
                "block '%s' shows the prerendered option '%s' for a time that is not known beforehand; "
                "use a sequential, rate or task block with 'view_s', or 'playback: live'",
                block->name, option->name);
        if (mode->foveated && cell->settings.foveate == PROTOCOL_FOVEATE_GAZE)
            return read_fail(
                reader, node,
                "block '%s' shows the prerendered option '%s', whose mode '%s' follows the gaze, which "
                "is not known beforehand; set 'foveate: target', or 'playback: live'",
                block->name, option->name, mode->name);
    }
    return true;
}

bool cell_check(struct reader *reader, const struct yaml_node *node, const struct protocol_block *block,
                const struct protocol_cell *cell)
{
    const struct protocol_settings *settings = &cell->settings;
    bool pair = protocol_kind_is_pair(block->kind);
    bool task = block->kind == PROTOCOL_TASK; // whose count is what it is about
    if ((task && !count_check(reader, node, block, settings)) || !question_check(reader, node, block, cell) ||
        (!task && !count_check(reader, node, block, settings)) ||
        !timing_check(reader, node, block, settings) || !playback_check(reader, node, block, cell))
        return false;
    if (settings->foveate == PROTOCOL_FOVEATE_TARGET && settings->fixation == PROTOCOL_FIXATION_FREE)
        return read_fail(
            reader, node,
            "block '%s' foveates a target that is not there; set 'fixation' to cross or moving, or "
            "'foveate' to gaze",
            block->name);
    if (block->kind == PROTOCOL_SEQUENTIAL && settings->view_ns == 0)
        return read_fail(reader, node,
                         "block '%s' shows one option after the other, but for no time; set 'view_s'",
                         block->name);
    if (!pair && (cell->role == PROTOCOL_NULL || cell->role == PROTOCOL_CATCH))
        return read_fail(reader, node, "block '%s' shows one option at a time; null and catch trials need two",
                         block->name);
    if (pair && cell->role != PROTOCOL_NULL && cell->shown[0] == cell->shown[1] &&
        memcmp(cell->option[0].values, cell->option[1].values, sizeof cell->option[0].values) == 0)
        return read_fail(
            reader, node,
            cell->role == PROTOCOL_CATCH
                ? "block '%s' has a catch trial whose two options are the same; name an option, or "
                  "parameters of it, that differ obviously"
                : "block '%s' has a trial whose two options are the same; write 'role: null' if so meant",
            block->name);
    return true;
}
