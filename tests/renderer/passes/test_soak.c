// Three thousand frames of time_warped: what it keeps neither drifts nor decays. FOVSTUDY_SOAK_FRAMES=10000
// asks for another number (at least 400); CTest has the least that shows it in a minute.
//
// The drifting eye goes round the same small loop every LOOP frames, so that an early and a late round show the
// same views and their errors against `regular` may be compared frame by frame.
#include "tests/renderer/stage.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>

#include <cmocka.h>

enum { FRAMES = 3000, LOOP = 200, EARLY = LOOP, EVERY = 8 };

struct room {
    struct stage stage;
    struct scene *scene;
    struct renderer_scene *uploaded;
};

static int open_room(void **state)
{
    char error[512];
    struct room *r = calloc(1, sizeof *r);
    if (!r || !stage_open(&r->stage, 64, 64))
        return -1;
    r->scene = scene_open("town:triangles=20000", error, sizeof error);
    if (!r->scene)
        fail_msg("%s", error);
    r->uploaded = renderer_scene_create(r->stage.renderer, r->scene);
    *state = r;
    return r->uploaded ? 0 : -1;
}

static int close_room(void **state)
{
    struct room *r = *state;
    renderer_scene_destroy(r->uploaded);
    scene_destroy(r->scene);
    stage_close(&r->stage);
    free(r);
    return 0;
}

// Around the path's third second: an ellipse of `size_m`, the head turning with it by `turn_rad`.
static struct frame frame_at(const struct room *r, uint64_t number, double size_m, double turn_rad)
{
    struct frame frame = stage_frame(&r->stage, r->scene, number, 3, 0, 0);
    const double phase = 2 * 3.14159265358979 * (double)(number % LOOP) / LOOP;
    const double half = 0.5 * turn_rad * sin(phase);
    const struct dquat yaw = {0, sin(half), 0, cos(half)};
    frame.moving = size_m > 0;
    frame.animation_s = size_m > 0 ? 0.5 - 0.5 * cos(phase) : 0; // there and back
    struct pose head = camera_path_pose(&r->scene->path, 3);
    head.position = dvec3_add(head.position, (struct dvec3){size_m * cos(phase), 0.3 * size_m * sin(2 * phase),
                                                            0.6 * size_m * sin(phase)});
    struct dmat4 turn = dmat4_compose((struct dvec3){0, 0, 0}, yaw, (struct dvec3){1, 1, 1});
    const struct dvec3 ahead = dquat_rotate(head.orientation, (struct dvec3){0, 0, -1});
    head.orientation = dquat_look(dmat4_direction(&turn, ahead), (struct dvec3){0, 1, 0});
    for (int eye = 0; eye < EYES; eye++)
        frame.eyes[eye].pose = viewing_eye_pose(&head, eye, VIEWING_DEFAULT_IPD_M);
    return frame;
}

static uint64_t frame_count(void)
{
    const char *asked = getenv("FOVSTUDY_SOAK_FRAMES");
    const long count = asked ? strtol(asked, NULL, 10) : FRAMES;
    return count >= 2 * LOOP ? (uint64_t)count / LOOP * LOOP : 2 * LOOP;
}

static double error_of(const struct room *r, struct renderer_option *warped, struct renderer_option *regular)
{
    double mean = 0;
    for (int eye = 0; eye < EYES; eye++) {
        uint8_t *x = stage_read(&r->stage, warped, eye), *y = stage_read(&r->stage, regular, eye);
        mean += stage_compare(&r->stage, x, y).mean / EYES;
        free(x);
        free(y);
    }
    return mean;
}

struct soak {
    double early, late;       // mean error of 255 over one round each
    double half_pixel;        // mean change of `regular` over the early round, sampled half a pixel off
    double worst;             // error of any one frame measured
    double early_px, late_px; // shaded a frame, share of all
};

static void measure(struct room *r, struct renderer_option *warped, struct renderer_option *regular[2],
                    const struct frame *frame, bool early, struct soak *s)
{
    assert_true(renderer_draw(regular[0], frame, NULL));
    const double error = error_of(r, warped, regular[0]);
    *(early ? &s->early : &s->late) += error * EVERY / LOOP;
    s->worst = fmax(s->worst, error);
    if (!early)
        return;
    struct frame aside = *frame;
    for (int eye = 0; eye < EYES; eye++) {
        struct viewing_fov *f = &aside.eyes[eye].fov;
        const double half = 0.5 * (f->tan_left + f->tan_right) / r->stage.width;
        *f =
            (struct viewing_fov){f->tan_left - half, f->tan_right + half, f->tan_down - half, f->tan_up + half};
    }
    assert_true(renderer_draw(regular[1], &aside, NULL));
    s->half_pixel += error_of(r, regular[0], regular[1]) * EVERY / LOOP;
}

static struct soak run(struct room *r, double size_m, double turn_rad, const struct renderer_settings *settings)
{
    const uint64_t frames = frame_count();
    struct renderer_option *warped = stage_option_set(&r->stage, r->uploaded, "time_warped", settings);
    struct renderer_option *regular[2];
    struct soak s = {0};
    for (int i = 0; i < 2; i++)
        regular[i] = stage_option_set(&r->stage, r->uploaded, "regular", settings);
    for (uint64_t n = 0; n < frames; n++) {
        const struct frame frame = frame_at(r, n, size_m, turn_rad);
        struct frame_stats stats;
        assert_true(renderer_draw(warped, &frame, &stats));
        const bool early = n >= EARLY && n < EARLY + LOOP, late = n >= frames - LOOP;
        const double share = (double)stats.shaded_px / (2.0 * r->stage.width * r->stage.height) / LOOP;
        s.early_px += early ? share : 0;
        s.late_px += late ? share : 0;
        if (n % EVERY == 0 && (early || late))
            measure(r, warped, regular, &frame, early, &s);
    }
    renderer_option_destroy(warped);
    for (int i = 0; i < 2; i++)
        renderer_option_destroy(regular[i]);
    print_message("error early %.4f, late %.4f, worst %.4f of 255, half a pixel is %.4f; shaded early %.2f %%, "
                  "late %.2f %%\n",
                  s.early, s.late, s.worst, s.half_pixel, 100 * s.early_px, 100 * s.late_px);
    return s;
}

static void a_still_eye_stays_exact(void **state)
{
    const struct soak s = run(*state, 0, 0, NULL);
    assert_true(s.worst == 0);
}

static void a_drifting_eye_errs_no_more_in_the_end(void **state)
{
    const struct soak s = run(*state, 0.15, 0.1, NULL);
    assert_true(s.early > 0 && s.late < 1.1 * s.early);
    assert_true(s.late < 1.5 * s.half_pixel && s.worst < 3 * s.half_pixel);
    assert_true(s.late_px < 1.1 * s.early_px);
}

int main(void)
{
    struct stage probe;
    if (!stage_open(&probe, 16, 16))
        return 77;
    stage_close(&probe);
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_still_eye_stays_exact),
        cmocka_unit_test(a_drifting_eye_errs_no_more_in_the_end),
    };
    return cmocka_run_group_tests(tests, open_room, close_room);
}
