// `regular`: deferred, full resolution, every pixel: the reference of all studies.
//
// G-buffer, GGX shading in compute, tone mapping with fixed luminance, as the regular renderer of Franke et al.
// 2021, section 8.4; with ambient occlusion and temporal antialiasing where the trial's settings ask for them.

#include "renderer/modes/deferred.h"

#include <stdlib.h>

struct mode_state {
    struct gpu *gpu;
    struct deferred deferred;
    struct gpu_image colour;
    bool in_use;
};

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
    const struct deferred_desc deferred = {.setup = setup, .colour = {&s->colour}};
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
    .create = create,
    .record = record,
    .destroy = destroy,
};
