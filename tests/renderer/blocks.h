// A scene of a few boxes, some of them moving: what a law needs and nothing else.
#ifndef TESTS_RENDERER_BLOCKS_H
#define TESTS_RENDERER_BLOCKS_H

#include "stimuli/scene.h"

// Where a moving block's middle is at a time, metres and seconds.
struct block_key {
    float time_s, x, y, z;
};

struct block {
    struct dvec3 middle, half; // metres; half may be zero on any axis
    float colour[3];           // linear; all zero means white
    float emissive[3];
    float smoothness, metallic;   // smoothness: 1 - roughness
    const struct block_key *keys; // borrowed; NULL: it stands still
    uint32_t key_count;           // at least 2
    bool inside_out;              // seen from within
};

struct blocks {
    const struct block *list;
    uint32_t count;
    struct dvec3 eye, target; // of a camera that stands still
    const struct scene_light *lights;
    uint32_t light_count;
    float sky; // radiance of all of it, cd/m^2
};

// Never NULL; destroyed by the caller. Sky and key give mid gray where a white surface sees the sky.
struct scene *blocks_scene(const struct blocks *blocks);

#endif
