// Variable rate shading: rings in degrees, blocks of one surface each, and `regular` where nothing is coarse.
#include "renderer/gpu/gpu.h"
#include "stimuli/builtin/maker.h"
#include "tests/renderer/stage.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

enum { WIDTH = 120, HEIGHT = 109, PIXELS = WIDTH * HEIGHT }; // the last tiles and blocks are cut off

static int open_stage(void **state)
{
    struct stage *stage = calloc(1, sizeof *stage);
    *state = stage;
    return stage && stage_open(stage, WIDTH, HEIGHT) ? 0 : -1;
}

static int close_stage(void **state)
{
    stage_close(*state);
    free(*state);
    return 0;
}

// A ground of one colour under a lamp, lit differently at every pixel, without a sun; before it, with `wall`, a
// square that glows against a black sky.
static struct scene *build(bool wall)
{
    struct maker *maker = calloc(1, sizeof *maker);
    assert_true(maker && maker_create(maker, "vrs"));
    struct scene *scene = maker->scene;
    scene->sun.direction = (struct dvec3){0, 1, 0};
    scene->luminance = 1;
    scene->path =
        (struct camera_path){.knots[0] = {{0, 1.2, 0}, {0.2, 0, -0.4}}, .knot_count = 1, .speed_m_s = 1};
    if (wall)
        scene->path.knots[0] = (struct camera_path_knot){{0, 1, 2}, {0.1, 1.1, -3}};
    assert_true(camera_path_finish(&scene->path));
    const uint32_t plain =
        maker_material(maker, &(struct maker_material_desc){.name = "plain", .roughness = 1});
    const uint32_t glow =
        maker_material(maker, &(struct maker_material_desc){
                                  .name = "glow", .roughness = 1, .emissive = {wall ? 3 : 0, wall ? 1 : 0, 0}});
    maker_mesh_begin(maker);
    uint32_t corner[4];
    for (int i = 0; i < 4; i++) {
        const float x = i & 1 ? 1 : -1, y = i & 2 ? 1 : -1;
        struct maker_vertex v = {.position = {40 * x, 0, -40 * y}, .normal = {0, 1, 0}, .colour = {1, 1, 1}};
        if (wall)
            v = (struct maker_vertex){
                .position = {x, 1 + 0.7f * y, 0}, .normal = {0, 0, 1}, .colour = {1, 1, 1}};
        corner[i] = maker_vertex(maker, wall ? glow : plain, &v);
    }
    maker_triangle(maker, wall ? glow : plain, corner[0], corner[1], corner[3]);
    maker_triangle(maker, wall ? glow : plain, corner[0], corner[3], corner[2]);
    const uint32_t node = maker_node(maker, -1, (struct dvec3){0, 0, 0}, (struct dquat){0, 0, 0, 1});
    maker_instance(maker, maker_mesh_end(maker), node);
    for (int i = 0; i < 30 && !wall; i++)
        maker_light(maker, &(struct scene_light){
                               .position = {0.5 * (i % 6) - 1.2, 0.15 + 0.02 * i, 0.5 * (i / 6) - 1.5},
                               .intensity = {0.1f * (float)(i % 3), 0.2f, 0.3f},
                               .range_m = 3,
                               .direction = {0, -1, 0},
                               .cos_inner = 1,
                               .cos_outer = -2});
    scene = maker_finish(maker);
    free(maker);
    assert_non_null(scene);
    return scene;
}

static struct renderer_option *option_of(struct stage *stage, struct renderer_scene *scene, const char *mode,
                                         const struct renderer_settings *settings)
{
    struct mode_choice choice;
    char error[512];
    assert_true(mode_parse(mode, &choice, error, sizeof error));
    struct renderer_option *option = renderer_option_create(stage->renderer, scene, &choice, settings);
    if (!option)
        fail_msg("%s: %s", mode, stage->log);
    return option;
}

