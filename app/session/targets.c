#include "app/session/targets.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#define NS 1e-9

// The green of Weier's sphere, and white for the cross: with its dark edges it is seen on every ground.
static const float green[3] = {0.15f, 0.88f, 0.20f}, white[3] = {0.95f, 0.95f, 0.95f};

// Whether time ends the showing; else somebody does.
static bool is_timed(const struct plan_trial *trial)
{
    return trial->resolved->view_ns > 0 &&
           (trial->kind == PROTOCOL_SEQUENTIAL || !protocol_kind_is_pair(trial->kind));
}

static struct fixation_flight flight_of(const struct plan_trial *trial, const struct camera_path *path)
{
    const struct protocol_settings *settings = trial->resolved;
    bool timed = is_timed(trial);
    return (struct fixation_flight){
        .path = path,
        .start_s = (double)settings->path_start_ns * NS,
        .still = settings->camera == PROTOCOL_CAMERA_STILL,
        .view_s = timed ? (double)settings->view_ns * NS : 0.0,
        .begin_s = timed ? (double)settings->fade_from_gray_ns * NS : 0.0,
    };
}

struct pose targets_head(const struct plan_trial *trial, const struct camera_path *path, double time_s)
{
    const struct fixation_flight flight = flight_of(trial, path);
    return fixation_head(&flight, time_s);
}

static bool place_spheres(struct targets *targets, const struct targets_desc *desc,
                          const struct fixation_flight *flight, uint32_t showing)
{
    const struct protocol_settings *settings = desc->trial->resolved;
    const double fade_s = flight->begin_s + (double)settings->fade_to_gray_ns * NS;
    return spheres_place(&targets->spheres[showing],
                         &(struct spheres_desc){
                             .rays = desc->rays,
                             .path = desc->path,
                             .start_s = flight->start_s,
                             .length_s = flight->view_s > 0.0 ? flight->view_s + fade_s : 0.0,
                             .begin_s = flight->begin_s,
                             .still = flight->still,
                             .fov = desc->fov,
                             .ipd_m = desc->ipd_m,
                             .seed = 2 * desc->trial->seed + showing,
                             .count = desc->trial->spheres[showing],
                         });
}

bool targets_needed(const struct plan_trial *trial)
{
    return trial->resolved->fixation != PROTOCOL_FIXATION_FREE || trial->kind == PROTOCOL_SEQUENTIAL ||
           trial->spheres[0] + trial->spheres[1] > 0;
}

bool targets_prepare(struct targets *targets, const struct targets_desc *desc)
{
    static const enum fixation_kind kinds[] = {[PROTOCOL_FIXATION_FREE] = FIXATION_CROSS,
                                               [PROTOCOL_FIXATION_CROSS] = FIXATION_CROSS,
                                               [PROTOCOL_FIXATION_MOVING] = FIXATION_MOVING};
    const struct plan_trial *trial = desc->trial;
    const struct fixation_flight flight = flight_of(trial, desc->path);
    *targets = (struct targets){.fixates = trial->resolved->fixation != PROTOCOL_FIXATION_FREE};
    fixation_target_init(&targets->fixation, kinds[trial->resolved->fixation], &flight, trial->target_seed);
    bool done = true;
    if (targets->fixates || trial->kind == PROTOCOL_SEQUENTIAL)
        done = fixation_target_measure(&targets->fixation, desc->rays);
    for (uint32_t showing = 0; showing < 2; showing++)
        done = done && place_spheres(targets, desc, &flight, showing);
    if (!done)
        targets_finish(targets);
    return done;
}

void targets_finish(struct targets *targets)
{
    fixation_target_finish(&targets->fixation);
    for (uint32_t showing = 0; showing < 2; showing++)
        spheres_finish(&targets->spheres[showing]);
    *targets = (struct targets){0};
}

bool targets_fixation(const struct targets *targets, const struct machine_view *view,
                      struct fixation_place *out)
{
    if (!targets->fixates || view->screen != MACHINE_STIMULUS || view->slot == PLAN_SLOT_NONE)
        return false;
    *out = fixation_target_at(&targets->fixation, (double)view->stimulus_ns * NS);
    return true;
}

// A ball or cross of an angular radius around a point in the head's frame, seen by both eyes.
static void place(const struct targets_view *eyes, struct dvec3 point, double radius_deg, double radius_m,
                  struct renderer_mark *mark)
{
    const struct pose head = {.orientation = {0, 0, 0, 1}};
    for (int eye = 0; eye < EYES; eye++) {
        const struct dvec3 d = dvec3_sub(point, viewing_eye_pose(&head, eye, eyes->ipd_m).position);
        if (radius_m > 0.0)
            radius_deg = 57.29577951308232 * asin(fmin(radius_m / dvec3_length(d), 1.0));
        if (!viewing_disc(&eyes->fov, eyes->width, eyes->height, d, radius_deg, &mark->place[eye]))
            mark->opacity[eye] = 0.0;
    }
}

