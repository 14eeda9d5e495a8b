// Andersson, P., Nilsson, J., Akenine-Moller, T., Oskarsson, M., Astrom, K. & Fairchild, M. D., "FLIP: A
// Difference Evaluator for Alternating Images", Proceedings of the ACM on Computer Graphics and Interactive
// Techniques 3(2) (HPG 2020), article 15. LDR-FLIP:
//
//   colour: opponent colours, filtered by contrast sensitivity, clamped to sRGB, L*a*b* with Hunt's adjustment,
//     HyAB distance, redistributed to 0..1: Delta E_c
//   features: edges and points of the unfiltered luminance, by first and second derivatives of a Gaussian:
//     Delta E_f = (max(| |edge| - |edge'| |, | |point| - |point'| |) / sqrt 2)^0.5
//   both: Delta E = Delta E_c^(1 - Delta E_f)
//
// The paper's filters are sums of Gaussians in two dimensions, here applied along rows and then across;
// blue-yellow's two Gaussians are two such filters. Rows filtered along x are kept for the output rows that
// need them.
#include "analysis/image/flip.h"

#include "analysis/image/flip_color.h"
#include "analysis/image/flip_kernel.h"
#include "analysis/image/luma.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

// a sqrt(pi / b) exp(-pi^2 x^2 / b), x in degrees; the paper's constants.
struct csf_term {
    double a, b;
};
static const struct csf_term csf_y = {1, 0.0047}, csf_rg = {1, 0.0053};
static const struct csf_term csf_by[2] = {{34.1, 0.04}, {13.5, 0.025}};
static const double feature_width_deg = 0.082; // w, the paper's: twice the Gaussian's deviation
static const double max_pixels_per_degree = 240;
static const double pi = 3.14159265358979323846;

// What is kept of a row filtered along x; the last three are luminance by the feature Gaussian and its
// derivatives.
enum { KEPT_Y, KEPT_RG, KEPT_BY_1, KEPT_BY_2, KEPT_SMOOTH, KEPT_FIRST, KEPT_SECOND, KEPT };
// Rows of work: three opponent inputs with borders; opponent filtered; L*a*b*; features.
enum { OUT_Y, OUT_RG, OUT_BY, OUT_L, OUT_A, OUT_B, OUT_EDGE, OUT_POINT, OUTS };
enum { MAX_ROWS = 2 * FLIP_MAX_RADIUS + 1 };

struct side {          // of one image
    float *kept[KEPT]; // rows * width, row y at y % rows
    float *input[3];   // width + 2 radius
    float *out[OUTS];  // width
};

struct image_flip {
    int radius; // of the widest filter
    struct flip_kernel y, rg, by[2], smooth, first, second;
    float by_share[2];
    float table[256];
    uint32_t width; // the memory is for this width
    float *memory;  // owned; all below
    struct side test, reference;
    float *scratch, *values; // width
};

// exp(-pi^2 x^2 / b) is a Gaussian of variance b / (2 pi^2).
static double csf_sd_px(struct csf_term term, double pixels_per_degree)
{
    return sqrt(term.b / (2 * pi * pi)) * pixels_per_degree;
}

static void set_kernels(struct image_flip *flip, double ppd)
{
    double sd = 0.5 * feature_width_deg * ppd;
    int color_radius = (int)ceil(3 * csf_sd_px(csf_by[0], ppd)), feature_radius = (int)ceil(3 * sd);
    flip->radius = color_radius > feature_radius ? color_radius : feature_radius;
    flip->y = flip_gaussian(csf_sd_px(csf_y, ppd), color_radius);
    flip->rg = flip_gaussian(csf_sd_px(csf_rg, ppd), color_radius);
    double share[2];
    for (int i = 0; i < 2; i++) {
        double side = flip_gaussian_sum(csf_sd_px(csf_by[i], ppd), color_radius);
        share[i] = csf_by[i].a * sqrt(pi / csf_by[i].b) * side * side;
        flip->by[i] = flip_gaussian(csf_sd_px(csf_by[i], ppd), color_radius);
    }
    for (int i = 0; i < 2; i++)
        flip->by_share[i] = (float)(share[i] / (share[0] + share[1]));
    flip->smooth = flip_gaussian(sd, feature_radius);
    flip->first = flip_first_derivative(sd, feature_radius);
    flip->second = flip_second_derivative(sd, feature_radius);
}

