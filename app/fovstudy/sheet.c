#include "app/fovstudy/sheet.h"

#include "app/command/png.h"
#include "app/display/font.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { GAP = 8 };                           // pixels between things
static const uint8_t paper = 24, ink = 235; // gray levels, dark like most pictures' borders
static const double cap_least = 9,
                    cap_share = 56; // label's capitals: pixels, or this part of a picture's height

struct page {
    uint32_t column, line, width, height; // of a column, of a line of text, of all
    uint8_t *rgba, *coverage;
    struct font *font;
};

bool sheet_init(struct sheet *sheet, uint32_t rows, uint32_t width, uint32_t height)
{
    *sheet = (struct sheet){
        .width = width, .height = height, .rows = rows, .cells = calloc(rows, sizeof *sheet->cells)};
    return sheet->cells != NULL;
}

void sheet_finish(struct sheet *sheet)
{
    for (uint32_t row = 0; sheet->cells && row < sheet->rows; row++)
        for (int column = 0; column < SHEET_COLUMNS; column++)
            free(sheet->cells[row][column].rgba);
    free(sheet->cells);
    *sheet = (struct sheet){0};
}

static uint32_t text_width(const struct page *page, const char *text)
{
    return (uint32_t)ceil(font_width_px(page->font, text, strlen(text)));
}

// Columns are as wide as the widest thing in any of them; those without a picture in any row are left out.
static uint32_t measure(const struct sheet *sheet, struct page *page)
{
    uint32_t columns = 1;
    page->column = sheet->width;
    page->line = (uint32_t)ceil(font_line_px(page->font));
    for (uint32_t row = 0; row < sheet->rows; row++) {
        for (uint32_t column = 0; column < SHEET_COLUMNS; column++) {
            const struct sheet_cell *cell = &sheet->cells[row][column];
            const uint32_t width = cell->rgba ? text_width(page, cell->label) : 0;
            page->column = width > page->column ? width : page->column;
            columns = cell->rgba && column + 1 > columns ? column + 1 : columns;
        }
    }
    const uint32_t title = text_width(page, sheet->title) + 2 * GAP;
    page->width = GAP + columns * (page->column + GAP);
    page->width = title > page->width ? title : page->width;
    page->height = GAP + page->line + sheet->rows * (GAP + page->line + sheet->height) + GAP;
    return columns;
}

static void write_text(struct page *page, const char *text, uint32_t x, uint32_t y)
{
    const struct font_canvas canvas = {page->coverage, (int)page->width, (int)page->height};
    font_draw(page->font, text, strlen(text), x, y + font_ascent_px(page->font), &canvas);
}

static void place(struct page *page, const struct sheet *sheet, const struct sheet_cell *cell, uint32_t x,
                  uint32_t y)
{
    write_text(page, cell->label, x, y);
    for (uint32_t line = 0; line < sheet->height; line++)
        memcpy(page->rgba + 4 * ((size_t)(y + page->line + line) * page->width + x),
               cell->rgba + 4 * (size_t)line * sheet->width, 4 * (size_t)sheet->width);
}

static void lay_ink(struct page *page)
{
    for (size_t i = 0; i < (size_t)page->width * page->height; i++)
        for (int c = 0; page->coverage[i] && c < 3; c++) {
            uint8_t *value = &page->rgba[4 * i + (size_t)c];
            *value = (uint8_t)(*value + (ink - *value) * page->coverage[i] / 255);
        }
}

static bool draw(const struct sheet *sheet, struct page *page)
{
    page->font = font_create(fmax(cap_least, sheet->height / cap_share));
    if (!page->font)
        return false;
    const uint32_t columns = measure(sheet, page);
    const size_t pixels = (size_t)page->width * page->height;
    page->rgba = malloc(4 * pixels);
    page->coverage = calloc(pixels, 1);
    if (!page->rgba || !page->coverage)
        return false;
    memset(page->rgba, paper, 4 * pixels);
    write_text(page, sheet->title, GAP, GAP);
    for (uint32_t row = 0; row < sheet->rows; row++)
        for (uint32_t column = 0; column < columns; column++)
            if (sheet->cells[row][column].rgba)
                place(page, sheet, &sheet->cells[row][column], GAP + column * (page->column + GAP),
                      GAP + page->line + GAP + row * (GAP + page->line + sheet->height));
    lay_ink(page);
    return true;
}

bool sheet_write(const struct sheet *sheet, const char *path, char *error, size_t error_size)
{
    struct page page = {0};
    bool done = draw(sheet, &page);
    if (!done)
        snprintf(error, error_size, "out of memory");
    else if (!(done = png_write(path, page.width, page.height, 4, page.rgba)))
        snprintf(error, error_size, "cannot write %s: %s", path, strerror(errno));
    free(page.rgba);
    free(page.coverage);
    font_destroy(page.font);
    return done;
}
