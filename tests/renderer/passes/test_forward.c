// What a device may refuse, drawn past the refusal. The forward shading of vrs path=hardware, without a map of
// rates, gives the picture of `regular`: what the two share is shared, and the depths that come first are met
// to the last bit. So does multiview, where nothing is clipped: that is what the software driver gets wrong.
#include "renderer/modes/room.h"
#include "renderer/passes/shadow/shadow.h"
#include "tests/renderer/blocks.h"
#include "tests/renderer/passes/rig.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

enum { WIDTH = 96, HEIGHT = 88, PIXELS = 2 * WIDTH * HEIGHT };

struct bed {
    struct rig rig;
    struct scene *scene;
    struct scene_gpu *gpu_scene;
    struct shadow shadow;
    struct gpu_frame frame;
};

// Takes the scene.
static void bed_open(struct bed *b, struct scene *scene)
{
    *b = (struct bed){.scene = scene};
    assert_true(rig_open(&b->rig));
    b->gpu_scene = scene_gpu_create(b->rig.gpu, b->scene);
    assert_non_null(b->gpu_scene);
    assert_true(shadow_init(&b->shadow, b->rig.gpu, b->gpu_scene) &&
                gpu_frame_init(&b->frame, b->rig.gpu, false));
}

static void bed_close(struct bed *b)
{
    gpu_frame_finish(&b->frame);
    shadow_finish(&b->shadow);
    scene_gpu_destroy(b->gpu_scene);
    scene_destroy(b->scene);
    rig_close(&b->rig);
}

static uint32_t draw(struct bed *b, const struct mode *mode, const double *values, bool ssao, double time_s,
                     uint8_t (*out)[4])
{
    struct mode_explanation explanation = {0};
    struct mode_result result;
    const struct mode_setup setup = {.gpu = b->rig.gpu,
                                     .scene = b->gpu_scene,
                                     .shadow_map = b->shadow.map.view,
                                     .width = WIDTH,
                                     .height = HEIGHT,
                                     .values = values,
                                     .settings = {.ssao = ssao},
                                     .frame = &b->rig.frame,
                                     .counters = &b->rig.counters,
                                     .explanation = &explanation};
    struct mode_state *state = mode->create(&setup);
    assert_non_null(state);
    struct rig_view view = rig_view_default(WIDTH, HEIGHT);
    const struct pose head = camera_path_pose(&b->scene->path, time_s);
    for (int eye = 0; eye < EYES; eye++)
        view.eyes[eye].pose = viewing_eye_pose(&head, eye, VIEWING_DEFAULT_IPD_M);
    assert_true(gpu_frame_begin(&b->frame));
    scene_gpu_update(b->gpu_scene, b->frame.cmd, view.eyes[0].pose.position, 0, 0);
    view.origin = view.last_origin = b->gpu_scene->origin;
    rig_frame(&b->rig, &view);
    scene_gpu_constants(b->gpu_scene, b->rig.frame.mapped);
    shadow_constants(&b->shadow, b->gpu_scene->origin, b->rig.frame.mapped);
    struct shared_counters *counters = b->rig.counters.mapped;
    memset(counters, 0, sizeof *counters);
    assert_true(mode->record(state, &(struct mode_record){.gpu_frame = &b->frame, .result = &result}));
    assert_true(gpu_frame_end(&b->frame));
    rig_download(&b->rig, result.colour, 4, out);
    mode->destroy(state);
    return counters->shaded_px;
}

static void forward_shades_what_deferred_does(void **state)
{
    (void)state;
    static uint8_t regular[PIXELS][4], forward[PIXELS][4];
    static const char *const scenes[] = {"atrium", "town:triangles=60000"};
    const double plain[MODE_PARAMETERS] = {0};          // eyes=separate
    const double values[MODE_PARAMETERS] = {10, 20, 1}; // path=hardware
    for (size_t k = 0; k < countof(scenes); k++) {
        struct bed b;
        char error[512];
        struct scene *scene = scene_open(scenes[k], error, sizeof error);
        assert_non_null(scene);
        bed_open(&b, scene);
        b.rig.gpu->shading_rate.texel = 0; // a device that has it too
        for (int ssao = 0; ssao < 2; ssao++) {
            draw(&b, &mode_regular, plain, ssao, 7, regular);
            const uint32_t shaded = draw(&b, &mode_vrs, values, ssao, 7, forward);
            // nothing missed, and nothing hidden but where two surfaces have one depth
            assert_in_range(shaded, PIXELS, PIXELS + PIXELS / 1000);
            uint32_t off = 0;
            double mean = 0;
            for (size_t i = 0; i < PIXELS; i++)
                for (int c = 0; c < 3; c++) {
                    const int d = abs(regular[i][c] - forward[i][c]);
                    off += d > 3;
                    mean += d / (3.0 * PIXELS);
                }
            print_message("%s%s: mean difference %.4f of 255, %u values off by more than 3\n", scenes[k],
                          ssao ? ", occlusion" : "", mean, off);
            // the G-buffer keeps colours and roughness in 8 bits; near a highlight or a shadow's edge that
            // shows
            assert_true(mean < 0.25 && off < 3 * PIXELS / 500);
        }
        bed_close(&b);
    }
}

static void multiview_draws_what_eye_by_eye_does(void **state)
{
    (void)state;
    static uint8_t apart[PIXELS][4], together[PIXELS][4];
    static const struct block list[] = {
        {.middle = {0, 0, -1}, .half = {0.2, 0.3, 0.2}, .colour = {0.8f, 0.2f, 0.1f}},
        {.middle = {0.6, 0.2, -1.5},
         .half = {0.3, 0.2, 0.1},
         .colour = {0.1f, 0.5f, 0.2f},
         .emissive = {0, 0, 0.1f}},
        {.middle = {-1, -0.4, -2}, .half = {0.5, 0.5, 0.4}, .colour = {0.2f, 0.2f, 0.7f}},
    };
    struct bed b;
    bed_open(&b,
             blocks_scene(&(struct blocks){
                 .list = list, .count = countof(list), .eye = {0, 0, 0}, .target = {0, 0, -1}, .sky = 0.3f}));
    const double eye_by_eye[MODE_PARAMETERS] = {0}, multiview[MODE_PARAMETERS] = {1};
    draw(&b, &mode_regular, eye_by_eye, true, 0, apart);
    draw(&b, &mode_regular, multiview, true, 0, together);
    assert_memory_equal(apart, together, sizeof apart);
    assert_memory_not_equal(apart, apart[PIXELS / 2], sizeof apart / 2); // the eyes differ
    bed_close(&b);
}

int main(void)
{
    struct rig probe;
    if (!rig_open(&probe))
        return 77;
    rig_close(&probe);
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(forward_shades_what_deferred_does),
        cmocka_unit_test(multiview_draws_what_eye_by_eye_does),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
