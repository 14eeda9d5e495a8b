#include "app/display/font.h"

#include "dejavu_sans.h"

#include <math.h>
#include <stdlib.h>

// The library is one header; its code does not meet our warnings.
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wsign-conversion"
#pragma GCC diagnostic ignored "-Wshadow"
#pragma GCC diagnostic ignored "-Wunused-function"
#pragma GCC diagnostic ignored "-Wcast-qual"
#define STB_TRUETYPE_IMPLEMENTATION
#define STBTT_STATIC
#include <stb_truetype.h>
#pragma GCC diagnostic pop

struct font {
    stbtt_fontinfo info;
    float scale;
    double ascent_px, line_px;
};

struct font *font_create(double cap_px)
{
    struct font *font = calloc(1, sizeof *font);
    if (!font)
        return NULL;
    int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
    if (!stbtt_InitFont(&font->info, dejavu_sans, 0) ||
        !stbtt_GetCodepointBox(&font->info, 'H', &x0, &y0, &x1, &y1) || y1 <= 0) {
        free(font);
        return NULL;
    }
    int ascent = 0, descent = 0, gap = 0;
    stbtt_GetFontVMetrics(&font->info, &ascent, &descent, &gap);
    font->scale = (float)(cap_px / y1);
    font->ascent_px = ascent * (double)font->scale;
    font->line_px = (ascent - descent + gap) * (double)font->scale * 1.15;
    return font;
}

void font_destroy(struct font *font)
{
    free(font);
}

double font_ascent_px(const struct font *font)
{
    return font->ascent_px;
}

double font_line_px(const struct font *font)
{
    return font->line_px;
}

uint32_t font_next_character(const char **cursor, const char *end)
{
    const unsigned char *p = (const unsigned char *)*cursor;
    size_t left = (size_t)(end - *cursor);
    if (left == 0)
        return 0;
    size_t length = p[0] < 0x80                   ? 1
                    : p[0] >= 0xc2 && p[0] < 0xe0 ? 2
                    : (p[0] & 0xf0) == 0xe0       ? 3
                    : p[0] >= 0xf0 && p[0] < 0xf5 ? 4
                                                  : 0;
    if (length == 0 || length > left) {
        *cursor += 1;
        return 0xfffd;
    }
    uint32_t code = length == 1 ? p[0] : p[0] & (0x7fu >> length);
    for (size_t i = 1; i < length; i++) {
        if ((p[i] & 0xc0) != 0x80) {
            *cursor += 1;
            return 0xfffd;
        }
        code = code << 6 | (p[i] & 0x3fu);
    }
    *cursor += length;
    return code;
}

static double advance(const struct font *font, uint32_t code, uint32_t next)
{
    int width = 0, bearing = 0;
    stbtt_GetCodepointHMetrics(&font->info, (int)code, &width, &bearing);
    if (next)
        width += stbtt_GetCodepointKernAdvance(&font->info, (int)code, (int)next);
    return width * (double)font->scale;
}

double font_width_px(const struct font *font, const char *text, size_t bytes)
{
    const char *end = text + bytes;
    double width = 0.0;
    uint32_t code = font_next_character(&text, end);
    while (code) {
        uint32_t next = font_next_character(&text, end);
        width += advance(font, code, next);
        code = next;
    }
    return width;
}

static void blit(const struct font_canvas *canvas, const uint8_t *glyph, int width, int height, int left,
                 int top)
{
    for (int y = 0; y < height; y++) {
        for (int x = 0; x < width; x++) {
            int cx = left + x, cy = top + y;
            if (cx < 0 || cy < 0 || cx >= canvas->width || cy >= canvas->height)
                continue;
            uint8_t *to = &canvas->coverage[(size_t)cy * (size_t)canvas->width + (size_t)cx];
            uint8_t from = glyph[y * width + x];
            *to = *to > from ? *to : from;
        }
    }
}

void font_draw(const struct font *font, const char *text, size_t bytes, double x, double y,
               const struct font_canvas *canvas)
{
    const char *end = text + bytes;
    uint32_t code = font_next_character(&text, end);
    while (code) {
        uint32_t next = font_next_character(&text, end);
        int width = 0, height = 0, left = 0, top = 0;
        float shift = (float)(x - floor(x));
        unsigned char *glyph = stbtt_GetCodepointBitmapSubpixel(&font->info, font->scale, font->scale, shift,
                                                                0.0f, (int)code, &width, &height, &left, &top);
        if (glyph)
            blit(canvas, glyph, width, height, (int)floor(x) + left, (int)lround(y) + top);
        stbtt_FreeBitmap(glyph, NULL);
        x += advance(font, code, next);
        code = next;
    }
}
