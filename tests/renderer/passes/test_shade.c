// Shading: what the lists of lights and tiles leave out is nothing, blocks are shaded by their leaders, and
// occlusion darkens the sky's light alone.
#include "renderer/passes/shade/shade.h"
#include "renderer/passes/tonemap/tonemap.h"
#include "tests/renderer/passes/rig.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

enum { WIDTH = 44, HEIGHT = 37, PIXELS = 2 * WIDTH * HEIGHT, LIGHTS = 1500, TILES_X = 6, TILES_Y = 5 };
enum { BLOCKS_X = 11, BLOCKS_Y = 10 };
enum { HALF_WIDTH = 22, HALF_HEIGHT = 19, HALVES = 2 * HALF_WIDTH * HALF_HEIGHT };

struct bed {
    struct rig rig;
    struct rig_view view;
    uint8_t base[PIXELS][4], surface[PIXELS][2];
    uint32_t normal[PIXELS];
    float depth[PIXELS];
    uint8_t map[PIXELS];
    struct gpu_image images[4]; // base, normal, surface, depth
    struct gpu_buffer lights;
    float first[PIXELS][4], second[PIXELS][4];
};

static void bed_open(struct bed *b, uint64_t seed, double near_m, double far_m)
{
    uint64_t random = seed;
    assert_true(rig_open(&b->rig));
    b->view = rig_view_default(WIDTH, HEIGHT);
    for (int eye = 0; eye < EYES; eye++) {
        b->view.eyes[eye].pose.orientation = rig_turn(&random, 6);
        b->view.eyes[eye].fov = (struct viewing_fov){1.3 - 0.5 * eye, 0.8 + 0.5 * eye, 1.2, 0.9};
    }
    for (size_t i = 0; i < PIXELS; i++) {
        const double distance = exp(rig_uniform(&random, log(near_m), log(far_m)));
        b->depth[i] = rig_below(&random, 4) == 0 ? 0 : (float)(VIEWING_NEAR_M / distance);
        b->normal[i] = (uint32_t)rig_random(&random);
        b->map[i] = rig_below(&random, 3) != 0;
        for (int c = 0; c < 4; c++)
            b->base[i][c] = (uint8_t)rig_random(&random);
        b->surface[i][0] = (uint8_t)rig_random(&random);
        b->surface[i][1] = (uint8_t)rig_random(&random);
    }
    const VkImageLayout colour = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
    b->images[0] = rig_sampled(&b->rig, VK_FORMAT_R8G8B8A8_SRGB, WIDTH, HEIGHT, 4, b->base, colour);
    b->images[1] = rig_sampled(&b->rig, VK_FORMAT_R32_UINT, WIDTH, HEIGHT, 4, b->normal, colour);
    b->images[2] = rig_sampled(&b->rig, VK_FORMAT_R8G8_UNORM, WIDTH, HEIGHT, 2, b->surface, colour);
    b->images[3] = rig_sampled(&b->rig, VK_FORMAT_D32_SFLOAT, WIDTH, HEIGHT, 4, b->depth,
                               VK_IMAGE_LAYOUT_DEPTH_READ_ONLY_OPTIMAL);
    assert_true(gpu_buffer_create(b->rig.gpu, "lights", LIGHTS * sizeof(struct shared_light),
                                  VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, GPU_HOST, &b->lights));
}

static void bed_close(struct bed *b)
{
    for (int i = 0; i < 4; i++)
        gpu_image_destroy(b->rig.gpu, &b->images[i]);
    gpu_buffer_destroy(b->rig.gpu, &b->lights);
    rig_close(&b->rig);
    free(b);
}

static struct shade_desc desc_of(struct bed *b)
{
    return (struct shade_desc){.gpu = b->rig.gpu,
                               .frame = &b->rig.frame,
                               .lights = &b->lights,
                               .width = WIDTH,
                               .height = HEIGHT,
                               .base = b->images[0].view,
                               .normal = b->images[1].view,
                               .surface = b->images[2].view,
                               .depth = b->images[3].view};
}

