#include "app/session/measure.h"

#include "analysis/image/error.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// An option's history settles within a few frames; early ones are seen too, so both count. At least three come
// from an option that was on screen for six full frames.
enum { FIRST_STEP = 2, FIRST_COUNT = 3, LATER_STEP = 8 };

struct cell {
    struct measure_key key;
    struct image_error_sum sum;
    bool changed;
};

struct measure {
    uint32_t width, height;
    struct cell *cells; // owned
    size_t count, capacity;
    uint8_t *shown, *wanted; // one eye's pixels each
    uint32_t trial, attempt; // of the counts
    int64_t conditions[2];   // that they count
    uint64_t full_frames[2];
};

void measure_metric(const struct protocol *protocol, const struct protocol_settings *settings,
                    char out[MEASURE_METRIC])
{
    const struct catalogue *catalogue = protocol->catalogue;
    int used = snprintf(out, MEASURE_METRIC, "wrmse");
    for (uint32_t i = 0; i < catalogue->setting_count; i++) {
        const struct catalogue_parameter *setting = &catalogue->settings[i];
        double value = settings->render[i];
        if (value == setting->fallback || used < 0 || used >= MEASURE_METRIC)
            continue;
        size_t left = (size_t)(MEASURE_METRIC - used);
        used += setting->choices
                    ? snprintf(out + used, left, ";%s=%s", setting->name, setting->choices[(size_t)value])
                    : snprintf(out + used, left, ";%s=%.9g", setting->name, value);
    }
}

struct measure *measure_create(uint32_t width, uint32_t height)
{
    struct measure *measure = calloc(1, sizeof *measure);
    if (!measure)
        return NULL;
    size_t bytes = (size_t)width * height * 4;
    *measure = (struct measure){.width = width, .height = height, .trial = UINT32_MAX};
    measure->shown = malloc(bytes);
    measure->wanted = malloc(bytes);
    if (!measure->shown || !measure->wanted) {
        measure_destroy(measure);
        return NULL;
    }
    return measure;
}

void measure_destroy(struct measure *measure)
{
    if (!measure)
        return;
    free(measure->cells);
    free(measure->shown);
    free(measure->wanted);
    free(measure);
}

static struct cell *find(const struct measure *measure, const struct measure_key *key)
{
    for (size_t i = 0; i < measure->count; i++) {
        struct cell *cell = &measure->cells[i];
        if (cell->key.condition_id == key->condition_id && cell->key.scene == key->scene &&
            strcmp(cell->key.metric, key->metric) == 0)
            return cell;
    }
    return NULL;
}

static struct cell *find_or_add(struct measure *measure, const struct measure_key *key)
{
    struct cell *cell = find(measure, key);
    if (cell)
        return cell;
    if (measure->count == measure->capacity) {
        size_t capacity = measure->capacity ? 2 * measure->capacity : 64;
        struct cell *cells = realloc(measure->cells, capacity * sizeof *cells);
        if (!cells)
            return NULL;
        measure->cells = cells;
        measure->capacity = capacity;
    }
    cell = &measure->cells[measure->count++];
    *cell = (struct cell){.key = *key};
    return cell;
}

bool measure_at(uint64_t count)
{
    return count <= FIRST_STEP * FIRST_COUNT ? count % FIRST_STEP == 0 : count % LATER_STEP == 0;
}

bool measure_due(struct measure *measure, const struct machine_view *view, int64_t condition_id)
{
    if (view->slot == PLAN_SLOT_NONE || view->fade > 0.0)
        return false;
    if (view->trial_index != measure->trial || view->attempt != measure->attempt) {
        measure->trial = view->trial_index;
        measure->attempt = view->attempt;
        measure->full_frames[0] = measure->full_frames[1] = 0;
    }
    if (measure->conditions[view->slot] != condition_id) {
        measure->conditions[view->slot] = condition_id; // an adjusted value begins anew
        measure->full_frames[view->slot] = 0;
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

bool measure_take(struct measure *measure, const struct measure_key *key, struct renderer_option *option,
                  struct renderer_option *reference, const struct frame *frame)
{
    struct frame_stats stats;
    struct cell *cell = find_or_add(measure, key);
    if (!cell || !renderer_draw(reference, frame, &stats))
        return false;
    for (int eye = 0; eye < EYES; eye++)
        if (!add_eye(measure, &cell->sum, eye, option, reference, frame))
            return false;
    cell->changed = true;
    return true;
}

static double cell_error(const struct cell *cell)
{
    return image_error_result(&cell->sum).weighted_rmse / 255.0;
}

double measure_error(const struct measure *measure, const struct measure_key *key)
{
    const struct cell *cell = find(measure, key);
    return cell ? cell_error(cell) : (double)NAN;
}

bool measure_next_changed(struct measure *measure, struct measure_key *out_key, double *out_error)
{
    for (size_t i = 0; i < measure->count; i++) {
        struct cell *cell = &measure->cells[i];
        if (!cell->changed)
            continue;
        cell->changed = false;
        *out_key = cell->key;
        *out_error = cell_error(cell);
        return true;
    }
    return false;
}

void measure_not_stored(struct measure *measure, const struct measure_key *key)
{
    struct cell *cell = find(measure, key);
    if (cell)
        cell->changed = true;
}
