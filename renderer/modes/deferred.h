// The passes that every deferred mode shares, in their order: cull, G-buffer, occlusion, shading, tone mapping,
// temporal antialiasing. A mode with a redraw map hands it over and draws, shades and filters its pixels only.
//
// Use: deferred_init -> per frame deferred_geometry, deferred_occlusion, deferred_shade, deferred_show.
#ifndef RENDERER_MODES_DEFERRED_H
#define RENDERER_MODES_DEFERRED_H

#include "renderer/modes/room.h"
#include "renderer/passes/cull/cull.h"
#include "renderer/passes/gbuffer/gbuffer.h"
#include "renderer/passes/motion/motion.h"
#include "renderer/passes/redraw/redraw.h"
#include "renderer/passes/shade/shade.h"
#include "renderer/passes/ssao/ssao.h"
#include "renderer/passes/taa/taa.h"
#include "renderer/passes/tonemap/tonemap.h"

struct deferred {
    struct cull cull;
    struct gbuffer gbuffer;
    struct ssao ssao;
    struct shade shade;
    struct tonemap tonemap;
    struct taa taa;
    struct motion motion;
    const struct gpu_image *colour[2]; // the mode's own
    bool has_ssao, has_taa, has_motion, has_map;
};

struct deferred_desc {
    const struct mode_setup *setup;
    const struct gpu_image *colour[2]; // rgba8, tone-mapped into; the second may be NULL
    enum gbuffer_eyes eyes;            // with a redraw map eye by eye
    bool ids;                          // the mode needs moving ids in the G-buffer
    const struct shade_blocks *blocks; // for shade_desc; NULL: every pixel by itself
    bool depth_only;                   // no G-buffer but depth, and ids; with own_shade
    bool own_shade;                    // the mode shades and tone-maps by itself
    // of a mode with a redraw map, else all null
    const struct gpu_image *redraw_map, *position[2];
    const struct redraw *redraw;
    bool moving_everywhere; // GBUFFER_MOVING_EVERYWHERE will be asked for
};

bool deferred_init(struct deferred *deferred, const struct deferred_desc *desc);
void deferred_finish(struct deferred *deferred);
void deferred_explain(const struct deferred *deferred, const struct mode_setup *setup);

// Cull and G-buffer. source: which positions hold what is kept, for GBUFFER_MOVING_EVERYWHERE.
void deferred_geometry(struct deferred *deferred, struct gpu_frame *frame, enum gbuffer_extent extent,
                       uint32_t source);
// Ambient occlusion, where it is on. source: which positions.
void deferred_occlusion(struct deferred *deferred, struct gpu_frame *frame, uint32_t source);
// Shading and tone mapping into colour `target`; with a redraw map from its list of tiles.
void deferred_shade(struct deferred *deferred, struct gpu_frame *frame, uint32_t target);
// The motion vectors of a mode that draws everything, where they are on; else NULL.
const struct gpu_image *deferred_motion(struct deferred *deferred, struct gpu_frame *frame);
// The picture to show: colour `source`, or with TAA what comes of it.
const struct gpu_image *deferred_show(struct deferred *deferred, struct gpu_frame *frame, uint32_t source,
                                      bool history);

#endif
