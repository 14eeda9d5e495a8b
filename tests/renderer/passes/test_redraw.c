// The redraw map's or-pyramid and list of tiles against brute force, pixel by pixel.
#include "renderer/passes/redraw/redraw.h"
#include "tests/renderer/passes/rig.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

enum maps { EMPTY, FULL, NOISE, SPARSE, DISC, CORNERS, ONE_EYE, MAPS };

struct bed {
    struct rig rig;
    uint32_t width, height;
    struct gpu_image image;
    struct redraw pass;
    uint8_t *map;              // both eyes
    uint32_t *pyramid, *tiles; // what the pass wrote
    uint32_t texels, words;
};

static size_t count_of(const struct bed *b)
{
    return (size_t)b->width * b->height;
}

static void bed_open(struct bed *b, uint32_t width, uint32_t height)
{
    *b = (struct bed){.width = width, .height = height};
    assert_true(rig_open(&b->rig));
    b->image = rig_image(&b->rig, VK_FORMAT_R8_UINT, width, height);
    const struct redraw_desc desc = {.gpu = b->rig.gpu,
                                     .counters = &b->rig.counters,
                                     .width = width,
                                     .height = height,
                                     .redraw_map = b->image.view};
    assert_true(redraw_init(&b->pass, &desc));
    b->texels = (uint32_t)(b->pass.pyramid.size / 4);
    b->words = (uint32_t)(b->pass.tiles.size / 4);
    b->map = calloc(2 * count_of(b), 1);
    b->pyramid = calloc(b->texels, 4);
    b->tiles = calloc(b->words, 4);
    assert_true(b->map && b->pyramid && b->tiles);
}

static void bed_close(struct bed *b)
{
    redraw_finish(&b->pass);
    gpu_image_destroy(b->rig.gpu, &b->image);
    free(b->map);
    free(b->pyramid);
    free(b->tiles);
    rig_close(&b->rig);
}

static void paint(struct bed *b, enum maps maps, uint64_t seed)
{
    uint64_t random = seed;
    const double x = rig_uniform(&random, 0, b->width), y = rig_uniform(&random, 0, b->height);
    for (size_t i = 0; i < 2 * count_of(b); i++) {
        const uint32_t u = (uint32_t)(i % b->width), v = (uint32_t)(i % count_of(b) / b->width);
        const bool edge_x = u == 0 || u == b->width - 1, edge_y = v == 0 || v == b->height - 1;
        const bool values[MAPS] = {[FULL] = true,
                                   [NOISE] = rig_below(&random, 3) == 0,
                                   [SPARSE] = rig_below(&random, 300) == 0,
                                   [DISC] = hypot(u - x, v - y) < 0.2 * b->height,
                                   [CORNERS] = edge_x && edge_y,
                                   [ONE_EYE] = i >= count_of(b)};
        b->map[i] = values[maps];
    }
}

static void run(struct bed *b, bool last, uint32_t counted_before)
{
    struct shared_counters *counters = b->rig.counters.mapped;
    *counters = (struct shared_counters){.shaded_px = counted_before};
    rig_upload(&b->rig, &b->image, 1, b->map);
    VkCommandBuffer cmd = rig_begin(&b->rig);
    redraw_record(&b->pass, cmd, last);
    rig_end(&b->rig, cmd);
    rig_read_words(&b->rig, &b->pass.pyramid, b->texels, b->pyramid);
    rig_read_words(&b->rig, &b->pass.tiles, b->words, b->tiles);
}

// Pixels of a square of the map, what lies outside of the image left out.
static uint32_t redrawn_in(const struct bed *b, uint32_t eye, uint32_t x, uint32_t y, uint32_t side)
{
    uint32_t sum = 0;
    for (uint32_t v = y; v < y + side && v < b->height; v++)
        for (uint32_t u = x; u < x + side && u < b->width; u++)
            sum += b->map[eye * count_of(b) + (size_t)v * b->width + u];
    return sum;
}

// The texel of level l at (x, y) covers the square of 8 * 2^l pixels from (x, y) times that; the last level is
// one texel an eye.
static void check_pyramid(const struct bed *b)
{
    uint32_t at = 0, width = 0, height = 0;
    for (uint32_t level = 0; level < b->pass.levels; level++) {
        const uint32_t side = (uint32_t)SHARED_TILE << level;
        width = b->pass.tiles_x >> level ? b->pass.tiles_x >> level : 1;
        height = b->pass.tiles_y >> level ? b->pass.tiles_y >> level : 1;
        assert_true(width * side >= b->width && height * side >= b->height);
        for (uint32_t i = 0; i < 2 * width * height; i++, at++) {
            const uint32_t eye = i / (width * height), x = i % width, y = i / width % height;
            if ((b->pyramid[at] != 0) != (redrawn_in(b, eye, x * side, y * side, side) != 0))
                fail_msg("%u x %u: level %u, texel (%u, %u) is %u", b->width, b->height, level, x, y,
                         b->pyramid[at]);
        }
    }
    assert_int_equal(at, b->texels);
    assert_true(width == 1 && height == 1);
}

