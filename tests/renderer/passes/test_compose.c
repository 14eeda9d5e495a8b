// Composition: a redrawn pixel's position leads back to its pixel and its depth.
#include "renderer/passes/compose/compose.h"
#include "tests/renderer/passes/rig.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

enum { WIDTH = 40, HEIGHT = 36, PIXELS = 2 * WIDTH * HEIGHT };

static const float untouched[4] = {-7, -8, -9, 0.5f};

struct bed {
    struct rig rig;
    struct rig_view view;
    float depth[PIXELS];
    uint16_t id[PIXELS];
    uint8_t map[PIXELS];
    float position[PIXELS][4];
};

// Depths from the near plane to 10 km, background in a quarter of the pixels, all kinds of ids.
static void paint(struct bed *b, uint64_t seed)
{
    uint64_t random = seed;
    for (size_t i = 0; i < PIXELS; i++) {
        const double distance = exp(rig_uniform(&random, log(VIEWING_NEAR_M), log(1e4)));
        b->depth[i] = rig_below(&random, 4) == 0 ? 0 : (float)(VIEWING_NEAR_M / distance);
        b->id[i] = rig_below(&random, 2) ? 0 : (uint16_t)rig_below(&random, 65536);
        b->map[i] = rig_below(&random, 3) != 0;
        memcpy(b->position[i], untouched, sizeof untouched);
    }
}

static void place(struct bed *b, uint64_t seed, double away_m)
{
    uint64_t random = seed;
    b->view = rig_view_default(WIDTH, HEIGHT);
    for (int eye = 0; eye < EYES; eye++) {
        struct rig_eye *e = &b->view.eyes[eye];
        e->pose.position = dvec3_add(e->pose.position, (struct dvec3){away_m, 0.3 * away_m, -away_m});
        e->pose.orientation = rig_turn(&random, 6);
        e->fov = (struct viewing_fov){1.3 - 0.5 * eye, 0.8 + 0.5 * eye, 1.2, 0.9};
    }
}

// A list of all tiles of both eyes (renderer/shared/tiles.glsl).
static struct gpu_buffer every_tile(struct rig *rig)
{
    const uint32_t across = (WIDTH + SHARED_TILE - 1) / SHARED_TILE,
                   down = (HEIGHT + SHARED_TILE - 1) / SHARED_TILE;
    const uint32_t count = EYES * across * down;
    struct gpu_buffer tiles;
    assert_true(gpu_buffer_create(rig->gpu, "tiles", 4 * (SHARED_TILES_FIRST + count),
                                  VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT,
                                  GPU_HOST, &tiles));
    uint32_t *words = tiles.mapped;
    memcpy(words, (const uint32_t[]){count, 1, 1, count}, 16);
    for (uint32_t i = 0; i < count; i++)
        words[SHARED_TILES_FIRST + i] = i % across | i / across % down << 15 | i / (across * down) << 30;
    return tiles;
}

