// The makers' tools: normals, tangents, splitting, mip maps, poses; each against what geometry or arithmetic
// says.
#include "stimuli/scene.h"

#include <setjmp.h>
#include <stdarg.h>

#include <cmocka.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

static uint64_t next_random(uint64_t *state)
{
    *state = *state * 6364136223846793005u + 1442695040888963407u;
    return *state >> 33;
}

static double uniform(uint64_t *state)
{
    return (double)next_random(state) / 2147483648.0;
}

// Written from the map's definition, apart from the code under test.
static struct dvec3 decode(const int16_t n[2])
{
    double u = n[0] / 32767.0, v = n[1] / 32767.0, z = 1 - fabs(u) - fabs(v);
    double fold = z < 0 ? -z : 0;
    return dvec3_normalise((struct dvec3){u - copysign(fold, u), v - copysign(fold, v), z});
}

static void encodes_normals_to_a_thousandth_of_a_degree(void **state)
{
    (void)state;
    uint64_t seed = 5;
    for (int i = 0; i < 20000; i++) {
        float n[3];
        int16_t code[2];
        for (int k = 0; k < 3; k++)
            n[k] = (float)(uniform(&seed) * 2 - 1);
        if (i < 6) {
            memset(n, 0, sizeof n);
            n[i / 2] = i % 2 ? -1.0f : 1.0f;
        }
        scene_encode_normal(n, code);
        double angle =
            geometry_angle_deg(decode(code), (struct dvec3){(double)n[0], (double)n[1], (double)n[2]});
        if (!(angle < 0.005))
            fail_msg("%g %g %g is off by %g deg", (double)n[0], (double)n[1], (double)n[2], angle);
    }
}

// A cylinder whose u runs around and v down: the tangent at each vertex is the derivative of position by u.
static void tangents_follow_u_on_a_cylinder(void **state)
{
    (void)state;
    enum { AROUND = 64, UP = 5 };
    for (int mirrored = 0; mirrored < 2; mirrored++) {
        struct scene_vertex vertices[(AROUND + 1) * UP] = {0};
        uint32_t indices[AROUND * (UP - 1) * 6], count = 0;
        for (int j = 0; j < UP; j++)
            for (int i = 0; i <= AROUND; i++) {
                struct scene_vertex *v = &vertices[j * (AROUND + 1) + i];
                double a = 2 * 3.14159265358979 * i / AROUND;
                const float normal[3] = {(float)sin(a), 0, (float)cos(a)};
                v->position[0] = 2 * normal[0], v->position[1] = (float)j, v->position[2] = 2 * normal[2];
                v->uv[0][0] = (float)(mirrored ? -i : i) / AROUND, v->uv[0][1] = -(float)j;
                scene_encode_normal(normal, v->normal);
            }
        for (uint32_t j = 0; j + 1 < UP; j++)
            for (uint32_t i = 0; i < AROUND; i++) {
                uint32_t a = j * (AROUND + 1) + i, b = a + AROUND + 1;
                const uint32_t quad[6] = {a, a + 1, b + 1, a, b + 1, b};
                memcpy(indices + count, quad, sizeof quad);
                count += 6;
            }
        scene_make_tangents(vertices, (AROUND + 1) * UP, indices, count);
        for (int i = 1; i < AROUND; i++) {
            double a = 2 * 3.14159265358979 * i / AROUND, s = mirrored ? -1 : 1;
            const int16_t *t = vertices[2 * (AROUND + 1) + i].tangent;
            double angle = geometry_angle_deg((struct dvec3){t[0], t[1], t[2]},
                                              (struct dvec3){s * cos(a), 0, -s * sin(a)});
            assert_true(angle < 0.1);
            // v runs down in glTF, so on an outside that is not mirrored the bitangent (up) is cross(n, t).
            assert_int_equal(t[3], mirrored ? 32767 : -32767);
        }
    }
}

