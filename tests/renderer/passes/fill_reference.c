#include "tests/renderer/passes/fill_reference.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static double luminance(const double *rgb) // ITU-R BT.709
{
    return 0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2];
}

// NULL outside the level and where it has nothing.
static const double *valid_texel(const struct fill_pyramid *p, uint32_t level, int64_t x, int64_t y)
{
    if (x < 0 || y < 0 || x >= p->levels[level].width || y >= p->levels[level].height)
        return NULL;
    const double *texel = p->levels[level].texels[y * p->levels[level].width + x];
    return texel[3] > 0 ? texel : NULL;
}

static void add_level(struct fill_pyramid *p, uint32_t level)
{
    const uint32_t width = (p->levels[level - 1].width + 1) / 2, height = (p->levels[level - 1].height + 1) / 2;
    p->levels[level].width = width;
    p->levels[level].height = height;
    p->levels[level].texels = calloc((size_t)width * height, sizeof *p->levels[level].texels);
    assert_non_null(p->levels[level].texels);
    for (uint32_t i = 0; i < width * height; i++) {
        double *out = p->levels[level].texels[i], low = 2, high = -1;
        double sums[2][3] = {{0}}, counts[2] = {0}, farthest = 2; // of the background and of surfaces
        for (int64_t k = 0; k < 4; k++) {
            const double *in = valid_texel(p, level - 1, 2 * (i % width) + k % 2, 2 * (i / width) + k / 2);
            if (!in)
                continue;
            const int kind = in[4] > 0;
            for (int c = 0; c < 3; c++)
                sums[kind][c] += in[c];
            counts[kind]++;
            low = fmin(low, luminance(in));
            high = fmax(high, luminance(in));
            farthest = kind ? fmin(farthest, in[4]) : farthest;
        }
        const int kind = counts[1] > 0;
        if (counts[kind] == 0)
            continue;
        for (int c = 0; c < 3; c++)
            out[c] = sums[kind][c] / counts[kind];
        out[3] = 1 - 0.5 * (high - low);
        out[4] = kind ? farthest : 0;
    }
}

struct fill_pyramid fill_build(uint32_t width, uint32_t height, const struct rig_eye *eye,
                               const uint8_t (*colours)[4], const float (*positions)[4])
{
    struct fill_pyramid p = {.levels[0] = {width, height, calloc((size_t)width * height, 5 * sizeof(double))}};
    const struct dvec3 forward = dquat_rotate(eye->pose.orientation, (struct dvec3){0, 0, -1});
    assert_non_null(p.levels[0].texels);
    for (size_t i = 0; i < (size_t)width * height; i++) {
        if (positions[i][3] == 0)
            continue;
        for (int c = 0; c < 3; c++)
            p.levels[0].texels[i][c] = colours[i][c] / 255.0;
        p.levels[0].texels[i][3] = 1;
        if (positions[i][3] < 0)
            continue;
        const struct dvec3 at = {positions[i][0], positions[i][1], positions[i][2]};
        const double distance = dvec3_dot(forward, dvec3_sub(at, eye->pose.position));
        p.levels[0].texels[i][4] = VIEWING_NEAR_M / fmax(distance, VIEWING_NEAR_M);
    }
    while (p.levels[p.level_count].width > 1 || p.levels[p.level_count].height > 1)
        add_level(&p, ++p.level_count);
    return p;
}

void fill_free(struct fill_pyramid *p)
{
    for (uint32_t level = 0; level <= p->level_count; level++)
        free(p->levels[level].texels);
}

// Bilinear between the four texel centres around the pixel's centre, those without a value or of another kind
// than `over` left out.
static void blend(const struct fill_pyramid *p, uint32_t level, uint32_t x, uint32_t y, const double over[5],
                  double out[4])
{
    const double at_x = (x + 0.5) / (1u << level) - 0.5, at_y = (y + 0.5) / (1u << level) - 0.5;
    double sum[4] = {0}, weights = 0;
    for (int k = 0; k < 4; k++) {
        const double texel_x = floor(at_x) + k % 2, texel_y = floor(at_y) + k / 2;
        const double *texel = valid_texel(p, level, (int64_t)texel_x, (int64_t)texel_y);
        if (!texel || (texel[4] > 0) != (over[4] > 0))
            continue;
        const double weight = (1 - fabs(at_x - texel_x)) * (1 - fabs(at_y - texel_y));
        for (int c = 0; c < 4; c++)
            sum[c] += weight * texel[c];
        weights += weight;
    }
    for (int c = 0; c < 4; c++)
        out[c] = sum[c] / weights;
}

static double eccentricity_deg(const struct fill_pyramid *p, const struct rig_eye *eye, uint32_t x, uint32_t y)
{
    if (!isfinite(eye->gaze_x_deg) || !isfinite(eye->gaze_y_deg))
        return 0; // no gaze: all is fovea
    return geometry_angle_deg(
        viewing_pixel_direction(&eye->fov, p->levels[0].width, p->levels[0].height, x + 0.5, y + 0.5),
        viewing_direction(eye->gaze_x_deg, eye->gaze_y_deg));
}

struct fill_answer fill_ask(const struct fill_pyramid *p, const struct rig_eye *eye,
                            const struct fill_parameters *q, const float (*positions)[4], uint32_t x,
                            uint32_t y)
{
    const double w = (double)positions[y * p->levels[0].width + x][3];
    const double from_fovea = eccentricity_deg(p, eye, x, y) - q->fovea_deg;
    struct fill_answer a = {.hole = w == 0, .from_fovea_deg = from_fovea};
    const double width = q->periphery_deg - q->fovea_deg;
    const double t = width > 0 ? fmin(fmax(from_fovea / width, 0), 1) : from_fovea > 0;
    a.confidence = t * t * (3 - 2 * t); // c_e
    if (w >= 2)
        a.confidence *= pow(q->dynamic_decay, round((w - floor(w)) * 64)); // c_d
    if (!a.hole)
        return a;
    const double *over = NULL;
    for (uint32_t m = 1; !over && m <= p->level_count; m++) {
        over = valid_texel(p, m, x >> m, y >> m);
        a.level = over ? m : 0;
    }
    a.filled = over != NULL;
    double value[4] = {0};
    if (over)
        blend(p, a.level, x, y, over, value);
    memcpy(a.rgb, value, sizeof a.rgb);
    a.depth = over ? over[4] : 0;
    a.confidence *= value[3] * pow(q->hole_decay, a.level); // c_c c_s
    return a;
}
