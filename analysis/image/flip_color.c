// Andersson et al. 2020 (see flip.c): the colour pipeline.
#include "analysis/image/flip_color.h"

#include <math.h>
#include <string.h>

// X / Xn, Y / Yn, Z / Zn of a linear sRGB colour: the matrix of IEC 61966-2-1's primaries with each row divided
// by its sum, which is the white. Its digits are the authors' program's (10135552 / 24577794 and so on), so
// that results compare.
static const float ratio_from_rgb[3][3] = {
    {0.4338953888f, 0.3762423726f, 0.1898622385f},
    {0.2126368217f, 0.7151829818f, 0.0721801965f},
    {0.0177524232f, 0.1094656287f, 0.8727819482f},
};
// Its inverse.
static const float rgb_from_ratio[3][3] = {
    {3.080341988f, -1.537398969f, -0.542943019f},
    {-0.921178396f, 1.875929984f, 0.045248412f},
    {0.052881293f, -0.204011206f, 1.151129913f},
};

static const float qc = 0.7f;  // exponent of colour differences, Andersson et al. 2020
static const float pc = 0.4f;  // share of the largest difference that is mapped to ...
static const float pt = 0.95f; // ... this share of 0..1, same
// HyAB of Hunt-adjusted green and blue, the largest in sRGB, to the power of qc: 203.3016547^0.7, computed from
// the definitions in double precision.
static const float cmax = 41.27609841f;

void flip_opponent_row(const struct image_pixels *image, uint32_t row, const float table[256], float *out_y,
                       float *out_rg, float *out_by)
{
    const uint8_t *data = image->data + row * image_row_bytes(image);
    const float(*m)[3] = ratio_from_rgb;
    for (uint32_t i = 0; i < image->width; i++, data += image->channels) {
        float r = table[data[0]], g = table[data[1]], b = table[data[2]];
        float x = m[0][0] * r + m[0][1] * g + m[0][2] * b;
        float y = m[1][0] * r + m[1][1] * g + m[1][2] * b;
        float z = m[2][0] * r + m[2][1] * g + m[2][2] * b;
        out_y[i] = y;
        out_rg[i] = x - y;
        out_by[i] = y - z;
    }
}

// Cube root of a positive normal number: a third of its exponent as first guess (within 4 %), then two of
// Halley's steps (each cubes the error). cbrtf() cannot run on several numbers at once.
static inline float cube_root(float x)
{
    int32_t bits;
    memcpy(&bits, &x, sizeof bits);
    bits =
        (int32_t)((float)bits * (1.f / 3)) + 709921077; // 2/3 of 1.0f's bits, less the mean error of the guess
    float r;
    memcpy(&r, &bits, sizeof r);
    for (int i = 0; i < 2; i++) {
        float cube = r * r * r;
        r *= (cube + 2 * x) / (2 * cube + x);
    }
    return r;
}

// CIE 15: f(t) of L*a*b*, linear below (6/29)^3.
static inline float lab_f(float t)
{
    const float limit = 216.f / 24389, slope = 841.f / 108, offset = 4.f / 29;
    float root = cube_root(t > limit ? t : limit);
    return t > limit ? root : t * slope + offset;
}

static inline float clamp(float v)
{
    v = v > 0 ? v : 0;
    return v < 1 ? v : 1;
}

void flip_hunt_row(const float *restrict in_y, const float *restrict in_rg, const float *restrict in_by,
                   uint32_t count, float *restrict out_l, float *restrict out_a, float *restrict out_b)
{
    const float(*m)[3] = ratio_from_rgb, (*n)[3] = rgb_from_ratio;
    for (uint32_t i = 0; i < count; i++) {
        float y = in_y[i], x = y + in_rg[i], z = y - in_by[i];
        float r = clamp(n[0][0] * x + n[0][1] * y + n[0][2] * z);
        float g = clamp(n[1][0] * x + n[1][1] * y + n[1][2] * z);
        float b = clamp(n[2][0] * x + n[2][1] * y + n[2][2] * z);
        float fx = lab_f(m[0][0] * r + m[0][1] * g + m[0][2] * b);
        float fy = lab_f(m[1][0] * r + m[1][1] * g + m[1][2] * b);
        float fz = lab_f(m[2][0] * r + m[2][1] * g + m[2][2] * b);
        float l = 116 * fy - 16;
        out_l[i] = l;
        out_a[i] = 0.01f * l * 500 * (fx - fy); // Hunt: chroma fades with lightness
        out_b[i] = 0.01f * l * 200 * (fy - fz);
    }
}

void flip_color_error_row(const float *const lab[3], const float *const lab_reference[3], uint32_t count,
                          float *restrict out)
{
    const float *restrict l = lab[0], *restrict a = lab[1], *restrict b = lab[2];
    const float *restrict rl = lab_reference[0], *restrict ra = lab_reference[1],
                          *restrict rb = lab_reference[2];
    for (uint32_t i = 0; i < count; i++) {
        float da = a[i] - ra[i], db = b[i] - rb[i];
        out[i] = fabsf(l[i] - rl[i]) + sqrtf(da * da + db * db);
    }
    for (uint32_t i = 0; i < count; i++) {
        float error = powf(out[i], qc);
        error = error < pc * cmax ? pt / (pc * cmax) * error
                                  : pt + (error - pc * cmax) / (cmax - pc * cmax) * (1 - pt);
        out[i] = error < 1 ? error : 1; // rounding, at green against blue
    }
}
