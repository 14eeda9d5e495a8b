#include "app/display/text.h"

#include "app/display/font.h"
#include "app/display/text_layout.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

struct colour {
    double r, g, b, a; // sRGB, 0..1
};

// Dark and translucent, so that white text stands out over any picture and over gray.
static const struct colour panel = {0.04, 0.04, 0.05, 0.82};
static const struct colour ink[] = {
    [TEXT_TITLE] = {1.0, 1.0, 1.0, 1.0},
    [TEXT_BODY] = {0.95, 0.95, 0.95, 1.0},
    [TEXT_HINT] = {0.75, 0.78, 0.85, 1.0},
};
static const struct colour mark = {1.0, 0.82, 0.2, 1.0};

// Straight-alpha "over".
static void cover(uint8_t *pixel, struct colour colour, double coverage)
{
    double a = colour.a * coverage, below = pixel[3] / 255.0, all = a + below * (1.0 - a);
    const double c[3] = {colour.r, colour.g, colour.b};
    for (int i = 0; i < 3 && all > 0.0; i++)
        pixel[i] = (uint8_t)lround(255.0 * (c[i] * a + pixel[i] / 255.0 * below * (1.0 - a)) / all);
    pixel[3] = (uint8_t)lround(255.0 * all);
}

static void fill(struct text_image *image, double x0, double y0, double x1, double y1, struct colour colour)
{
    int right = (int)fmin(image->width, round(x1)), bottom = (int)fmin(image->height, round(y1));
    for (int y = (int)fmax(0.0, round(y0)); y < bottom; y++)
        for (int x = (int)fmax(0.0, round(x0)); x < right; x++)
            cover(&image->rgba[4 * ((size_t)y * image->width + (size_t)x)], colour, 1.0);
}

static void ink_coverage(struct text_image *image, const struct font_canvas *canvas, struct colour colour)
{
    size_t count = (size_t)canvas->width * (size_t)canvas->height;
    for (size_t i = 0; i < count; i++)
        if (canvas->coverage[i])
            cover(&image->rgba[4 * i], colour, canvas->coverage[i] / 255.0);
    memset(canvas->coverage, 0, count);
}

static void draw_run(struct text_image *image, const struct font_canvas *canvas, const struct text_run *run,
                     const struct font *font)
{
    if (run->marked) {
        double line = font_line_px(font), pad = line * 0.28;
        fill(image, run->x - pad, run->top, run->x + run->width + pad, run->top + line, mark);
    }
    font_draw(font, run->text, run->bytes, run->x, run->top + font_ascent_px(font), canvas);
    ink_coverage(image, canvas, run->marked ? (struct colour){0.05, 0.05, 0.05, 1.0} : ink[run->style]);
}

// Where the panel's middle falls in each eye: a point straight ahead of the head.
static bool place(const struct text_view *view, struct text_image *image)
{
    for (int eye = 0; eye < EYES; eye++) {
        double x = 0.0, y = 0.0, side = eye == EYE_LEFT ? 0.5 : -0.5;
        struct dvec3 middle = {side * view->ipd_m, 0.0, -TEXT_DISTANCE_M};
        if (!viewing_pixel(&view->fov[eye], view->width, view->height, middle, &x, &y))
            return false;
        image->left[eye] = (int32_t)lround(x - image->width / 2.0);
        image->top[eye] = (int32_t)lround(y - image->height / 2.0);
    }
    return true;
}

void text_view_init(struct text_view *view, const struct viewing_fov *fov, uint32_t width, uint32_t height,
                    double ipd_m)
{
    *view = (struct text_view){.fov = {*fov, *fov}, .width = width, .height = height, .ipd_m = ipd_m};
}

static bool draw_page(const struct text_layout *layout, uint32_t page, struct text_image *out)
{
    out->width = (uint32_t)ceil(layout->width);
    out->height = (uint32_t)ceil(layout->height[page]);
    out->rgba = calloc((size_t)out->width * out->height, 4);
    struct font_canvas canvas = {.width = (int)out->width, .height = (int)out->height};
    canvas.coverage = calloc((size_t)out->width * out->height, 1);
    if (out->rgba && canvas.coverage) {
        fill(out, 0, 0, out->width, out->height, panel);
        for (size_t i = 0; i < layout->run_count; i++)
            if (layout->runs[i].page == page)
                draw_run(out, &canvas, &layout->runs[i], layout->fonts[layout->runs[i].style]);
    }
    bool done = out->rgba && canvas.coverage;
    free(canvas.coverage);
    return done;
}

bool text_draw(const struct text_view *view, const struct text_screen *screen, uint32_t page,
               struct text_image *out)
{
    *out = (struct text_image){0};
    struct text_layout layout;
    if (!viewing_fov_ok(&view->fov[EYE_LEFT]) || view->width < 16 || view->height < 16)
        return false;
    if (!text_layout_init(&layout, view, screen))
        return false;
    out->pages = layout.page_count;
    out->page = page < layout.page_count ? page : layout.page_count - 1;
    out->cap_px = layout.cap_px;
    bool done = draw_page(&layout, out->page, out) && place(view, out);
    text_layout_finish(&layout);
    if (!done)
        text_image_finish(out);
    return done;
}

void text_image_finish(struct text_image *image)
{
    free(image->rgba);
    *image = (struct text_image){0};
}
