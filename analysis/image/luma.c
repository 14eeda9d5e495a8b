// ITU-R BT.601-7 (luma of stored values), IEC 61966-2-1 (sRGB) and ITU-R BT.709-6 (luminance of its primaries).
#include "analysis/image/luma.h"

#include <math.h>

void image_luma_row(const struct image_pixels *image, uint32_t y, float offset, float *out)
{
    const uint8_t *data = image->data + y * image_row_bytes(image);
    uint32_t step = image->channels;
    for (uint32_t x = 0; x < image->width; x++, data += step)
        out[x] = 0.299f * (float)data[0] + 0.587f * (float)data[1] + 0.114f * (float)data[2] - offset;
}

void image_linear_table(float table[256])
{
    for (int i = 0; i < 256; i++) {
        double s = i / 255.0;
        table[i] = (float)(s <= 0.04045 ? s / 12.92 : pow((s + 0.055) / 1.055, 2.4));
    }
}

void image_luminance_row(const struct image_pixels *image, uint32_t y, const float table[256], float *out)
{
    const uint8_t *data = image->data + y * image_row_bytes(image);
    uint32_t step = image->channels;
    for (uint32_t x = 0; x < image->width; x++, data += step)
        out[x] = 0.2126f * table[data[0]] + 0.7152f * table[data[1]] + 0.0722f * table[data[2]];
}
