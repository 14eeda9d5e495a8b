#include "app/fovbench/measures.h"

#include <math.h>

// flip.h: the pixels per degree that it takes.
#define FLIP_LEAST 1.0
#define FLIP_MOST 240.0

_Static_assert((int)IMAGE_RINGS == (int)ROW_RINGS, "a row has a place for each ring");

struct image_view measures_view(const struct frame_eye *eye)
{
    return (struct image_view){eye->fov.tan_left, eye->fov.tan_right, eye->fov.tan_down,
                               eye->fov.tan_up,   eye->gaze_x_deg,    eye->gaze_y_deg};
}

bool measures_tools_init(struct measures_tools *tools, const struct frame_eye *eye, uint32_t width,
                         uint32_t height)
{
    const struct image_view view = measures_view(eye);
    const double ppd = image_pixels_per_degree(&view, width, height);
    const bool has_flip = ppd >= FLIP_LEAST && ppd <= FLIP_MOST;
    *tools = (struct measures_tools){{image_rings_create(), image_rings_create()},
                                     image_ssim_create(),
                                     has_flip ? image_flip_create(ppd) : NULL};
    if (tools->rings[EYE_LEFT] && tools->rings[EYE_RIGHT] && tools->ssim && (tools->flip || !has_flip))
        return true;
    measures_tools_finish(tools);
    return false;
}

void measures_tools_finish(struct measures_tools *tools)
{
    for (int eye = 0; eye < EYES; eye++)
        image_rings_destroy(tools->rings[eye]);
    image_ssim_destroy(tools->ssim);
    image_flip_destroy(tools->flip);
    *tools = (struct measures_tools){0};
}

bool measures_tools_look(struct measures_tools *tools, const struct frame *frame, uint32_t width,
                         uint32_t height)
{
    for (int eye = 0; eye < EYES; eye++) {
        const struct image_view view = measures_view(&frame->eyes[eye]);
        if (!image_rings_set(tools->rings[eye], width, height, &view))
            return false;
    }
    return true;
}

bool measures_add(struct measures *m, struct measures_tools *tools, int eye, const struct image_pixels *test,
                  const struct image_pixels *truth)
{
    const struct image_rings *rings = tools->rings[eye];
    return image_error_rings_add(&m->error, test, truth, rings) &&
           image_ssim_add(tools->ssim, test, truth, rings, &m->ssim) &&
           (!tools->flip || image_flip_add(tools->flip, test, truth, rings, &m->flip, NULL));
}

struct row_error measures_result(const struct measures *m, int region)
{
    const struct image_error error = image_error_result(&m->error.region[region]);
    return (struct row_error){.psnr_db = error.psnr_db,
                              .wpsnr_db = error.weighted_psnr_db,
                              .ssim = image_ring_mean(&m->ssim, region),
                              .flip = image_ring_mean(&m->flip, region),
                              .flicker_excess = (double)NAN};
}
