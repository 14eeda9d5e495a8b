#include "renderer/modes/deferred.h"

static VkImageView view_of(const struct gpu_image *image)
{
    return image ? image->view : VK_NULL_HANDLE;
}

static bool init_geometry(struct deferred *d, const struct deferred_desc *desc)
{
    const struct mode_setup *s = desc->setup;
    struct cull_desc cull = {.gpu = s->gpu,
                             .scene = s->scene,
                             .frame = s->frame,
                             .counters = s->counters,
                             .both_eyes = desc->eyes != GBUFFER_EYE_BY_EYE,
                             .instanced = desc->eyes == GBUFFER_INSTANCED};
    if (d->has_map) {
        cull.pyramid = &desc->redraw->pyramid;
        cull.tiles_x = desc->redraw->tiles_x;
        cull.tiles_y = desc->redraw->tiles_y;
        cull.levels = desc->redraw->levels;
    }
    struct gbuffer_desc gbuffer = {.gpu = s->gpu,
                                   .scene = s->scene,
                                   .frame = s->frame,
                                   .width = s->width,
                                   .height = s->height,
                                   .depth_only = desc->depth_only,
                                   .eyes = desc->eyes,
                                   .ids = s->scene->scene->moving_count &&
                                          (desc->ids || d->has_taa || d->has_motion),
                                   .redraw_map = view_of(desc->redraw_map)};
    for (int i = 0; desc->moving_everywhere && i < 2; i++)
        gbuffer.position[i] = view_of(desc->position[i]);
    return cull_init(&d->cull, &cull) && gbuffer_init(&d->gbuffer, &gbuffer);
}

static bool init_ssao(struct deferred *d, const struct deferred_desc *desc)
{
    const struct mode_setup *s = desc->setup;
    struct ssao_desc ssao = {.gpu = s->gpu,
                             .frame = s->frame,
                             .width = s->width,
                             .height = s->height,
                             .depth = d->gbuffer.depth.view,
                             .redraw_map = view_of(desc->redraw_map),
                             .position = {view_of(desc->position[0]), view_of(desc->position[1])}};
    if (d->has_map) {
        ssao.pyramid = &desc->redraw->pyramid;
        ssao.tiles_x = desc->redraw->tiles_x;
        ssao.tiles_y = desc->redraw->tiles_y;
    }
    return ssao_init(&d->ssao, &ssao);
}

static bool init_light(struct deferred *d, const struct deferred_desc *desc)
{
    const struct mode_setup *s = desc->setup;
    const struct gpu_buffer *tiles = d->has_map ? &desc->redraw->tiles : NULL;
    const struct shade_desc shade = {.gpu = s->gpu,
                                     .frame = s->frame,
                                     .lights = &s->scene->lights,
                                     .shadow_map = s->shadow_map,
                                     .width = s->width,
                                     .height = s->height,
                                     .base = d->gbuffer.base.view,
                                     .normal = d->gbuffer.normal.view,
                                     .surface = d->gbuffer.surface.view,
                                     .depth = d->gbuffer.depth.view,
                                     .emissive = d->gbuffer.emissive.view,
                                     .ao = d->ssao.shown.view,
                                     .ao_depth = d->ssao.distance.view,
                                     .redraw_map = view_of(desc->redraw_map),
                                     .tiles = tiles,
                                     .blocks = desc->blocks};
    if (!shade_init(&d->shade, &shade))
        return false;
    const struct tonemap_desc tonemap = {.gpu = s->gpu,
                                         .frame = s->frame,
                                         .width = s->width,
                                         .height = s->height,
                                         .hdr = d->shade.hdr.view,
                                         .targets = {view_of(desc->colour[0]), view_of(desc->colour[1])},
                                         .redraw_map = view_of(desc->redraw_map),
                                         .tiles = tiles,
                                         .leaders = desc->blocks ? &d->shade.leaders : NULL};
    return tonemap_init(&d->tonemap, &tonemap);
}

static bool init_taa(struct deferred *d, const struct deferred_desc *desc)
{
    const struct mode_setup *s = desc->setup;
    const struct taa_desc taa = {.gpu = s->gpu,
                                 .frame = s->frame,
                                 .motions = &s->scene->motions,
                                 .motion_count = s->scene->motion_count,
                                 .width = s->width,
                                 .height = s->height,
                                 .colour = {view_of(desc->colour[0]), view_of(desc->colour[1])},
                                 .position = {view_of(desc->position[0]), view_of(desc->position[1])},
                                 .redraw_map = view_of(desc->redraw_map),
                                 .depth = d->gbuffer.depth.view,
                                 .id = d->gbuffer.id.view};
    return taa_init(&d->taa, &taa);
}

static bool init_motion(struct deferred *d, const struct deferred_desc *desc)
{
    const struct mode_setup *s = desc->setup;
    const struct motion_desc motion = {.gpu = s->gpu,
                                       .scene = s->scene,
                                       .frame = s->frame,
                                       .counters = s->counters,
                                       .width = s->width,
                                       .height = s->height,
                                       .depth = d->gbuffer.depth.view,
                                       .id = d->gbuffer.id.view};
    return motion_init(&d->motion, &motion);
}

