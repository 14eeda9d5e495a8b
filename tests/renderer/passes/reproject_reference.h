// Forward warping by brute force and in double precision, from Franke et al. 2021, section 4: every pixel of
// the last frame is a point sprite of one pixel that goes where its world position now falls, and the nearest
// wins. A winner that shows through between the spread pixels of a nearer surface is then made a hole, by the
// sentence at resolve.comp's shows_through.
//
// A result is accepted where rounding to float cannot decide otherwise: a point within 1e-3 px of a pixel's
// border may fall on either side, two points within 1e-5 of each other's distance may win over each other, and
// so may 10 % of distance be passed or not. What shows through is undecided where that depends on such a point.
#ifndef TESTS_RENDERER_PASSES_REPROJECT_REFERENCE_H
#define TESTS_RENDERER_PASSES_REPROJECT_REFERENCE_H

#include "tests/renderer/passes/rig.h"

enum { WARP_MOTIONS = 8 };

struct warp {
    struct rig_view view;
    double drop_deg;
    bool drop_moving;
    float motions[WARP_MOTIONS][16]; // by moving id, column-major; 0 unused
    float (*positions)[4];           // two layers, reproject.h
};

struct warp_verdict {
    uint32_t pixels;    // compared
    uint32_t covered;   // holding a point
    uint32_t certain;   // with one acceptable answer only
    uint32_t shows;     // surely showing through: a hole
    uint32_t undecided; // showing through or not
    uint32_t wrong;     // not acceptable
    double worst_error; // of positions, relative to their distance from the origin + 1
};

// The pass's results: the index of the source pixel of each pixel (-1: a hole) and its new position.
struct warp_verdict warp_judge(const struct warp *warp, int eye, const int64_t *sources,
                               const float (*positions)[4]);

#endif
