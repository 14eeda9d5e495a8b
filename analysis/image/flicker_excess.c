// Our own measure, since flicker has no standard; flicker_excess.h defines it. It
// compares along motion, as the temporal error of video consistency does: Lai, W.-S. et al., "Learning Blind
// Video Temporal Consistency", ECCV 2018 (warping error over unoccluded pixels), less what the
// reference itself has.
#include "analysis/image/flicker_excess.h"

#include "analysis/image/luma.h"

#include <math.h>
#include <stdlib.h>

struct image_flicker_excess {
    uint32_t width, height;
    bool begun;                                  // the planes of [previous] hold a frame
    int previous;                                // which of the two
    float *memory;                               // owned; all planes
    float *test[2], *reference[2], *nearness[2]; // luma, luma, 1 / distance
    float *values;                               // width
    uint8_t *mask;                               // owned; width
};

struct image_flicker_excess *image_flicker_excess_create(void)
{
    return calloc(1, sizeof(struct image_flicker_excess));
}

void image_flicker_excess_destroy(struct image_flicker_excess *flicker)
{
    if (!flicker)
        return;
    free(flicker->memory);
    free(flicker->mask);
    free(flicker);
}

void image_flicker_excess_cut(struct image_flicker_excess *flicker)
{
    flicker->begun = false;
}

static bool reserve(struct image_flicker_excess *flicker, uint32_t width, uint32_t height)
{
    if (width == flicker->width && height == flicker->height)
        return true;
    size_t plane = (size_t)width * height;
    float *memory = malloc((6 * plane + width) * sizeof *memory);
    uint8_t *mask = malloc(width);
    if (!memory || !mask) {
        free(memory);
        free(mask);
        return false;
    }
    free(flicker->memory);
    free(flicker->mask);
    flicker->memory = memory;
    flicker->mask = mask;
    for (int i = 0; i < 2; i++, memory += 3 * plane) {
        flicker->test[i] = memory;
        flicker->reference[i] = memory + plane;
        flicker->nearness[i] = memory + 2 * plane;
    }
    flicker->values = memory;
    flicker->width = width;
    flicker->height = height;
    flicker->begun = false;
    return true;
}

static float nearness_of(float distance)
{
    return distance > 0 ? 1 / distance : 0; // 0, negative and missing are background
}

// The four pixels around a point of the previous frame and their weights; pixels with weight 0 are not touched.
struct footprint {
    size_t at[4];
    float weight[4];
};

static bool footprint_of(const struct image_flicker_excess *flicker, float x, float y, struct footprint *out)
{
    float px = x - 0.5f, py = y - 0.5f; // pixel centres at whole numbers
    if (!(px >= 0 && py >= 0 && px <= (float)(flicker->width - 1) && py <= (float)(flicker->height - 1)))
        return false;
    uint32_t ix = (uint32_t)px, iy = (uint32_t)py;
    float fx = px - (float)ix, fy = py - (float)iy;
    size_t at = (size_t)iy * flicker->width + ix;
    size_t right = fx > 0 ? 1 : 0, below = fy > 0 ? flicker->width : 0;
    *out = (struct footprint){{at, at + right, at + below, at + below + right},
                              {(1 - fx) * (1 - fy), fx * (1 - fy), (1 - fx) * fy, fx * fy}};
    return true;
}

static float sample(const float *plane, const struct footprint *f)
{
    return plane[f->at[0]] * f->weight[0] + plane[f->at[1]] * f->weight[1] + plane[f->at[2]] * f->weight[2] +
           plane[f->at[3]] * f->weight[3];
}

static bool same_surface(float seen, float expected)
{
    float larger = seen > expected ? seen : expected;
    return fabsf(seen - expected) <= IMAGE_FLICKER_TOLERANCE * larger;
}

static void compare_row(struct image_flicker_excess *flicker, const float *motion, uint32_t y)
{
    int before = flicker->previous, now = 1 - before;
    size_t row = (size_t)y * flicker->width;
    for (uint32_t x = 0; x < flicker->width; x++, motion += 4) {
        struct footprint f = {{0}, {0}};
        flicker->values[x] = 0;
        flicker->mask[x] = footprint_of(flicker, motion[0], motion[1], &f) &&
                           same_surface(sample(flicker->nearness[before], &f), nearness_of(motion[2]));
        if (!flicker->mask[x])
            continue;
        float test = fabsf(flicker->test[now][row + x] - sample(flicker->test[before], &f));
        float reference = fabsf(flicker->reference[now][row + x] - sample(flicker->reference[before], &f));
        flicker->values[x] = test > reference ? test - reference : 0;
    }
}

bool image_flicker_excess_add(struct image_flicker_excess *flicker, const struct image_pixels *test,
                              const struct image_pixels *reference, const float *motion,
                              const struct image_rings *rings, struct image_ring_sum *sum)
{
    if (!motion || !image_pair_ok(test, reference) || !image_rings_fit(rings, test->width, test->height) ||
        !reserve(flicker, test->width, test->height))
        return false;
    int now = 1 - flicker->previous;
    uint32_t width = test->width;
    for (uint32_t y = 0; y < test->height; y++, motion += 4 * (size_t)width) {
        size_t row = (size_t)y * width;
        image_luma_row(test, y, 0, flicker->test[now] + row);
        image_luma_row(reference, y, 0, flicker->reference[now] + row);
        for (uint32_t x = 0; x < width; x++)
            flicker->nearness[now][row + x] = nearness_of(motion[4 * (size_t)x + 3]);
        if (!flicker->begun)
            continue;
        compare_row(flicker, motion, y);
        image_ring_sum_row(sum, rings, y, 0, width, flicker->values, flicker->mask);
    }
    flicker->previous = now;
    flicker->begun = true;
    return true;
}
