// `time_warped`: last frame's pixels reprojected, holes filled, and only what is not trusted drawn anew.
//
// Franke, Fink, Martschinke, Selgrad and Stamminger, "Time-Warped Foveated Rendering for Virtual Reality
// Headsets", Computer Graphics Forum 40(1), 2021: sections 4 to 7. We differ from the paper in this:
// - `splat` atomic resolves points by 64-bit atomics instead of drawing them as sprites (reproject.h); both
// give the
//   same pixels;
// - a pixel that shows through between the spread pixels of a nearer surface is a hole (show_through.comp);
// - pixels are not discarded in the fragment shader: kept pixels get the nearest depth first, so that the depth
//   test rejects their fragments before they are shaded;
// - a hole takes the finest level that has a value at its place, blended bilinearly between that level's valid
//   texels of its kind; the paper says only that the level is chosen by the hole's size;
// - the background is a direction with a class of its own: it is reprojected, and surfaces' holes never take
// its colour;
// - colours are averaged, and L is measured, in the tone-mapped and encoded 8-bit values that are kept;
// - the pyramid ends where A^m < epsilon, since deeper holes are redrawn whatever their colour;
// - the or-pyramid of the redraw map begins at 8x8 pixels, and a box is looked up in 8x8 of its texels, not
// 2x2;
// - moving pixels are redrawn in turns of strips of tiles, every as many frames as D^t needs to fall under
// epsilon, and
//   moving objects' boxes every six frames (movers.h);
// - the age t of a moving object's pixel counts to 63, so with D above epsilon^(1/63), 0.975 at epsilon 0.2,
//   age alone never redraws it.

#include "renderer/modes/deferred.h"
#include "renderer/passes/compose/compose.h"
#include "renderer/passes/movers/movers.h"
#include "renderer/passes/pyramid/pyramid.h"
#include "renderer/passes/reproject/reproject.h"

#include <stdio.h>
#include <stdlib.h>

enum { EPSILON, FOVEA_DEG, PERIPHERY_DEG, HOLE_DECAY, DYNAMIC_DECAY, DYNAMIC_OBJECTS, SPLAT };
enum { OBJECTS_FOVEATED, OBJECTS_REGULAR };
enum { SPLAT_ATOMIC, SPLAT_POINTS };

static const char *const object_words[] = {"foveated", "regular", NULL};
static const char *const splat_words[] = {"atomic", "points", NULL};

static const struct mode_parameter parameters[] = {
    [EPSILON] = {"epsilon", "", "confidence under which a pixel is drawn anew; 1 draws everything, 0 nothing",
                 0, 1, 0.2, NULL},
    [FOVEA_DEG] = {"fovea_deg", "deg", "eccentricity within which every pixel is drawn anew (phi_F)", 0, 90, 10,
                   NULL},
    [PERIPHERY_DEG] = {"periphery_deg", "deg", "eccentricity of full trust (phi_0); above fovea_deg", 0, 180,
                       30, NULL},
    [HOLE_DECAY] = {"hole_decay", "", "trust lost per pyramid level of a filled hole (A)", 0, 1, 0.6, NULL},
    [DYNAMIC_DECAY] = {"dynamic_decay", "", "trust lost per frame on moving objects (D)", 0, 1, 0.75, NULL},
    [DYNAMIC_OBJECTS] =
        {"dynamic_objects", "",
         "foveated: reprojected like the rest; regular: drawn everywhere in every frame (the mixed mode)", 0, 1,
         OBJECTS_FOVEATED, object_words},
    [SPLAT] = {"splat", "",
               "how points find their pixels: 64-bit atomics, or drawn as points (the paper); same picture", 0,
               1, SPLAT_ATOMIC, splat_words},
};

struct mode_state {
    struct gpu *gpu;
    float epsilon, fovea_deg;
    bool has_movers, objects_regular;
    bool marks; // moving boxes are redrawn in turn
    struct deferred deferred;
    struct reproject reproject;
    struct pyramid pyramid;
    struct redraw redraw;
    struct movers movers;
    struct compose compose;
    // two histories, written in turn: unfiltered tone-mapped colours and exact positions (reproject.h)
    struct gpu_image colour[2], position[2];
    struct gpu_image redraw_map;
    uint32_t last; // the history written last
    bool in_use;   // the images have left their first layout
};

