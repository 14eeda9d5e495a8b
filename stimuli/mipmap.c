// Mip chains: box filter in linear light; alpha-tested textures keep their covered area (Castano, Computing
// Alpha Mipmaps, The Witness 2010) and weight colour by alpha, so that what shows through no mask does not
// bleed in.
//
// The chain is filtered in 16-bit linear values and rounded to 8 bit once a level: rounding does not pile up.
#include "stimuli/scene.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

struct tables {
    uint16_t linear_from_srgb[256];
    uint8_t srgb_from_linear[65536];
    uint32_t histogram[65536];
};

struct level {
    uint32_t width, height;
    uint16_t *rgba; // linear
};

// IEC 61966-2-1
static double linear_from_srgb(double v)
{
    return v <= 0.04045 ? v / 12.92 : pow((v + 0.055) / 1.055, 2.4);
}

static void fill_tables(struct tables *tables)
{
    uint32_t next = 0;
    for (uint32_t i = 0; i < 256; i++) {
        tables->linear_from_srgb[i] = (uint16_t)lround(linear_from_srgb(i / 255.0) * 65535.0);
        // linear values up to here round to sRGB step i
        uint32_t end = i < 255 ? (uint32_t)(linear_from_srgb((i + 0.5) / 255.0) * 65535.0) : 65535u;
        while (next <= end)
            tables->srgb_from_linear[next++] = (uint8_t)i;
    }
}

static void expand(const struct tables *tables, const uint8_t *in, size_t pixels, bool srgb, uint16_t *out)
{
    for (size_t i = 0; i < pixels; i++, in += 4, out += 4) {
        for (int k = 0; k < 3; k++)
            out[k] = srgb ? tables->linear_from_srgb[in[k]] : (uint16_t)(in[k] * 257u);
        out[3] = (uint16_t)(in[3] * 257u);
    }
}

// The taps of one output along one axis. Halving an odd size covers three inputs with the weights of a box as
// wide as in / out; weights are in units of 1 / in and sum to in.
struct taps {
    uint32_t first, count;
    uint32_t weight[3];
};

static struct taps taps_for(uint32_t in, uint32_t out, uint32_t at)
{
    if (in == out)
        return (struct taps){at, 1, {1, 0, 0}};
    if (in == out * 2)
        return (struct taps){at * 2, 2, {1, 1, 0}};
    return (struct taps){at * 2, 3, {out - at, out, at + 1}};
}

static void filter_pixel(const struct level *in, const struct taps *x, const struct taps *y, bool weigh,
                         uint16_t out[4])
{
    uint64_t sum[4] = {0, 0, 0, 0}, alpha_sum[3] = {0, 0, 0}, total = 0;
    for (uint32_t j = 0; j < y->count; j++)
        for (uint32_t i = 0; i < x->count; i++) {
            const uint16_t *p = in->rgba + ((size_t)(y->first + j) * in->width + x->first + i) * 4;
            uint64_t weight = (uint64_t)x->weight[i] * y->weight[j];
            total += weight;
            for (int k = 0; k < 4; k++)
                sum[k] += weight * p[k];
            for (int k = 0; weigh && k < 3; k++)
                alpha_sum[k] += weight * p[k] * p[3]; // below 2^62 up to sizes of 16384
        }
    for (int k = 0; k < 4; k++)
        out[k] = (uint16_t)((sum[k] + total / 2) / total);
    for (int k = 0; weigh && sum[3] > 0 && k < 3; k++)
        out[k] = (uint16_t)((alpha_sum[k] + sum[3] / 2) / sum[3]);
}

// The common case, both sizes even and no alpha weight, four plain sums.
static void filter_row_even(const struct level *in, uint32_t row, uint32_t width, uint16_t *out)
{
    const uint16_t *a = in->rgba + (size_t)row * 2 * in->width * 4;
    const uint16_t *b = a + (size_t)in->width * 4;
    for (uint32_t i = 0; i < width; i++, a += 8, b += 8, out += 4)
        for (int k = 0; k < 4; k++)
            out[k] = (uint16_t)(((uint32_t)a[k] + a[k + 4] + b[k] + b[k + 4] + 2u) / 4u);
}

static void filter_level(const struct level *in, struct level *out, bool weigh)
{
    bool even = in->width == out->width * 2 && in->height == out->height * 2;
    for (uint32_t row = 0; row < out->height; row++) {
        uint16_t *at = out->rgba + (size_t)row * out->width * 4;
        if (even && !weigh) {
            filter_row_even(in, row, out->width, at);
            continue;
        }
        struct taps y = taps_for(in->height, out->height, row);
        for (uint32_t column = 0; column < out->width; column++) {
            struct taps x = taps_for(in->width, out->width, column);
            filter_pixel(in, &x, &y, weigh, at + (size_t)column * 4);
        }
    }
}

