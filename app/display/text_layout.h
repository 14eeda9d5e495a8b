// Breaks a screen's text into lines and pages and gives every run of glyphs its place on the panel.
#ifndef APP_DISPLAY_TEXT_LAYOUT_H
#define APP_DISPLAY_TEXT_LAYOUT_H

#include "app/display/font.h"
#include "app/display/text.h"

enum text_style { TEXT_TITLE, TEXT_BODY, TEXT_HINT, TEXT_STYLES };
enum { TEXT_PAGES = 32, TEXT_RUNS = 1024 }; // what is beyond is left out

struct text_run {
    const char *text; // borrowed from the screen, or from the layout's numbers
    size_t bytes;
    enum text_style style;
    bool marked;
    uint32_t page;
    double x, top, width; // pixels from the panel's upper left corner; top of the line
};

struct text_layout {
    struct font *fonts[TEXT_STYLES]; // owned
    struct text_run *runs;           // owned
    size_t run_count;
    double width; // of the panel
    double height[TEXT_PAGES];
    uint32_t page_count;
    double cap_px;
    char numbers[64][8]; // the scale's labels
};

// False: out of memory.
bool text_layout_init(struct text_layout *layout, const struct text_view *view,
                      const struct text_screen *screen);
void text_layout_finish(struct text_layout *layout);

#endif
