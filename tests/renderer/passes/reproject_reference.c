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
    double x, y;            // pixels
    double nearness;        // 1 / distance in front of the eye, 0 for the background
    double signed_nearness; // the same where it does not land, below 0 behind the eye
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
    f.signed_nearness = direction ? 0 : -1 / p.z;
    f.lands = !(w->drop_moving && from[3] >= 2) && isfinite(p.x + p.y + p.z) &&
              (direction ? p.z < 0 : -p.z >= (double)(float)VIEWING_NEAR_M);
    if (!f.lands)
        return f;
    viewing_pixel(&e->fov, w->view.width, w->view.height, p, &f.x, &f.y);
    f.nearness = direction ? 0 : fmax(-1 / p.z, 1e-35 / VIEWING_NEAR_M);
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

// Everything one pixel could hold before what shows through is looked for: the sources that may win, nearly all
// of the time one or none.
enum { RIVALS = 8 };

struct contest {
    bool hole_possible;
    uint32_t rivals; // more than RIVALS: not all are listed
    int64_t rival[RIVALS];
};

static bool certain(const struct contest *c)
{
    return c->rivals + c->hole_possible == 1;
}

// Of points in exactly the same place the first wins.
static bool repeats(const struct contest *c, const float (*from)[4], int64_t i)
{
    for (uint32_t k = 0; k < c->rivals && k < RIVALS; k++) {
        if (memcmp(from[i], from[c->rival[k]], sizeof from[i]) == 0)
            return true;
    }
    return false;
}

static struct contest hold(const struct warp *w, int eye, const struct flight *flights, int64_t x, int64_t y)
{
    const int64_t count = (int64_t)w->view.width * w->view.height;
    const float(*from)[4] = (const float(*)[4])w->positions + eye * count;
    double sure_nearness = -1; // of the nearest point that surely lands here
    for (int64_t i = 0; i < count; i++) {
        if (flights[i].nearness > sure_nearness && lands_on(w, eye, &flights[i], x, y) == SURE)
            sure_nearness = flights[i].nearness;
    }
    struct contest c = {.hole_possible = sure_nearness < 0};
    for (int64_t i = 0; i < count; i++) {
        if (flights[i].nearness < sure_nearness - tie * fmax(sure_nearness, 0) ||
            lands_on(w, eye, &flights[i], x, y) == NONE || repeats(&c, from, i))
            continue;
        if (c.rivals < RIVALS)
            c.rival[c.rivals] = i;
        c.rivals++;
    }
    return c;
}

enum answer { NO, PERHAPS, YES };

enum { REACH = 3 };

static enum answer more(double a, double b)
{
    return a > b * (1 + tie) ? YES : a > b * (1 - tie) && b > 0 ? PERHAPS : NO;
}

// The steps from (x, y) in a direction to the next pixel more than 10 % nearer than `nearness`, 0 without one.
static enum answer next_nearer(const struct warp *w, const struct flight *flights,
                               const struct contest *contests, int64_t x, int64_t y, const int64_t step[2],
                               double nearness, int64_t *out)
{
    for (int64_t i = 1; i <= REACH; i++) {
        const int64_t at_x = x + i * step[0], at_y = y + i * step[1];
        if (at_x < 0 || at_y < 0 || at_x >= w->view.width || at_y >= w->view.height)
            return NO;
        const struct contest *c = &contests[at_y * w->view.width + at_x];
        if (!certain(c))
            return PERHAPS;
        const enum answer nearer = c->rivals ? more(flights[c->rival[0]].nearness, 1.1 * nearness) : NO;
        *out = i;
        if (nearer != NO)
            return nearer;
    }
    return NO;
}

