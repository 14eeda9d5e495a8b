// Reprojection of surfaces: flat pieces at right angles to z before the background.
#include "tests/renderer/passes/reproject_bed.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <string.h>

#include <cmocka.h>

enum { PIECES = 8 };

struct piece {
    double left, right, bottom, top, z; // metres, world
};

struct stage {
    uint32_t count;
    struct piece pieces[PIECES];
};

// What a pixel of a view sees: its position, reproject.h.
static void see(const struct stage *s, const struct rig_view *view, size_t pixel, float out[4])
{
    const size_t count = (size_t)view->width * view->height;
    const struct rig_eye *e = &view->eyes[pixel / count];
    const double x = (double)(pixel % view->width) + 0.5, y = (double)(pixel % count / view->width) + 0.5;
    const struct dvec3 d =
        dquat_rotate(e->pose.orientation, viewing_pixel_direction(&e->fov, view->width, view->height, x, y));
    double nearest = HUGE_VAL;
    for (uint32_t i = 0; i < s->count; i++) {
        const struct piece *p = &s->pieces[i];
        const double t = (p->z - e->pose.position.z) / d.z;
        const double at_x = e->pose.position.x + t * d.x, at_y = e->pose.position.y + t * d.y;
        if (t > 0 && t < nearest && at_x > p->left && at_x < p->right && at_y > p->bottom && at_y < p->top)
            nearest = t;
    }
    const bool background = nearest == HUGE_VAL;
    const struct dvec3 p = background
                               ? dvec3_normalise(d)
                               : dvec3_sub(dvec3_add(e->pose.position, dvec3_scale(d, nearest)), view->origin);
    out[0] = (float)p.x;
    out[1] = (float)p.y;
    out[2] = (float)p.z;
    out[3] = background ? -1.f : 1.f;
}

static void see_all(struct bed *b, const struct stage *s, const struct rig_view *view)
{
    for (size_t i = 0; i < 2 * bed_pixels(b); i++)
        see(s, view, i, b->warp.positions[i]);
}

static void step_eyes(struct rig_view *view, struct dvec3 step)
{
    for (int eye = 0; eye < EYES; eye++)
        view->eyes[eye].pose.position = dvec3_add(view->eyes[eye].pose.position, step);
}

// Several frames in a row, each from what the last one left, every one judged.
static void surfaces_agree_with_brute_force(void **state)
{
    (void)state;
    struct bed b;
    struct warp_verdict sum = {0};
    bed_open(&b, 45, 36);
    for (uint64_t seed = 0; seed < 8; seed++) {
        uint64_t random = seed;
        struct stage s = {.count = PIECES};
        for (int i = 0; i < PIECES; i++) {
            const double z = -exp(rig_uniform(&random, log(0.5), log(20))), size = -z * 0.6;
            const double x = rig_uniform(&random, z, -z), y = rig_uniform(&random, z, -z);
            s.pieces[i] = (struct piece){x - size, x + size, y - size, y + size, z};
        }
        b.warp.view = rig_view_default(b.width, b.height);
        see_all(&b, &s, &b.warp.view);
        const struct dvec3 step = {rig_uniform(&random, -0.05, 0.05), rig_uniform(&random, -0.05, 0.05),
                                   rig_uniform(&random, -0.08, 0.02)};
        for (int frame = 0; frame < 4; frame++) {
            step_eyes(&b.warp.view, step);
            bed_run(&b);
            struct warp_verdict v = bed_judge(&b);
            if (v.wrong)
                fail_msg("seed %u, frame %d: %u pixels are wrong", (unsigned)seed, frame, v.wrong);
            bed_add(&sum, &v);
            memcpy(b.warp.positions, b.result, 2 * bed_pixels(&b) * sizeof *b.result);
        }
    }
    bed_tell("surfaces", &sum);
    assert_true(sum.certain > 0.95 * sum.pixels && sum.shows > 100);
    bed_close(&b);
}

