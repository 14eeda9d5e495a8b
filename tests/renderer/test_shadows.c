// Sun shadows: where geometry says, and nowhere else. The sky is black here, so that what the sun does not
// reach is 0.
#include "stimuli/builtin/maker.h"
#include "tests/renderer/stage.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

enum { SIZE = 96 };
static const double half_plane_m = 4, half_quad_m = 0.8, quad_m = 1.6, eye_m = 1.5; // heights over the plane

struct look {
    struct dvec3 sun;  // towards it; all zero: none
    struct dvec3 away; // the whole scene
    double tilt_rad;   // of the plane, about x
    bool quad, quad_moves, quad_masked, plane_moves;
};

static void add_square(struct maker *maker, uint32_t material, double half, double y, uint32_t node)
{
    maker_mesh_begin(maker);
    uint32_t corner[4];
    for (int i = 0; i < 4; i++) {
        struct maker_vertex v = {
            .position = {(float)(i & 1 ? half : -half), (float)y, (float)(i & 2 ? half : -half)},
            .normal = {0, 1, 0},
            .uv = {(float)(i & 1), (float)(i >> 1)},
            .colour = {1, 1, 1}};
        corner[i] = maker_vertex(maker, material, &v);
    }
    maker_triangle(maker, material, corner[0], corner[3], corner[1]);
    maker_triangle(maker, material, corner[0], corner[2], corner[3]);
    maker_instance(maker, maker_mesh_end(maker), node);
}

static uint32_t add_node(struct maker *maker, const struct look *look, double tilt_rad, bool moves)
{
    const struct dquat turn = {sin(tilt_rad / 2), 0, 0, cos(tilt_rad / 2)};
    const uint32_t node = maker_node(maker, -1, look->away, turn);
    const float at[3] = {(float)look->away.x, (float)look->away.y, (float)look->away.z};
    const float keys[6] = {at[0], at[1], at[2], at[0], at[1], at[2]};
    if (moves)
        maker_channel(maker, node, SCENE_TRANSLATION, 2, (const float[]){0, 1}, keys);
    return node;
}

static struct scene *build(const struct look *look)
{
    struct maker *maker = calloc(1, sizeof *maker);
    assert_true(maker && maker_create(maker, "shadows"));
    struct scene *scene = maker->scene;
    const bool sun = dvec3_length(look->sun) > 0;
    scene->sun.direction = sun ? dvec3_normalise(look->sun) : (struct dvec3){0, 1, 0};
    for (int i = 0; i < 3; i++) {
        scene->sun.illuminance[i] = sun ? 3 : 0;
        scene->sky.zenith[i] = scene->sky.horizon[i] = scene->sky.ground[i] = 0;
    }
    scene->luminance = 0.18f;
    // between the plane and the square over it, looking down, a little askew
    const struct dvec3 eye = {0.1, eye_m, 0.05}, target = {0.25, 0, 0.3};
    scene->path = (struct camera_path){.knots[0] = {dvec3_add(look->away, eye), dvec3_add(look->away, target)},
                                       .knot_count = 1,
                                       .speed_m_s = 1};
    assert_true(camera_path_finish(&scene->path));
    uint8_t *clear = calloc(16, 4);
    const int32_t texture = maker_texture(maker, 4, clear, true, false, 0);
    const uint32_t plain =
        maker_material(maker, &(struct maker_material_desc){.name = "plain", .roughness = 1});
    const uint32_t masked =
        maker_material(maker, &(struct maker_material_desc){
                                  .name = "holes", .roughness = 1, .base = texture + 1, .alpha_mask = true});
    add_square(maker, plain, half_plane_m, 0, add_node(maker, look, look->tilt_rad, look->plane_moves));
    if (look->quad)
        add_square(maker, look->quad_masked ? masked : plain, half_quad_m, quad_m,
                   add_node(maker, look, 0, look->quad_moves));
    scene = maker_finish(maker);
    free(maker);
    assert_non_null(scene);
    return scene;
}

struct picture {
    uint8_t *left; // rgba, freed by the caller
    struct frame frame;
    char explanation[4096];
};

static struct picture draw(struct stage *stage, const struct look *look)
{
    struct picture p = {0};
    struct scene *scene = build(look);
    struct renderer_scene *uploaded = renderer_scene_create(stage->renderer, scene);
    assert_non_null(uploaded);
    struct renderer_option *option = stage_option(stage, uploaded, "regular");
    p.frame = stage_frame(stage, scene, 0, 0, 0, 0);
    p.frame.moving = true;
    assert_true(renderer_draw(option, &p.frame, NULL));
    assert_true(renderer_option_explain(option, p.explanation, sizeof p.explanation));
    p.left = stage_read(stage, option, EYE_LEFT);
    renderer_option_destroy(option);
    renderer_scene_destroy(uploaded);
    scene_destroy(scene);
    return p;
}

static uint32_t differing(const uint8_t *a, const uint8_t *b, int most)
{
    uint32_t count = 0;
    for (size_t i = 0; i < SIZE * SIZE; i++)
        count += abs(a[4 * i] - b[4 * i]) > most;
    return count;
}

static const struct dvec3 suns[] = {{0, 1, 0},       {0.3, 1, 0.2},       {1, 1, -0.5},   {-1, 0.5, 1},
                                    {0.9, 0.3, 0.1}, {0.02, 0.17, -0.98}, {1, 0.08, 0.7}, {-0.6, 0.03, 1}};