static void degenerate_tangents_stay_at_right_angles(void **state)
{
    (void)state;
    struct scene_vertex v[3] = {{.position = {0, 0, 0}}, {.position = {1, 0, 0}}, {.position = {0, 1, 0}}};
    const uint32_t indices[3] = {0, 1, 2};
    for (int k = 0; k < 3; k++)
        scene_encode_normal((const float[3]){k == 0, k == 1, k == 2}, v[k].normal);
    v[1].tangent[1] = 32767, v[1].tangent[3] = -32767;
    scene_make_tangents(v, 3, indices, 3);
    for (int k = 0; k < 3; k++) {
        const int16_t *t = v[k].tangent;
        struct dvec3 tangent = {t[0] / 32767.0, t[1] / 32767.0, t[2] / 32767.0};
        assert_true(fabs(dvec3_length(tangent) - 1) < 1e-3);
        if (k != 1)
            assert_true(fabs(dvec3_dot(tangent, decode(v[k].normal))) < 1e-3);
    }
    assert_int_equal(v[1].tangent[1], 32767); // given ones are kept
    assert_int_equal(v[1].tangent[3], -32767);
}

static int compare_triangles(const void *a, const void *b)
{
    return memcmp(a, b, 3 * sizeof(uint32_t));
}

// Each triangle turned so that its smallest index comes first: winding is kept, order within may change.
static void canonical(uint32_t *indices, uint32_t count)
{
    for (uint32_t i = 0; i < count; i += 3) {
        uint32_t *t = indices + i;
        while (t[0] > t[1] || t[0] > t[2]) {
            uint32_t first = t[0];
            t[0] = t[1], t[1] = t[2], t[2] = first;
        }
    }
    qsort(indices, count / 3, 3 * sizeof *indices, compare_triangles);
}

static void split_keeps_every_triangle_in_tight_compact_pieces(void **state)
{
    (void)state;
    enum { SIDE = 101, TRIANGLES = (SIDE - 1) * (SIDE - 1) * 2 };
    struct scene_vertex *vertices = calloc(SIDE * SIDE, sizeof *vertices);
    uint32_t *indices = malloc(TRIANGLES * 3 * sizeof *indices),
             *before = malloc(TRIANGLES * 3 * sizeof *before);
    struct scene_submodel *pieces = malloc(TRIANGLES * sizeof *pieces);
    for (int i = 0; i < SIDE * SIDE; i++) {
        vertices[i].position[0] = (float)(i % SIDE);
        vertices[i].position[2] = (float)(i / SIDE);
    }
    uint32_t count = 0;
    for (uint32_t z = 0; z + 1 < SIDE; z++)
        for (uint32_t x = 0; x + 1 < SIDE; x++) {
            uint32_t a = z * SIDE + x, b = a + SIDE;
            const uint32_t quad[6] = {a, b, a + 1, a + 1, b, b + 1};
            memcpy(indices + count, quad, sizeof quad);
            count += 6;
        }
    // The file's order is the worst: shuffled.
    uint64_t seed = 9;
    for (uint32_t i = count / 3 - 1; i > 0; i--) {
        uint32_t k = (uint32_t)(next_random(&seed) % (i + 1)), t[3];
        memcpy(t, indices + i * 3, sizeof t);
        memcpy(indices + i * 3, indices + k * 3, sizeof t);
        memcpy(indices + k * 3, t, sizeof t);
    }
    memcpy(before, indices, count * sizeof *before);
    uint32_t made = scene_split(vertices, SIDE * SIDE, indices, count, 900, 7, pieces);
    assert_int_equal(made, TRIANGLES / SCENE_SUBMODEL_TRIANGLES);
    uint32_t at = 900;
    double area = 0;
    for (uint32_t i = 0; i < made; i++) {
        assert_int_equal(pieces[i].first_index, at);
        assert_int_equal(pieces[i].material, 7);
        assert_true(pieces[i].index_count <= SCENE_SUBMODEL_TRIANGLES * 3);
        struct scene_box box = {{1e9f, 1e9f, 1e9f}, {-1e9f, -1e9f, -1e9f}};
        for (uint32_t k = at - 900; k < at - 900 + pieces[i].index_count; k++)
            for (int axis = 0; axis < 3; axis++) {
                box.min[axis] = fminf(box.min[axis], vertices[indices[k]].position[axis]);
                box.max[axis] = fmaxf(box.max[axis], vertices[indices[k]].position[axis]);
            }
        assert_memory_equal(&box, &pieces[i].bounds, sizeof box);
        area += (double)((box.max[0] - box.min[0]) * (box.max[2] - box.min[2]));
        at += pieces[i].index_count;
    }
    assert_int_equal(at, 900 + count);
    // Pieces that do not overlap would cover the plane once.
    if (!(area < 1.5 * (SIDE - 1) * (SIDE - 1)))
        fail_msg("the boxes cover %g times the plane", area / ((SIDE - 1) * (SIDE - 1)));
    canonical(indices, count);
    canonical(before, count);
    assert_memory_equal(indices, before, count * sizeof *before);
    free(vertices);
    free(indices);
    free(before);
    free(pieces);
}

