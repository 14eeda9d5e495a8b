// `time_warped`: last frame's pixels reprojected, holes filled, and only what is not trusted drawn anew.
//
// Franke, Fink, Martschinke, Selgrad and Stamminger, "Time-Warped Foveated Rendering for Virtual Reality
// Headsets", Computer Graphics Forum 40(1), 2021: sections 4 (reprojection), 5.1 (hole filling), 5.2
// (confidence), 6.1 (discard), 6.2 (composition) and the motion of objects of section 7. We differ from the
// paper in this:
// - points are splatted by 64-bit atomics instead of drawn as sprites (reproject.h);
// - pixels are not discarded in the fragment shader: kept pixels get the nearest depth first, so that the depth
//   test rejects their fragments before they are shaded;
// - a hole takes the finest level that has a value at its place, blended bilinearly between that level's valid
//   texels; the paper says only that the level is chosen by the hole's size;
// - colours are averaged, and L is measured, in the tone-mapped and encoded 8-bit values that are kept;
// - the pyramid ends where A^m < epsilon, since deeper holes are redrawn whatever their colour;
// - the pyramid holds no depths: only motion smoothing (6.2) reads them;
// - the age t of a moving object's pixel counts to 63, so with D above epsilon^(1/63), 0.975 at epsilon 0.2,
//   age alone never redraws it.

#include "renderer/modes/room.h"
#include "renderer/passes/compose/compose.h"
#include "renderer/passes/cull/cull.h"
#include "renderer/passes/gbuffer/gbuffer.h"
#include "renderer/passes/pyramid/pyramid.h"
#include "renderer/passes/redraw/redraw.h"
#include "renderer/passes/reproject/reproject.h"
#include "renderer/passes/shade/shade.h"
#include "renderer/passes/tonemap/tonemap.h"

#include <stdio.h>
#include <stdlib.h>

enum { EPSILON, FOVEA_DEG, PERIPHERY_DEG, HOLE_DECAY, DYNAMIC_DECAY };

static const struct mode_parameter parameters[] = {
    [EPSILON] = {"epsilon", "", "confidence under which a pixel is drawn anew; 1 draws everything, 0 nothing",
                 0, 1, 0.2, NULL},
    [FOVEA_DEG] = {"fovea_deg", "deg", "eccentricity within which every pixel is drawn anew (phi_F)", 0, 90, 10,
                   NULL},
    [PERIPHERY_DEG] = {"periphery_deg", "deg", "eccentricity of full trust (phi_0); above fovea_deg", 0, 180,
                       30, NULL},
    [HOLE_DECAY] = {"hole_decay", "", "trust lost per pyramid level of a filled hole (A)", 0, 1, 0.6, NULL},
    [DYNAMIC_DECAY] = {"dynamic_decay", "", "trust lost per frame on moving objects (D)", 0, 1, 0.75, NULL},
};

struct mode_state {
    struct gpu *gpu;
    float epsilon, fovea_deg;
    struct cull cull;
    struct gbuffer gbuffer;
    struct shade shade;
    struct tonemap tonemap;
    struct reproject reproject;
    struct pyramid pyramid;
    struct redraw redraw;
    struct compose compose;
    // two histories, written in turn: unfiltered tone-mapped colours and exact positions (reproject.h)
    struct gpu_image colour[2], position[2];
    struct gpu_image redraw_map;
    uint32_t last; // the history written last
    bool in_use;   // the images have left their first layout
};

static bool supported(const struct gpu *gpu, char *why, size_t why_size)
{
    if (gpu->int64_atomics)
        return true;
    snprintf(why, why_size,
             "time_warped needs 64-bit atomics on storage buffers (shaderBufferInt64Atomics), which %s lacks",
             gpu->properties.deviceName);
    return false;
}

static bool agree(const double *values, char *why, size_t why_size)
{
    if (values[PERIPHERY_DEG] > values[FOVEA_DEG])
        return true;
    snprintf(why, why_size, "periphery_deg of mode 'time_warped' is %g; it must be more than fovea_deg, %g",
             values[PERIPHERY_DEG], values[FOVEA_DEG]);
    return false;
}

static void destroy(struct mode_state *s)
{
    if (!s)
        return;
    compose_finish(&s->compose);
    redraw_finish(&s->redraw);
    pyramid_finish(&s->pyramid);
    reproject_finish(&s->reproject);
    tonemap_finish(&s->tonemap);
    shade_finish(&s->shade);
    gbuffer_finish(&s->gbuffer);
    cull_finish(&s->cull);
    for (int i = 0; i < 2; i++) {
        gpu_image_destroy(s->gpu, &s->colour[i]);
        gpu_image_destroy(s->gpu, &s->position[i]);
    }
    gpu_image_destroy(s->gpu, &s->redraw_map);
    free(s);
}

static bool create_image(struct mode_state *s, const struct mode_setup *setup, const char *name,
                         VkFormat format, struct gpu_image *out)
{
    const VkImageUsageFlags usage =
        VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
    return gpu_image_create(s->gpu,
                            &(struct gpu_image_desc){.name = name,
                                                     .format = format,
                                                     .width = setup->width,
                                                     .height = setup->height,
                                                     .layers = 2,
                                                     .array = true,
                                                     .usage = usage},
                            out);
}

