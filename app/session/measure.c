#include "app/session/measure.h"

#include "analysis/image/error.h"
#include "app/session/live.h"

#include <math.h>
#include <stdlib.h>

// An option's history settles within a few frames; early ones are seen too, so both count. At least three come
// from an option that was on screen for six full frames.
enum { FIRST_STEP = 2, FIRST_COUNT = 3, LATER_STEP = 8 };

struct measure {
    uint32_t scene_count, width, height;
    struct image_error_sum *sums; // [condition][scene]
    uint8_t *shown, *wanted;      // one eye's pixels each
    uint32_t trial, attempt;      // of the counts
    struct image_error_sum own;   // of an option with values of its own
    struct mode_choice values;    // these; mode NULL: none
    uint32_t own_trial, own_attempt;
    uint64_t full_frames[2];
};

struct measure *measure_create(uint32_t condition_count, uint32_t scene_count, uint32_t width, uint32_t height)
{
    struct measure *measure = calloc(1, sizeof *measure);
    if (!measure)
        return NULL;
    size_t bytes = (size_t)width * height * 4;
    *measure =
        (struct measure){.scene_count = scene_count, .width = width, .height = height, .trial = UINT32_MAX};
    measure->sums = calloc((size_t)condition_count * scene_count, sizeof *measure->sums);
    measure->shown = malloc(bytes);
    measure->wanted = malloc(bytes);
    if (!measure->sums || !measure->shown || !measure->wanted) {
        measure_destroy(measure);
        return NULL;
    }
    return measure;
}

void measure_destroy(struct measure *measure)
{
    if (!measure)
        return;
    free(measure->sums);
    free(measure->shown);
    free(measure->wanted);
    free(measure);
}

bool measure_at(uint64_t count)
{
    return count <= FIRST_STEP * FIRST_COUNT ? count % FIRST_STEP == 0 : count % LATER_STEP == 0;
}

bool measure_due(struct measure *measure, const struct machine_view *view)
{
    if (view->slot == PLAN_SLOT_NONE || view->fade > 0.0)
        return false;
    if (measure->trial != view->trial_index || measure->attempt != view->attempt) {
        measure->trial = view->trial_index;
        measure->attempt = view->attempt;
        measure->full_frames[0] = measure->full_frames[1] = 0;
    }
    uint64_t count = ++measure->full_frames[view->slot];
    return measure_at(count);
}

static bool add_eye(struct measure *measure, struct image_error_sum *sum, int eye,
                    struct renderer_option *option, struct renderer_option *reference,
                    const struct frame *frame)
{
    if (!renderer_read(option, eye, measure->shown) || !renderer_read(reference, eye, measure->wanted))
        return false;
    const struct frame_eye *seen = &frame->eyes[eye];
    struct image_view view = {.tan_left = seen->fov.tan_left,
                              .tan_right = seen->fov.tan_right,
                              .tan_down = seen->fov.tan_down,
                              .tan_up = seen->fov.tan_up,
                              .gaze_x_deg = seen->gaze_x_deg,
                              .gaze_y_deg = seen->gaze_y_deg};
    struct image_pixels test = {
        .data = measure->shown, .width = measure->width, .height = measure->height, .channels = 4};
    struct image_pixels truth = test;
    truth.data = measure->wanted;
    return image_error_add(sum, &test, &truth, &view);
}

static bool take(struct measure *measure, struct image_error_sum *sum, struct renderer_option *option,
                 struct renderer_option *reference, const struct frame *frame)
{
    struct frame_stats stats;
    if (!renderer_draw(reference, frame, &stats))
        return false;
    for (int eye = 0; eye < EYES; eye++)
        if (!add_eye(measure, sum, eye, option, reference, frame))
            return false;
    return true;
}

bool measure_take(struct measure *measure, uint32_t condition, uint32_t scene, struct renderer_option *option,
                  struct renderer_option *reference, const struct frame *frame)
{
    struct image_error_sum *sum = &measure->sums[(size_t)condition * measure->scene_count + scene];
    return take(measure, sum, option, reference, frame);
}

bool measure_take_own(struct measure *measure, const struct mode_choice *values, struct renderer_option *option,
                      struct renderer_option *reference, const struct frame *frame)
{
    if (!measure->values.mode || !live_same(&measure->values, values) || measure->own_trial != measure->trial ||
        measure->own_attempt != measure->attempt) {
        measure->own = (struct image_error_sum){0};
        measure->values = *values;
        measure->own_trial = measure->trial;
        measure->own_attempt = measure->attempt;
    }
    return take(measure, &measure->own, option, reference, frame);
}

double measure_own_error(const struct measure *measure, const struct machine_view *view)
{
    if (!measure->values.mode || measure->own_trial != view->trial_index ||
        measure->own_attempt != view->attempt)
        return NAN;
    return image_error_result(&measure->own).weighted_rmse / 255.0;
}

double measure_error(const struct measure *measure, uint32_t condition, uint32_t scene)
{
    return image_error_result(&measure->sums[(size_t)condition * measure->scene_count + scene]).weighted_rmse /
           255.0;
}
