#include "studies/protocol/parts.h"

#include <stdio.h>
#include <string.h>

const char *protocol_camera_name(enum protocol_camera camera)
{
    return language_find(&language_settings, "camera")->words[camera];
}

const char *protocol_fixation_name(enum protocol_fixation fixation)
{
    return language_find(&language_settings, "fixation")->words[fixation];
}

const char *protocol_foveate_name(enum protocol_foveate foveate)
{
    return language_find(&language_settings, "foveate")->words[foveate];
}

void settings_defaults(const struct catalogue *catalogue, struct protocol_settings *out)
{
    *out = (struct protocol_settings){
        // Franke 2021, section 8.2: half a second of gray fade; its parts: DESIGN 4
        .fade_to_gray_ns = 125000000, .fade_gray_ns = 250000000, .fade_from_gray_ns = 125000000,
        .gap_ns = 1000000000,         .confirm_ns = 500000000,   .count_question = -1,
    };
    for (uint32_t i = 0; i < catalogue->setting_count; i++)
        out->render[i] = catalogue->settings[i].fallback;
}

static bool fade_read(struct reader *reader, const struct yaml_node *node, struct protocol_settings *settings)
{
    const struct language_section *section = &language_fade;
    return !node || (read_section(reader, node, section, NULL) &&
                     key_seconds(reader, node, section, "to_gray_s", &settings->fade_to_gray_ns) &&
                     key_seconds(reader, node, section, "gray_s", &settings->fade_gray_ns) &&
                     key_seconds(reader, node, section, "from_gray_s", &settings->fade_from_gray_ns));
}

static bool words_read(struct reader *reader, const struct yaml_node *map, struct protocol_settings *settings)
{
    static const char *const keys[] = {"camera", "fixation", "foveate", "advance", "pace"};
    uint32_t chosen[] = {settings->camera, settings->fixation, settings->foveate, settings->advance,
                         settings->pace};
    for (uint32_t i = 0; i < sizeof keys / sizeof keys[0]; i++)
        if (!key_word(reader, map, &language_settings, keys[i], &chosen[i]))
            return false;
    settings->camera = (enum protocol_camera)chosen[0];
    settings->fixation = (enum protocol_fixation)chosen[1];
    settings->foveate = (enum protocol_foveate)chosen[2];
    settings->advance = (enum protocol_advance)chosen[3];
    settings->pace = (enum protocol_pace)chosen[4];
    return true;
}

static bool times_read(struct reader *reader, const struct yaml_node *map, struct protocol_settings *settings)
{
    const struct {
        const char *key;
        int64_t *into;
    } times[] = {
        {"path_start_s", &settings->path_start_ns},
        {"view_s", &settings->view_ns},
        {"gap_s", &settings->gap_ns},
        {"min_exposure_s", &settings->min_exposure_ns},
        {"deadline_s", &settings->deadline_ns},
        {"confirm_s", &settings->confirm_ns},
        {"rest_s", &settings->rest_ns},
    };
    for (uint32_t i = 0; i < sizeof times / sizeof times[0]; i++)
        if (!key_seconds(reader, map, &language_settings, times[i].key, times[i].into))
            return false;
    return true;
}

static bool asked_read(struct reader *reader, const struct yaml_node *map, struct protocol_settings *settings)
{
    const char *names[PROTOCOL_QUESTIONS + 1] = {NULL};
    for (uint32_t i = 0; i < reader->protocol->question_count; i++)
        names[i] = reader->protocol->questions[i].name;
    uint32_t count_question = 0, found = 0;
    int64_t spheres[2] = {settings->spheres[0], settings->spheres[1]};
    if (!key_names(reader, map, &language_settings, "question", "question", names, PROTOCOL_ASKED,
                   settings->asked, &settings->asked_count) ||
        !key_names(reader, map, &language_settings, "ratings", "question", names, PROTOCOL_ASKED,
                   settings->ratings, &settings->rating_count) ||
        !key_names(reader, map, &language_settings, "count", "question", names, 1, &count_question, &found) ||
        !key_range(reader, map, &language_settings, "spheres", spheres))
        return false;
    if (found)
        settings->count_question = (int32_t)count_question;
    settings->spheres[0] = (uint32_t)spheres[0];
    settings->spheres[1] = (uint32_t)spheres[1];
    return true;
}

bool settings_read(struct reader *reader, const struct yaml_node *map, struct protocol_settings *settings)
{
    const struct catalogue *catalogue = reader->catalogue;
    const char *more[CATALOGUE_SETTINGS + 1] = {NULL};
    if (!map)
        return true;
    for (uint32_t i = 0; i < catalogue->setting_count; i++)
        more[i] = catalogue->settings[i].name;
    if (!read_section(reader, map, &language_settings, more) || !words_read(reader, map, settings) ||
        !times_read(reader, map, settings) || !fade_read(reader, yaml_get(map, "fade"), settings) ||
        !asked_read(reader, map, settings))
        return false;
    for (uint32_t i = 0; i < catalogue->setting_count; i++) {
        const struct yaml_node *node = yaml_get(map, catalogue->settings[i].name);
        if (node && !parameter_read(reader, node, &catalogue->settings[i], "settings", &settings->render[i]))
            return false;
    }
    return true;
}