// Whether the last frame held something as far off as that, in the pixels of the line from source a to source b
// that divide it as `part` of `whole` does.
static enum answer was_gap(const struct warp *w, int eye, const struct flight *flights, int64_t a, int64_t b,
                           double part, double whole)
{
    const int64_t width = w->view.width;
    const float(*from)[4] = (const float(*)[4])w->positions + eye * width * w->view.height;
    const double way_x = (double)(b % width - a % width), way_y = (double)(b / width - a / width);
    const double steps = fmax(fabs(way_x), fabs(way_y)), place = part * steps / whole;
    enum answer answer = NO;
    for (double i = floor(place); i <= ceil(place); i++) {
        if (i < 1 || i > steps - 1)
            continue;
        const int64_t at =
            (a / width + lround(way_y * i / steps)) * width + a % width + lround(way_x * i / steps);
        if (from[at][3] == 0)
            continue;
        const double least = fmin(flights[a].nearness, flights[b].nearness);
        const enum answer far = more(least, 1.1 * flights[at].signed_nearness);
        answer = far > answer ? far : answer;
    }
    return answer;
}

static enum answer shows_through(const struct warp *w, int eye, const struct flight *flights,
                                 const struct contest *contests, int64_t s, int64_t x, int64_t y)
{
    static const int64_t across[4][2][2] = {
        {{1, 0}, {-1, 0}}, {{0, 1}, {0, -1}}, {{1, 1}, {-1, -1}}, {{1, -1}, {-1, 1}}};
    const int64_t width = w->view.width;
    enum answer answer = NO;
    for (int k = 0; k < 4; k++) {
        int64_t i[2] = {0, 0};
        enum answer side[2];
        for (int n = 0; n < 2; n++)
            side[n] = next_nearer(w, flights, contests, x, y, across[k][n], flights[s].nearness, &i[n]);
        if (side[0] == NO || side[1] == NO)
            continue;
        enum answer one = PERHAPS;
        if (side[0] == YES && side[1] == YES) {
            const int64_t a = (y + i[0] * across[k][0][1]) * width + x + i[0] * across[k][0][0],
                          b = (y + i[1] * across[k][1][1]) * width + x + i[1] * across[k][1][0];
            one = YES - was_gap(w, eye, flights, contests[a].rival[0], contests[b].rival[0], (double)i[0],
                                (double)(i[0] + i[1]));
        }
        answer = one > answer ? one : answer;
    }
    return answer;
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

// Whether the pass's answer for one pixel is among those possible.
static bool acceptable(const struct warp *w, int eye, const struct flight *flights,
                       const struct contest *contests, int64_t pixel, int64_t answer, struct warp_verdict *v)
{
    const int64_t width = w->view.width;
    const struct contest *c = &contests[pixel];
    const bool listed = c->rivals <= RIVALS;
    bool ok = !listed || (answer < 0 && c->hole_possible);
    enum answer shows = NO;
    for (uint32_t k = 0; k < c->rivals && k < RIVALS; k++) {
        const enum answer one =
            shows_through(w, eye, flights, contests, c->rival[k], pixel % width, pixel / width);
        ok |= answer < 0 ? one != NO : answer == c->rival[k] && one != YES;
        shows = k == 0 || one == shows ? one : PERHAPS;
    }
    v->shows += shows == YES && !c->hole_possible;
    v->undecided += shows == PERHAPS || !listed;
    v->certain += certain(c) && shows != PERHAPS;
    return ok;
}

struct warp_verdict warp_judge(const struct warp *w, int eye, const int64_t *sources,
                               const float (*positions)[4])
{
    const int64_t width = w->view.width, count = width * w->view.height;
    const float(*from)[4] = (const float(*)[4])w->positions + eye * count;
    struct warp_verdict v = {0};
    struct flight *flights = calloc((size_t)count, sizeof *flights);
    struct contest *contests = calloc((size_t)count, sizeof *contests);
    assert_true(flights && contests);
    for (int64_t i = 0; i < count; i++)
        flights[i] = fly(w, eye, from[i]);
    for (int64_t i = 0; i < count; i++)
        contests[i] = hold(w, eye, flights, i % width, i / width);
    for (int64_t i = 0; i < count; i++) {
        const int64_t s = sources[i];
        assert_true(s >= -1 && s < count);
        v.pixels++;
        v.covered += s >= 0;
        const bool ok = acceptable(w, eye, flights, contests, i, s, &v);
        const double error =
            s >= 0 ? position_error(&flights[s], from[s], positions[i]) : (positions[i][3] == 0 ? 0 : HUGE_VAL);
        v.worst_error = fmax(v.worst_error, error);
        v.wrong += !ok || !(error < 1e-5);
    }
    free(flights);
    free(contests);
    return v;
}
