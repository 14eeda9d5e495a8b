#include "app/fovbench/still.h"

#include "analysis/image/flicker_still.h"
#include "app/fovbench/measures.h"
#include "app/fovbench/progress.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

// The modes measured at once; the reference is not among them.
struct batch {
    size_t first, count;
    struct image_flicker_still *flicker[REQUEST_MODES][EYES]; // owned
    struct image_flicker_still_sum sums[REQUEST_MODES];
};

struct stage {
    struct lineup *lineup;
    const struct scene *scene;
    struct walk walk;
    uint64_t frames;
    const char *progress_name;
    struct image_rings *rings[EYES]; // owned
    uint8_t *truth, *shown;          // owned
};

static bool take_eye(struct stage *s, struct batch *batch, int eye)
{
    const struct image_pixels truth = {s->truth, s->walk.width, s->walk.height, 4, 0};
    const struct image_pixels shown = {s->shown, s->walk.width, s->walk.height, 4, 0};
    if (!renderer_read(s->lineup->options[0], eye, s->truth))
        return false;
    for (size_t i = 0; i < batch->count; i++)
        if (!renderer_read(s->lineup->options[batch->first + i], eye, s->shown) ||
            !image_flicker_still_add(batch->flicker[i][eye], &shown, &truth, s->rings[eye], &batch->sums[i]))
            return false;
    return true;
}

static bool draw(struct stage *s, const struct batch *batch, const struct frame *frame)
{
    if (!renderer_draw(s->lineup->options[0], frame, NULL))
        return false;
    for (size_t i = 0; i < batch->count; i++)
        if (!renderer_draw(s->lineup->options[batch->first + i], frame, NULL))
            return false;
    return true;
}

// Frames are numbered from where no frame of the walk was, so that every mode begins anew; the gaze stays where
// the walk's first frame has it.
static bool run(struct stage *s, struct batch *batch)
{
    enum { FAR_NUMBER = 1 << 30 };
    const uint64_t all = REQUEST_WARM_UP + s->frames;
    struct frame frame;
    walk_frame(&s->walk, s->scene, 0, &frame);
    for (uint64_t n = 0; n < all; n++) {
        progress_show(s->progress_name, "still frame", n, all);
        frame.number = (uint64_t)FAR_NUMBER * (batch->first + 1) + n;
        if (!draw(s, batch, &frame))
            return false;
        for (int eye = 0; n >= REQUEST_WARM_UP && eye < EYES; eye++)
            if (!take_eye(s, batch, eye))
                return false;
    }
    return true;
}

static bool measure_batch(struct stage *s, struct batch *batch, double *out_flicker)
{
    bool ok = true;
    for (size_t i = 0; i < batch->count; i++)
        for (int eye = 0; eye < EYES; eye++)
            ok = ok && (batch->flicker[i][eye] =
                            image_flicker_still_create((uint32_t)s->frames, WALK_FRAMES_PER_S)) != NULL;
    if (!ok)
        fprintf(stderr, "fovbench: out of memory\n");
    ok = ok && run(s, batch);
    for (size_t i = 0; i < batch->count; i++) {
        out_flicker[batch->first + i] = 255 * image_ring_mean(&batch->sums[i].weighted, IMAGE_WHOLE);
        for (int eye = 0; eye < EYES; eye++)
            image_flicker_still_destroy(batch->flicker[i][eye]);
    }
    return ok;
}

static bool stage_init(struct stage *s)
{
    const size_t bytes = 4 * (size_t)s->walk.width * s->walk.height;
    struct frame frame;
    s->truth = malloc(bytes);
    s->shown = malloc(bytes);
    walk_frame(&s->walk, s->scene, 0, &frame);
    bool ok = s->truth && s->shown;
    for (int eye = 0; eye < EYES; eye++) {
        s->rings[eye] = image_rings_create();
        const struct image_view view = measures_view(&frame.eyes[eye]);
        ok = ok && s->rings[eye] && image_rings_set(s->rings[eye], s->walk.width, s->walk.height, &view);
    }
    if (!ok)
        fprintf(stderr, "fovbench: out of memory\n");
    return ok;
}

bool still_measure(struct lineup *lineup, const struct walk *walk, const struct scene *scene, uint64_t frames,
                   const char *progress_name, double *out_flicker)
{
    struct stage stage = {
        .lineup = lineup, .scene = scene, .walk = *walk, .frames = frames, .progress_name = progress_name};
    const double bytes = 2.0 * 4 * (double)frames * walk->width * walk->height; // of one mode, flicker_still.h
    const size_t most = bytes < STILL_BYTES ? (size_t)(STILL_BYTES / bytes) : 1;
    stage.walk.still = stage.walk.rest = true;
    bool ok = stage_init(&stage);
    out_flicker[0] = 0; // against itself
    for (size_t first = 1; ok && first < lineup->count; first += most) {
        struct batch batch = {.first = first,
                              .count = lineup->count - first < most ? lineup->count - first : most};
        ok = measure_batch(&stage, &batch, out_flicker);
    }
    for (int eye = 0; eye < EYES; eye++)
        image_rings_destroy(stage.rings[eye]);
    free(stage.truth);
    free(stage.shown);
    return ok;
}
