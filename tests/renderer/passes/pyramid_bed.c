#include "tests/renderer/passes/pyramid_bed.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

void bed_open(struct bed *b, uint32_t width, uint32_t height)
{
    *b = (struct bed){.width = width, .height = height, .count = (size_t)2 * width * height};
    assert_true(rig_open(&b->rig));
    b->view = rig_view_default(width, height);
    for (int i = 0; i < 2; i++) {
        b->colour[i] = rig_image(&b->rig, VK_FORMAT_R8G8B8A8_UNORM, width, height);
        b->position[i] = rig_image(&b->rig, VK_FORMAT_R32G32B32A32_SFLOAT, width, height);
    }
    b->redraw_map = rig_image(&b->rig, VK_FORMAT_R8_UINT, width, height);
    b->positions = calloc(b->count, sizeof *b->positions);
    b->after = calloc(b->count, sizeof *b->after);
    b->forced = calloc(b->count, 1);
    b->colours = calloc(b->count, sizeof *b->colours);
    b->result = calloc(b->count, sizeof *b->result);
    b->map = calloc(b->count, 1);
    assert_true(b->positions && b->after && b->forced && b->colours && b->result && b->map);
    uint64_t random = width;
    for (int eye = 0; eye < EYES; eye++)
        b->view.eyes[eye].pose.orientation = rig_turn(&random, 3);
}

void bed_close(struct bed *b)
{
    for (int i = 0; i < 2; i++) {
        gpu_image_destroy(b->rig.gpu, &b->colour[i]);
        gpu_image_destroy(b->rig.gpu, &b->position[i]);
    }
    gpu_image_destroy(b->rig.gpu, &b->redraw_map);
    free(b->positions);
    free(b->after);
    free(b->forced);
    free(b->colours);
    free(b->result);
    free(b->map);
    rig_close(&b->rig);
}

static struct pyramid_confidence confidence_of(const struct fill_parameters *q)
{
    return (struct pyramid_confidence){.epsilon = (float)q->epsilon,
                                       .fovea_deg = (float)q->fovea_deg,
                                       .periphery_deg = (float)q->periphery_deg,
                                       .hole_decay = (float)q->hole_decay,
                                       .dynamic_decay = (float)q->dynamic_decay};
}

struct pyramid bed_make(struct bed *b, const struct fill_parameters *q, bool forced)
{
    struct pyramid pass;
    const struct pyramid_desc desc = {.gpu = b->rig.gpu,
                                      .frame = &b->rig.frame,
                                      .width = b->width,
                                      .height = b->height,
                                      .colour = {b->colour[0].view, b->colour[1].view},
                                      .position = {b->position[0].view, b->position[1].view},
                                      .redraw_map = b->redraw_map.view,
                                      .moving = forced,
                                      .confidence = confidence_of(q)};
    assert_true(pyramid_init(&pass, &desc));
    return pass;
}

struct pyramid bed_make_unlimited(struct bed *b)
{
    return bed_make(b, &(struct fill_parameters){.epsilon = 0, .hole_decay = 1}, false);
}

void bed_use(struct pyramid *pass, const struct fill_parameters *q)
{
    const uint32_t levels = pass->confidence.levels;
    pass->confidence = confidence_of(q);
    pass->confidence.levels = levels;
}

void bed_run(struct bed *b, const struct pyramid *pass, uint32_t target, const uint8_t *before)
{
    rig_upload(&b->rig, &b->colour[target], sizeof *b->colours, b->colours);
    rig_upload(&b->rig, &b->position[target], sizeof *b->positions, b->positions);
    memset(b->map, 7, b->count); // every pixel must be written
    rig_upload(&b->rig, &b->redraw_map, 1, before ? before : b->map);
    rig_frame(&b->rig, &b->view);
    VkCommandBuffer cmd = rig_begin(&b->rig);
    pyramid_pull(pass, cmd, target);
    pyramid_fill(pass, cmd, target, b->turn);
    rig_end(&b->rig, cmd);
    rig_download(&b->rig, &b->colour[target], sizeof *b->result, b->result);
    rig_download(&b->rig, &b->position[target], sizeof *b->after, b->after);
    rig_download(&b->rig, &b->redraw_map, 1, b->map);
    for (size_t i = 0; i < b->count; i++)
        assert_true(b->map[i] <= 1);
}

static void judge_pixel(const struct bed *b, size_t i, const struct fill_answer *a,
                        const struct fill_parameters *q, struct verdict *v)
{
    const double epsilon = q->epsilon;
    const bool expected = b->forced[i] || epsilon >= 1 || a->confidence < epsilon;
    // without a ramp between phi_F and phi_0 the rim is as sharp as an angle in floats
    const bool rim = q->periphery_deg - q->fovea_deg < 0.1 && fabs(a->from_fovea_deg) < 2e-3;
    const bool undecided =
        !b->forced[i] && epsilon > 0 && epsilon < 1 && (rim || fabs(a->confidence - epsilon) < level_error);
    const bool early = b->turns && b->positions[i][3] >= 2 && b->map[i]; // a law of its own, below
    v->redrawn += b->map[i];
    v->undecided += undecided;
    v->wrong_decisions += !undecided && !early && b->map[i] != expected;
    if (!a->hole) {
        v->wrong_colours += memcmp(b->result[i], b->colours[i], 4) != 0; // never touched
    } else if (!b->map[i]) {
        v->kept_holes++;
        double worst = 0;
        for (int c = 0; c < 3; c++)
            worst = fmax(worst, fabs(b->result[i][c] - 255 * a->rgb[c]));
        v->worst_colour = fmax(v->worst_colour, worst);
        v->wrong_colours += !(worst <= 1) || b->result[i][3] != 255;
    }
    const float *p = b->after[i];
    if (a->hole && !b->map[i]) {
        const bool depth_ok = a->depth == 0 ? p[0] == 0 : fabs((double)p[0] / a->depth - 1) < 1e-5;
        v->wrong_positions += !depth_ok || p[1] != 0 || p[2] != 0 || p[3] != 0;
    } else {
        v->wrong_positions += memcmp(p, b->positions[i], sizeof *b->after) != 0;
    }
}