struct image_flip *image_flip_create(double pixels_per_degree)
{
    if (!(pixels_per_degree >= 1 && pixels_per_degree <= max_pixels_per_degree))
        return NULL;
    struct image_flip *flip = calloc(1, sizeof *flip);
    if (!flip)
        return NULL;
    set_kernels(flip, pixels_per_degree);
    image_linear_table(flip->table);
    return flip;
}

void image_flip_destroy(struct image_flip *flip)
{
    if (!flip)
        return;
    free(flip->memory);
    free(flip);
}

static uint32_t kept_rows(const struct image_flip *flip)
{
    return (uint32_t)(2 * flip->radius + 1);
}

static float *place_side(struct side *side, float *memory, size_t width, size_t rows)
{
    for (int i = 0; i < KEPT; i++, memory += width * rows)
        side->kept[i] = memory;
    for (int i = 0; i < 3; i++, memory += width + rows)
        side->input[i] = memory;
    for (int i = 0; i < OUTS; i++, memory += width)
        side->out[i] = memory;
    return memory;
}

static bool reserve(struct image_flip *flip, uint32_t width)
{
    if (width == flip->width)
        return true;
    size_t rows = kept_rows(flip);
    size_t side = KEPT * width * rows + 3 * (width + rows) + (size_t)OUTS * width;
    float *memory = malloc((2 * side + 2 * (size_t)width) * sizeof *memory);
    if (!memory)
        return false;
    free(flip->memory);
    flip->memory = memory;
    flip->width = width;
    memory = place_side(&flip->test, memory, width, rows);
    memory = place_side(&flip->reference, memory, width, rows);
    flip->scratch = memory;
    flip->values = memory + width;
    return true;
}

static void continue_edges(float *row, uint32_t width, int radius)
{
    for (int k = 1; k <= radius; k++) {
        row[-k] = row[0];
        row[(int)width - 1 + k] = row[width - 1];
    }
}

static void add_input_row(const struct image_flip *flip, struct side *side, const struct image_pixels *image,
                          uint32_t y)
{
    uint32_t width = image->width;
    float *in[3];
    for (int i = 0; i < 3; i++)
        in[i] = side->input[i] + flip->radius;
    flip_opponent_row(image, y, flip->table, in[0], in[1], in[2]);
    for (int i = 0; i < 3; i++)
        continue_edges(in[i], width, flip->radius);
    const struct flip_kernel *kernels[KEPT] = {&flip->y,      &flip->rg,    &flip->by[0], &flip->by[1],
                                               &flip->smooth, &flip->first, &flip->second};
    static const int source[KEPT] = {0, 1, 2, 2, 0, 0, 0};
    for (int i = 0; i < KEPT; i++)
        flip_filter_along(kernels[i], in[source[i]], width,
                          side->kept[i] + (size_t)(y % kept_rows(flip)) * width);
}

// Rows y - radius .. y + radius of what was kept, continued by the first and last row of the image.
struct window {
    const float *row[MAX_ROWS];
};

static void across(const struct image_flip *flip, const struct flip_kernel *kernel, const float *kept,
                   uint32_t y, uint32_t width, uint32_t height, float *out)
{
    struct window window;
    for (int k = -kernel->radius; k <= kernel->radius; k++) {
        int64_t row = (int64_t)y + k;
        row = row < 0 ? 0 : row >= height ? height - 1 : row;
        window.row[k + kernel->radius] = kept + (size_t)((uint64_t)row % kept_rows(flip)) * width;
    }
    flip_filter_across(kernel, window.row + kernel->radius, width, out);
}

