#include "app/fovstudy/picture.h"

#include <stdio.h>
#include <stdlib.h>

void picture_subtract(const uint8_t *a, const uint8_t *b, size_t pixels, uint8_t *out,
                      struct picture_difference *sum)
{
    for (size_t i = 0; i < 4 * pixels; i++) {
        int d = abs(a[i] - b[i]);
        out[i] = (uint8_t)(PICTURE_STRONGER * d < 255 ? PICTURE_STRONGER * d : 255);
        sum->max = d > sum->max ? d : sum->max;
        sum->total += d;
        sum->values += i % 4 != 3;
    }
}

void picture_log(void *user, enum renderer_log_level level, const char *sentence)
{
    (void)user;
    if (level != RENDERER_INFO)
        fprintf(stderr, "fovstudy: %s\n", sentence);
}
