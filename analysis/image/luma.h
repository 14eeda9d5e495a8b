// Rows of stored 8-bit sRGB as rows of floats: what several measures share. Private to analysis/image.
#ifndef ANALYSIS_IMAGE_LUMA_H
#define ANALYSIS_IMAGE_LUMA_H

#include "analysis/image/view.h"

// 0.299 R' + 0.587 G' + 0.114 B', ITU-R BT.601, in levels of 0..255, minus `offset`.
void image_luma_row(const struct image_pixels *image, uint32_t y, float offset, float *out);

// Linear value of a stored level, IEC 61966-2-1: 0..1.
void image_linear_table(float table[256]);

// Linear luminance 0.2126 R + 0.7152 G + 0.0722 B, ITU-R BT.709: 0..1, by image_linear_table()'s table.
void image_luminance_row(const struct image_pixels *image, uint32_t y, const float table[256], float *out);

#endif
