#include "tests/renderer/passes/reproject_reference.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static const double border_px = 1e-3, tie = 1e-5, rim_deg = 1e-3;

enum candidate_kind { NONE, MAYBE, SURE };

// Where one source pixel goes.
struct flight {
    bool lands;
    struct dvec3 world;
    double x, y;     // pixels
    double nearness; // 1 / distance in front of the eye, 0 for the background
};

static struct flight fly(const struct warp *w, int eye, const float from[4])
{
    const struct rig_eye *e = &w->view.eyes[eye];
    struct flight f = {.world = {from[0], from[1], from[2]}};
    if (from[3] == 0)
        return f;
    const bool direction = from[3] < 0;
    struct dvec3 away = f.world;
    if (!direction) {
        f.world = dvec3_add(f.world, dvec3_sub(w->view.last_origin, w->view.origin));
        if (from[3] >= 2) {
            struct dmat4 motion;
            for (int i = 0; i < 16; i++)
                motion.m[i] = (double)w->motions[(int)from[3] - 1][i];
            f.world = dmat4_point(&motion, f.world);
        }
        away = dvec3_sub(f.world, dvec3_sub(e->pose.position, w->view.origin));
    }
    const struct dquat q = e->pose.orientation;
    const struct dvec3 p = dquat_rotate((struct dquat){-q.x, -q.y, -q.z, q.w}, away);
    f.lands = isfinite(p.x + p.y + p.z) && (direction ? p.z < 0 : -p.z >= (double)(float)VIEWING_NEAR_M);
    if (!f.lands)
        return f;
    viewing_pixel(&e->fov, w->view.width, w->view.height, p, &f.x, &f.y);
    f.nearness = direction ? 0 : -1 / p.z;
    return f;
}

// How far the fovea keeps points off a pixel: below 0 they are dropped.
static double outside_fovea_deg(const struct warp *w, int eye, int64_t x, int64_t y)
{
    const struct rig_eye *e = &w->view.eyes[eye];
    if (!isfinite(e->gaze_x_deg) || !isfinite(e->gaze_y_deg))
        return 0 - w->drop_deg;
    const struct dvec3 ray =
        viewing_pixel_direction(&e->fov, w->view.width, w->view.height, (double)x + 0.5, (double)y + 0.5);
    return geometry_angle_deg(ray, viewing_direction(e->gaze_x_deg, e->gaze_y_deg)) - w->drop_deg;
}

static enum candidate_kind lands_on(const struct warp *w, int eye, const struct flight *f, int64_t x, int64_t y)
{
    if (!f->lands)
        return NONE;
    const double in_x = fmin(f->x - (double)x, (double)x + 1 - f->x),
                 in_y = fmin(f->y - (double)y, (double)y + 1 - f->y);
    const double in = fmin(in_x, in_y), out = w->drop_deg > 0 ? outside_fovea_deg(w, eye, x, y) : 1;
    if (in < -border_px || out < -rim_deg)
        return NONE;
    return in > border_px && out > rim_deg ? SURE : MAYBE;
}

// Everything one pixel could hold.
struct contest {
    double sure_nearness; // of the nearest point that surely lands here, -1 without any
    uint32_t acceptable;
    bool winner_ok;
};

static struct contest judge_pixel(const struct warp *w, int eye, const struct flight *flights, int64_t x,
                                  int64_t y, int64_t winner)
{
    const int64_t count = (int64_t)w->view.width * w->view.height;
    const float(*from)[4] = (const float(*)[4])w->positions + eye * count;
    struct contest c = {.sure_nearness = -1};
    for (int64_t i = 0; i < count; i++) {
        if (flights[i].nearness > c.sure_nearness && lands_on(w, eye, &flights[i], x, y) == SURE)
            c.sure_nearness = flights[i].nearness;
    }
    c.acceptable = c.sure_nearness < 0;
    c.winner_ok = winner < 0 && c.sure_nearness < 0;
    int64_t first = -1; // of those in exactly the winner's place
    for (int64_t i = 0; i < count; i++) {
        if (lands_on(w, eye, &flights[i], x, y) == NONE ||
            flights[i].nearness < c.sure_nearness - tie * fmax(c.sure_nearness, 0))
            continue;
        c.acceptable++;
        c.winner_ok |= i == winner;
        if (first < 0 && winner >= 0 && memcmp(from[i], from[winner], sizeof from[i]) == 0)
            first = i;
    }
    c.winner_ok &= first < 0 || first == winner;
    return c;
}

static double position_error(const struct flight *f, const float source[4], const float got[4])
{
    if (source[3] < 0) // a direction stays as it is
        return memcmp(source, got, 4 * sizeof *got) == 0 ? 0 : HUGE_VAL;
    const double age = source[3] >= 2 ? fmin(round((double)(source[3] - floorf(source[3])) * 64) + 1, 63) : 0;
    if ((double)got[3] != (double)floorf(source[3]) + age / 64)
        return HUGE_VAL;
    const struct dvec3 d = dvec3_sub((struct dvec3){got[0], got[1], got[2]}, f->world);
    return dvec3_length(d) / (dvec3_length(f->world) + 1);
}

struct warp_verdict warp_judge(const struct warp *w, int eye, const int64_t *sources,
                               const float (*positions)[4])
{
    const int64_t width = w->view.width, count = width * w->view.height;
    const float(*from)[4] = (const float(*)[4])w->positions + eye * count;
    struct warp_verdict v = {0};
    struct flight *flights = calloc((size_t)count, sizeof *flights);
    assert_non_null(flights);
    for (int64_t i = 0; i < count; i++)
        flights[i] = fly(w, eye, from[i]);
    for (int64_t i = 0; i < count; i++) {
        const int64_t s = sources[i];
        assert_true(s >= -1 && s < count);
        const struct contest c = judge_pixel(w, eye, flights, i % width, i / width, s);
        v.pixels++;
        v.covered += s >= 0;
        v.certain += c.acceptable == 1;
        const double error =
            s >= 0 ? position_error(&flights[s], from[s], positions[i]) : (positions[i][3] == 0 ? 0 : HUGE_VAL);
        v.worst_error = fmax(v.worst_error, error);
        v.wrong += !c.winner_ok || !(error < 1e-5);
    }
    free(flights);
    return v;
}
