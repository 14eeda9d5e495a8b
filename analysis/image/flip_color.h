// The colour spaces of FLIP, row by row. Private to analysis/image.
#ifndef ANALYSIS_IMAGE_FLIP_COLOR_H
#define ANALYSIS_IMAGE_FLIP_COLOR_H

#include "analysis/image/view.h"

// Opponent colours without the scales that YCxCz gives them (filters are linear, so the scales cancel):
// y = Y / Yn, rg = X / Xn - Y / Yn, by = Y / Yn - Z / Zn. `table`: luma.h's image_linear_table().
void flip_opponent_row(const struct image_pixels *image, uint32_t y, const float table[256], float *out_y,
                       float *out_rg, float *out_by);

// From filtered opponent colours, clamped to what a screen can show, to Hunt-adjusted L*a*b*.
void flip_hunt_row(const float *y, const float *rg, const float *by, uint32_t count, float *out_l, float *out_a,
                   float *out_b);

// HyAB distance of two rows of Hunt-adjusted colours, redistributed to 0..1 (the paper's Delta E_c).
void flip_color_error_row(const float *const lab[3], const float *const lab_reference[3], uint32_t count,
                          float *out);

#endif
