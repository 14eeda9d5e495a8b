#include "app/fovbench/errors.h"

#include "analysis/image/flicker_excess.h"
#include "app/fovbench/measures.h"
#include "app/fovbench/motion.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

struct mode_errors {
    struct measures measures, supersampled;
    struct image_flicker_excess *flicker[EYES]; // owned
    struct image_ring_sum excess;
};

struct errors {
    struct errors_desc desc;
    struct motion *motion; // owned, as all below
    struct measures_tools tools;
    uint8_t *truth, *shown; // one eye's pixels each
    uint64_t compared, supersampled;
    struct mode_errors modes[REQUEST_MODES];
};

static bool create_flicker(struct errors *errors)
{
    for (size_t mode = 0; mode < errors->desc.lineup->count; mode++)
        for (int eye = 0; eye < EYES; eye++)
            if (!(errors->modes[mode].flicker[eye] = image_flicker_excess_create()))
                return false;
    return true;
}

struct errors *errors_create(const struct errors_desc *desc)
{
    struct errors *errors = calloc(1, sizeof *errors);
    const size_t bytes = 4 * (size_t)desc->width * desc->height;
    bool ok = false;
    if (errors) {
        errors->desc = *desc;
        errors->truth = malloc(bytes);
        errors->shown = malloc(bytes);
        ok = errors->truth && errors->shown &&
             measures_tools_init(&errors->tools, desc->eye, desc->width, desc->height) &&
             create_flicker(errors);
    }
    if (!ok)
        fprintf(stderr, "fovbench: out of memory\n");
    else if ((errors->motion = motion_create(desc->lineup->renderer, desc->lineup->scene, desc->reference,
                                             desc->width, desc->height)))
        return errors;
    errors_destroy(errors);
    return NULL;
}

void errors_destroy(struct errors *errors)
{
    if (!errors)
        return;
    for (size_t mode = 0; mode < REQUEST_MODES; mode++)
        for (int eye = 0; eye < EYES; eye++)
            image_flicker_excess_destroy(errors->modes[mode].flicker[eye]);
    measures_tools_finish(&errors->tools);
    motion_destroy(errors->motion);
    free(errors->truth);
    free(errors->shown);
    free(errors);
}

static bool is_second(const struct errors *errors, uint64_t n)
{
    return n % errors->desc.every + 1 == errors->desc.every;
}

bool errors_due(const struct errors *errors, uint64_t n)
{
    return n < errors->desc.frames && (is_second(errors, n) || is_second(errors, n + 1));
}

// Of all compared frames the wanted number, evenly spread.
static bool supersample_due(const struct errors *errors)
{
    const uint64_t all = errors->desc.frames / errors->desc.every, wanted = errors->desc.supersampled_frames;
    return errors->desc.supersample && all &&
           (errors->compared + 1) * wanted / all != errors->compared * wanted / all;
}

static struct image_pixels pixels_of(const struct errors *errors, const uint8_t *data)
{
    return (struct image_pixels){data, errors->desc.width, errors->desc.height, 4, 0};
}

static bool take_mode(struct errors *errors, size_t mode, int eye, bool second, const uint8_t *supersampled)
{
    struct mode_errors *m = &errors->modes[mode];
    const struct image_pixels truth = pixels_of(errors, errors->truth),
                              shown = pixels_of(errors, errors->shown);
    if (!second)
        image_flicker_excess_cut(m->flicker[eye]);
    if (!image_flicker_excess_add(m->flicker[eye], &shown, &truth, motion_of(errors->motion, eye),
                                  errors->tools.rings[eye], &m->excess))
        return false;
    if (!second)
        return true;
    const struct image_pixels finer = pixels_of(errors, supersampled);
    return measures_add(&m->measures, &errors->tools, eye, &shown, &truth) &&
           (!supersampled || measures_add(&m->supersampled, &errors->tools, eye, &shown, &finer));
}

static bool take_eye(struct errors *errors, int eye, bool second, bool finer)
{
    struct lineup *lineup = errors->desc.lineup;
    const uint8_t *supersampled = NULL;
    if (!renderer_read(lineup->options[0], eye, errors->truth))
        return false;
    if (finer && !(supersampled = supersample_read(errors->desc.supersample, eye)))
        return false;
    for (size_t mode = 0; mode < lineup->count; mode++) {
        if (!renderer_read(lineup->options[mode], eye, errors->shown))
            return false;
        if (!take_mode(errors, mode, eye, second, supersampled)) {
            fprintf(stderr, "fovbench: pictures of %ux%u cannot be compared: too small, or out of memory\n",
                    errors->desc.width, errors->desc.height);
            return false;
        }
    }
    return true;
}

bool errors_take(struct errors *errors, const struct frame *frame, uint64_t n, double *out_moving_share)
{
    const bool second = is_second(errors, n), finer = second && supersample_due(errors);
    *out_moving_share = (double)NAN;
    if (!motion_draw(errors->motion, frame) || (finer && !supersample_draw(errors->desc.supersample, frame)) ||
        !measures_tools_look(&errors->tools, frame, errors->desc.width, errors->desc.height))
        return false;
    for (int eye = 0; eye < EYES; eye++)
        if (!take_eye(errors, eye, second, finer))
            return false;
    if (second)
        *out_moving_share = motion_share(errors->motion);
    errors->compared += second;
    errors->supersampled += finer;
    return true;
}

void errors_result(const struct errors *errors, size_t mode, struct row *row)
{
    const struct mode_errors *m = &errors->modes[mode];
    row->error_frames = errors->compared;
    row->error = measures_result(&m->measures, IMAGE_WHOLE);
    row->error.flicker_excess = image_ring_mean(&m->excess, IMAGE_WHOLE);
    for (int i = 0; i < ROW_RINGS; i++) {
        row->rings[i] = measures_result(&m->measures, i);
        row->rings[i].flicker_excess = image_ring_mean(&m->excess, i);
    }
    if (errors->supersampled) {
        row->supersampled_factor = supersample_factor(errors->desc.supersample);
        row->supersampled_frames = errors->supersampled;
        row->supersampled = measures_result(&m->supersampled, IMAGE_WHOLE);
    }
}
