// `regular`: deferred, full resolution, every pixel: the reference of all studies.
//
// G-buffer, GGX shading in compute, tone mapping with fixed luminance, as the regular renderer of Franke et al.
// 2021, section 8.4; with ambient occlusion and temporal antialiasing where the trial's settings ask for them.

#include "renderer/modes/deferred.h"

#include <stdio.h>
#include <stdlib.h>

enum { EYES_DRAWN };

static const char *const eyes_drawn[] = {[GBUFFER_EYE_BY_EYE] = "separate",
                                         [GBUFFER_MULTIVIEW] = "multiview",
                                         [GBUFFER_INSTANCED] = "instanced",
                                         NULL};

static const struct mode_parameter parameters[] = {
    [EYES_DRAWN] = {"eyes", "",
                    "surfaces drawn eye after eye, or in one pass for both, by multiview or by two instances",
                    0, 2, GBUFFER_EYE_BY_EYE, eyes_drawn},
};

struct mode_state {
    struct gpu *gpu;
    struct deferred deferred;
    struct gpu_image colour;
    bool in_use;
};

static bool supported(const struct gpu *gpu, const double *values, char *why, size_t why_size)
{
    const enum gbuffer_eyes eyes = (enum gbuffer_eyes)values[EYES_DRAWN];
    const char *lack = eyes == GBUFFER_MULTIVIEW && !gpu->multiview      ? "multiview"
                       : eyes == GBUFFER_INSTANCED && !gpu->output_layer ? "shaderOutputLayer"
                                                                         : NULL;
    if (lack)
        snprintf(why, why_size,
                 "regular with eyes=%s needs %s, which %s lacks or gets wrong; eyes=separate runs anywhere",
                 eyes_drawn[eyes], lack, gpu->properties.deviceName);
    return !lack;
}

static void destroy(struct mode_state *state)
{
    if (!state)
        return;
    deferred_finish(&state->deferred);
    gpu_image_destroy(state->gpu, &state->colour);
    free(state);
}

static struct mode_state *create(const struct mode_setup *setup)
{
    struct mode_state *s = calloc(1, sizeof *s);
    if (!s)
        return NULL;
    s->gpu = setup->gpu;
    const struct gpu_image_desc colour = {.name = "colour",
                                          .format = VK_FORMAT_R8G8B8A8_UNORM,
                                          .width = setup->width,
                                          .height = setup->height,
                                          .layers = 2,
                                          .array = true,
                                          .usage =
                                              VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT};
    const struct deferred_desc deferred = {
        .setup = setup, .colour = {&s->colour}, .eyes = (enum gbuffer_eyes)setup->values[EYES_DRAWN]};
    if (!gpu_image_create(s->gpu, &colour, &s->colour) || !deferred_init(&s->deferred, &deferred)) {
        destroy(s);
        return NULL;
    }
    deferred_explain(&s->deferred, setup);
    return s;
}

static bool record(struct mode_state *s, const struct mode_record *record)
{
    struct gpu_frame *f = record->gpu_frame;
    if (!s->in_use)
        gpu_image_layout(f->cmd, &s->colour, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_GENERAL);
    s->in_use = true;
    deferred_geometry(&s->deferred, f, GBUFFER_ALL, 0);
    deferred_occlusion(&s->deferred, f, 0);
    deferred_shade(&s->deferred, f, 0);
    *record->result = (struct mode_result){.colour = deferred_show(&s->deferred, f, 0, record->history),
                                           .motion = deferred_motion(&s->deferred, f)};
    return true;
}

const struct mode mode_regular = {
    .name = "regular",
    .description = "deferred, full resolution, every pixel: the reference",
    .source = "Franke et al. 2021, section 8.4 (the regular renderer)",
    .parameters = parameters,
    .parameter_count = countof(parameters),
    .supported = supported,
    .create = create,
    .record = record,
    .destroy = destroy,
};