static void everything_full_is_regular(void **state)
{
    struct stage *stage = *state;
    char error[512];
    struct scene *scene = scene_open("town:triangles=20000", error, sizeof error);
    struct renderer_scene *uploaded = renderer_scene_create(stage->renderer, scene);
    for (int filtered = 0; filtered < 2; filtered++) {
        const struct renderer_settings settings = {.ssao = filtered, .taa = filtered};
        struct renderer_option *regular = option_of(stage, uploaded, "regular", &settings);
        struct renderer_option *wide = option_of(stage, uploaded, "vrs:inner_deg=180,outer_deg=180", &settings);
        struct renderer_option *lost = option_of(stage, uploaded, "vrs", &settings); // no gaze
        for (uint64_t n = 0; n < 3; n++) {
            const struct frame frame = stage_frame(stage, scene, n, 5 + 0.1 * (double)n, 4, -3);
            struct frame nowhere = frame;
            nowhere.eyes[0].gaze_x_deg = nowhere.eyes[1].gaze_y_deg = NAN;
            struct frame_stats stats[2];
            assert_true(renderer_draw(regular, &frame, NULL) && renderer_draw(wide, &frame, &stats[0]) &&
                        renderer_draw(lost, &nowhere, &stats[1]));
            for (int eye = 0; eye < EYES; eye++) {
                uint8_t *r = stage_read(stage, regular, eye), *w = stage_read(stage, wide, eye),
                        *l = stage_read(stage, lost, eye);
                assert_memory_equal(r, w, 4 * PIXELS);
                assert_memory_equal(r, l, 4 * PIXELS);
                free(r);
                free(w);
                free(l);
            }
            assert_int_equal(stats[0].shaded_px, 2 * PIXELS);
            assert_int_equal(stats[1].shaded_px, 2 * PIXELS);
        }
        renderer_option_destroy(regular);
        renderer_option_destroy(wide);
        renderer_option_destroy(lost);
    }
    renderer_scene_destroy(uploaded);
    scene_destroy(scene);
}

// In double: the angle between the gaze and the middle of the block of `size` that holds a pixel.
static double block_deg(const struct frame_eye *eye, uint32_t x, uint32_t y, uint32_t size)
{
    const double cx = (x / size + 0.5) * size, cy = (y / size + 0.5) * size;
    return geometry_angle_deg(viewing_pixel_direction(&eye->fov, WIDTH, HEIGHT, cx, cy),
                              viewing_direction(eye->gaze_x_deg, eye->gaze_y_deg));
}

static uint32_t block_of(const struct frame_eye *eye, uint32_t x, uint32_t y, double inner, double outer,
                         bool *near_rim)
{
    const double four = block_deg(eye, x, y, 4), two = block_deg(eye, x, y, 2);
    *near_rim = fabs(four - outer) < 1e-3 || fabs(two - inner) < 1e-3;
    return four > outer ? 4 : two > inner ? 2 : 1;
}

struct rings {
    uint64_t shaded; // expected: one a block, if each is one surface
    uint32_t rims, checked[5],
        bent; // checked by size; blocks that are not of one colour, or pixels unlike `regular`
};

static void judge(const struct frame_eye *eye, const uint8_t *coarse, const uint8_t *full, double inner,
                  double outer, struct rings *r)
{
    for (uint32_t y = 0; y < HEIGHT; y++)
        for (uint32_t x = 0; x < WIDTH; x++) {
            bool rim;
            const uint32_t size = block_of(eye, x, y, inner, outer, &rim);
            const uint32_t first = (y - y % size) * WIDTH + x - x % size, own = y * WIDTH + x;
            r->rims += rim;
            r->checked[size]++;
            r->shaded += first == own;
            r->bent += size == 1 ? memcmp(coarse + 4 * own, full + 4 * own, 4) != 0
                                 : memcmp(coarse + 4 * own, coarse + 4 * first, 4) != 0;
        }
}