static void run(struct bed *b, bool with_id)
{
    struct rig *rig = &b->rig;
    struct gpu_image depth = rig_sampled(rig, VK_FORMAT_D32_SFLOAT, WIDTH, HEIGHT, 4, b->depth,
                                         VK_IMAGE_LAYOUT_DEPTH_READ_ONLY_OPTIMAL);
    struct gpu_image id =
        rig_sampled(rig, VK_FORMAT_R16_UINT, WIDTH, HEIGHT, 2, b->id, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
    struct gpu_image map = rig_image(rig, VK_FORMAT_R8_UINT, WIDTH, HEIGHT);
    struct gpu_image position[2];
    for (int i = 0; i < 2; i++)
        position[i] = rig_image(rig, VK_FORMAT_R32G32B32A32_SFLOAT, WIDTH, HEIGHT);
    struct gpu_buffer tiles = every_tile(rig);
    struct compose pass;
    const struct compose_desc desc = {.gpu = rig->gpu,
                                      .frame = &rig->frame,
                                      .depth = depth.view,
                                      .id = with_id ? id.view : VK_NULL_HANDLE,
                                      .redraw_map = map.view,
                                      .position = {position[0].view, position[1].view},
                                      .tiles = &tiles};
    assert_true(compose_init(&pass, &desc));
    rig_upload(rig, &map, 1, b->map);
    rig_upload(rig, &position[1], sizeof b->position[0], b->position);
    rig_frame(rig, &b->view);
    VkCommandBuffer cmd = rig_begin(rig);
    compose_record_tiles(&pass, cmd, 1);
    rig_end(rig, cmd);
    rig_download(rig, &position[1], sizeof b->position[0], b->position);
    compose_finish(&pass);
    gpu_buffer_destroy(rig->gpu, &tiles);
    struct gpu_image *images[] = {&depth, &id, &map, &position[0], &position[1]};
    for (size_t i = 0; i < countof(images); i++)
        gpu_image_destroy(rig->gpu, images[i]);
}

struct errors {
    double px, depth; // depth relative, beyond what `slack_m` of rounding explains
    double direction; // of unit length
};

static struct dvec3 to_eye(const struct rig_eye *e, struct dvec3 v)
{
    const struct dquat q = e->pose.orientation;
    return dquat_rotate((struct dquat){-q.x, -q.y, -q.z, q.w}, v);
}

// What a position's rounding to float may cost at this distance is taken off both errors.
static void check_pixel(const struct bed *b, size_t i, bool with_id, double slack_m, struct errors *worst)
{
    const struct rig_eye *e = &b->view.eyes[i / (PIXELS / EYES)];
    const float *got = b->position[i];
    if (!b->map[i]) {
        assert_memory_equal(got, untouched, sizeof untouched);
        return;
    }
    const bool background = b->depth[i] == 0;
    assert_true(got[3] == (background ? -1.f : 1.f + (with_id ? (float)b->id[i] : 0.f)));
    struct dvec3 v = {got[0], got[1], got[2]};
    if (background)
        worst->direction = fmax(worst->direction, fabs(dvec3_length(v) - 1));
    else
        v = dvec3_sub(v, e->pose.position);
    v = to_eye(e, v);
    double x, y, slack_px = 0;
    assert_true(viewing_pixel(&e->fov, WIDTH, HEIGHT, v, &x, &y));
    if (!background) {
        const double distance = (double)(float)VIEWING_NEAR_M / (double)b->depth[i];
        const double error = fmax(fabs(-v.z - distance) - slack_m, 0) / distance;
        worst->depth = fmax(worst->depth, error);
        slack_px = 2 * WIDTH * slack_m / distance;
    }
    const double off = hypot(x - ((double)(i % WIDTH) + 0.5), y - ((double)(i / WIDTH % HEIGHT) + 0.5));
    worst->px = fmax(worst->px, off - slack_px);
}

static void a_position_leads_back_to_its_pixel(void **state)
{
    (void)state;
    struct bed *b = calloc(1, sizeof *b);
    assert_non_null(b);
    assert_true(rig_open(&b->rig));
    // at the origin, in a room, and as far from the origin as it is let (geometry_snap_origin: 128 m)
    static const double away_m[] = {0, 3, 128};
    for (size_t i = 0; i < countof(away_m); i++) {
        // a float holds up to 256 m to 2^-17 m after rounding, in each of three axes; near the origin nothing
        // is forgiven
        const double slack_m = away_m[i] > 10 ? 2 * sqrt(3) * 0x1p-17 : 0;
        struct errors worst = {0};
        for (uint64_t seed = 0; seed < 6; seed++) {
            place(b, seed, away_m[i]);
            paint(b, 100 * i + seed);
            run(b, seed % 2);
            for (size_t p = 0; p < PIXELS; p++)
                check_pixel(b, p, seed % 2, slack_m, &worst);
        }
        print_message("%g m out: within %.1e px, depth within %.1e, directions unit to %.1e\n", away_m[i],
                      worst.px, worst.depth, worst.direction);
        assert_true(worst.px < 0.01 && worst.depth < 1e-5 && worst.direction < 1e-6);
    }
    rig_close(&b->rig);
    free(b);
}

int main(void)
{
    struct rig probe;
    if (!rig_open(&probe))
        return 77;
    rig_close(&probe);
    const struct CMUnitTest tests[] = {cmocka_unit_test(a_position_leads_back_to_its_pixel)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
