// Boxes about a pair of eyes and what a test of culling does with them: cull, and say by brute force what is
// seen.
#ifndef TESTS_RENDERER_PASSES_CULL_BED_H
#define TESTS_RENDERER_PASSES_CULL_BED_H

#include "renderer/passes/cull/cull.h"
#include "renderer/passes/redraw/redraw.h"
#include "tests/renderer/passes/rig.h"

enum { BOXES = 400, MESHES = 5, SUBMODELS = 3, MATERIALS = 3 };

static const struct dvec3 middle = {500, -20, 3000}; // of the scene, far from the world's origin

struct box {
    struct dmat4 world_from_mesh, mesh_from_world;
    double min[3], max[3];
};

struct dvec3 bed_at_share(const struct box *b, double x, double y, double z);
bool bed_box_point_seen(const struct box *b, const struct rig_eye *e);
bool bed_frustum_point_in_box(const struct box *b, const struct rig_eye *e);
// Wholly behind one plane, by more than the margin for rounding.
bool bed_clearly_out(const struct box *b, const struct rig_eye *e);

struct bed {
    struct rig rig;
    struct scene *scene;
    struct scene_gpu *uploaded;
    struct cull cull, by_map; // by the frustum alone, and by the redraw map too
    struct gpu_image map_image;
    struct redraw redraw;
    uint32_t width, height;
    struct rig_view view;
    struct shared_item *items;
    struct box *boxes; // one an item
    uint32_t *visible, *in_frustum;
    struct shared_draw *draws;
    uint32_t *counts;
};

void bed_open(struct bed *b, uint64_t seed, uint32_t width, uint32_t height);
void bed_close(struct bed *b);
void bed_look(struct bed *b, uint64_t seed);
void bed_run(struct bed *b);
// After bed_run, for the same view.
void bed_run_by_map(struct bed *b, const uint8_t *map, bool moving_everywhere);

#endif