// A hole's level in the pyramid: how far off the next valid pixel is.
static uint32_t hole_level(const struct bed *b, size_t pixel)
{
    const size_t eye = pixel / bed_pixels(b) * bed_pixels(b);
    const uint32_t x = (uint32_t)(pixel - eye) % b->width, y = (uint32_t)(pixel - eye) / b->width;
    for (uint32_t m = 0; m < 16; m++) {
        for (uint32_t v = y >> m << m; v < ((y >> m) + 1) << m && v < b->height; v++)
            for (uint32_t u = x >> m << m; u < ((x >> m) + 1) << m && u < b->width; u++)
                if (b->result[eye + v * b->width + u][3] != 0)
                    return m;
    }
    return 16;
}

// Everything farther than the wall that is seen within its outline, a pixel inside the rim that the wall's
// outermost samples may have: `rim_m`, the size of a pixel on the wall when it was drawn.
static uint32_t count_leaks(const struct bed *b, const struct piece *wall, double rim_m)
{
    uint32_t leaks = 0;
    for (size_t i = 0; i < 2 * bed_pixels(b); i++) {
        const struct rig_eye *e = &b->warp.view.eyes[i / bed_pixels(b)];
        const size_t pixel = i % bed_pixels(b);
        bool inside = true;
        for (int corner = 0; corner < 4; corner++) {
            const double x = (double)(pixel % b->width) + (corner & 1 ? 1.5 : -0.5),
                         y = (double)(pixel / b->width) + (corner & 2 ? 1.5 : -0.5);
            const struct dvec3 d = viewing_pixel_direction(&e->fov, b->width, b->height, x, y);
            const double t = (wall->z - e->pose.position.z) / d.z;
            const double at_x = e->pose.position.x + t * d.x, at_y = e->pose.position.y + t * d.y;
            inside &= at_x > wall->left + rim_m && at_x < wall->right - rim_m && at_y > wall->bottom + rim_m &&
                      at_y < wall->top - rim_m;
        }
        const float w = b->result[i][3];
        leaks += inside && w != 0 && (w < 0 || (double)b->result[i][2] < wall->z - 0.01);
    }
    return leaks;
}

struct dolly {
    uint32_t leaks, worst_frame, redrawn;
};

// Towards `stage` until its first piece is 2.4 times as large. Holes of a level and above are drawn anew, as
// the confidence would have it; 16: none.
static struct dolly run_dolly(struct bed *b, const struct stage *stage, double step_m, uint32_t redrawn_level)
{
    struct dolly d = {0};
    const double start_m = -stage->pieces[0].z;
    b->warp.view = rig_view_default(b->width, b->height);
    const struct viewing_fov *f = &b->warp.view.eyes[0].fov;
    const double rim_m = start_m * (f->tan_up + f->tan_down) / b->height;
    see_all(b, stage, &b->warp.view);
    while (start_m < 2.4 * (start_m + b->warp.view.eyes[0].pose.position.z - step_m)) {
        step_eyes(&b->warp.view, (struct dvec3){0, 0, -step_m});
        rig_upload(&b->rig, &b->position[0], sizeof *b->warp.positions, b->warp.positions);
        rig_frame(&b->rig, &b->warp.view);
        bed_record(b, &b->pass, 0);
        rig_download(&b->rig, &b->position[1], sizeof *b->result, b->result);
        const uint32_t leaks = count_leaks(b, &stage->pieces[0], rim_m);
        d.leaks += leaks;
        d.worst_frame = leaks > d.worst_frame ? leaks : d.worst_frame;
        for (size_t p = 0; p < 2 * bed_pixels(b); p++) {
            memcpy(b->warp.positions[p], b->result[p], sizeof b->result[p]);
            if (redrawn_level < 16 && b->result[p][3] == 0 && hole_level(b, p) >= redrawn_level) {
                see(stage, &b->warp.view, p, b->warp.positions[p]);
                d.redrawn++;
            }
        }
    }
    return d;
}