struct verdict bed_judge(const struct bed *b, const struct fill_parameters *q)
{
    struct verdict v = {0};
    for (int eye = 0; eye < EYES; eye++) {
        const size_t at = (size_t)eye * b->count / 2;
        const float(*positions)[4] = (const float(*)[4])(b->positions + at);
        struct fill_pyramid p = fill_build(b->width, b->height, &b->view.eyes[eye],
                                           (const uint8_t(*)[4])(b->colours + at), positions);
        for (uint32_t i = 0; i < b->count / 2; i++) {
            struct fill_answer a = fill_ask(&p, &b->view.eyes[eye], q, positions, i % b->width, i / b->width);
            judge_pixel(b, at + i, &a, q, &v);
        }
        fill_free(&p);
    }
    return v;
}

static bool is_hole(enum holes holes, uint64_t *random, uint32_t x, uint32_t y)
{
    switch (holes) {
    case SPECKLED:
        return rig_below(random, 2);
    case SPARSE:
        return rig_below(random, 50) != 0;
    case BLOCKS:
        return (x / 11 + y / 7) % 2 || rig_below(random, 20) == 0;
    case ALL_HOLES:
    case ONE_PIXEL:
        return true;
    default:
        return false;
    }
}

void bed_paint(struct bed *b, enum holes holes, uint64_t seed)
{
    uint64_t random = seed;
    const uint64_t noise = seed % 3 == 0 ? 256 : 40;
    for (size_t i = 0; i < b->count; i++) {
        const uint32_t x = (uint32_t)i % b->width, y = (uint32_t)(i % (b->count / 2)) / b->width;
        const uint64_t kind = rig_below(&random, 10);
        float w = kind < 2   ? -1.f
                  : kind < 6 ? 1.f
                             : 2.f + (float)rig_below(&random, 9) + (float)(1 + rig_below(&random, 12)) / 64;
        if (w >= 2 && !b->turns)
            w = 1; // a pass that was not told that objects move
        if (is_hole(holes, &random, x, y))
            w = 0;
        const struct rig_eye *e = &b->view.eyes[i / (b->count / 2)];
        const struct dvec3 ray = dquat_rotate(
            e->pose.orientation, viewing_pixel_direction(&e->fov, b->width, b->height, x + 0.5, y + 0.5));
        const struct dvec3 at =
            dvec3_add(e->pose.position, dvec3_scale(ray, exp(rig_uniform(&random, log(0.04), log(100)))));
        const float position[4] = {(float)at.x, (float)at.y, (float)at.z, w};
        memcpy(b->positions[i], position, sizeof position);
        for (int c = 0; c < 3; c++) {
            const uint64_t base = noise == 256 ? 0 : (2u * x + 3u * y * (unsigned)(c + 1)) % 216;
            b->colours[i][c] = w == 0 ? 0 : (uint8_t)(base + rig_below(&random, noise));
        }
        b->colours[i][3] = w == 0 ? 0 : 255;
    }
    for (int eye = 0; holes == ONE_PIXEL && eye < EYES; eye++) {
        const size_t i = (size_t)eye * b->count / 2 + rig_below(&random, b->count / 2);
        b->positions[i][3] = 1;
        memcpy(b->colours[i], (const uint8_t[]){200, 100, 50, 255}, 4);
    }
}

void bed_look(struct bed *b, double x_deg, double y_deg)
{
    for (int eye = 0; eye < EYES; eye++) {
        b->view.eyes[eye].gaze_x_deg = x_deg - 3 * eye;
        b->view.eyes[eye].gaze_y_deg = y_deg;
    }
}

void bed_draw_parameters(struct bed *b, struct fill_parameters *q, uint64_t seed)
{
    static const double epsilons[] = {0, 0.05, 0.1, 0.2, 0.5, 0.9, 1}, decays[] = {0, 0.3, 0.6, 0.6, 0.9, 1};
    uint64_t random = seed;
    // ahead, a corner, outside the image, beyond 90 deg, behind, none
    static const double gazes[][2] = {{0, 0}, {48, 50}, {-80, 10}, {120, -20}, {180, 0}, {(double)NAN, 0}};
    *q = seed % 4 == 0 ? paper
                       : (struct fill_parameters){epsilons[rig_below(&random, 7)], rig_uniform(&random, 0, 90),
                                                  rig_uniform(&random, 0, 180), decays[rig_below(&random, 6)],
                                                  decays[rig_below(&random, 6)]};
    const size_t gaze = rig_below(&random, 6);
    bed_look(b, gazes[gaze][0], gazes[gaze][1]);
}