// Points and spots of 1 mm to 30 m around the eyes.
static void scatter_lights(struct bed *b, uint64_t seed)
{
    uint64_t random = seed;
    struct shared_light *list = b->lights.mapped;
    for (size_t i = 0; i < LIGHTS; i++) {
        const double away = exp(rig_uniform(&random, log(0.05), log(200)));
        const struct dvec3 to = dvec3_normalise((struct dvec3){
            rig_uniform(&random, -1, 1), rig_uniform(&random, -1, 1), rig_uniform(&random, -1, 1)});
        const bool spot = rig_below(&random, 2);
        list[i] = (struct shared_light){
            .position = {(float)(away * to.x), (float)(away * to.y), (float)(away * to.z)},
            .range_m = (float)exp(rig_uniform(&random, log(1e-3), log(30))),
            .intensity = {(float)rig_uniform(&random, 0, 9), (float)rig_uniform(&random, 0, 9), 5},
            .direction = {(float)to.y, (float)to.z, (float)to.x},
            .cos_inner = 0.9f,
            .cos_outer = spot ? 0.3f : -2};
    }
}

static void fill_frame(struct bed *b, uint32_t lights, float sky, float sun)
{
    rig_frame(&b->rig, &b->view);
    struct shared_frame *f = b->rig.frame.mapped;
    f->light_count = lights;
    f->exposure = 1;
    f->sun_direction[1] = 1;
    f->sun_direction[3] = sun > 0;
    for (int c = 0; c < 3; c++) {
        f->sky_zenith[c] = f->sky_horizon[c] = f->sky_ground[c] = sky;
        f->sun_illuminance[c] = sun;
    }
}

// With `listed`, from the tiles; pixels that are not redrawn keep what was there: nothing.
static void shade_into(struct bed *b, const struct shade_desc *desc, bool listed, float (*out)[4])
{
    struct shade pass;
    assert_true(shade_init(&pass, desc));
    VkCommandBuffer cmd = rig_begin(&b->rig);
    if (listed)
        shade_record_tiles(&pass, cmd);
    else
        shade_record(&pass, cmd);
    rig_end(&b->rig, cmd);
    rig_read_level(&b->rig, &pass.hdr, 0, out[0]);
    shade_finish(&pass);
}

// Whatever the tile, whatever the depths in it: the lists give the sum of every light to the last bit.
static void light_lists_lose_no_light(void **state)
{
    (void)state;
    static const double near_m[] = {0.1, 0.1, 2.9, 40}, far_m[] = {500, 3, 3, 41};
    for (size_t i = 0; i < countof(near_m); i++) {
        struct bed *b = calloc(1, sizeof *b);
        bed_open(b, i, near_m[i], far_m[i]);
        scatter_lights(b, 50 + i);
        static const uint32_t counts[] = {0, 1, 31, 1024, 1025, LIGHTS};
        for (size_t k = 0; k < countof(counts); k++) {
            fill_frame(b, counts[k], 1, 1);
            struct shade_desc desc = desc_of(b);
            shade_into(b, &desc, false, b->first);
            desc.every_light = true;
            shade_into(b, &desc, false, b->second);
            assert_memory_equal(b->first, b->second, sizeof b->first);
        }
        bed_close(b);
    }
}

// Two rows of groups and more groups than tiles, as beyond 65535 of them.
static void make_tiles(const struct bed *b, uint32_t *words)
{
    uint32_t count = 0;
    for (uint32_t eye = 0; eye < EYES; eye++)
        for (uint32_t y = 0; y < TILES_Y; y++)
            for (uint32_t x = 0; x < TILES_X; x++) {
                bool any = false;
                for (uint32_t p = 0; p < 64; p++) {
                    const uint32_t px = 8 * x + p % 8, py = 8 * y + p / 8;
                    any |= px < WIDTH && py < HEIGHT && b->map[(eye * HEIGHT + py) * WIDTH + px];
                }
                if (any)
                    words[SHARED_TILES_FIRST + count++] = x | y << 15 | eye << 30;
            }
    words[0] = count / 2 + 1;
    words[1] = 2;
    words[2] = 1;
    words[3] = count;
}