bool deferred_init(struct deferred *d, const struct deferred_desc *desc)
{
    *d = (struct deferred){.colour = {desc->colour[0], desc->colour[1]},
                           .has_ssao = desc->setup->settings.ssao,
                           .has_taa = desc->setup->settings.taa,
                           .has_motion = desc->setup->settings.motion && !desc->redraw_map,
                           .has_map = desc->redraw_map != NULL};
    return init_geometry(d, desc) && (!d->has_ssao || init_ssao(d, desc)) &&
           (desc->own_shade || init_light(d, desc)) && (!d->has_taa || init_taa(d, desc)) &&
           (!d->has_motion || init_motion(d, desc));
}

void deferred_finish(struct deferred *d)
{
    motion_finish(&d->motion);
    taa_finish(&d->taa);
    tonemap_finish(&d->tonemap);
    shade_finish(&d->shade);
    ssao_finish(&d->ssao);
    gbuffer_finish(&d->gbuffer);
    cull_finish(&d->cull);
}

void deferred_explain(const struct deferred *d, const struct mode_setup *setup)
{
    struct mode_explanation *e = setup->explanation;
    mode_explain(e, cull_memory(&d->cull), "indirect draws of %u submodels, %s", setup->scene->item_count,
                 d->gbuffer.eyes == GBUFFER_EYE_BY_EYE ? "a list for each eye"
                                                       : "one list for both eyes, which are drawn in one pass");
    mode_explain(e, gbuffer_memory(&d->gbuffer), "%s, %u pipelines%s%s",
                 d->gbuffer.depth_only ? "depth" : "G-buffer", d->gbuffer.pipeline_count,
                 d->gbuffer.has_emissive ? ", emissive because the scene glows"
                                         : "; no emissive, nothing glows",
                 d->gbuffer.has_id ? ", ids because objects move" : "; no ids, nobody asks what moves");
    if (d->has_ssao)
        mode_explain(e, ssao_memory(&d->ssao), "ambient occlusion of half resolution, because it is on");
    if (d->shade.gpu)
        mode_explain(
            e, shade_memory(&d->shade), "shaded colour, linear HDR%s, %u local lights in masks by tile",
            d->shade.blocks ? " of the pixels that lead others" : "", setup->scene->scene->light_count);
    mode_explain(e, d->colour[0]->bytes + (d->colour[1] ? d->colour[1]->bytes : 0), "tone-mapped colour%s",
                 d->colour[1] ? " of this and the last frame" : "");
    if (d->has_taa)
        mode_explain(e, taa_memory(&d->taa), "filtered pictures of this and the last frame, because TAA is on");
    if (d->has_motion)
        mode_explain(e, d->motion.image.bytes, "motion vectors, because they are measured");
}

void deferred_geometry(struct deferred *d, struct gpu_frame *f, enum gbuffer_extent extent, uint32_t source)
{
    cull_record(&d->cull, gpu_timer_begin(f, "cull"), extent == GBUFFER_MOVING_EVERYWHERE);
    gpu_timer_end(f);
    gbuffer_record(&d->gbuffer, gpu_timer_begin(f, "g-buffer"), &d->cull.draws, &d->cull.draw_counts, extent,
                   source);
    gpu_timer_end(f);
}

void deferred_occlusion(struct deferred *d, struct gpu_frame *f, uint32_t source)
{
    if (!d->has_ssao)
        return;
    ssao_record(&d->ssao, gpu_timer_begin(f, "ambient occlusion"), source);
    gpu_timer_end(f);
}

void deferred_shade(struct deferred *d, struct gpu_frame *f, uint32_t target)
{
    VkCommandBuffer cmd = gpu_timer_begin(f, "shade");
    if (d->has_map)
        shade_record_tiles(&d->shade, cmd);
    else
        shade_record(&d->shade, cmd);
    gpu_timer_end(f);
    cmd = gpu_timer_begin(f, "tone map");
    gpu_barrier(cmd, VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT);
    if (d->has_map)
        tonemap_record_tiles(&d->tonemap, cmd, target);
    else
        tonemap_record(&d->tonemap, cmd, target);
    gpu_timer_end(f);
}

const struct gpu_image *deferred_motion(struct deferred *d, struct gpu_frame *f)
{
    if (!d->has_motion)
        return NULL;
    motion_record(&d->motion, gpu_timer_begin(f, "motion vectors"));
    gpu_timer_end(f);
    return &d->motion.image;
}

const struct gpu_image *deferred_show(struct deferred *d, struct gpu_frame *f, uint32_t source, bool history)
{
    if (!d->has_taa)
        return d->colour[source];
    taa_record(&d->taa, gpu_timer_begin(f, "temporal antialiasing"), source, history);
    gpu_timer_end(f);
    return &d->taa.shown;
}