static double coverage(const uint8_t *rgba, size_t pixels, float cutoff)
{
    size_t covered = 0;
    for (size_t i = 0; i < pixels; i++)
        covered += (float)rgba[i * 4 + 3] >= cutoff * 255.0f;
    return (double)covered / (double)pixels;
}

// The factor on alpha that brings the level's covered area nearest to `wanted`: the histogram gives the alpha
// that has to land just where it rounds up to the first 8-bit step that passes the cutoff.
static double coverage_scale(struct tables *tables, const struct level *level, double wanted, float cutoff)
{
    size_t pixels = (size_t)level->width * level->height, above = 0, best_above = 0;
    memset(tables->histogram, 0, sizeof tables->histogram);
    for (size_t i = 0; i < pixels; i++)
        tables->histogram[level->rgba[i * 4 + 3]]++;
    uint32_t best = 65536;
    double target = wanted * (double)pixels;
    for (uint32_t alpha = 65535; alpha > 0; alpha--) {
        above += tables->histogram[alpha];
        if (tables->histogram[alpha] > 0 && fabs((double)above - target) < fabs((double)best_above - target)) {
            best_above = above;
            best = alpha;
        }
    }
    double step = ceil((double)cutoff * 255.0) - 0.5;
    return (best < 65536 ? step + 1e-6 : step - 1e-3) * 257.0 / (double)(best < 65536 ? best : 65535);
}

static void compress(const struct tables *tables, const struct level *level, bool srgb, double alpha_scale,
                     uint8_t *out)
{
    size_t pixels = (size_t)level->width * level->height;
    const uint16_t *in = level->rgba;
    for (size_t i = 0; i < pixels; i++, in += 4, out += 4) {
        for (int k = 0; k < 3; k++)
            out[k] = srgb ? tables->srgb_from_linear[in[k]] : (uint8_t)((in[k] + 128u) / 257u);
        double alpha = alpha_scale * in[3] / 257.0 + 0.5;
        out[3] =
            alpha_scale == 1.0 ? (uint8_t)((in[3] + 128u) / 257u) : (uint8_t)(alpha < 255.0 ? alpha : 255.0);
    }
}

static uint32_t level_size(uint32_t size, uint32_t level)
{
    return size >> level > 0 ? size >> level : 1u;
}

static void build_chain(struct tables *tables, const struct scene_texture *texture, float cutoff,
                        uint32_t levels, struct level work[2], uint8_t *rgba)
{
    size_t pixels = (size_t)texture->width * texture->height;
    bool mask = cutoff > 0.0f;
    double wanted = mask ? coverage(rgba, pixels, cutoff) : 0.0;
    expand(tables, rgba, pixels, texture->srgb, work[0].rgba);
    work[0].width = texture->width;
    work[0].height = texture->height;
    uint8_t *out = rgba + pixels * 4;
    for (uint32_t level = 1; level < levels; level++) {
        struct level *from = &work[(level + 1) % 2], *to = &work[level % 2];
        to->width = level_size(texture->width, level);
        to->height = level_size(texture->height, level);
        filter_level(from, to, mask);
        // Nothing or everything covered stays as it is under any filter.
        bool scale = mask && wanted > 0.0 && wanted < 1.0;
        compress(tables, to, texture->srgb, scale ? coverage_scale(tables, to, wanted, cutoff) : 1.0, out);
        out += (size_t)to->width * to->height * 4;
    }
}

bool scene_make_mips(struct scene_texture *texture, float alpha_cutoff)
{
    size_t total = 0;
    uint32_t levels = 0;
    do {
        total += (size_t)level_size(texture->width, levels) * level_size(texture->height, levels);
        levels++;
    } while (level_size(texture->width, levels - 1) > 1 || level_size(texture->height, levels - 1) > 1);
    size_t pixels = (size_t)texture->width * texture->height;
    struct level work[2] = {{.rgba = malloc(pixels * 8)}, {.rgba = malloc((pixels / 2 + 1) * 8)}};
    struct tables *tables = malloc(sizeof *tables);
    uint8_t *rgba = malloc(total * 4);
    bool ok = work[0].rgba != NULL && work[1].rgba != NULL && tables != NULL && rgba != NULL;
    if (ok) {
        memcpy(rgba, texture->rgba, pixels * 4);
        fill_tables(tables);
        build_chain(tables, texture, alpha_cutoff, levels, work, rgba);
        free(texture->rgba);
        texture->rgba = rgba;
        texture->levels = levels;
        rgba = NULL;
    }
    free(rgba);
    free(tables);
    free(work[0].rgba);
    free(work[1].rgba);
    return ok;
}