static void tone_map(struct bed *b, struct tonemap_desc desc, bool listed, uint8_t (*out)[4])
{
    struct tonemap pass;
    struct gpu_image target = rig_image(&b->rig, VK_FORMAT_R8G8B8A8_UNORM, WIDTH, HEIGHT);
    memset(out, 7, PIXELS * sizeof *out);
    rig_upload(&b->rig, &target, 4, out);
    desc.targets[0] = target.view;
    assert_true(tonemap_init(&pass, &desc));
    VkCommandBuffer cmd = rig_begin(&b->rig);
    if (listed)
        tonemap_record_tiles(&pass, cmd, 0);
    else
        tonemap_record(&pass, cmd, 0);
    rig_end(&b->rig, cmd);
    rig_download(&b->rig, &target, 4, out);
    tonemap_finish(&pass);
    gpu_image_destroy(b->rig.gpu, &target);
}

static void a_list_of_tiles_is_the_redraw_map(void **state)
{
    (void)state;
    struct bed *b = calloc(1, sizeof *b);
    bed_open(b, 9, 0.5, 20);
    scatter_lights(b, 3);
    fill_frame(b, 100, 1, 1);
    // the left half of the left eye is kept, so that whole tiles are
    for (size_t i = 0; i < PIXELS / 2; i++)
        b->map[i] = i % WIDTH < 20 ? 0 : b->map[i];
    struct gpu_image map = rig_image(&b->rig, VK_FORMAT_R8_UINT, WIDTH, HEIGHT);
    rig_upload(&b->rig, &map, 1, b->map);
    struct gpu_buffer tiles;
    assert_true(gpu_buffer_create(b->rig.gpu, "tiles", 4 * (SHARED_TILES_FIRST + 2 * TILES_X * TILES_Y),
                                  VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT,
                                  GPU_HOST, &tiles));
    make_tiles(b, tiles.mapped);
    struct shade_desc desc = desc_of(b);
    shade_into(b, &desc, false, b->first);
    desc.redraw_map = map.view;
    desc.tiles = &tiles;
    for (int listed = 0; listed < 2; listed++) {
        shade_into(b, &desc, listed, b->second);
        for (size_t i = 0; i < PIXELS; i++)
            if (b->map[i])
                assert_memory_equal(b->first[i], b->second[i], sizeof b->first[i]);
    }
    static uint8_t mapped[2][PIXELS][4];
    const struct tonemap_desc tonemap = {.gpu = b->rig.gpu,
                                         .frame = &b->rig.frame,
                                         .width = WIDTH,
                                         .height = HEIGHT,
                                         .redraw_map = map.view,
                                         .tiles = &tiles};
    struct gpu_image hdr = rig_image(&b->rig, VK_FORMAT_R16G16B16A16_SFLOAT, WIDTH, HEIGHT);
    struct tonemap_desc with_hdr = tonemap;
    with_hdr.hdr = hdr.view;
    rig_upload(&b->rig, &hdr, 8, b->first); // any bits will do that are numbers
    tone_map(b, with_hdr, false, mapped[0]);
    tone_map(b, with_hdr, true, mapped[1]);
    assert_memory_equal(mapped[0], mapped[1], sizeof mapped[0]);
    for (size_t i = 0; i < PIXELS; i++)
        assert_true((mapped[0][i][3] == 255) == (b->map[i] != 0));
    gpu_image_destroy(b->rig.gpu, &hdr);
    gpu_image_destroy(b->rig.gpu, &map);
    gpu_buffer_destroy(b->rig.gpu, &tiles);
    bed_close(b);
}

