#include "app/command/png.h"

#include <stb/stb_image_write.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

static void append(void *context, void *data, int size)
{
    FILE *file = context;
    fwrite(data, 1, (size_t)size, file); // a failure stays in ferror
}

static uint8_t *without_alpha(const uint8_t *rgba, size_t count)
{
    uint8_t *rgb = malloc(3 * count);
    for (size_t i = 0; rgb && i < count; i++) {
        rgb[3 * i] = rgba[4 * i];
        rgb[3 * i + 1] = rgba[4 * i + 1];
        rgb[3 * i + 2] = rgba[4 * i + 2];
    }
    return rgb;
}

bool png_write(const char *path, uint32_t width, uint32_t height, int channels, const uint8_t *pixels)
{
    char temporary[4096];
    if (snprintf(temporary, sizeof temporary, "%s.part", path) >= (int)sizeof temporary)
        return false;
    const int written = channels == 4 ? 3 : channels;
    uint8_t *rgb = channels == 4 ? without_alpha(pixels, (size_t)width * height) : NULL;
    FILE *file = channels == 4 && !rgb ? NULL : fopen(temporary, "wb");
    bool ok = false;
    if (file) {
        ok = stbi_write_png_to_func(append, file, (int)width, (int)height, written, rgb ? rgb : pixels,
                                    (int)width * written) != 0;
        ok = !ferror(file) && ok;
        ok = fclose(file) == 0 && ok;
        ok = ok && rename(temporary, path) == 0;
        if (!ok)
            unlink(temporary);
    }
    free(rgb);
    return ok;
}