static struct renderer_mark fixation_mark(const struct targets_view *eyes, bool ball, struct dvec3 point)
{
    struct renderer_mark mark = {.kind = ball ? RENDERER_MARK_BALL : RENDERER_MARK_CROSS, .opacity = {1, 1}};
    for (int i = 0; i < 3; i++)
        mark.colour[i] = ball ? green[i] : white[i];
    place(eyes, point, ball ? FIXATION_RADIUS_DEG : FIXATION_CROSS_DEG, 0.0, &mark);
    return mark;
}

// The spheres are in the world: they fade with it.
static uint32_t sphere_marks(const struct targets *targets, const struct machine_view *view,
                             const struct pose *head, const struct targets_view *eyes,
                             struct renderer_mark *out, uint32_t capacity)
{
    const struct spheres *spheres = &targets->spheres[view->showing == 1];
    const struct dquat q = head->orientation, back = {-q.x, -q.y, -q.z, q.w};
    uint32_t count = 0;
    for (uint32_t i = 0; i < spheres->count && count < capacity; i++) {
        const struct sphere *sphere = &spheres->all[i];
        struct renderer_mark mark = {.kind = RENDERER_MARK_BALL, .fade = view->fade};
        for (int eye = 0; eye < EYES; eye++)
            mark.opacity[eye] = spheres_seen(spheres, i, eye, (double)view->stimulus_ns * NS);
        for (int k = 0; k < 3; k++)
            mark.colour[k] = spheres_colours[sphere->colour].srgb[k];
        place(eyes, dquat_rotate(back, dvec3_sub(sphere->position, head->position)), 0.0, SPHERES_RADIUS_M,
              &mark);
        if (mark.opacity[EYE_LEFT] > 0.0 || mark.opacity[EYE_RIGHT] > 0.0)
            out[count++] = mark;
    }
    return count;
}

// Farther ones first, since nearer ones lie over them.
static int by_size(const void *a, const void *b)
{
    const struct renderer_mark *x = a, *y = b;
    const double *mx = x->place[EYE_LEFT].unit_from_px[0], *my = y->place[EYE_LEFT].unit_from_px[0];
    return mx[0] < my[0] ? 1 : mx[0] > my[0] ? -1 : 0; // larger: fewer units a pixel
}

uint32_t targets_marks(const struct targets *targets, const struct machine_view *view, const struct pose *head,
                       const struct targets_view *eyes, struct renderer_mark *out, uint32_t capacity)
{
    struct fixation_place at;
    uint32_t count = 0;
    if (capacity == 0 || view->screen != MACHINE_STIMULUS || !view->trial)
        return 0;
    if (view->marker) { // as deep as what comes next, so that the eyes are there already
        const double distance_m = fixation_target_at(&targets->fixation, 0.0).distance_m;
        out[0] = fixation_mark(eyes, false, (struct dvec3){0, 0, -distance_m});
        return 1;
    }
    if (view->slot == PLAN_SLOT_NONE)
        return 0;
    if (view->fade < 1.0)
        count = sphere_marks(targets, view, head, eyes, out, capacity - 1);
    qsort(out, count, sizeof *out, by_size);
    // In the full gray of a switch the option's letter stands in the cross's place.
    const bool letter = view->fade >= 1.0 && view->trial->kind != PROTOCOL_SEQUENTIAL &&
                        protocol_kind_is_pair(view->trial->kind);
    const bool ball = targets->fixation.kind == FIXATION_MOVING;
    if (targets_fixation(targets, view, &at) && (ball || !letter))
        out[count++] = fixation_mark(eyes, ball, at.point);
    return count;
}

bool targets_sphere_json(const struct targets *targets, uint32_t showing, uint32_t sphere, char *out,
                         size_t out_size)
{
    const struct spheres *spheres = &targets->spheres[showing == 1];
    const struct sphere *s = &spheres->all[sphere];
    if (sphere >= spheres->count)
        return false;
    int length =
        snprintf(out, out_size,
                 "{\"showing\":%u,\"sphere\":%u,\"of\":%u,\"at\":[%.3f,%.3f,%.3f],\"colour\":\"%s\","
                 "\"from_s\":%.1f,\"to_s\":%.1f,\"relaxed\":\"%s\"}",
                 showing, sphere + 1, spheres->count, s->position.x, s->position.y, s->position.z,
                 spheres_colours[s->colour].name, s->from_s, s->to_s, spheres_relaxed_name(s->relaxed));
    return length > 0 && (size_t)length < out_size;
}