// Also where the frustum is lopsided and the eyes look apart: angles, not pixels from the middle of the
// picture.
static void rings_are_angles_through_the_projection(void **state)
{
    struct stage *stage = *state;
    struct scene *scene = build(false);
    struct renderer_scene *uploaded = renderer_scene_create(stage->renderer, scene);
    struct renderer_option *regular = option_of(stage, uploaded, "regular", NULL);
    static const struct {
        const char *mode;
        double inner, outer;
    } looks[] = {
        {"vrs", 10, 20}, {"vrs:inner_deg=7.5,outer_deg=33", 7.5, 33}, {"vrs:inner_deg=0,outer_deg=0", 0, 0}};
    for (size_t k = 0; k < sizeof looks / sizeof looks[0]; k++) {
        struct renderer_option *vrs = option_of(stage, uploaded, looks[k].mode, NULL);
        struct frame frame = stage_frame(stage, scene, 0, 0, 0, 0);
        for (int eye = 0; eye < EYES; eye++) {
            frame.eyes[eye].fov = (struct viewing_fov){0.9 - 0.4 * eye, 0.5 + 0.4 * eye, 0.8, 0.6};
            frame.eyes[eye].gaze_x_deg = 13 - 20 * eye;
            frame.eyes[eye].gaze_y_deg = -6 + 9 * eye;
        }
        struct frame_stats stats;
        struct rings rings = {0};
        assert_true(renderer_draw(regular, &frame, NULL) && renderer_draw(vrs, &frame, &stats));
        for (int eye = 0; eye < EYES; eye++) {
            uint8_t *coarse = stage_read(stage, vrs, eye), *full = stage_read(stage, regular, eye);
            judge(&frame.eyes[eye], coarse, full, looks[k].inner, looks[k].outer, &rings);
            free(coarse);
            free(full);
        }
        print_message(
            "%s: %u, %u and %u px at 1x1, 2x2 and 4x4; %u off, %u at a rim; %u shaded of %u expected\n",
            looks[k].mode, rings.checked[1], rings.checked[2], rings.checked[4], rings.bent, rings.rims,
            (uint32_t)stats.shaded_px, (uint32_t)rings.shaded);
        assert_true(rings.bent <= rings.rims);
        assert_true(llabs((long long)stats.shaded_px - (long long)rings.shaded) <= (long long)rings.rims);
        renderer_option_destroy(vrs);
    }
    renderer_option_destroy(regular);
    renderer_scene_destroy(uploaded);
    scene_destroy(scene);
}

// A silhouette stays where it is: coverage and depth are of every pixel.
static void a_block_with_two_surfaces_is_shaded_twice(void **state)
{
    struct stage *stage = *state;
    struct scene *scene = build(true);
    struct renderer_scene *uploaded = renderer_scene_create(stage->renderer, scene);
    struct renderer_option *regular = option_of(stage, uploaded, "regular", NULL);
    struct renderer_option *vrs = option_of(stage, uploaded, "vrs:inner_deg=0,outer_deg=0", NULL);
    const struct frame frame = stage_frame(stage, scene, 0, 0, 30, 20);
    struct frame_stats stats;
    assert_true(renderer_draw(regular, &frame, NULL) && renderer_draw(vrs, &frame, &stats));
    uint32_t glowing = 0;
    for (int eye = 0; eye < EYES; eye++) {
        uint8_t *coarse = stage_read(stage, vrs, eye), *full = stage_read(stage, regular, eye);
        assert_memory_equal(coarse, full, 4 * PIXELS); // the wall glows evenly
        for (size_t i = 0; i < PIXELS; i++)
            glowing += full[4 * i] > 0;
        free(coarse);
        free(full);
    }
    const uint32_t blocks = 2 * ((WIDTH + 3) / 4) * ((HEIGHT + 3) / 4);
    print_message("%u px glow; %u shaded in %u blocks\n", glowing, (uint32_t)stats.shaded_px, blocks);
    assert_true(glowing > 1000 && stats.shaded_px > blocks && stats.shaded_px < blocks + blocks / 3);
    renderer_option_destroy(regular);
    renderer_option_destroy(vrs);
    renderer_scene_destroy(uploaded);
    scene_destroy(scene);
}