static bool supported(const struct gpu *gpu, const double *values, char *why, size_t why_size)
{
    (void)values;
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
    movers_finish(&s->movers);
    deferred_finish(&s->deferred);
    redraw_finish(&s->redraw);
    pyramid_finish(&s->pyramid);
    reproject_finish(&s->reproject);
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
    const struct redraw_desc redraw = {.gpu = s->gpu,
                                       .counters = setup->counters,
                                       .width = setup->width,
                                       .height = setup->height,
                                       .redraw_map = s->redraw_map.view};
    const struct deferred_desc deferred = {.setup = setup,
                                           .colour = {&s->colour[0], &s->colour[1]},
                                           .ids = true,
                                           .redraw_map = &s->redraw_map,
                                           .position = {&s->position[0], &s->position[1]},
                                           .redraw = &s->redraw,
                                           .moving_everywhere = s->has_movers && s->objects_regular};
    return redraw_init(&s->redraw, &redraw) && deferred_init(&s->deferred, &deferred);
}

static struct pyramid_confidence confidence_of(const double *values)
{
    return (struct pyramid_confidence){.epsilon = (float)values[EPSILON],
                                       .fovea_deg = (float)values[FOVEA_DEG],
                                       .periphery_deg = (float)values[PERIPHERY_DEG],
                                       .hole_decay = (float)values[HOLE_DECAY],
                                       .dynamic_decay = (float)values[DYNAMIC_DECAY]};
}

static bool create_warping(struct mode_state *s, const struct mode_setup *setup)
{
    const struct reproject_desc reproject = {.gpu = s->gpu,
                                             .frame = setup->frame,
                                             .motions = &setup->scene->motions,
                                             .width = setup->width,
                                             .height = setup->height,
                                             .points = setup->values[SPLAT] == SPLAT_POINTS,
                                             .still = !s->has_movers,
                                             .colour = {s->colour[0].view, s->colour[1].view},
                                             .position = {s->position[0].view, s->position[1].view}};
    const struct pyramid_desc pyramid = {.gpu = s->gpu,
                                         .frame = setup->frame,
                                         .width = setup->width,
                                         .height = setup->height,
                                         .colour = {s->colour[0].view, s->colour[1].view},
                                         .position = {s->position[0].view, s->position[1].view},
                                         .redraw_map = s->redraw_map.view,
                                         .moving = s->marks,
                                         .all_levels = setup->settings.adjustable,
                                         .may_move = setup->settings.adjustable && s->has_movers,
                                         .holes = &s->reproject.holes,
                                         .confidence = confidence_of(setup->values)};
    return reproject_init(&s->reproject, &reproject) && pyramid_init(&s->pyramid, &pyramid);
}

static bool create_joining(struct mode_state *s, const struct mode_setup *setup)
{
    const struct movers_desc movers = {.gpu = s->gpu,
                                       .scene = setup->scene,
                                       .frame = setup->frame,
                                       .width = setup->width,
                                       .height = setup->height,
                                       .redraw_map = &s->redraw_map,
                                       .position = {s->position[0].view, s->position[1].view},
                                       .depth = s->deferred.gbuffer.depth.view,
                                       .join = s->objects_regular};
    const struct compose_desc compose = {.gpu = s->gpu,
                                         .frame = setup->frame,
                                         .depth = s->deferred.gbuffer.depth.view,
                                         .id = s->deferred.gbuffer.id.view,
                                         .redraw_map = s->redraw_map.view,
                                         .position = {s->position[0].view, s->position[1].view},
                                         .tiles = &s->redraw.tiles};
    return (!s->has_movers || movers_init(&s->movers, &movers)) && compose_init(&s->compose, &compose);
}

static void explain(const struct mode_state *s, const struct mode_setup *setup)
{
    struct mode_explanation *e = setup->explanation;
    deferred_explain(&s->deferred, setup);
    mode_explain(e, s->position[0].bytes + s->position[1].bytes,
                 "world positions of this and the last frame, 128 bit");
    mode_explain(e, reproject_memory(&s->reproject),
                 s->reproject.points ? "drawn points: source and depth" : "reprojection keys, 64 bit");
    mode_explain(e, pyramid_memory(&s->pyramid), "pull-push pyramid, %u levels because A^m < epsilon beyond",
                 s->pyramid.confidence.levels);
    mode_explain(e, s->redraw_map.bytes + redraw_memory(&s->redraw),
                 "redraw map, its or-pyramid and list of tiles");
    if (s->has_movers)
        mode_explain(e, s->movers.items.size, "list of %u moving submodels, %s", s->movers.item_count,
                     s->objects_regular ? "drawn everywhere in every frame"
                                        : "whose boxes are redrawn in turn");
}