static uint32_t pixel_at(uint32_t x, uint32_t y, uint32_t eye)
{
    return (eye * HEIGHT + y) * WIDTH + x;
}

// The pixel that shades for one, by leaders.glsl.
static uint32_t leader_of(const uint32_t *leaders, uint32_t x, uint32_t y, uint32_t eye)
{
    const uint32_t block = (eye * BLOCKS_Y + y / 4) * BLOCKS_X + x / 4;
    const uint32_t place = leaders[2 * block + (y % 4) / 2] >> (4 * (y % 2 * 4 + x % 4)) & 15;
    return pixel_at(x - x % 4 + place % 4, y - y % 4 + place / 4, eye);
}

// With blocks: no pixel is listed twice, those listed are shaded as without blocks, and everyone's leader is
// one.
static void leaders_are_shaded_once_and_whole(void **state)
{
    (void)state;
    static uint32_t list[SHARED_TILES_FIRST + PIXELS], leaders[2 * EYES * BLOCKS_X * BLOCKS_Y];
    static bool listed[PIXELS];
    struct bed *b = calloc(1, sizeof *b);
    bed_open(b, 11, 2, 2.001);
    scatter_lights(b, 3);
    fill_frame(b, 100, 1, 1);
    struct shade_desc desc = desc_of(b);
    shade_into(b, &desc, false, b->first);
    struct shared_counters *counters = b->rig.counters.mapped;
    counters->shaded_px = 0;
    desc.blocks = &(struct shade_blocks){&b->rig.counters, 10, 20};
    struct shade pass;
    assert_true(shade_init(&pass, &desc));
    VkCommandBuffer cmd = rig_begin(&b->rig);
    shade_record(&pass, cmd);
    rig_end(&b->rig, cmd);
    rig_read_level(&b->rig, &pass.hdr, 0, b->second[0]);
    rig_read_words(&b->rig, &pass.chosen, countof(list), list);
    rig_read_words(&b->rig, &pass.leaders, countof(leaders), leaders);
    shade_finish(&pass);
    const uint32_t count = list[SHARED_TILES_FIRST - 1];
    assert_true(count > PIXELS / 8 && count < PIXELS * 3 / 4);
    assert_int_equal(counters->shaded_px, count);
    assert_int_equal(list[0], (count + 63) / 64);
    assert_int_equal(list[1], 1);
    for (uint32_t i = 0; i < count; i++) {
        const uint32_t code = list[SHARED_TILES_FIRST + i];
        const uint32_t pixel = pixel_at(code & 0x7fff, code >> 15 & 0x7fff, code >> 30);
        assert_true(pixel < PIXELS && !listed[pixel]);
        listed[pixel] = true;
        assert_memory_equal(b->first[pixel], b->second[pixel], sizeof b->first[pixel]);
    }
    for (uint32_t i = 0; i < PIXELS; i++) {
        const uint32_t leader = leader_of(leaders, i % WIDTH, i / WIDTH % HEIGHT, i / (WIDTH * HEIGHT));
        assert_true(leader < PIXELS && listed[leader] && (leader == i || !listed[i]));
        assert_true((b->depth[leader] == 0) == (b->depth[i] == 0));
    }
    bed_close(b);
}

static void shade_occluded(struct bed *b, const uint8_t *occlusion, const float *distance, float (*out)[4])
{
    struct gpu_image ao = rig_sampled(&b->rig, VK_FORMAT_R8_UNORM, HALF_WIDTH, HALF_HEIGHT, 1, occlusion,
                                      VK_IMAGE_LAYOUT_GENERAL);
    struct gpu_image depth = rig_sampled(&b->rig, VK_FORMAT_R32_SFLOAT, HALF_WIDTH, HALF_HEIGHT, 4, distance,
                                         VK_IMAGE_LAYOUT_GENERAL);
    struct shade_desc desc = desc_of(b);
    desc.ao = ao.view;
    desc.ao_depth = depth.view;
    shade_into(b, &desc, false, out);
    gpu_image_destroy(b->rig.gpu, &ao);
    gpu_image_destroy(b->rig.gpu, &depth);
}

