#include "tests/renderer/passes/reproject_bed.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

size_t bed_pixels(const struct bed *b)
{
    return (size_t)b->width * b->height;
}

void bed_set_motion(struct bed *b, uint32_t id, const struct dmat4 *m)
{
    float *mapped = b->motions.mapped;
    for (int i = 0; i < 16; i++)
        mapped[16 * id + (uint32_t)i] = b->warp.motions[id][i] = (float)m->m[i];
}

void bed_open(struct bed *b, uint32_t width, uint32_t height)
{
    *b = (struct bed){.width = width, .height = height};
    assert_true(rig_open(&b->rig));
    assert_true(gpu_buffer_create(b->rig.gpu, "motions", sizeof b->warp.motions,
                                  VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, GPU_HOST, &b->motions));
    struct reproject_desc desc = {
        .gpu = b->rig.gpu, .frame = &b->rig.frame, .motions = &b->motions, .width = width, .height = height};
    for (int i = 0; i < 2; i++) {
        b->position[i] = rig_image(&b->rig, VK_FORMAT_R32G32B32A32_SFLOAT, width, height);
        b->colour[i] = rig_image(&b->rig, VK_FORMAT_R8G8B8A8_UNORM, width, height);
        desc.position[i] = b->position[i].view;
        desc.colour[i] = b->colour[i].view;
    }
    assert_true(reproject_init(&b->pass, &desc));
    desc.points = true;
    assert_true(reproject_init(&b->points, &desc));
    b->warp.view = rig_view_default(width, height);
    b->warp.positions = calloc(2 * bed_pixels(b), sizeof *b->warp.positions);
    b->result = calloc(2 * bed_pixels(b), sizeof *b->result);
    b->colours = calloc(2 * bed_pixels(b), sizeof *b->colours);
    b->sources = calloc(2 * bed_pixels(b), sizeof *b->sources);
    assert_true(b->warp.positions && b->result && b->colours && b->sources);
    const struct dmat4 identity = dmat4_identity();
    for (uint32_t id = 0; id < WARP_MOTIONS; id++)
        bed_set_motion(b, id, &identity);
}

void bed_close(struct bed *b)
{
    reproject_finish(&b->pass);
    reproject_finish(&b->points);
    for (int i = 0; i < 2; i++) {
        gpu_image_destroy(b->rig.gpu, &b->position[i]);
        gpu_image_destroy(b->rig.gpu, &b->colour[i]);
    }
    gpu_buffer_destroy(b->rig.gpu, &b->motions);
    free(b->warp.positions);
    free(b->result);
    free(b->colours);
    free(b->sources);
    rig_close(&b->rig);
}

void bed_record(struct bed *b, const struct reproject *pass, uint32_t from)
{
    VkCommandBuffer cmd = rig_begin(&b->rig);
    reproject_record(pass, cmd, from, (float)b->warp.drop_deg, b->warp.drop_moving);
    rig_end(&b->rig, cmd);
}

// Both ways of splatting give the same bytes.
static void record_both(struct bed *b)
{
    const size_t count = 2 * bed_pixels(b), bytes = count * sizeof *b->result;
    bed_record(b, &b->pass, 0);
    rig_download(&b->rig, &b->position[1], sizeof *b->result, b->result);
    rig_download(&b->rig, &b->colour[1], sizeof *b->colours, b->colours);
    float(*positions)[4] = malloc(bytes);
    uint8_t(*colours)[4] = malloc(count * sizeof *colours);
    assert_true(positions && colours);
    memset(positions, 0xa5, bytes); // every pixel must be written
    rig_upload(&b->rig, &b->position[1], sizeof *positions, positions);
    bed_record(b, &b->points, 0);
    rig_download(&b->rig, &b->position[1], sizeof *positions, positions);
    rig_download(&b->rig, &b->colour[1], sizeof *colours, colours);
    assert_memory_equal(positions, b->result, bytes);
    assert_memory_equal(colours, b->colours, count * sizeof *colours);
    free(positions);
    free(colours);
}

