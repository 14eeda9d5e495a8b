#include "app/fovbench/lineup.h"

#include <stdio.h>
#include <stdlib.h>

static void print_error(void *user, enum renderer_log_level level, const char *sentence)
{
    (void)user;
    if (level != RENDERER_INFO)
        fprintf(stderr, "fovbench: %s\n", sentence);
}

static bool create(struct lineup *lineup, const struct lineup_desc *desc, const struct scene *scene)
{
    const struct renderer_desc renderer_desc = {.log = {print_error, NULL},
                                                .device = desc->device,
                                                .width = desc->width,
                                                .height = desc->height,
                                                .validation = getenv("FOVSTUDY_VALIDATION") != NULL,
                                                .pass_times = desc->pass_times};
    lineup->renderer = renderer_create(&renderer_desc);
    lineup->scene = lineup->renderer ? renderer_scene_create(lineup->renderer, scene) : NULL;
    if (!lineup->scene)
        return false;
    for (; lineup->count < desc->mode_count; lineup->count++) {
        lineup->options[lineup->count] = renderer_option_create(
            lineup->renderer, lineup->scene, &desc->modes[lineup->count].choice, &desc->settings);
        if (!lineup->options[lineup->count])
            return false;
    }
    return true;
}

bool lineup_init(struct lineup *lineup, const struct lineup_desc *desc, const struct scene *scene)
{
    *lineup = (struct lineup){0};
    if (create(lineup, desc, scene))
        return true;
    lineup_finish(lineup);
    return false;
}

void lineup_finish(struct lineup *lineup)
{
    for (size_t i = 0; i < lineup->count; i++)
        renderer_option_destroy(lineup->options[i]);
    renderer_scene_destroy(lineup->scene);
    renderer_destroy(lineup->renderer);
    *lineup = (struct lineup){0};
}

bool lineup_draw(struct lineup *lineup, const struct frame *frame, struct frame_stats *out_stats)
{
    for (size_t i = 0; i < lineup->count; i++) {
        size_t mode = (size_t)((i + frame->number) % lineup->count);
        if (!renderer_draw(lineup->options[mode], frame, out_stats ? &out_stats[mode] : NULL))
            return false;
    }
    return true;
}
