#include "app/session/overlay.h"

#include <string.h>

void overlay_init(struct overlay *overlay, struct renderer *renderer, const struct text_view *view)
{
    memset(overlay, 0, sizeof *overlay);
    overlay->renderer = renderer;
    overlay->view = *view;
}

static bool draw(struct overlay *overlay)
{
    struct text_image image;
    struct text_screen text = screen_text(&overlay->screen);
    if (!overlay->screen.shown) {
        overlay->page = overlay->pages = 0;
        return renderer_set_overlay(overlay->renderer, NULL);
    }
    if (!text_draw(&overlay->view, &text, overlay->page, &image))
        return false;
    overlay->page = image.page;
    overlay->pages = image.pages;
    struct renderer_overlay over = {.rgba = image.rgba, .width = image.width, .height = image.height};
    memcpy(over.left, image.left, sizeof over.left);
    memcpy(over.top, image.top, sizeof over.top);
    bool done = renderer_set_overlay(overlay->renderer, &over);
    text_image_finish(&image);
    return done;
}

// A marked number does not turn a question back to its first page.
static bool same_but_selection(const struct screen *a, const struct screen *b)
{
    struct screen other = *b;
    other.scale_selected = a->scale_selected;
    return screen_same(a, &other);
}

bool overlay_set(struct overlay *overlay, const struct screen *screen)
{
    if (screen_same(&overlay->screen, screen))
        return true;
    if (!same_but_selection(&overlay->screen, screen))
        overlay->page = 0;
    overlay->screen = *screen;
    return draw(overlay);
}

bool overlay_turn(struct overlay *overlay, int pages)
{
    int64_t page = (int64_t)overlay->page + pages;
    if (page < 0 || page >= overlay->pages)
        return true;
    overlay->page = (uint32_t)page;
    return draw(overlay);
}

bool overlay_last_page(const struct overlay *overlay)
{
    return overlay->page + 1 >= overlay->pages;
}
