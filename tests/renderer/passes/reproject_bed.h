// A history and what a test of reprojection does with it: warp it both ways, judge it by brute force.
#ifndef TESTS_RENDERER_PASSES_REPROJECT_BED_H
#define TESTS_RENDERER_PASSES_REPROJECT_BED_H

#include "renderer/passes/reproject/reproject.h"
#include "tests/renderer/passes/reproject_reference.h"

struct bed {
    struct rig rig;
    uint32_t width, height;
    struct gpu_buffer motions;
    struct gpu_image position[2], colour[2];
    struct reproject pass, points; // the atomic splat and the rasteriser's points
    struct warp warp;              // what history 0 is warped by
    float (*result)[4];
    uint8_t (*colours)[4];
    int64_t *sources;
};

size_t bed_pixels(const struct bed *b);
void bed_set_motion(struct bed *b, uint32_t id, const struct dmat4 *m);
void bed_open(struct bed *b, uint32_t width, uint32_t height);
void bed_close(struct bed *b);
void bed_record(struct bed *b, const struct reproject *pass, uint32_t from);
// Every pixel's colour is its own number + 1, so that a result tells where it came from.
void bed_run(struct bed *b);
void bed_add(struct warp_verdict *sum, const struct warp_verdict *v);
void bed_tell(const char *what, const struct warp_verdict *v);
struct warp_verdict bed_judge(const struct bed *b);
void bed_put(struct bed *b, size_t pixel, struct dvec3 p, double w);
// What the last frame may have left: pixels of a view at random distances, holes, background, moving objects.
void bed_scatter(struct bed *b, const struct rig_view *before, uint64_t seed);

#endif