// 51/255 everywhere leaves a fifth of the sky's light and all of the sun's; background is not occluded.
static void occlusion_takes_the_sky_s_light_only(void **state)
{
    (void)state;
    struct bed *b = calloc(1, sizeof *b);
    bed_open(b, 4, 2, 3);
    static uint8_t occlusion[HALVES];
    static float distance[HALVES];
    memset(occlusion, 51, sizeof occlusion);
    for (size_t i = 0; i < HALVES; i++)
        distance[i] = 2.5f;
    const struct shade_desc open = desc_of(b);
    for (int sun = 0; sun < 2; sun++) {
        fill_frame(b, 0, sun ? 0 : 8, sun ? 8 : 0);
        shade_into(b, &open, false, b->first);
        shade_occluded(b, occlusion, distance, b->second);
        for (size_t i = 0; i < PIXELS; i++) {
            const float share = b->depth[i] == 0 || sun ? 1 : 0.2f;
            for (int c = 0; c < 3; c++)
                assert_true(fabsf(b->second[i][c] - share * b->first[i][c]) <= 2e-3f * b->first[i][c] + 1e-4f);
        }
    }
    bed_close(b);
}

// Columns of texels at 2 m, occluded, and at 40 m, open: a pixel takes that of its own distance, but for 4 %.
static void occlusion_stays_on_its_side_of_an_edge(void **state)
{
    (void)state;
    struct bed *b = calloc(1, sizeof *b);
    bed_open(b, 4, 2, 3);
    for (size_t i = 0; i < PIXELS; i++)
        b->depth[i] = (float)(VIEWING_NEAR_M / (i % WIDTH < 21 ? 2.0 : 40.0)); // between texels: 21 is odd
    gpu_image_destroy(b->rig.gpu, &b->images[3]);
    b->images[3] = rig_sampled(&b->rig, VK_FORMAT_D32_SFLOAT, WIDTH, HEIGHT, 4, b->depth,
                               VK_IMAGE_LAYOUT_DEPTH_READ_ONLY_OPTIMAL);
    static uint8_t occlusion[HALVES];
    static float distance[HALVES];
    for (size_t i = 0; i < HALVES; i++) {
        const size_t x = i % HALF_WIDTH;
        distance[i] = x <= 10 ? 2.f : x == 12 ? 0.f : 40.f; // and a column of background
        occlusion[i] = x <= 10 ? 0 : x == 12 ? 0 : 255;
    }
    fill_frame(b, 0, 8, 0);
    const struct shade_desc open = desc_of(b);
    shade_into(b, &open, false, b->first);
    shade_occluded(b, occlusion, distance, b->second);
    for (size_t i = 0; i < PIXELS; i++)
        for (int c = 0; c < 3; c++) {
            if (i % WIDTH < 21)
                assert_true(fabsf(b->second[i][c]) <= 0.04f * fabsf(b->first[i][c]));
            else
                assert_true(fabsf(b->second[i][c]) >= 0.96f * fabsf(b->first[i][c]) - 1e-4f);
        }
    bed_close(b);
}

int main(void)
{
    struct rig probe;
    if (!rig_open(&probe))
        return 77;
    rig_close(&probe);
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(light_lists_lose_no_light),
        cmocka_unit_test(a_list_of_tiles_is_the_redraw_map),
        cmocka_unit_test(leaders_are_shaded_once_and_whole),
        cmocka_unit_test(occlusion_takes_the_sky_s_light_only),
        cmocka_unit_test(occlusion_stays_on_its_side_of_an_edge),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
