// Procedural textures: a rule per texel gives height, colour and surface; from it come the three images of a
// material.
#ifndef STIMULI_BUILTIN_TEXTURE_H
#define STIMULI_BUILTIN_TEXTURE_H

#include "stimuli/builtin/maker.h"

#include <stdbool.h>
#include <stdint.h>

// Tileable fractal noise, made once per scene and looked up by all its textures.
enum { TEXTURE_COARSE, TEXTURE_FINE, TEXTURE_NOISES };
struct texture_noise {
    float *field[TEXTURE_NOISES]; // each 0..1, mean 0.5
};
bool texture_noise_create(struct texture_noise *noise, uint64_t seed);
void texture_noise_destroy(struct texture_noise *noise);
// u and v repeat with 1.
float texture_noise_at(const struct texture_noise *noise, int which, float u, float v);

struct texel {
    float height;    // metres above the texture's ground
    float colour[3]; // sRGB-encoded, 0..1
    float roughness, metallic, alpha;
};

typedef void (*texel_fn)(const struct texture_noise *noise, float u, float v, struct texel *out);

struct texture_desc {
    texel_fn texel;
    uint32_t size;
    float tile_m; // what the texture covers, for slopes
    bool plain;   // no normal and surface images
    bool masked;  // alpha
    bool nearest;
};

// Texture indices + 1, as maker_material_desc wants them; 0 where not made.
struct texture_set {
    int32_t base, surface, normal;
};
struct texture_set texture_make(struct maker *maker, const struct texture_noise *noise,
                                const struct texture_desc *desc);

// Shared by the rules.
float texture_smooth(float low, float high, float v); // 0..1
void texture_mix(float colour[3], const float other[3], float share);

#endif