static bool create_images(struct mode_state *s, const struct mode_setup *setup)
{
    for (int i = 0; i < 2; i++) {
        if (!create_image(s, setup, "history colour", VK_FORMAT_R8G8B8A8_UNORM, &s->colour[i]) ||
            !create_image(s, setup, "history position", VK_FORMAT_R32G32B32A32_SFLOAT, &s->position[i]))
            return false;
    }
    return create_image(s, setup, "redraw map", VK_FORMAT_R8_UINT, &s->redraw_map);
}

static bool create_drawing(struct mode_state *s, const struct mode_setup *setup)
{
    const struct gbuffer_desc gbuffer = {.gpu = s->gpu,
                                         .scene = setup->scene,
                                         .frame = setup->frame,
                                         .width = setup->width,
                                         .height = setup->height,
                                         .ids = setup->scene->scene->moving_count > 0,
                                         .redraw_map = s->redraw_map.view};
    const struct redraw_desc redraw = {.gpu = s->gpu,
                                       .counters = setup->counters,
                                       .width = setup->width,
                                       .height = setup->height,
                                       .redraw_map = s->redraw_map.view};
    if (!redraw_init(&s->redraw, &redraw))
        return false;
    const struct cull_desc cull = {.gpu = s->gpu,
                                   .scene = setup->scene,
                                   .frame = setup->frame,
                                   .counters = setup->counters,
                                   .pyramid = &s->redraw.pyramid,
                                   .tiles_x = s->redraw.tiles_x,
                                   .tiles_y = s->redraw.tiles_y,
                                   .levels = s->redraw.levels};
    if (!cull_init(&s->cull, &cull) || !gbuffer_init(&s->gbuffer, &gbuffer))
        return false;
    const struct shade_desc shade = {.gpu = s->gpu,
                                     .frame = setup->frame,
                                     .lights = &setup->scene->lights,
                                     .shadow_map = setup->shadow_map,
                                     .width = setup->width,
                                     .height = setup->height,
                                     .base = s->gbuffer.base.view,
                                     .normal = s->gbuffer.normal.view,
                                     .surface = s->gbuffer.surface.view,
                                     .depth = s->gbuffer.depth.view,
                                     .emissive = s->gbuffer.emissive.view,
                                     .redraw_map = s->redraw_map.view};
    if (!shade_init(&s->shade, &shade))
        return false;
    const struct tonemap_desc tonemap = {.gpu = s->gpu,
                                         .frame = setup->frame,
                                         .width = setup->width,
                                         .height = setup->height,
                                         .hdr = s->shade.hdr.view,
                                         .targets = {s->colour[0].view, s->colour[1].view},
                                         .redraw_map = s->redraw_map.view};
    return tonemap_init(&s->tonemap, &tonemap);
}

static bool create_warping(struct mode_state *s, const struct mode_setup *setup)
{
    const struct reproject_desc reproject = {.gpu = s->gpu,
                                             .frame = setup->frame,
                                             .motions = &setup->scene->motions,
                                             .width = setup->width,
                                             .height = setup->height,
                                             .colour = {s->colour[0].view, s->colour[1].view},
                                             .position = {s->position[0].view, s->position[1].view}};
    const struct pyramid_desc pyramid = {.gpu = s->gpu,
                                         .frame = setup->frame,
                                         .width = setup->width,
                                         .height = setup->height,
                                         .colour = {s->colour[0].view, s->colour[1].view},
                                         .position = {s->position[0].view, s->position[1].view},
                                         .redraw_map = s->redraw_map.view,
                                         .confidence = {.epsilon = s->epsilon,
                                                        .fovea_deg = s->fovea_deg,
                                                        .periphery_deg = (float)setup->values[PERIPHERY_DEG],
                                                        .hole_decay = (float)setup->values[HOLE_DECAY],
                                                        .dynamic_decay = (float)setup->values[DYNAMIC_DECAY]}};
    const struct compose_desc compose = {.gpu = s->gpu,
                                         .frame = setup->frame,
                                         .width = setup->width,
                                         .height = setup->height,
                                         .depth = s->gbuffer.depth.view,
                                         .id = s->gbuffer.id.view,
                                         .redraw_map = s->redraw_map.view,
                                         .position = {s->position[0].view, s->position[1].view}};
    return reproject_init(&s->reproject, &reproject) && pyramid_init(&s->pyramid, &pyramid) &&
           compose_init(&s->compose, &compose);
}

