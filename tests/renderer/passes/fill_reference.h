// Hole filling and confidence in double precision and pixel by pixel, from Franke et al. 2021,
// sections 5.1, 5.2 and 7 (the dynamic term).
//
// A pixel is a surface or the background. A level's texel is the mean of its surface inputs, and has the
// farthest of their depths; only without any is it the mean of its background inputs, depth 0. A hole mixes
// texels of the kind of the one over it.
//
// The pyramid is never cut short here. L is the luminance of the tone-mapped, encoded colour in [0, 1]; a
// level's contrast confidence is that of its own four inputs, of both kinds; m = 0 and c_c = 1 where nothing
// was filled.
#ifndef TESTS_RENDERER_PASSES_FILL_REFERENCE_H
#define TESTS_RENDERER_PASSES_FILL_REFERENCE_H

#include "tests/renderer/passes/rig.h"

enum { FILL_LEVELS = 16 };

struct fill_parameters {
    double epsilon, fovea_deg, periphery_deg, hole_decay, dynamic_decay;
};

// One eye's pyramid; level 0 is the image: rgb in [0, 1], alpha 1 where valid and 0 in holes, reversed depth.
struct fill_pyramid {
    uint32_t level_count; // beside level 0; the last is one pixel
    struct {
        uint32_t width, height;
        double (*texels)[5]; // owned
    } levels[FILL_LEVELS];
};

struct fill_answer {
    bool hole, filled;     // filled: a level had something here
    uint32_t level;        // m
    double rgb[3], depth;  // depth: of the texel over the pixel
    double from_fovea_deg; // eccentricity beyond phi_F
    double confidence;     // c
};

// colours: rgba8; positions: reproject.h; eye: where depths are measured from, the origin of positions is 0.
struct fill_pyramid fill_build(uint32_t width, uint32_t height, const struct rig_eye *eye,
                               const uint8_t (*colours)[4], const float (*positions)[4]);
void fill_free(struct fill_pyramid *pyramid);
struct fill_answer fill_ask(const struct fill_pyramid *pyramid, const struct rig_eye *eye,
                            const struct fill_parameters *parameters, const float (*positions)[4], uint32_t x,
                            uint32_t y);

#endif
