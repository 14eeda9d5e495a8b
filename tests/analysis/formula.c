#include "formula.h"

const struct image_view formula_view = {1.1, 0.9, 0.8, 0.9, 7, -4};

static int hash(int x, int y, int c, int t)
{
    int64_t h = ((int64_t)x * 7919 + y * 10007 + c * 3571 + t * 15013 + 12345) % 65537;
    h = (h * h + 77) % 65537;
    return (int)(h * h % 65537);
}

static uint8_t clamp(int v)
{
    return (uint8_t)(v < 0 ? 0 : v > 255 ? 255 : v);
}

static int reference_value(int x, int y, int c, int t)
{
    return clamp(96 + 60 * ((x / 8 + y / 6) % 2) + x * (c + 2) % 37 - y * (4 - c) % 29 + hash(x, y, c, t) % 9);
}

static int test_value(int x, int y, int c, int t)
{
    static const int patch[3] = {70, 0, -70};
    int noise = x < 24 ? hash(x, y, c + 3, t) % 41 - 20 : hash(x, y, c + 3, t) % 11 - 5;
    int v = clamp(reference_value(x, y, c, t) + noise);
    return x >= 20 && x < 30 && y >= 10 && y < 18 ? v + patch[c] : v;
}

static struct image_pixels fill(struct formula_picture *out, int t, int (*value)(int, int, int, int))
{
    uint8_t *p = out->data;
    for (int y = 0; y < FORMULA_HEIGHT; y++)
        for (int x = 0; x < FORMULA_WIDTH; x++)
            for (int c = 0; c < 3; c++)
                *p++ = clamp(value(x, y, c, t));
    return (struct image_pixels){out->data, FORMULA_WIDTH, FORMULA_HEIGHT, 3, 0};
}

struct image_pixels formula_reference(struct formula_picture *out, int t)
{
    return fill(out, t, reference_value);
}

struct image_pixels formula_test(struct formula_picture *out, int t)
{
    return fill(out, t, test_value);
}

struct image_pixels formula_solid(struct formula_picture *out, uint8_t r, uint8_t g, uint8_t b)
{
    for (int i = 0; i < FORMULA_PX; i++) {
        out->data[3 * i] = r;
        out->data[3 * i + 1] = g;
        out->data[3 * i + 2] = b;
    }
    return (struct image_pixels){out->data, FORMULA_WIDTH, FORMULA_HEIGHT, 3, 0};
}

struct image_pixels formula_noisy(struct formula_picture *out, int t, int amplitude)
{
    struct image_pixels image = formula_reference(out, 0);
    for (int i = 0; i < FORMULA_PX * 3; i++)
        out->data[i] = clamp(out->data[i] + hash(i % 997, i / 997, 9, t) % (2 * amplitude + 1) - amplitude);
    return image;
}

static double plane_nearness(double x, double y)
{
    return 0.2 + 0.002 * x + 0.001 * y;
}

void formula_motion(float out[FORMULA_PX * 4], int t)
{
    for (int y = 0; y < FORMULA_HEIGHT; y++)
        for (int x = 0; x < FORMULA_WIDTH; x++, out += 4) {
            bool box = x >= 16 + 2 * t && x < 28 + 2 * t && y >= 12 && y < 24;
            double from_x = x + 0.5 - (box ? 2 : 0.75), from_y = y + 0.5 - (box ? 0 : 0.5);
            double expected = box ? 0.5 : y < 6 ? 0 : plane_nearness(from_x, from_y);
            double present = box ? 0.5 : y < 6 ? 0 : plane_nearness(x + 0.5, y + 0.5);
            out[0] = (float)from_x;
            out[1] = (float)from_y;
            out[2] = (float)(expected > 0 ? 1 / expected : 0);
            out[3] = (float)(present > 0 ? 1 / present : 0);
        }
}

const char *formula_region_name(int region)
{
    static const char *const names[IMAGE_REGIONS] = {"0-5", "5-15", "15-30", "30+", "whole"};
    return names[region];
}

uint64_t formula_ring_pixels(const struct image_rings *rings, uint32_t height, int region)
{
    uint64_t pixels = 0;
    for (uint32_t y = 0; y < height; y++) {
        uint32_t count;
        const struct image_ring_run *runs = image_rings_runs(rings, y, &count);
        for (uint32_t i = 0; i < count; i++)
            if (region == IMAGE_WHOLE || runs[i].region == (uint32_t)region)
                pixels += runs[i].end - runs[i].begin;
    }
    return pixels;
}
