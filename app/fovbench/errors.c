#include "app/fovbench/errors.h"

#include "analysis/image/error.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

struct errors {
    struct lineup *lineup; // borrowed
    uint32_t width, height;
    uint64_t every, frames;
    uint8_t *truth, *shown; // owned, one eye's pixels each
    struct image_error_sum sums[REQUEST_MODES];
};

struct errors *errors_create(const struct errors_desc *desc)
{
    struct errors *errors = calloc(1, sizeof *errors);
    const size_t bytes = 4 * (size_t)desc->width * desc->height;
    if (errors) {
        errors->lineup = desc->lineup;
        errors->width = desc->width;
        errors->height = desc->height;
        errors->every = desc->every;
        errors->truth = malloc(bytes);
        errors->shown = malloc(bytes);
    }
    if (errors && errors->truth && errors->shown)
        return errors;
    fprintf(stderr, "fovbench: out of memory\n");
    errors_destroy(errors);
    return NULL;
}

void errors_destroy(struct errors *errors)
{
    if (!errors)
        return;
    free(errors->truth);
    free(errors->shown);
    free(errors);
}

bool errors_due(const struct errors *errors, uint64_t n)
{
    return n % errors->every + 2 >= errors->every;
}

static bool is_second(const struct errors *errors, uint64_t n)
{
    return n % errors->every + 1 == errors->every;
}

static bool take_eye(struct errors *errors, const struct frame_eye *eye, int index)
{
    const struct image_view view = {eye->fov.tan_left, eye->fov.tan_right, eye->fov.tan_down,
                                    eye->fov.tan_up,   eye->gaze_x_deg,    eye->gaze_y_deg};
    const struct image_pixels truth = {errors->truth, errors->width, errors->height, 4, 0};
    const struct image_pixels shown = {errors->shown, errors->width, errors->height, 4, 0};
    if (!renderer_read(errors->lineup->options[0], index, errors->truth))
        return false;
    for (size_t mode = 0; mode < errors->lineup->count; mode++) {
        if (!renderer_read(errors->lineup->options[mode], index, errors->shown))
            return false;
        image_error_add(&errors->sums[mode], &shown, &truth, &view);
    }
    return true;
}

bool errors_take(struct errors *errors, const struct frame *frame, uint64_t n)
{
    if (!is_second(errors, n))
        return true;
    for (int eye = 0; eye < EYES; eye++)
        if (!take_eye(errors, &frame->eyes[eye], eye))
            return false;
    errors->frames++;
    return true;
}

uint64_t errors_frames(const struct errors *errors)
{
    return errors->frames;
}

void errors_result(const struct errors *errors, size_t mode, struct row_error *out,
                   struct row_error out_rings[ROW_RINGS])
{
    const struct image_error error = image_error_result(&errors->sums[mode]);
    const double none = (double)NAN;
    *out = (struct row_error){error.psnr_db, none, none, error.weighted_psnr_db, none};
    for (int i = 0; i < ROW_RINGS; i++)
        out_rings[i] = (struct row_error){none, none, none, none, none};
}