static void what_hardware_lacks_is_said(void **state)
{
    struct stage *stage = *state;
    struct scene *scene = build(true);
    struct renderer_scene *uploaded = renderer_scene_create(stage->renderer, scene);
    struct mode_choice choice;
    char error[512];
    assert_true(mode_parse("vrs:path=hardware", &choice, error, sizeof error));
    struct renderer_option *option = renderer_option_create(stage->renderer, uploaded, &choice, NULL);
    if (option) { // a device that has it must draw
        const struct frame frame = stage_frame(stage, scene, 0, 0, 0, 0);
        struct frame_stats stats;
        assert_true(renderer_draw(option, &frame, &stats));
        assert_true(stats.shaded_px > 0 && stats.shaded_px < 2 * PIXELS);
    } else {
        assert_non_null(strstr(stage->log, "vrs with path=hardware needs a map of shading rates"));
        assert_non_null(strstr(stage->log, "path=compute runs anywhere"));
    }
    renderer_option_destroy(option);
    renderer_scene_destroy(uploaded);
    scene_destroy(scene);
}

static void rates_are_coded_and_chosen(void **state)
{
    (void)state;
    assert_int_equal(gpu_shading_rate_code(1, 1), 0);
    assert_int_equal(gpu_shading_rate_code(1, 2), 1);
    assert_int_equal(gpu_shading_rate_code(2, 1), 4);
    assert_int_equal(gpu_shading_rate_code(2, 2), 5);
    assert_int_equal(gpu_shading_rate_code(4, 4), 10);
    VkPhysicalDeviceFragmentShadingRateKHR rates[] = {
        {.fragmentSize = {4, 4}, .sampleCounts = VK_SAMPLE_COUNT_1_BIT | VK_SAMPLE_COUNT_4_BIT},
        {.fragmentSize = {4, 2}, .sampleCounts = VK_SAMPLE_COUNT_1_BIT},
        {.fragmentSize = {2, 2}, .sampleCounts = VK_SAMPLE_COUNT_1_BIT},
        {.fragmentSize = {1, 1}, .sampleCounts = ~0u},
    };
    assert_int_equal(gpu_shading_rate_largest(rates, 4), 4);
    assert_int_equal(gpu_shading_rate_largest(rates + 1, 3), 2);
    rates[0].sampleCounts = VK_SAMPLE_COUNT_4_BIT;
    assert_int_equal(gpu_shading_rate_largest(rates, 4), 2);
    assert_int_equal(gpu_shading_rate_largest(NULL, 0), 2);
    assert_int_equal(gpu_shading_rate_texel((VkExtent2D){8, 8}, (VkExtent2D){32, 32}), 8);
    assert_int_equal(gpu_shading_rate_texel((VkExtent2D){16, 16}, (VkExtent2D){16, 16}), 16);
    assert_int_equal(gpu_shading_rate_texel((VkExtent2D){4, 4}, (VkExtent2D){64, 64}), 8);
    assert_int_equal(gpu_shading_rate_texel((VkExtent2D){32, 8}, (VkExtent2D){32, 16}), 0);
}

int main(void)
{
    struct stage probe;
    if (!stage_open(&probe, 16, 16))
        return 77;
    stage_close(&probe);
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(everything_full_is_regular),
        cmocka_unit_test(rings_are_angles_through_the_projection),
        cmocka_unit_test(a_block_with_two_surfaces_is_shaded_twice),
        cmocka_unit_test(what_hardware_lacks_is_said),
        cmocka_unit_test(rates_are_coded_and_chosen),
    };
    return cmocka_run_group_tests(tests, open_stage, close_stage);
}