static void magnitude(const float *restrict a, uint32_t count, float *restrict inout)
{
    for (uint32_t i = 0; i < count; i++)
        inout[i] = sqrtf(a[i] * a[i] + inout[i] * inout[i]);
}

static void finish_side(const struct image_flip *flip, struct side *side, uint32_t y, uint32_t width,
                        uint32_t height)
{
    float *const *out = side->out, *scratch = flip->scratch;
    across(flip, &flip->y, side->kept[KEPT_Y], y, width, height, out[OUT_Y]);
    across(flip, &flip->rg, side->kept[KEPT_RG], y, width, height, out[OUT_RG]);
    across(flip, &flip->by[0], side->kept[KEPT_BY_1], y, width, height, out[OUT_BY]);
    across(flip, &flip->by[1], side->kept[KEPT_BY_2], y, width, height, scratch);
    for (uint32_t i = 0; i < width; i++)
        out[OUT_BY][i] = flip->by_share[0] * out[OUT_BY][i] + flip->by_share[1] * scratch[i];
    flip_hunt_row(out[OUT_Y], out[OUT_RG], out[OUT_BY], width, out[OUT_L], out[OUT_A], out[OUT_B]);
    across(flip, &flip->smooth, side->kept[KEPT_FIRST], y, width, height, scratch);
    across(flip, &flip->first, side->kept[KEPT_SMOOTH], y, width, height, out[OUT_EDGE]);
    magnitude(scratch, width, out[OUT_EDGE]);
    across(flip, &flip->smooth, side->kept[KEPT_SECOND], y, width, height, scratch);
    across(flip, &flip->second, side->kept[KEPT_SMOOTH], y, width, height, out[OUT_POINT]);
    magnitude(scratch, width, out[OUT_POINT]);
}

// Delta E_f, then Delta E.
static void combine(const struct image_flip *flip, uint32_t width)
{
    float *const *t = flip->test.out, *const *r = flip->reference.out;
    const float *lab[3] = {t[OUT_L], t[OUT_A], t[OUT_B]}, *lab_r[3] = {r[OUT_L], r[OUT_A], r[OUT_B]};
    flip_color_error_row(lab, lab_r, width, flip->values);
    for (uint32_t i = 0; i < width; i++) {
        float edge = fabsf(t[OUT_EDGE][i] - r[OUT_EDGE][i]), point = fabsf(t[OUT_POINT][i] - r[OUT_POINT][i]);
        float feature = sqrtf(0.70710678f * (edge > point ? edge : point));
        if (feature > 0) // else the power is 1
            flip->values[i] = powf(flip->values[i], 1 - (feature < 1 ? feature : 1));
    }
}

bool image_flip_add(struct image_flip *flip, const struct image_pixels *test,
                    const struct image_pixels *reference, const struct image_rings *rings,
                    struct image_ring_sum *sum, float *out_map)
{
    if (!image_pair_ok(test, reference) || !image_rings_fit(rings, test->width, test->height) ||
        !reserve(flip, test->width))
        return false;
    uint32_t width = test->width, height = test->height, next = 0;
    for (uint32_t y = 0; y < height; y++) {
        for (; next < height && next <= y + (uint32_t)flip->radius; next++) {
            add_input_row(flip, &flip->test, test, next);
            add_input_row(flip, &flip->reference, reference, next);
        }
        finish_side(flip, &flip->test, y, width, height);
        finish_side(flip, &flip->reference, y, width, height);
        combine(flip, width);
        image_ring_sum_row(sum, rings, y, 0, width, flip->values, NULL);
        if (out_map)
            memcpy(out_map + (size_t)y * width, flip->values, width * sizeof *out_map);
    }
    return true;
}