// Every tile with a redrawn pixel once, and a command of that many work groups in rows of at most 65535.
static void check_tiles(const struct bed *b)
{
    const uint32_t wide = (b->width + SHARED_TILE - 1) / SHARED_TILE,
                   high = (b->height + SHARED_TILE - 1) / SHARED_TILE, count = b->tiles[3];
    uint8_t *listed = calloc(2 * (size_t)wide * high, 1);
    assert_non_null(listed);
    assert_true(SHARED_TILES_FIRST + count <= b->words);
    for (uint32_t i = 0; i < count; i++) {
        const uint32_t code = b->tiles[SHARED_TILES_FIRST + i];
        const uint32_t x = code & 0x7fff, y = code >> 15 & 0x7fff, eye = code >> 30;
        assert_true(x < wide && y < high && eye < EYES);
        assert_true(redrawn_in(b, eye, x * SHARED_TILE, y * SHARED_TILE, SHARED_TILE) > 0);
        assert_int_equal(listed[(eye * high + y) * wide + x]++, 0);
    }
    uint32_t expected = 0;
    for (uint32_t i = 0; i < 2 * wide * high; i++)
        expected += redrawn_in(b, i / (wide * high), i % wide * SHARED_TILE, i / wide % high * SHARED_TILE,
                               SHARED_TILE) > 0;
    assert_int_equal(count, expected);
    const uint64_t groups = (uint64_t)b->tiles[0] * b->tiles[1] * b->tiles[2];
    assert_true(b->tiles[0] <= 65535 && b->tiles[1] <= 65535 && b->tiles[2] == 1);
    assert_true(groups >= count && groups < count + 65535ull);
    assert_true(count > 65535 || groups == count); // no work group too many without folding
    free(listed);
}

static void check_counter(const struct bed *b, uint32_t before, bool last)
{
    const struct shared_counters *counters = b->rig.counters.mapped;
    uint32_t sum = 0;
    for (size_t i = 0; i < 2 * count_of(b); i++)
        sum += b->map[i];
    const struct shared_counters expected = {.shaded_px = before + (last ? sum : 0)};
    assert_memory_equal(counters, &expected, sizeof expected);
}

static void any_map_agrees_with_brute_force(void **state)
{
    (void)state;
    static const uint32_t sizes[][2] = {{16, 16}, {17, 15},   {40, 36},  {64, 64},  {33, 130},
                                        {1, 1},   {200, 37},  {37, 200}, {8, 300},  {129, 127},
                                        {7, 9},   {128, 256}, {257, 8},  {320, 180}};
    uint64_t pixels = 0, tiles = 0, texels = 0;
    for (size_t s = 0; s < countof(sizes); s++) {
        struct bed b;
        bed_open(&b, sizes[s][0], sizes[s][1]);
        for (uint64_t seed = 0; seed < 2 * MAPS; seed++) {
            const bool last = (seed + seed / MAPS) % 2;
            const uint32_t before = seed % 3 ? 1000 : 0;
            paint(&b, (enum maps)(seed % MAPS), 100 * s + seed);
            run(&b, last, before);
            check_pyramid(&b);
            check_tiles(&b);
            check_counter(&b, before, last);
            pixels += 2 * count_of(&b);
            tiles += b.tiles[3];
            texels += b.texels;
        }
        bed_close(&b);
    }
    print_message("%llu pixels, %llu tiles listed, %llu texels\n", (unsigned long long)pixels,
                  (unsigned long long)tiles, (unsigned long long)texels);
}

// A list of more than 65535 tiles is a dispatch of several rows.
static void a_large_map_is_folded(void **state)
{
    (void)state;
    struct bed b;
    bed_open(&b, 4096, 2100);
    paint(&b, FULL, 0);
    run(&b, true, 0);
    check_pyramid(&b);
    check_tiles(&b);
    check_counter(&b, 0, true);
    assert_int_equal(b.tiles[3], 2 * 512 * 263);
    assert_true(b.tiles[0] == 65535 && b.tiles[1] == 5);
    bed_close(&b);
}

int main(void)
{
    struct rig probe;
    if (!rig_open(&probe))
        return 77;
    rig_close(&probe);
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(any_map_agrees_with_brute_force),
        cmocka_unit_test(a_large_map_is_folded),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
