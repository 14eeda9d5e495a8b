#include "app/fovbench/supersample.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

struct supersample {
    struct lineup lineup; // owned, one mode
    uint32_t width, height, factor;
    uint8_t *large, *small; // owned
};

struct supersample *supersample_create(const struct lineup_desc *desc, const struct scene *scene)
{
    struct supersample *s = calloc(1, sizeof *s);
    struct lineup_desc larger = *desc;
    const uint64_t pixels = 2 * (uint64_t)desc->width * desc->height;
    if (s) {
        s->width = desc->width;
        s->height = desc->height;
        s->factor = pixels * 16 <= SUPERSAMPLE_PIXELS ? 4 : 2;
        s->large = malloc(4 * (size_t)s->width * s->height * s->factor * s->factor);
        s->small = malloc(4 * (size_t)s->width * s->height);
    }
    if (!s || !s->large || !s->small) {
        fprintf(stderr, "fovbench: out of memory\n");
        supersample_destroy(s);
        return NULL;
    }
    larger.width *= s->factor;
    larger.height *= s->factor;
    larger.mode_count = 1;
    larger.settings.taa = false;
    if (lineup_init(&s->lineup, &larger, scene))
        return s;
    supersample_destroy(s);
    return NULL;
}

void supersample_destroy(struct supersample *s)
{
    if (!s)
        return;
    lineup_finish(&s->lineup);
    free(s->large);
    free(s->small);
    free(s);
}

uint32_t supersample_factor(const struct supersample *s)
{
    return s->factor;
}

bool supersample_draw(struct supersample *s, const struct frame *frame)
{
    return lineup_draw(&s->lineup, frame, NULL);
}

// IEC 61966-2-1.
static double linear_of(uint8_t level)
{
    double v = level / 255.0;
    return v <= 0.04045 ? v / 12.92 : pow((v + 0.055) / 1.055, 2.4);
}

static uint8_t level_of(double linear)
{
    double v = linear <= 0.0031308 ? 12.92 * linear : 1.055 * pow(linear, 1 / 2.4) - 0.055;
    return (uint8_t)lround(255 * fmin(fmax(v, 0), 1));
}

static double block_sum(const uint8_t *in, size_t row_bytes, uint32_t factor, const double *linear)
{
    double sum = 0;
    for (uint32_t y = 0; y < factor; y++)
        for (uint32_t x = 0; x < factor; x++)
            sum += linear[in[y * row_bytes + 4 * (size_t)x]];
    return sum;
}

void supersample_box(const uint8_t *in, uint32_t width, uint32_t height, uint32_t factor, uint8_t *out)
{
    double linear[256];
    const size_t row_bytes = 4 * (size_t)width * factor;
    for (int i = 0; i < 256; i++)
        linear[i] = linear_of((uint8_t)i);
    for (uint32_t y = 0; y < height; y++)
        for (uint32_t x = 0; x < width; x++, out += 4) {
            const uint8_t *block = in + (size_t)y * factor * row_bytes + 4 * (size_t)x * factor;
            for (int c = 0; c < 3; c++)
                out[c] = level_of(block_sum(block + c, row_bytes, factor, linear) / (factor * factor));
            out[3] = 255;
        }
}

const uint8_t *supersample_read(struct supersample *s, int eye)
{
    if (!renderer_read(s->lineup.options[0], eye, s->large))
        return NULL;
    supersample_box(s->large, s->width, s->height, s->factor, s->small);
    return s->small;
}
