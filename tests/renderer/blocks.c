#include "tests/renderer/blocks.h"

#include "stimuli/builtin/maker.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>

#include <cmocka.h>

static void add_face(struct maker *maker, uint32_t material, const struct block *b, int axis, int side)
{
    const double half[3] = {b->half.x, b->half.y, b->half.z};
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    uint32_t corner[4];
    for (int i = 0; i < 4; i++) {
        struct maker_vertex vertex = {.uv = {(float)(i & 1), (float)(i >> 1)}, .colour = {1, 1, 1}};
        vertex.position[axis] = (float)(side * half[axis]);
        vertex.position[u] = (float)(i & 1 ? half[u] : -half[u]);
        vertex.position[v] = (float)(i & 2 ? half[v] : -half[v]);
        vertex.normal[axis] = (float)(b->inside_out ? -side : side);
        corner[i] = maker_vertex(maker, material, &vertex);
    }
    const bool flip = (side < 0) != b->inside_out;
    maker_triangle(maker, material, corner[0], corner[flip ? 3 : 1], corner[flip ? 1 : 3]);
    maker_triangle(maker, material, corner[0], corner[flip ? 2 : 3], corner[flip ? 3 : 2]);
}

static void add_block(struct maker *maker, const struct block *b)
{
    struct maker_material_desc look = {
        .name = "block", .roughness = 1 - b->smoothness, .metallic = b->metallic};
    for (int i = 0; i < 3; i++) {
        look.colour[i] = b->colour[i];
        look.emissive[i] = b->emissive[i];
    }
    const uint32_t material = maker_material(maker, &look);
    maker_mesh_begin(maker);
    for (int face = 0; face < 6; face++)
        add_face(maker, material, b, face / 2, face % 2 ? 1 : -1);
    const uint32_t mesh = maker_mesh_end(maker);
    const uint32_t node = maker_node(maker, -1, b->middle, (struct dquat){0, 0, 0, 1});
    if (b->keys) {
        float times[8], values[24];
        assert_true(b->key_count <= 8);
        for (uint32_t i = 0; i < b->key_count; i++) {
            times[i] = b->keys[i].time_s;
            values[3 * i] = b->keys[i].x;
            values[3 * i + 1] = b->keys[i].y;
            values[3 * i + 2] = b->keys[i].z;
        }
        maker->scene->animation_s = fmaxf(maker->scene->animation_s, times[b->key_count - 1]);
        maker_channel(maker, node, SCENE_TRANSLATION, b->key_count, times, values);
    }
    maker_instance(maker, mesh, node);
}

struct scene *blocks_scene(const struct blocks *blocks)
{
    struct maker *maker = calloc(1, sizeof *maker);
    assert_true(maker && maker_create(maker, "blocks"));
    struct scene *scene = maker->scene;
    scene->sun.direction = (struct dvec3){0, 1, 0};
    for (int i = 0; i < 3; i++)
        scene->sky.zenith[i] = scene->sky.horizon[i] = scene->sky.ground[i] = blocks->sky;
    scene->luminance = 0.18f;
    scene->path =
        (struct camera_path){.knots[0] = {blocks->eye, blocks->target}, .knot_count = 1, .speed_m_s = 1};
    assert_true(camera_path_finish(&scene->path));
    for (uint32_t i = 0; i < blocks->count; i++)
        add_block(maker, &blocks->list[i]);
    for (uint32_t i = 0; i < blocks->light_count; i++)
        maker_light(maker, &blocks->lights[i]);
    scene = maker_finish(maker);
    free(maker);
    assert_non_null(scene);
    return scene;
}