static void a_dolly_towards_a_wall_lets_nothing_through(void **state)
{
    (void)state;
    struct bed b;
    bed_open(&b, 96, 80);
    // the wall alone before the sky, and before a far plane
    static const struct stage stages[] = {{1, {{-1, 1.2, -0.9, 0.8, -3}}},
                                          {2, {{-1, 1.2, -0.9, 0.8, -3}, {-300, 300, -300, 300, -100}}}};
    static const double steps_m[] = {0.008, 0.02, 0.05, 0.1};
    for (size_t k = 0; k < countof(stages); k++) {
        for (size_t i = k; i < countof(steps_m); i++) {
            const struct dolly kept = run_dolly(&b, &stages[k], steps_m[i], 16),
                               redrawn = run_dolly(&b, &stages[k], steps_m[i], 1);
            print_message("%g m a frame before %s: %u leaks without redraws; %u, at most %u in a frame, with "
                          "%u holes redrawn\n",
                          steps_m[i], k ? "a plane" : "the sky", kept.leaks, redrawn.leaks, redrawn.worst_frame,
                          redrawn.redrawn);
            assert_int_equal(kept.leaks, 0);
            // Redrawn pixels crowd with older ones, the rim's last are lost to those before them, and what is
            // drawn beyond them then has the sky between: a gap as real as any for one who sees pixels only.
            assert_true(redrawn.worst_frame <= 30);
        }
    }
    bed_close(&b);
}

// Two slits, 1 and 2 pixels wide, upright and level, between surfaces at 2 m.
static struct stage slits(const struct rig_view *view)
{
    const struct viewing_fov *f = &view->eyes[0].fov;
    const double px = 2 * (f->tan_left + f->tan_right) / view->width, left = -2 * f->tan_left;
    const double top = 2 * f->tan_up, end = 50;
    // pieces between pixel columns 10 | 11..30 | 32..60 | 61.., the last cut by rows 20 and 22..23
    return (struct stage){6,
                          {{-end, left + 11 * px, -end, end, -2},
                           {left + 12 * px, left + 31 * px, -end, end, -2},
                           {left + 33 * px, left + 60 * px, -end, end, -2},
                           {left + 60 * px, end, top - 20 * px, end, -2},
                           {left + 60 * px, end, top - 40 * px, top - 21 * px, -2},
                           {left + 60 * px, end, -end, top - 42 * px, -2}}};
}

static uint32_t background_of(const struct bed *b, const float (*positions)[4])
{
    uint32_t count = 0;
    for (size_t i = 0; i < 2 * bed_pixels(b); i++)
        count += positions[i][3] < 0;
    return count;
}

static void real_gaps_stay(void **state)
{
    (void)state;
    struct bed b;
    bed_open(&b, 96, 80);
    struct rig_view before = rig_view_default(b.width, b.height);
    for (int eye = 0; eye < EYES; eye++)
        before.eyes[eye].pose.position = (struct dvec3){0, 0, 0};
    const struct stage s = slits(&before);
    const double px = 2 * (before.eyes[0].fov.tan_left + before.eyes[0].fov.tan_right) / before.width;
    see_all(&b, &s, &before);
    const uint32_t all = background_of(&b, (const float(*)[4])b.warp.positions);
    assert_true(all == 2 * (3 * 80 + 3 * 36));
    // in pixels of the surfaces, a frame; the last is a step ahead that spreads the image's rim as much
    static const double moves[][3] = {{0, 0, 0},      {0.08, 0, 0}, {0, 0.08, 0}, {0.05, -0.07, 0},
                                      {-0.3, 0.2, 0}, {0, 0.9, 0},  {0.9, 0, 0},  {0, 0, -0.3}};
    for (size_t m = 0; m < countof(moves); m++) {
        b.warp.view = before;
        see_all(&b, &s, &before);
        for (int frame = 0; frame < 6; frame++) {
            step_eyes(&b.warp.view, (struct dvec3){moves[m][0] * px, moves[m][1] * px, moves[m][2] * px});
            bed_run(&b);
            if (m == 0)
                assert_memory_equal(b.result, b.warp.positions, 2 * bed_pixels(&b) * sizeof *b.result);
            memcpy(b.warp.positions, b.result, 2 * bed_pixels(&b) * sizeof *b.result);
        }
        const uint32_t left = background_of(&b, (const float(*)[4])b.result);
        assert_true(m < 4 ? left == all : left > all / 20);
        print_message("six frames of (%g, %g, %g) px: %u of %u gap pixels left\n", moves[m][0], moves[m][1],
                      moves[m][2], left, all);
    }
    bed_close(&b);
}

int main(void)
{
    struct rig probe;
    if (!rig_open(&probe))
        return 77;
    rig_close(&probe);
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(surfaces_agree_with_brute_force),
        cmocka_unit_test(a_dolly_towards_a_wall_lets_nothing_through),
        cmocka_unit_test(real_gaps_stay),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