static void take_values(struct mode_state *s, const double *values)
{
    s->epsilon = (float)values[EPSILON];
    s->fovea_deg = (float)values[FOVEA_DEG];
    s->marks = s->has_movers && s->epsilon > 0;
}

static bool set(struct mode_state *s, const double *values)
{
    const struct pyramid_confidence confidence = confidence_of(values);
    take_values(s, values);
    pyramid_set(&s->pyramid, &confidence, s->marks);
    return true;
}

static struct mode_state *create(const struct mode_setup *setup)
{
    struct mode_state *s = calloc(1, sizeof *s);
    if (!s)
        return NULL;
    s->gpu = setup->gpu;
    s->has_movers = setup->scene->moving_object_count > 0;
    take_values(s, setup->values);
    s->objects_regular = setup->values[DYNAMIC_OBJECTS] == OBJECTS_REGULAR;
    if (!create_images(s, setup) || !create_drawing(s, setup) || !create_warping(s, setup) ||
        !create_joining(s, setup)) {
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

static void warp(struct mode_state *s, struct gpu_frame *f, uint32_t target, uint32_t turn, bool mixed)
{
    // epsilon 0 redraws nothing, so the fovea must come from the last frame too
    reproject_record(&s->reproject, gpu_timer_begin(f, "reproject"), s->last, s->epsilon > 0 ? s->fovea_deg : 0,
                     mixed);
    gpu_timer_end(f);
    if (s->marks) {
        movers_mark(&s->movers, gpu_timer_begin(f, "mark moving boxes"), &s->redraw_map, turn);
        gpu_timer_end(f);
    }
    pyramid_pull(&s->pyramid, gpu_timer_begin(f, "pull"), target);
    gpu_timer_end(f);
    VkCommandBuffer cmd = gpu_timer_begin(f, "fill and confidence");
    pyramid_fill(&s->pyramid, cmd, target, turn);
    gpu_barrier(cmd, VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT);
    gpu_timer_end(f);
}

// The G-buffer of what is redrawn; the redraw map is complete afterwards, and its tiles are listed.
static void draw(struct mode_state *s, struct gpu_frame *f, uint32_t target, bool warped, bool mixed)
{
    redraw_record(&s->redraw, gpu_timer_begin(f, "redraw tiles"), !mixed);
    gpu_timer_end(f);
    deferred_geometry(&s->deferred, f,
                      mixed    ? GBUFFER_MOVING_EVERYWHERE
                      : warped ? GBUFFER_MASKED
                               : GBUFFER_ALL,
                      target);
    if (!mixed)
        return;
    VkCommandBuffer cmd = gpu_timer_begin(f, "join moving pixels");
    movers_join(&s->movers, cmd, target);
    redraw_record(&s->redraw, cmd, true);
    gpu_timer_end(f);
}

static bool record(struct mode_state *s, const struct mode_record *record)
{
    struct gpu_frame *f = record->gpu_frame;
    const uint32_t target = 1 - s->last;
    const bool warped = record->history && s->in_use && s->epsilon < 1;
    const bool mixed = warped && record->moving && s->has_movers && s->objects_regular;
    if (!s->in_use) {
        const struct gpu_image *images[] = {&s->colour[0], &s->colour[1], &s->position[0], &s->position[1],
                                            &s->redraw_map};
        for (size_t i = 0; i < countof(images); i++)
            gpu_image_layout(f->cmd, images[i], VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_GENERAL);
    }
    if (warped)
        warp(s, f, target, (uint32_t)record->number, mixed);
    else
        mark_all(s, f);
    draw(s, f, target, warped, mixed);
    compose_record_tiles(&s->compose, gpu_timer_begin(f, "compose"), target);
    gpu_timer_end(f);
    deferred_occlusion(&s->deferred, f, target);
    deferred_shade(&s->deferred, f, target);
    s->last = target;
    s->in_use = true;
    *record->result = (struct mode_result){.colour = deferred_show(&s->deferred, f, target, record->history),
                                           .redraw_map = &s->redraw_map,
                                           .counts_shaded = true};
    return true;
}

const struct mode mode_time_warped = {
    .name = "time_warped",
    .description = "reprojected periphery; the fovea and what is not trusted are drawn anew",
    .source = "Franke et al. 2021, Time-Warped Foveated Rendering for Virtual Reality Headsets",
    .parameters = parameters,
    .parameter_count = countof(parameters),
    .foveated = true,
    .supported = supported,
    .agree = agree,
    .create = create,
    .record = record,
    .set = set,
    .destroy = destroy,
};