// How far a point of the plane is from the edge of the square's shadow, metres; positive inside.
static double inside_shadow(const struct dvec3 p, const struct dvec3 sun)
{
    const double t = quad_m / sun.y;
    return half_quad_m - fmax(fabs(p.x + sun.x * t), fabs(p.z + sun.z * t));
}

static void a_square_s_shadow_lies_where_the_sun_puts_it(void **state)
{
    struct stage *stage = *state;
    uint32_t dark = 0, lit = 0, unclear = 0;
    for (int k = 0; k < 4; k++) {
        struct picture p = draw(stage, &(struct look){.sun = suns[k], .quad = true});
        const struct frame_eye *eye = &p.frame.eyes[EYE_LEFT];
        const struct dvec3 sun = dvec3_normalise(suns[k]);
        // the filter reaches 2 texels of 2 cm each way in the map; the lift moves the surface as far towards
        // the sun; on the ground both are longer by 1 / sin of the sun's height
        const double blur = 2 * 2.83 * 0.02 / sun.y;
        for (uint32_t i = 0; i < SIZE * SIZE; i++) {
            struct dvec3 d = viewing_pixel_direction(&eye->fov, SIZE, SIZE, i % SIZE + 0.5, i / SIZE + 0.5);
            d = dquat_rotate(eye->pose.orientation, d);
            const struct dvec3 hit = dvec3_add(eye->pose.position, dvec3_scale(d, -eye->pose.position.y / d.y));
            if (d.y > -1e-3 || fmax(fabs(hit.x), fabs(hit.z)) > half_plane_m - 0.05)
                continue;
            const double in = inside_shadow(hit, sun);
            if (fabs(in) < blur) {
                unclear++;
                continue;
            }
            const bool shadowed = p.left[4 * i] == 0;
            if (shadowed != (in > 0))
                fail_msg("sun %d, pixel %u,%u: %s, %.3f m from the edge", k, i % SIZE, i / SIZE,
                         shadowed ? "dark" : "lit", in);
            dark += shadowed;
            lit += !shadowed;
        }
        free(p.left);
    }
    print_message("%u pixels dark, %u lit, %u near an edge\n", dark, lit, unclear);
    assert_true(dark > 1000 && lit > 10000);
}

// A plane that moves is not in the map, so nothing shadows it: the standing one must look the same to the last
// bit.
static void a_lit_plane_does_not_shadow_itself(void **state)
{
    struct stage *stage = *state;
    static const double tilts[] = {0, 0.3, -0.7};
    for (size_t t = 0; t < sizeof tilts / sizeof tilts[0]; t++)
        for (size_t k = 0; k < sizeof suns / sizeof suns[0]; k++) {
            struct look look = {.sun = suns[k], .tilt_rad = tilts[t]};
            struct picture still = draw(stage, &look);
            look.plane_moves = true;
            struct picture moving = draw(stage, &look);
            assert_non_null(strstr(still.explanation, "sun shadows of what stands still"));
            assert_non_null(strstr(moving.explanation, "no sun shadows"));
            const uint32_t wrong = differing(still.left, moving.left, 0);
            if (wrong)
                fail_msg("sun %zu, tilt %g: %u pixels differ", k, tilts[t], wrong);
            free(still.left);
            free(moving.left);
        }
}

static void what_moves_or_is_cut_out_casts_none(void **state)
{
    struct stage *stage = *state;
    struct look look = {.sun = suns[1]};
    struct picture bare = draw(stage, &look);
    look.quad = true;
    struct picture still = draw(stage, &look);
    assert_true(differing(bare.left, still.left, 0) > 100);
    look.quad_moves = true;
    struct picture moving = draw(stage, &look);
    assert_int_equal(differing(bare.left, moving.left, 0), 0);
    look.quad_moves = false;
    look.quad_masked = true;
    struct picture clear = draw(stage, &look);
    assert_int_equal(differing(bare.left, clear.left, 0), 0);
    free(bare.left);
    free(still.left);
    free(moving.left);
    free(clear.left);
}

static void a_scene_without_a_sun_has_no_map(void **state)
{
    struct picture p = draw(*state, &(struct look){.quad = true});
    assert_non_null(strstr(p.explanation, "     0.00 MiB  no sun shadows"));
    free(p.left);
}

// 160 steps of the origin's grid to the side: the same picture, but for the rounding of the map's edges.
static void ten_kilometres_out_shadows_are_the_same(void **state)
{
    struct look look = {.sun = suns[2], .quad = true};
    struct picture here = draw(*state, &look);
    look.away = (struct dvec3){10240, 0, -10240};
    struct picture there = draw(*state, &look);
    assert_int_equal(differing(here.left, there.left, 1), 0);
    free(here.left);
    free(there.left);
}

static int open_stage(void **state)
{
    struct stage *stage = calloc(1, sizeof *stage);
    *state = stage;
    return stage && stage_open(stage, SIZE, SIZE) ? 0 : -1;
}

static int close_stage(void **state)
{
    stage_close(*state);
    free(*state);
    return 0;
}

int main(void)
{
    struct stage probe;
    if (!stage_open(&probe, 16, 16))
        return 77;
    stage_close(&probe);
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_square_s_shadow_lies_where_the_sun_puts_it),
        cmocka_unit_test(a_lit_plane_does_not_shadow_itself),
        cmocka_unit_test(what_moves_or_is_cut_out_casts_none),
        cmocka_unit_test(a_scene_without_a_sun_has_no_map),
        cmocka_unit_test(ten_kilometres_out_shadows_are_the_same),
    };
    return cmocka_run_group_tests(tests, open_stage, close_stage);
}