static void split_of_few_or_coincident_triangles(void **state)
{
    (void)state;
    struct scene_vertex vertices[3] = {0};
    uint32_t indices[1503 * 3];
    struct scene_submodel pieces[1503];
    for (uint32_t i = 0; i < 1503 * 3; i++)
        indices[i] = i % 3;
    assert_int_equal(scene_split(vertices, 3, indices, 3, 0, 0, pieces), 1);
    assert_int_equal(pieces[0].index_count, 3);
    assert_int_equal(scene_split(vertices, 3, indices, 0, 0, 0, pieces), 0);
    assert_int_equal(scene_split(vertices, 3, indices, 1503 * 3, 0, 0, pieces), 4);
    assert_int_equal(pieces[3].index_count, 9);
}

static double linear(uint8_t srgb)
{
    double v = srgb / 255.0;
    return v <= 0.04045 ? v / 12.92 : pow((v + 0.055) / 1.055, 2.4);
}

static struct scene_texture noise(uint32_t width, uint32_t height, bool srgb, uint64_t seed)
{
    struct scene_texture t = {.width = width, .height = height, .levels = 1, .srgb = srgb};
    t.rgba = malloc((size_t)width * height * 4);
    for (size_t i = 0; i < (size_t)width * height * 4; i++)
        t.rgba[i] = (uint8_t)next_random(&seed);
    return t;
}

static uint32_t at_least_one(uint32_t v)
{
    return v > 0 ? v : 1;
}

static void mips_keep_the_mean_of_linear_light(void **state)
{
    (void)state;
    static const uint32_t sizes[][2] = {{64, 64}, {37, 53}, {1, 19}, {256, 3}, {1, 1}, {100, 100}};
    for (size_t s = 0; s < sizeof sizes / sizeof sizes[0]; s++)
        for (int srgb = 0; srgb < 2; srgb++) {
            struct scene_texture t = noise(sizes[s][0], sizes[s][1], srgb, 77 + s);
            assert_true(scene_make_mips(&t, 0.0f));
            assert_int_equal(t.levels, 1 + (uint32_t)floor(log2(fmax(t.width, t.height))));
            double first[4];
            const uint8_t *at = t.rgba;
            for (uint32_t level = 0; level < t.levels; level++) {
                size_t pixels = (size_t)at_least_one(t.width >> level) * at_least_one(t.height >> level);
                double sum[4] = {0};
                for (size_t i = 0; i < pixels; i++, at += 4)
                    for (int k = 0; k < 4; k++)
                        sum[k] += (srgb && k < 3 ? linear(at[k]) : at[k] / 255.0) / (double)pixels;
                if (level == 0)
                    memcpy(first, sum, sizeof first);
                for (int k = 0; k < 4; k++) // one 8-bit step near the middle of the sRGB curve is 0.007
                    if (!(fabs(sum[k] - first[k]) < 0.005))
                        fail_msg("%ux%u level %u channel %d: mean %g, was %g", t.width, t.height, level, k,
                                 sum[k], first[k]);
            }
            free(t.rgba);
        }
}

static void mips_of_black_and_white_are_not_gray_128(void **state)
{
    (void)state;
    struct scene_texture t = {.width = 2, .height = 1, .levels = 1, .srgb = true, .rgba = calloc(2, 4)};
    memset(t.rgba + 4, 255, 4);
    assert_true(scene_make_mips(&t, 0.0f));
    assert_int_equal(t.levels, 2);
    assert_int_equal(t.rgba[8], 188); // half the light of white
    assert_int_equal(t.rgba[11], 128);
    free(t.rgba);
}

