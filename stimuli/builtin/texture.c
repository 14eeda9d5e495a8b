#include "stimuli/builtin/texture.h"

#include "stimuli/builtin/random.h"

#include <math.h>
#include <stdlib.h>

enum { NOISE_SIZE = 1024 };

// Adds one octave of value noise with `cells` cells a side.
static void add_octave(float *field, uint32_t cells, float weight, uint64_t seed)
{
    uint32_t step = NOISE_SIZE / cells;
    for (uint32_t y = 0; y < NOISE_SIZE; y++) {
        uint32_t cy = y / step, ny = (cy + 1) % cells;
        float ty = (float)(y % step) / (float)step;
        ty = ty * ty * (3 - 2 * ty);
        for (uint32_t cx = 0; cx < cells; cx++) {
            uint32_t nx = (cx + 1) % cells;
            float a = random_unit(seed, cy * cells + cx), b = random_unit(seed, cy * cells + nx);
            float c = random_unit(seed, ny * cells + cx), d = random_unit(seed, ny * cells + nx);
            float left = a + (c - a) * ty, right = b + (d - b) * ty;
            float *to = &field[y * NOISE_SIZE + cx * step];
            for (uint32_t x = 0; x < step; x++) {
                float t = (float)x / (float)step;
                to[x] += weight * (left + (right - left) * t * t * (3 - 2 * t));
            }
        }
    }
}

bool texture_noise_create(struct texture_noise *noise, uint64_t seed)
{
    static const struct {
        uint32_t cells, octaves;
    } shape[TEXTURE_NOISES] = {{4, 5}, {64, 3}};
    *noise = (struct texture_noise){0};
    for (int i = 0; i < TEXTURE_NOISES; i++) {
        noise->field[i] = calloc((size_t)NOISE_SIZE * NOISE_SIZE, sizeof(float));
        if (noise->field[i] == NULL) {
            texture_noise_destroy(noise);
            return false;
        }
        float sum = 2.0f - exp2f(1.0f - (float)shape[i].octaves), weight = 1.0f / sum;
        for (uint32_t k = 0; k < shape[i].octaves; k++, weight *= 0.5f)
            add_octave(noise->field[i], shape[i].cells << k, weight, seed * 16 + (uint64_t)i * 8 + k);
    }
    return true;
}

void texture_noise_destroy(struct texture_noise *noise)
{
    for (int i = 0; i < TEXTURE_NOISES; i++)
        free(noise->field[i]);
    *noise = (struct texture_noise){0};
}

float texture_noise_at(const struct texture_noise *noise, int which, float u, float v)
{
    int32_t x = (int32_t)lrintf(u * NOISE_SIZE) & (NOISE_SIZE - 1);
    int32_t y = (int32_t)lrintf(v * NOISE_SIZE) & (NOISE_SIZE - 1);
    return noise->field[which][y * NOISE_SIZE + x];
}

float texture_smooth(float low, float high, float v)
{
    float t = fminf(fmaxf((v - low) / (high - low), 0), 1);
    return t * t * (3 - 2 * t);
}

void texture_mix(float colour[3], const float other[3], float share)
{
    for (int i = 0; i < 3; i++)
        colour[i] += (other[i] - colour[i]) * share;
}

static uint8_t byte(float v)
{
    return (uint8_t)(fminf(fmaxf(v, 0), 1) * 255 + 0.5f);
}

static uint8_t *normal_image(const float *height, uint32_t size, float tile_m)
{
    uint8_t *out = malloc((size_t)size * size * 4);
    if (out == NULL)
        return NULL;
    float per_m = (float)size / (2 * tile_m);
    for (uint32_t y = 0; y < size; y++) {
        const float *row = &height[y * size], *up = &height[(y + size - 1) % size * size];
        const float *down = &height[(y + 1) % size * size];
        for (uint32_t x = 0; x < size; x++) {
            // Image rows run down, the bitangent runs up.
            float nx = (row[(x + size - 1) % size] - row[(x + 1) % size]) * per_m;
            float ny = (down[x] - up[x]) * per_m;
            float scale = 1 / sqrtf(nx * nx + ny * ny + 1);
            uint8_t *p = &out[(y * size + x) * 4];
            p[0] = byte(nx * scale * 0.5f + 0.5f);
            p[1] = byte(ny * scale * 0.5f + 0.5f);
            p[2] = byte(scale * 0.5f + 0.5f);
            p[3] = 255;
        }
    }
    return out;
}

struct texture_set texture_make(struct maker *maker, const struct texture_noise *noise,
                                const struct texture_desc *desc)
{
    uint32_t size = desc->size;
    struct texture_set set = {0};
    uint8_t *base = malloc((size_t)size * size * 4), *surface = malloc((size_t)size * size * 4);
    float *height = malloc((size_t)size * size * sizeof *height);
    if (base == NULL || surface == NULL || height == NULL) {
        free(base);
        free(surface);
        free(height);
        maker->failed = true;
        return set;
    }
    for (uint32_t i = 0; i < size * size; i++) {
        struct texel t = {.roughness = 0.8f, .alpha = 1};
        desc->texel(noise, ((float)(i % size) + 0.5f) / (float)size, ((float)(i / size) + 0.5f) / (float)size,
                    &t);
        for (int k = 0; k < 3; k++)
            base[i * 4 + (uint32_t)k] = byte(t.colour[k]);
        base[i * 4 + 3] = byte(t.alpha);
        surface[i * 4] = 255;
        surface[i * 4 + 1] = byte(t.roughness);
        surface[i * 4 + 2] = byte(t.metallic);
        surface[i * 4 + 3] = 255;
        height[i] = t.height;
    }
    set.base = maker_texture(maker, size, base, true, desc->nearest, desc->masked ? 0.5f : 0) + 1;
    if (desc->plain) {
        free(surface);
    } else {
        set.surface = maker_texture(maker, size, surface, false, desc->nearest, 0) + 1;
        set.normal =
            maker_texture(maker, size, normal_image(height, size, desc->tile_m), false, desc->nearest, 0) + 1;
    }
    free(height);
    return set;
}
