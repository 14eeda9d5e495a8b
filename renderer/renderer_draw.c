#include "renderer/renderer_private.h"

#include <math.h>
#include <string.h>
#include <time.h>

const char *renderer_redraw_name(enum frame_redraw redraw)
{
    static const char *const names[FRAME_REDRAW_CAUSES] = {[FRAME_REDRAW_FIRST] = "first",
                                                           [FRAME_REDRAW_CUT] = "cut",
                                                           [FRAME_REDRAW_GAP] = "gap",
                                                           [FRAME_REDRAW_MOTION] = "motion",
                                                           [FRAME_REDRAW_GAZE] = "gaze"};
    return names[redraw];
}

static bool frame_ok(const struct frame *frame)
{
    for (int eye = 0; eye < EYES; eye++) {
        const struct frame_eye *e = &frame->eyes[eye];
        const struct dvec3 p = e->pose.position;
        const struct dquat q = e->pose.orientation;
        if (!viewing_fov_ok(&e->fov) || !isfinite(p.x + p.y + p.z) || !isfinite(q.x + q.y + q.z + q.w) ||
            fabs(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w - 1) > 1e-6)
            return false;
    }
    return isfinite(frame->animation_s);
}

static double now_ms(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec * 1e3 + (double)t.tv_nsec * 1e-6;
}

static enum frame_redraw redraw_of(const struct renderer_option *o, const struct frame *frame)
{
    if (!o->drawn)
        return FRAME_REDRAW_FIRST;
    if (frame->cut)
        return FRAME_REDRAW_CUT;
    if (frame->number != o->last_number + 1)
        return FRAME_REDRAW_GAP;
    if (frame->moving != o->last_moving)
        return FRAME_REDRAW_MOTION;
    return frame->gaze_returned ? FRAME_REDRAW_GAZE : FRAME_REDRAW_NONE;
}

static void fill_stats(const struct renderer_option *o, enum frame_redraw redraw, double cpu_ms,
                       struct frame_stats *out)
{
    const struct gpu_frame *f = &o->renderer->frame;
    const struct shared_counters *c = o->counters.mapped;
    *out = (struct frame_stats){
        .shaded_px = o->result.counts_shaded ? c->shaded_px : 2ull * o->renderer->width * o->renderer->height,
        .triangles = c->triangles,
        .submodels = c->submodels,
        .gpu_ms = f->gpu_ms,
        .cpu_ms = cpu_ms,
        .frustum_triangles = c->frustum_triangles ? c->frustum_triangles : c->triangles,
        .frustum_submodels = c->frustum_submodels ? c->frustum_submodels : c->submodels,
        .moving_px = c->moving_px,
        .redraw = o->result.redraw_map ? redraw : FRAME_REDRAW_NONE,
        .timer_count = f->timer_count};
    for (uint32_t i = 0; i < f->timer_count && i < FRAME_TIMERS; i++) {
        out->timers[i].name = f->timers[i].name;
        out->timers[i].ms = f->timers[i].ms;
    }
}

bool renderer_draw(struct renderer_option *o, const struct frame *frame, struct frame_stats *out_stats)
{
    struct renderer *r = o->renderer;
    if (!frame_ok(frame)) {
        renderer_relay(r, RENDERER_ERROR, "a frame's pose or field of view is not a finite, proper one");
        return false;
    }
    const double start = now_ms();
    const enum frame_redraw redraw = redraw_of(o, frame);
    const bool history = redraw == FRAME_REDRAW_NONE;
    if (!gpu_frame_begin(&r->frame))
        return false;
    scene_gpu_update(o->scene->gpu, r->frame.cmd, frame->eyes[EYE_LEFT].pose.position, frame->animation_s,
                     history ? o->last_animation_s : frame->animation_s);
    renderer_fill_constants(o, frame);
    memset(o->counters.mapped, 0, sizeof(struct shared_counters));
    const struct mode_record record = {.gpu_frame = &r->frame,
                                       .number = frame->number,
                                       .history = history,
                                       .moving = frame->moving,
                                       .result = &o->result};
    if (!o->mode->record(o->state, &record))
        return false;
    const double recorded = now_ms();
    if (!gpu_frame_end(&r->frame))
        return false;
    o->drawn = true;
    o->last_number = frame->number;
    o->last_animation_s = frame->animation_s;
    o->last_moving = frame->moving;
    memcpy(o->last_eyes, frame->eyes, sizeof o->last_eyes);
    o->last_origin = o->scene->gpu->origin;
    if (out_stats)
        fill_stats(o, redraw, recorded - start, out_stats);
    return true;
}
