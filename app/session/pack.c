#include "app/session/pack.h"

#include <lz4.h>

enum { CHANNELS = 3 };

size_t pack_scratch(size_t pixels)
{
    return CHANNELS * pixels;
}

size_t pack_bound(size_t pixels)
{
    return pack_scratch(pixels) > LZ4_MAX_INPUT_SIZE ? 0 : (size_t)LZ4_compressBound((int)pack_scratch(pixels));
}

size_t pack(const uint8_t *rgba, size_t pixels, uint8_t *scratch, uint8_t *out, size_t out_size)
{
    uint8_t last[CHANNELS] = {0};
    if (pack_scratch(pixels) > LZ4_MAX_INPUT_SIZE || out_size > INT32_MAX)
        return 0;
    for (size_t i = 0; i < pixels; i++) {
        for (size_t c = 0; c < CHANNELS; c++) {
            uint8_t value = rgba[4 * i + c];
            scratch[CHANNELS * i + c] = (uint8_t)(value - last[c]);
            last[c] = value;
        }
    }
    int size =
        LZ4_compress_default((const char *)scratch, (char *)out, (int)pack_scratch(pixels), (int)out_size);
    return size > 0 ? (size_t)size : 0;
}

bool unpack(const uint8_t *packed, size_t size, size_t pixels, uint8_t *scratch, uint8_t *out_rgba)
{
    uint8_t red = 0, green = 0, blue = 0;
    size_t bytes = pack_scratch(pixels);
    if (size > INT32_MAX || bytes > LZ4_MAX_INPUT_SIZE ||
        LZ4_decompress_safe((const char *)packed, (char *)scratch, (int)size, (int)bytes) != (int)bytes)
        return false;
    for (size_t i = 0; i < pixels; i++) {
        out_rgba[4 * i] = red = (uint8_t)(red + scratch[3 * i]);
        out_rgba[4 * i + 1] = green = (uint8_t)(green + scratch[3 * i + 1]);
        out_rgba[4 * i + 2] = blue = (uint8_t)(blue + scratch[3 * i + 2]);
        out_rgba[4 * i + 3] = 255;
    }
    return true;
}