static double covered(const uint8_t *rgba, size_t pixels, double cutoff)
{
    size_t count = 0;
    for (size_t i = 0; i < pixels; i++)
        count += rgba[i * 4 + 3] / 255.0 >= cutoff;
    return (double)count / (double)pixels;
}

// Leaves: crossing strokes two or three texels thin with soft edges.
static struct scene_texture strokes(void)
{
    struct scene_texture t = noise(256, 128, true, 3);
    for (int i = 0; i < 256 * 128; i++) {
        double x = i % 256, y = i / 256.0;
        double wave = fabs(sin(x * 0.31 + 1.7 * sin(y * 0.11))) * fabs(sin(y * 0.23 + x * 0.09));
        double alpha = 0.5 + 8.0 * (0.06 - wave);
        t.rgba[i * 4 + 3] = (uint8_t)(255 * fmin(fmax(alpha, 0), 1));
    }
    return t;
}

static double worst_coverage(float test_cutoff, float kept_cutoff)
{
    struct scene_texture t = strokes();
    double wanted = covered(t.rgba, 256 * 128, (double)test_cutoff), worst = 0;
    assert_true(wanted > 0.05 && wanted < 0.6);
    assert_true(scene_make_mips(&t, kept_cutoff));
    const uint8_t *at = t.rgba;
    for (uint32_t level = 0; level < 6; level++) { // down to 8 x 4
        size_t pixels = (size_t)(256u >> level) * (128u >> level);
        worst = fmax(worst, fabs(covered(at, pixels, (double)test_cutoff) - wanted));
        at += pixels * 4;
    }
    free(t.rgba);
    return worst;
}

static void mips_keep_the_covered_area(void **state)
{
    (void)state;
    static const float cutoffs[] = {0.3f, 0.5f, 0.8f};
    for (int c = 0; c < 3; c++) {
        double worst = worst_coverage(cutoffs[c], cutoffs[c]);
        if (!(worst < 0.03))
            fail_msg("cutoff %g: coverage changes by %g", (double)cutoffs[c], worst);
    }
    assert_true(worst_coverage(0.5f, 0.0f) > 0.1); // what a plain box filter does to the same strokes
}

static void masked_mips_keep_the_leaf_colour(void **state)
{
    (void)state;
    // Green leaf on white that no one sees: the white must not come in.
    struct scene_texture t = {.width = 4, .height = 4, .levels = 1, .srgb = true, .rgba = malloc(64)};
    for (int i = 0; i < 16; i++) {
        const uint8_t leaf[4] = {10, 120, 20, 255}, none[4] = {255, 255, 255, 0};
        memcpy(t.rgba + i * 4, i % 4 < 1 ? leaf : none, 4);
    }
    assert_true(scene_make_mips(&t, 0.5f));
    const uint8_t *last = t.rgba + (16 + 4) * 4;
    assert_int_equal(last[0], 10);
    assert_int_equal(last[1], 120);
    assert_int_equal(last[2], 20);
    free(t.rgba);
}

