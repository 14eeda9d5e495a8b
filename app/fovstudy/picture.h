// What the commands that write pictures share: the renderer's sentences on stderr, and the difference of two.
#ifndef APP_FOVSTUDY_PICTURE_H
#define APP_FOVSTUDY_PICTURE_H

#include "renderer/renderer.h"

#include <stddef.h>
#include <stdint.h>

enum { PICTURE_STRONGER = 8 }; // so that a few levels can be seen

struct picture_difference {
    double total, values; // of rgb, in levels of 0..255
    int max;
};

// Writes |a - b|, PICTURE_STRONGER times as strong, over rgba of `pixels` pixels and adds it to *sum; `out` may
// be a or b.
void picture_subtract(const uint8_t *a, const uint8_t *b, size_t pixels, uint8_t *out,
                      struct picture_difference *sum);
// For struct renderer_log: warnings and errors.
void picture_log(void *user, enum renderer_log_level level, const char *sentence);

#endif
