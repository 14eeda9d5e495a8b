#include "tests/renderer/stage.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static void hear(void *user, enum renderer_log_level level, const char *sentence)
{
    struct stage *stage = user;
    (void)level;
    size_t used = strlen(stage->log);
    snprintf(stage->log + used, sizeof stage->log - used, "%s\n", sentence);
}

bool stage_open(struct stage *stage, uint32_t width, uint32_t height)
{
    return stage_open_timed(stage, width, height, false);
}

bool stage_open_timed(struct stage *stage, uint32_t width, uint32_t height, bool pass_times)
{
    *stage = (struct stage){.width = width, .height = height};
    setenv("VK_LAYER_ENABLES", "VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT", 1);
    stage->renderer = renderer_create(&(struct renderer_desc){
        .log = {hear, stage}, .width = width, .height = height, .validation = true, .pass_times = pass_times});
    if (stage->renderer)
        return true;
    if (strstr(stage->log, "no Vulkan"))
        return false;
    fail_msg("%s", stage->log);
    return false;
}

void stage_close(struct stage *stage)
{
    if (renderer_validation_messages(stage->renderer) != 0)
        fail_msg("the validation layer spoke: %s", stage->log);
    renderer_destroy(stage->renderer);
}

struct renderer_option *stage_option(struct stage *stage, struct renderer_scene *scene, const char *mode)
{
    return stage_option_set(stage, scene, mode, NULL);
}

struct renderer_option *stage_option_set(struct stage *stage, struct renderer_scene *scene, const char *mode,
                                         const struct renderer_settings *settings)
{
    struct mode_choice choice;
    char error[512];
    if (!mode_parse(mode, &choice, error, sizeof error))
        fail_msg("%s", error);
    struct renderer_option *option = renderer_option_create(stage->renderer, scene, &choice, settings);
    if (!option)
        fail_msg("%s: %s", mode, stage->log);
    return option;
}

struct frame stage_frame(const struct stage *stage, const struct scene *scene, uint64_t number, double time_s,
                         double gaze_x_deg, double gaze_y_deg)
{
    struct frame frame = {.number = number};
    struct pose head = camera_path_pose(&scene->path, time_s);
    for (int eye = 0; eye < EYES; eye++)
        frame.eyes[eye] = (struct frame_eye){
            .pose = viewing_eye_pose(&head, eye, VIEWING_DEFAULT_IPD_M),
            .fov = viewing_symmetric_fov(VIEWING_DEFAULT_FOV_DEG, stage->width, stage->height),
            .gaze_x_deg = gaze_x_deg,
            .gaze_y_deg = gaze_y_deg,
        };
    return frame;
}

uint8_t *stage_read(const struct stage *stage, struct renderer_option *option, int eye)
{
    uint8_t *pixels = malloc(4 * (size_t)stage->width * stage->height);
    assert_non_null(pixels);
    assert_true(renderer_read(option, eye, pixels));
    return pixels;
}

struct stage_difference stage_compare(const struct stage *stage, const uint8_t *a, const uint8_t *b)
{
    struct stage_difference d = {0};
    const size_t count = (size_t)stage->width * stage->height;
    for (size_t i = 0; i < 4 * count; i++) {
        int difference = abs(a[i] - b[i]);
        d.max = difference > d.max ? difference : d.max;
        d.mean += difference;
    }
    d.mean /= 3.0 * (double)count; // alpha is 255 in both
    return d;
}

struct stage_difference stage_differ(const struct stage *stage, struct renderer_option *a,
                                     struct renderer_option *b)
{
    struct stage_difference worst = {0};
    for (int eye = 0; eye < EYES; eye++) {
        uint8_t *x = stage_read(stage, a, eye), *y = stage_read(stage, b, eye);
        const struct stage_difference d = stage_compare(stage, x, y);
        worst.mean += d.mean / EYES;
        worst.max = d.max > worst.max ? d.max : worst.max;
        free(x);
        free(y);
    }
    return worst;
}
