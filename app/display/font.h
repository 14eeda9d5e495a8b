// The one typeface, embedded: sizes, widths and glyph pixels. Read-only; any thread.
#ifndef APP_DISPLAY_FONT_H
#define APP_DISPLAY_FONT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

struct font; // owned by its creator

struct font *font_create(double cap_px); // NULL: out of memory or a broken font file
void font_destroy(struct font *font);    // NULL is fine

double font_ascent_px(const struct font *font);
double font_line_px(const struct font *font);
// Width of a run of UTF-8, kerning included.
double font_width_px(const struct font *font, const char *text, size_t bytes);

struct font_canvas {
    uint8_t *coverage; // width * height, 0..255; glyphs are added by maximum
    int width, height;
};
// Draws a run with its baseline at y, from x; what falls outside the canvas is cut.
void font_draw(const struct font *font, const char *text, size_t bytes, double x, double y,
               const struct font_canvas *canvas);

// The code point at *cursor, which moves past it; a broken byte counts as U+FFFD. 0 at `end`.
uint32_t font_next_character(const char **cursor, const char *end);

#endif