static void explain(const struct mode_state *s, const struct mode_setup *setup)
{
    struct mode_explanation *e = setup->explanation;
    const uint32_t moving = setup->scene->scene->moving_count;
    mode_explain(e, cull_memory(&s->cull), "indirect draws of %u submodels for two eyes",
                 setup->scene->item_count);
    mode_explain(e, gbuffer_memory(&s->gbuffer), "G-buffer, %u pipelines%s%s", s->gbuffer.pipeline_count,
                 s->gbuffer.has_emissive ? ", emissive because the scene glows"
                                         : "; no emissive, nothing glows",
                 moving ? ", ids because objects move" : "; no ids, nothing moves");
    mode_explain(e, s->shade.hdr.bytes, "shaded colour, linear HDR, %u local lights",
                 setup->scene->scene->light_count);
    mode_explain(e, s->colour[0].bytes + s->colour[1].bytes, "tone-mapped colour of this and the last frame");
    mode_explain(e, s->position[0].bytes + s->position[1].bytes,
                 "world positions of this and the last frame, 128 bit");
    mode_explain(e, reproject_memory(&s->reproject), "reprojection keys, 64 bit");
    mode_explain(e, pyramid_memory(&s->pyramid), "pull-push pyramid, %u levels because A^m < epsilon beyond",
                 s->pyramid.confidence.levels);
    mode_explain(e, s->redraw_map.bytes + redraw_memory(&s->redraw),
                 "redraw map, its or-pyramid and list of tiles");
}

static struct mode_state *create(const struct mode_setup *setup)
{
    struct mode_state *s = calloc(1, sizeof *s);
    if (!s)
        return NULL;
    s->gpu = setup->gpu;
    s->epsilon = (float)setup->values[EPSILON];
    s->fovea_deg = (float)setup->values[FOVEA_DEG];
    if (!create_images(s, setup) || !create_drawing(s, setup) || !create_warping(s, setup)) {
        destroy(s);
        return NULL;
    }
    explain(s, setup);
    return s;
}

// Everything is drawn: the first frame, a cut, epsilon 1.
static void mark_all(struct mode_state *s, struct gpu_frame *f)
{
    VkCommandBuffer cmd = gpu_timer_begin(f, "redraw map");
    const VkImageSubresourceRange all = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 2};
    gpu_barrier(cmd, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT);
    vkCmdClearColorImage(cmd, s->redraw_map.image, VK_IMAGE_LAYOUT_GENERAL, &(VkClearColorValue){.uint32 = {1}},
                         1, &all);
    gpu_barrier(cmd, VK_PIPELINE_STAGE_2_CLEAR_BIT, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT);
    gpu_timer_end(f);
}

static void warp(struct mode_state *s, struct gpu_frame *f, uint32_t target)
{
    // epsilon 0 redraws nothing, so the fovea must come from the last frame too
    reproject_record(&s->reproject, gpu_timer_begin(f, "reproject"), s->last, s->epsilon > 0 ? s->fovea_deg : 0,
                     false);
    gpu_timer_end(f);
    pyramid_pull(&s->pyramid, gpu_timer_begin(f, "pull"), target);
    gpu_timer_end(f);
    VkCommandBuffer cmd = gpu_timer_begin(f, "fill and confidence");
    pyramid_fill(&s->pyramid, cmd, target);
    gpu_barrier(cmd, VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT);
    gpu_timer_end(f);
}

static bool record(struct mode_state *s, const struct mode_record *record)
{
    struct gpu_frame *f = record->gpu_frame;
    const uint32_t target = 1 - s->last;
    const bool warped = record->history && s->in_use && s->epsilon < 1;
    if (!s->in_use) {
        const struct gpu_image *images[] = {&s->colour[0], &s->colour[1], &s->position[0], &s->position[1],
                                            &s->redraw_map};
        for (size_t i = 0; i < countof(images); i++)
            gpu_image_layout(f->cmd, images[i], VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_GENERAL);
    }
    if (warped)
        warp(s, f, target);
    else
        mark_all(s, f);
    redraw_record(&s->redraw, gpu_timer_begin(f, "redraw tiles"), true);
    gpu_timer_end(f);
    cull_record(&s->cull, gpu_timer_begin(f, "cull"), false);
    gpu_timer_end(f);
    gbuffer_record(&s->gbuffer, gpu_timer_begin(f, "g-buffer"), &s->cull.draws, &s->cull.draw_counts, warped);
    gpu_timer_end(f);
    shade_record(&s->shade, gpu_timer_begin(f, "shade"));
    gpu_timer_end(f);
    VkCommandBuffer cmd = gpu_timer_begin(f, "tone map");
    gpu_barrier(cmd, VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT);
    tonemap_record(&s->tonemap, cmd, target);
    gpu_timer_end(f);
    compose_record(&s->compose, gpu_timer_begin(f, "compose"), target);
    gpu_timer_end(f);
    s->last = target;
    s->in_use = true;
    *record->result =
        (struct mode_result){.colour = &s->colour[target], .redraw_map = &s->redraw_map, .counts_shaded = true};
    return true;
}

const struct mode mode_time_warped = {
    .name = "time_warped",
    .description = "reprojected periphery; the fovea and what is not trusted are drawn anew",
    .source = "Franke et al. 2021, Time-Warped Foveated Rendering for Virtual Reality Headsets",
    .parameters = parameters,
    .parameter_count = countof(parameters),
    .supported = supported,
    .agree = agree,
    .create = create,
    .record = record,
    .destroy = destroy,
};