static void poses_follow_the_curves(void **state)
{
    (void)state;
    float times[] = {1, 2, 4};
    float line[] = {0, 0, 0, 10, 0, 0, 10, 8, 0};
    float cubic[] = {0, 0, 0, 1, 1, 1, 6, 0, 0, 0, 3, 0, 2, 2, 2, 0, 0, 0, 0, 0, 0, 2, 2, 2, 0, 0, 0};
    struct scene_node nodes[3] = {
        {.parent = -1, .local = dmat4_identity(), .rotation = {0, 0, 0, 1}, .scale = {1, 1, 1}},
        {.parent = 0, .local = dmat4_identity()},
        {.parent = -1, .local = dmat4_identity()}};
    nodes[1].local.m[12] = 100;
    nodes[2].local.m[13] = 55;
    struct scene_channel channels[2] = {{0, SCENE_SCALE, SCENE_CUBIC, 3, times, cubic},
                                        {0, SCENE_TRANSLATION, SCENE_LINEAR, 3, times, line}};
    struct scene scene = {
        .nodes = nodes, .node_count = 3, .channels = channels, .channel_count = 2, .animation_s = 4};
    scene_finish(&scene);
    assert_true(nodes[0].moving && nodes[1].moving && !nodes[2].moving);
    struct dmat4 world[3];
    scene_pose(&scene, 1.25, false, world);
    assert_true(fabs(world[0].m[12] - 2.5) < 1e-9);
    // Hermite at t = 1/4 with step 1: h00 = 0.84375, h10 = 0.140625, h01 = 0.15625, h11 = -0.046875
    double scale_x = 0.84375 * 1 + 0.140625 * 6 + 0.15625 * 2 - 0.046875 * 0;
    double scale_y = 0.84375 * 1 + 0.15625 * 2 - 0.046875 * 3;
    assert_true(fabs(world[0].m[0] - scale_x) < 1e-9);
    assert_true(fabs(world[0].m[5] - scale_y) < 1e-9);
    assert_true(fabs(world[1].m[12] - (2.5 + 100 * scale_x)) < 1e-9);
    assert_true(fabs(world[2].m[13] - 55) < 1e-12);
    scene_pose(&scene, 3.0 + 4.0 * 5, false, world); // repeats
    assert_true(fabs(world[0].m[13] - 4) < 1e-9);
    scene_pose(&scene, -1.0, false, world);
    assert_true(fabs(world[0].m[13] - 4) < 1e-9);
    scene_pose(&scene, 0.5, false, world); // before the first key
    assert_true(fabs(world[0].m[12]) < 1e-12 && fabs(world[0].m[0] - 1) < 1e-12);
    world[2].m[13] = -1;
    scene_pose(&scene, 1.5, true, world);
    assert_true(fabs(world[2].m[13] + 1) < 1e-12); // left alone
    assert_true(fabs(world[0].m[12] - 5) < 1e-9);
}

static void rotations_turn_evenly_and_steps_jump(void **state)
{
    (void)state;
    float times[] = {0, 1};
    float turn[] = {0, 0, 0, 1, 0, -0.70710678f, 0, -0.70710678f}; // a quarter about y, by the far sign
    float step[] = {1, 2, 3, 4, 5, 6};
    struct scene_node node = {
        .parent = -1, .local = dmat4_identity(), .rotation = {0, 0, 0, 1}, .scale = {1, 1, 1}};
    struct scene_channel channels[2] = {{0, SCENE_ROTATION, SCENE_LINEAR, 2, times, turn},
                                        {0, SCENE_TRANSLATION, SCENE_STEP, 2, times, step}};
    struct scene scene = {
        .nodes = &node, .node_count = 1, .channels = channels, .channel_count = 2, .animation_s = 1};
    scene_finish(&scene);
    for (int i = 0; i < 10; i++) {
        struct dmat4 world;
        scene_pose(&scene, i / 10.0, false, &world);
        struct dvec3 x = dmat4_direction(&world, (struct dvec3){1, 0, 0});
        assert_true(fabs(atan2(-x.z, x.x) - i * 9.0 * 3.14159265358979 / 180) < 1e-6);
        assert_true(fabs(world.m[12] - 1) < 1e-12 && fabs(world.m[14] - 3) < 1e-12);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(encodes_normals_to_a_thousandth_of_a_degree),
        cmocka_unit_test(tangents_follow_u_on_a_cylinder),
        cmocka_unit_test(degenerate_tangents_stay_at_right_angles),
        cmocka_unit_test(split_keeps_every_triangle_in_tight_compact_pieces),
        cmocka_unit_test(split_of_few_or_coincident_triangles),
        cmocka_unit_test(mips_keep_the_mean_of_linear_light),
        cmocka_unit_test(mips_of_black_and_white_are_not_gray_128),
        cmocka_unit_test(mips_keep_the_covered_area),
        cmocka_unit_test(masked_mips_keep_the_leaf_colour),
        cmocka_unit_test(poses_follow_the_curves),
        cmocka_unit_test(rotations_turn_evenly_and_steps_jump),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
