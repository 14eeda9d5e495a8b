// `regular`: deferred, full resolution, every pixel: the reference of all studies.
//
// G-buffer, GGX shading in compute, tone mapping with fixed luminance, as the regular renderer of Franke et al.
// 2021, section 8.4. Cull -> G-buffer -> shade -> tone map.

#include "renderer/modes/room.h"
#include "renderer/passes/cull/cull.h"
#include "renderer/passes/gbuffer/gbuffer.h"
#include "renderer/passes/shade/shade.h"
#include "renderer/passes/tonemap/tonemap.h"

#include <stdlib.h>

struct mode_state {
    struct gpu *gpu;
    struct cull cull;
    struct gbuffer gbuffer;
    struct shade shade;
    struct tonemap tonemap;
    struct gpu_image colour;
};

static void destroy(struct mode_state *state)
{
    if (!state)
        return;
    tonemap_finish(&state->tonemap);
    shade_finish(&state->shade);
    gbuffer_finish(&state->gbuffer);
    cull_finish(&state->cull);
    gpu_image_destroy(state->gpu, &state->colour);
    free(state);
}

static bool create_passes(struct mode_state *s, const struct mode_setup *setup)
{
    const struct gpu_image_desc colour = {.name = "colour",
                                          .format = VK_FORMAT_R8G8B8A8_UNORM,
                                          .width = setup->width,
                                          .height = setup->height,
                                          .layers = 2,
                                          .array = true,
                                          .usage =
                                              VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT};
    const struct gbuffer_desc gbuffer = {.gpu = s->gpu,
                                         .scene = setup->scene,
                                         .frame = setup->frame,
                                         .width = setup->width,
                                         .height = setup->height};
    if (!gpu_image_create(s->gpu, &colour, &s->colour) ||
        !cull_init(&s->cull, &(struct cull_desc){.gpu = s->gpu,
                                                 .scene = setup->scene,
                                                 .frame = setup->frame,
                                                 .counters = setup->counters}) ||
        !gbuffer_init(&s->gbuffer, &gbuffer))
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
                                     .emissive = s->gbuffer.emissive.view};
    if (!shade_init(&s->shade, &shade))
        return false;
    const struct tonemap_desc tonemap = {.gpu = s->gpu,
                                         .frame = setup->frame,
                                         .width = setup->width,
                                         .height = setup->height,
                                         .hdr = s->shade.hdr.view,
                                         .targets = {s->colour.view}};
    return tonemap_init(&s->tonemap, &tonemap);
}

static struct mode_state *create(const struct mode_setup *setup)
{
    struct mode_state *s = calloc(1, sizeof *s);
    if (!s)
        return NULL;
    s->gpu = setup->gpu;
    if (!create_passes(s, setup)) {
        destroy(s);
        return NULL;
    }
    mode_explain(setup->explanation, cull_memory(&s->cull), "indirect draws of %u submodels for two eyes",
                 setup->scene->item_count);
    mode_explain(
        setup->explanation, gbuffer_memory(&s->gbuffer), "G-buffer, %u pipelines%s", s->gbuffer.pipeline_count,
        s->gbuffer.has_emissive ? ", emissive because the scene glows" : "; no emissive, nothing glows");
    mode_explain(setup->explanation, s->shade.hdr.bytes, "shaded colour, linear HDR, %u local lights",
                 setup->scene->scene->light_count);
    mode_explain(setup->explanation, s->colour.bytes, "tone-mapped colour");
    return s;
}

static bool record(struct mode_state *s, const struct mode_record *record)
{
    struct gpu_frame *f = record->gpu_frame;
    cull_record(&s->cull, gpu_timer_begin(f, "cull"), false);
    gpu_timer_end(f);
    gbuffer_record(&s->gbuffer, gpu_timer_begin(f, "g-buffer"), &s->cull.draws, &s->cull.draw_counts, false);
    gpu_timer_end(f);
    shade_record(&s->shade, gpu_timer_begin(f, "shade"));
    gpu_timer_end(f);
    VkCommandBuffer cmd = gpu_timer_begin(f, "tone map");
    gpu_barrier(cmd, VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT);
    gpu_image_layout(cmd, &s->colour, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_GENERAL);
    tonemap_record(&s->tonemap, cmd, 0);
    gpu_timer_end(f);
    *record->result = (struct mode_result){.colour = &s->colour};
    return true;
}

const struct mode mode_regular = {
    .name = "regular",
    .description = "deferred, full resolution, every pixel: the reference",
    .source = "Franke et al. 2021, section 8.4 (the regular renderer)",
    .create = create,
    .record = record,
    .destroy = destroy,
};
