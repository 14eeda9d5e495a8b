#include "studies/protocol/parts.h"

#include <stdio.h>
#include <string.h>

static const char *const cameras[] = {"path", "still", NULL};
static const char *const fixations[] = {"free", NULL};
static const char *const foveates[] = {"gaze", NULL};
static const char *const advances[] = {"key", "auto", NULL};

const char *protocol_camera_name(enum protocol_camera camera)
{
    return cameras[camera];
}

const char *protocol_fixation_name(enum protocol_fixation fixation)
{
    return fixations[fixation];
}

const char *protocol_foveate_name(enum protocol_foveate foveate)
{
    return foveates[foveate];
}

void settings_defaults(const struct catalogue *catalogue, struct protocol_settings *out)
{
    *out = (struct protocol_settings){
        .fade_to_gray_ns =
            125000000, // Franke 2021, section 8.2: half a second of gray fade; its parts: DESIGN 4
        .fade_gray_ns = 250000000,
        .fade_from_gray_ns = 125000000,
        .confirm_ns = 500000000,
        .question = UINT32_MAX,
    };
    for (uint32_t i = 0; i < catalogue->setting_count; i++)
        out->render[i] = catalogue->settings[i].fallback;
}

static bool fade_read(struct reader *reader, const struct yaml_node *node, struct protocol_settings *settings)
{
    static const char *const known[] = {"to_gray_s", "gray_s", "from_gray_s", NULL};
    int64_t *const into[] = {&settings->fade_to_gray_ns, &settings->fade_gray_ns, &settings->fade_from_gray_ns};
    if (!read_keys(reader, node, "fade", known))
        return false;
    for (uint32_t i = 0; known[i]; i++) {
        const struct yaml_node *value = yaml_get(node, known[i]);
        if (value && !read_seconds(reader, value, known[i], 10, into[i]))
            return false;
    }
    return true;
}

static bool question_read(struct reader *reader, const struct yaml_node *node, uint32_t *out)
{
    const char *names[PROTOCOL_QUESTIONS + 1] = {NULL};
    for (uint32_t i = 0; i < reader->protocol->question_count; i++)
        names[i] = reader->protocol->questions[i].name;
    return read_word(reader, node, "question", names, out);
}

// The words and times of the table below; false after an error.
static bool plain_read(struct reader *reader, const struct yaml_node *map, struct protocol_settings *settings)
{
    const struct {
        const char *key;
        const char *const *words;
    } choices[] = {{"camera", cameras}, {"fixation", fixations}, {"foveate", foveates}, {"advance", advances}};
    uint32_t chosen[] = {settings->camera, settings->fixation, settings->foveate, settings->advance};
    for (uint32_t i = 0; i < 4; i++) {
        const struct yaml_node *node = yaml_get(map, choices[i].key);
        if (node && !read_word(reader, node, choices[i].key, choices[i].words, &chosen[i]))
            return false;
    }
    settings->camera = (enum protocol_camera)chosen[0];
    settings->fixation = (enum protocol_fixation)chosen[1];
    settings->foveate = (enum protocol_foveate)chosen[2];
    settings->advance = (enum protocol_advance)chosen[3];

    const struct {
        const char *key;
        int64_t *into;
    } times[] = {
        {"view_s", &settings->view_ns}, {"confirm_s", &settings->confirm_ns}, {"rest_s", &settings->rest_ns}};
    for (uint32_t i = 0; i < 3; i++) {
        const struct yaml_node *node = yaml_get(map, times[i].key);
        if (node && !read_seconds(reader, node, times[i].key, 3600, times[i].into))
            return false;
    }
    return true;
}

bool settings_read(struct reader *reader, const struct yaml_node *map, struct protocol_settings *settings)
{
    if (!map)
        return true;
    const struct catalogue *catalogue = reader->catalogue;
    const char *known[16 + CATALOGUE_SETTINGS] = {"camera", "fixation",  "foveate", "advance",  "fade",
                                                  "view_s", "confirm_s", "rest_s",  "question", NULL};
    for (uint32_t i = 0; i < catalogue->setting_count; i++)
        known[9 + i] = catalogue->settings[i].name;
    if (!read_keys(reader, map, "settings", known) || !plain_read(reader, map, settings))
        return false;
    const struct yaml_node *fade = yaml_get(map, "fade"), *question = yaml_get(map, "question");
    if (fade && !fade_read(reader, fade, settings))
        return false;
    if (question && !question_read(reader, question, &settings->question))
        return false;
    for (uint32_t i = 0; i < catalogue->setting_count; i++) {
        const struct yaml_node *node = yaml_get(map, catalogue->settings[i].name);
        if (node && !parameter_read(reader, node, &catalogue->settings[i], "settings", &settings->render[i]))
            return false;
    }
    return true;
}
