// `vrs`: every pixel shaded around the gaze, one of each 2x2 or 4x4 block farther out.
//
// Patney et al., "Towards Foveated Rendering for Gaze-Tracked Virtual Reality", SIGGRAPH Asia 2016, as the
// rival of Franke et al. 2021, section 8.4: 1x1 inside 10 degrees of eccentricity, 2x2 to 20, 4x4 beyond. A
// block's leader is shaded whole and its colour goes to the block, so that textures become coarser with the
// light, as in hardware.
//
// path=compute (shade/choose.comp) runs anywhere over the full G-buffer. path=hardware shades forward with
// VK_KHR_fragment_shading_rate. We differ from the paper in this:
// - none of Patney's prefiltering and contrast enhancement, as in Franke's comparison;
// - hardware: depths come first, at full rate and with the alpha test, which the paper's forward renderer left
// out:
//   coarse fragments cannot test alpha pixel by pixel;
// - hardware: rings are cut at the map's texels, 8 or more pixels a side.

#include "renderer/modes/vrs/forward.h"

#include <stdio.h>
#include <stdlib.h>

enum { INNER_DEG, OUTER_DEG, PATH };
enum { COMPUTE, HARDWARE };

static const char *const paths[] = {"compute", "hardware", NULL};

static const struct mode_parameter parameters[] = {
    [INNER_DEG] = {"inner_deg", "deg", "eccentricity within which every pixel is shaded", 0, 180, 10, NULL},
    [OUTER_DEG] = {"outer_deg", "deg",
                   "eccentricity within which one of each 2x2 block is; beyond, of each 4x4", 0, 180, 20, NULL},
    [PATH] = {"path", "", "coarse shading in a compute kernel, or by the device's own shading rates", 0, 1,
              COMPUTE, paths},
};

struct mode_state {
    struct gpu *gpu;
    bool hardware;
    struct deferred deferred;
    struct forward forward; // hardware only
    struct tonemap tonemap; // hardware only
    struct gpu_image colour;
    bool in_use;
};

static bool supported(const struct gpu *gpu, const double *values, char *why, size_t why_size)
{
    if ((int)values[PATH] == COMPUTE || gpu->shading_rate.texel)
        return true;
    snprintf(why, why_size,
             "vrs with path=hardware needs a map of shading rates (VK_KHR_fragment_shading_rate, "
             "attachmentFragmentShadingRate), which %s lacks; path=compute runs anywhere",
             gpu->properties.deviceName);
    return false;
}

static bool agree(const double *values, char *why, size_t why_size)
{
    if (values[OUTER_DEG] >= values[INNER_DEG])
        return true;
    snprintf(why, why_size, "outer_deg of mode 'vrs' is %g; it must be at least inner_deg, %g",
             values[OUTER_DEG], values[INNER_DEG]);
    return false;
}

static void destroy(struct mode_state *s)
{
    if (!s)
        return;
    tonemap_finish(&s->tonemap);
    forward_finish(&s->forward);
    deferred_finish(&s->deferred);
    gpu_image_destroy(s->gpu, &s->colour);
    free(s);
}

static bool create_hardware(struct mode_state *s, const struct mode_setup *setup, float inner_deg,
                            float outer_deg)
{
    const struct deferred_desc deferred = {
        .setup = setup, .colour = {&s->colour}, .depth_only = true, .own_shade = true};
    if (!deferred_init(&s->deferred, &deferred) ||
        !forward_init(&s->forward, setup, &s->deferred, inner_deg, outer_deg))
        return false;
    const struct tonemap_desc tonemap = {.gpu = s->gpu,
                                         .frame = setup->frame,
                                         .width = setup->width,
                                         .height = setup->height,
                                         .hdr = s->forward.hdr.view,
                                         .targets = {s->colour.view}};
    return tonemap_init(&s->tonemap, &tonemap);
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
    const struct shade_blocks blocks = {.counters = setup->counters,
                                        .inner_deg = (float)setup->values[INNER_DEG],
                                        .outer_deg = (float)setup->values[OUTER_DEG]};
    if (!gpu_image_create(s->gpu, &colour, &s->colour))
        return false;
    if (s->hardware)
        return create_hardware(s, setup, blocks.inner_deg, blocks.outer_deg);
    const struct deferred_desc deferred = {.setup = setup, .colour = {&s->colour}, .blocks = &blocks};
    return deferred_init(&s->deferred, &deferred);
}

static void explain_hardware(const struct mode_state *s, struct mode_explanation *e)
{
    const struct gpu_shading_rate *rate = &s->gpu->shading_rate;
    mode_explain(e, s->forward.rates.bytes, "shading rates, a texel for %ux%u pixels; %s", rate->texel,
                 rate->texel,
                 rate->largest == 4 ? "4x4 beyond outer_deg"
                                    : "2x2 beyond outer_deg too, because the device has no 4x4");
    mode_explain(e, s->forward.hdr.bytes, "shaded colour, linear HDR, forward");
}

static struct mode_state *create(const struct mode_setup *setup)
{
    struct mode_state *s = calloc(1, sizeof *s);
    if (!s)
        return NULL;
    s->gpu = setup->gpu;
    s->hardware = (int)setup->values[PATH] == HARDWARE;
    if (!create_passes(s, setup)) {
        destroy(s);
        return NULL;
    }
    deferred_explain(&s->deferred, setup);
    if (s->hardware)
        explain_hardware(s, setup->explanation);
    return s;
}

static bool set(struct mode_state *s, const double *values)
{
    s->deferred.shade.inner_deg = s->forward.inner_deg = (float)values[INNER_DEG];
    s->deferred.shade.outer_deg = s->forward.outer_deg = (float)values[OUTER_DEG];
    return true;
}

static void shade_forward(struct mode_state *s, struct gpu_frame *f)
{
    forward_rates(&s->forward, gpu_timer_begin(f, "shading rates"));
    gpu_timer_end(f);
    forward_record(&s->forward, gpu_timer_begin(f, "shade"), &s->deferred);
    gpu_timer_end(f);
    tonemap_record(&s->tonemap, gpu_timer_begin(f, "tone map"), 0);
    gpu_timer_end(f);
}

static bool record(struct mode_state *s, const struct mode_record *record)
{
    struct gpu_frame *f = record->gpu_frame;
    if (!s->in_use)
        gpu_image_layout(f->cmd, &s->colour, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_GENERAL);
    s->in_use = true;
    deferred_geometry(&s->deferred, f, GBUFFER_ALL, 0);
    deferred_occlusion(&s->deferred, f, 0);
    if (s->hardware)
        shade_forward(s, f);
    else
        deferred_shade(&s->deferred, f, 0);
    *record->result = (struct mode_result){.colour = deferred_show(&s->deferred, f, 0, record->history),
                                           .motion = deferred_motion(&s->deferred, f),
                                           .counts_shaded = true};
    return true;
}

const struct mode mode_vrs = {
    .name = "vrs",
    .description = "variable rate shading: coarser blocks with growing eccentricity",
    .source = "Patney et al. 2016, Towards Foveated Rendering for Gaze-Tracked Virtual Reality",
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