void bed_run(struct bed *b)
{
    const uint32_t count = (uint32_t)bed_pixels(b);
    for (uint32_t i = 0; i < 2 * count; i++) {
        const uint32_t number = i % count + 1;
        const uint8_t colour[4] = {(uint8_t)number, (uint8_t)(number >> 8), (uint8_t)(number >> 16), 255};
        memcpy(b->colours[i], colour, sizeof colour);
    }
    rig_upload(&b->rig, &b->position[0], sizeof b->warp.positions[0], b->warp.positions);
    rig_upload(&b->rig, &b->colour[0], sizeof b->colours[0], b->colours);
    rig_frame(&b->rig, &b->warp.view);
    record_both(b);
    for (uint32_t i = 0; i < 2 * count; i++) {
        const uint8_t *c = b->colours[i];
        b->sources[i] = (c[0] | c[1] << 8 | c[2] << 16) - 1;
        assert_int_equal(c[3], b->sources[i] >= 0 ? 255 : 0);
        for (int k = 0; k < 4; k++)
            assert_true(isfinite(b->result[i][k]));
    }
}

void bed_add(struct warp_verdict *sum, const struct warp_verdict *v)
{
    sum->pixels += v->pixels;
    sum->covered += v->covered;
    sum->certain += v->certain;
    sum->shows += v->shows;
    sum->undecided += v->undecided;
    sum->wrong += v->wrong;
    sum->worst_error = fmax(sum->worst_error, v->worst_error);
}

void bed_tell(const char *what, const struct warp_verdict *v)
{
    print_message("%s: %u pixels, %u covered, %u show through, %u undecided, %.2f %% with one possible answer; "
                  "positions within %.1e\n",
                  what, v->pixels, v->covered, v->shows, v->undecided, 100.0 * v->certain / v->pixels,
                  v->worst_error);
}

struct warp_verdict bed_judge(const struct bed *b)
{
    struct warp_verdict sum = {0};
    for (int eye = 0; eye < EYES; eye++) {
        const size_t at = (size_t)eye * bed_pixels(b);
        struct warp_verdict v = warp_judge(&b->warp, eye, b->sources + at, (const float(*)[4])(b->result + at));
        bed_add(&sum, &v);
    }
    return sum;
}

void bed_put(struct bed *b, size_t pixel, struct dvec3 p, double w)
{
    float *out = b->warp.positions[pixel];
    out[0] = (float)p.x;
    out[1] = (float)p.y;
    out[2] = (float)p.z;
    out[3] = (float)w;
}

void bed_scatter(struct bed *b, const struct rig_view *before, uint64_t seed)
{
    uint64_t random = seed;
    for (size_t i = 0; i < 2 * bed_pixels(b); i++) {
        const struct rig_eye *e = &before->eyes[i / bed_pixels(b)];
        const size_t pixel = i % bed_pixels(b);
        const struct dvec3 ray = viewing_pixel_direction(
            &e->fov, b->width, b->height, (double)(pixel % b->width) + 0.5, (double)(pixel / b->width) + 0.5);
        struct dvec3 d = dquat_rotate(e->pose.orientation, ray);
        const double kind = rig_uniform(&random, 0, 1), distance = exp(rig_uniform(&random, log(0.1), log(50)));
        const struct dvec3 p = dvec3_sub(dvec3_add(e->pose.position, dvec3_scale(d, distance)), before->origin);
        if (kind < 0.1)
            bed_put(b, i, p, 0);
        else if (kind < 0.25)
            bed_put(b, i, d, -1);
        else if (kind < 0.5)
            bed_put(b, i, p,
                    2 + (double)rig_below(&random, WARP_MOTIONS - 1) + (double)rig_below(&random, 64) / 64);
        else if (kind < 0.55 && pixel > 0) // the same place twice
            memcpy(b->warp.positions[i], b->warp.positions[i - 1], sizeof b->warp.positions[i]);
        else
            bed_put(b, i, p, 1);
    }
}
