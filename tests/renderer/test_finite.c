// No NaN and no infinity leaves a pass, whatever the scene's radiance: every float image of every mode is read
// after every frame.
#include "tests/renderer/blocks.h"
#include "tests/renderer/float_images.h"
#include "tests/renderer/stage.h"

#include <float.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>

#include <cmocka.h>

enum { WIDTH = 48, HEIGHT = 40, FRAMES = 9 };

static const char *const names[] = {"time_warped", "time_warped:splat=points",
                                    "time_warped:dynamic_objects=regular", "regular", "vrs"};
enum { MODES = sizeof names / sizeof names[0] };
static const struct renderer_settings all = {.ssao = true, .taa = true, .motion = true};

static const struct block_key sweep[] = {{0, -1, 0.4f, -2.5f}, {0.5f, 1, 0.4f, -2.5f}, {1, -1, 0.4f, -2.5f}};

// A glowing wall, mirrors that face the lights, things in motion, all under a sky: everything as bright as `e`.
static struct scene *glow(float e)
{
    const struct block list[] = {
        {.middle = {0, -1.5, -2}, .half = {6, 0.1, 6}, .colour = {0.3f, 0.4f, 0.2f}},
        {.middle = {-0.8, 0, -3}, .half = {0.5, 1, 0.2}, .emissive = {e, 0.5f * e, 0.01f * e}},
        {.middle = {0.6, 0, -3}, .half = {0.5, 1, 0.2}, .smoothness = 1, .metallic = 1},
        {.middle = {1.8, 0, -4}, .half = {0.5, 1, 0.2}, .smoothness = 0.9f, .colour = {0.9f, 0.8f, 0.1f}},
        {.middle = {-1, 0.4, -2.5},
         .half = {0.2, 0.2, 0.2},
         .emissive = {0.1f * e, e, e},
         .keys = sweep,
         .key_count = 3},
    };
    const struct scene_light lights[] = {
        {.position = {0.3, 0.2, -1.5}, .intensity = {e, e, e}, .range_m = 10, .cos_outer = -2},
        {.position = {0.6, 0, -2.8}, .intensity = {e, e, e}, .range_m = 10, .cos_outer = -2}}; // on a surface
    struct scene *scene = blocks_scene(&(struct blocks){.list = list,
                                                        .count = sizeof list / sizeof list[0],
                                                        .target = {0, 0, -1},
                                                        .lights = lights,
                                                        .light_count = 2,
                                                        .sky = fminf(e, 65504)});
    scene->sun = (struct scene_sun){.direction = {0.48, 0.8, 0.36}, .illuminance = {e, e, e}};
    return scene;
}

// A head that sways so that holes open, a cut, a gaze that is nowhere, objects that stop.
static struct frame frame_at(const struct stage *stage, const struct scene *scene, uint64_t n)
{
    struct frame frame = stage_frame(stage, scene, n, 0, n == 6 ? NAN : 10 * sin((double)n), 5);
    const double half = 0.05 * sin(1.7 * (double)n);
    const struct pose head = {.position = {0.15 * sin(2.0 * (double)n), 0.05 * cos((double)n), 0},
                              .orientation = {0, sin(half), 0, cos(half)}};
    for (int eye = 0; eye < EYES; eye++)
        frame.eyes[eye].pose = viewing_eye_pose(&head, eye, VIEWING_DEFAULT_IPD_M);
    frame.cut = n == 4;
    frame.gaze_returned = n == 7;
    frame.moving = n < 8;
    frame.animation_s = n < 8 ? 0.03 * (double)n : 0;
    return frame;
}

static void draw_and_look(struct stage *stage, const struct scene *scene, float e)
{
    struct renderer_scene *uploaded = renderer_scene_create(stage->renderer, scene);
    assert_non_null(uploaded);
    for (int mode = 0; mode < MODES; mode++) {
        struct renderer_option *option = stage_option_set(stage, uploaded, names[mode], &all);
        for (uint64_t n = 0; n < FRAMES; n++) {
            char when[128];
            const struct frame frame = frame_at(stage, scene, n);
            assert_true(renderer_draw(option, &frame, NULL));
            snprintf(when, sizeof when, "%s, radiance %g, frame %u", names[mode], (double)e, (unsigned)n);
            float_images_check(when);
        }
        renderer_option_destroy(option);
    }
    renderer_scene_destroy(uploaded);
}

static void every_pass_writes_finite_numbers(void **state)
{
    (void)state;
    const float strengths[] = {0, 1e-6f, 1e-3f, 1, 1e3f, 65504, 1e6f, FLT_MAX};
    // what must have been looked into, or this test says nothing
    const char *const written[] = {"history position",
                                   "hdr",
                                   "pull-push pyramid",
                                   "pyramid of farthest depths",
                                   "half-resolution distances",
                                   "filtered colour",
                                   "g-buffer emissive",
                                   "g-buffer depth",
                                   "motion vectors",
                                   "point depths"};
    for (size_t i = 0; i < sizeof strengths / sizeof strengths[0]; i++) {
        struct stage stage;
        assert_true(stage_open(&stage, WIDTH, HEIGHT));
        float_images_watch(stage.renderer);
        struct scene *scene = glow(strengths[i]);
        draw_and_look(&stage, scene, strengths[i]);
        for (size_t k = 0; strengths[i] > 1e-5f && k < sizeof written / sizeof written[0]; k++)
            if (!float_images_used(written[k]))
                fail_msg("nothing was seen in '%s'", written[k]);
        const float largest = float_images_largest("hdr");
        print_message("radiance %g: shaded colours up to %g\n", (double)strengths[i], (double)largest);
        assert_true(strengths[i] < 65504 || largest >= 65504);
        float_images_finish();
        scene_destroy(scene);
        stage_close(&stage);
    }
}

int main(void)
{
    struct stage probe;
    if (!stage_open(&probe, 16, 16))
        return 77;
    stage_close(&probe);
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_pass_writes_finite_numbers),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
