#include "app/display/text_layout.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// The panel keeps to the middle of the view, where headset lenses are sharp; in a small image it may take more
// of the picture, since there the text would not fit otherwise.
#define PANEL_HALF_X_DEG 30.0
#define PANEL_HALF_Y_DEG 28.0
#define PANEL_LEAST_PX 440.0
#define PANEL_MOST 0.94 // of the image, less what vergence shifts the panel sideways
// Before a second page letters may shrink to 1.35 degrees and 9 px, in tiny images to 6 px.
#define CAP_LEAST_SHARE 0.75
#define CAP_LEAST_PX 6.0
#define CAP_SMALL_PX 9.0
#define LINES_LEAST 40.0
#define PARAGRAPH_GAP 0.3 // lines
#define CAP_SHRINK 0.85
static const double style_size[TEXT_STYLES] = {[TEXT_TITLE] = 1.35, [TEXT_BODY] = 1.0, [TEXT_HINT] = 0.9};

// The flow of lines down the pages.
struct flow {
    struct text_layout *layout;
    double room_x, room_y; // the most a panel may take
    const char *more;
    double margin;
    double y, bottom; // next line's top; where lines end on this page
    uint32_t page;
};

static void add_run(struct flow *flow, struct text_run run)
{
    struct text_layout *layout = flow->layout;
    if (layout->run_count == TEXT_RUNS)
        return;
    run.page = flow->page;
    run.top = flow->y;
    run.width = font_width_px(layout->fonts[run.style], run.text, run.bytes);
    layout->runs[layout->run_count++] = run;
}

static void add_centred(struct flow *flow, const char *text, size_t bytes, enum text_style style)
{
    double width = font_width_px(flow->layout->fonts[style], text, bytes);
    add_run(flow,
            (struct text_run){.text = text, .bytes = bytes, .style = style, .x = (flow->room_x - width) / 2});
}

static void end_page(struct flow *flow)
{
    if (flow->more) {
        flow->y += 0.5 * font_line_px(flow->layout->fonts[TEXT_HINT]);
        add_centred(flow, flow->more, strlen(flow->more), TEXT_HINT);
        flow->y += font_line_px(flow->layout->fonts[TEXT_HINT]);
    }
    flow->layout->height[flow->page] = flow->y + flow->margin;
    if (flow->page + 1 < TEXT_PAGES)
        flow->page++;
    flow->y = flow->margin;
}

static void add_line(struct flow *flow, const char *text, size_t bytes, enum text_style style)
{
    double line = font_line_px(flow->layout->fonts[style]);
    if (flow->y + line > flow->bottom && flow->y > flow->margin)
        end_page(flow);
    if (bytes > 0)
        add_centred(flow, text, bytes, style);
    flow->y += line;
}

// How many bytes of the line starting at `text` fit: up to a space where there is one, else to the last
// character.
static size_t fitting(const struct font *font, const char *text, size_t bytes, double room)
{
    const char *end = text + bytes, *cursor = text;
    size_t best = 0, any = 0;
    while (cursor < end) {
        const char *before = cursor;
        uint32_t code = font_next_character(&cursor, end);
        if (code == ' ')
            best = (size_t)(before - text);
        if (font_width_px(font, text, (size_t)(cursor - text)) > room)
            return best > 0 ? best : any > 0 ? any : (size_t)(cursor - text);
        any = (size_t)(cursor - text);
    }
    return bytes;
}

static void add_text(struct flow *flow, const char *text, enum text_style style)
{
    const struct font *font = flow->layout->fonts[style];
    double room = flow->room_x - 2.0 * flow->margin;
    while (text && *text) {
        size_t length = strcspn(text, "\n");
        const char *line = text;
        if (length == 0)
            add_line(flow, line, 0, style);
        while (length > 0) {
            size_t take = fitting(font, line, length, room);
            add_line(flow, line, take, style);
            while (take < length && line[take] == ' ')
                take++;
            line += take;
            length -= take;
        }
        text = *line == '\n' ? line + 1 : line;
        if (*text)
            flow->y += PARAGRAPH_GAP * font_line_px(font);
    }
}

static void add_gap(struct flow *flow)
{
    if (flow->y > flow->margin)
        flow->y += 0.5 * font_line_px(flow->layout->fonts[TEXT_BODY]);
}

// How many numbers a line takes, so that they stay apart; lines are filled evenly.
static int scale_columns(const struct flow *flow, const struct text_screen *screen)
{
    const struct font *font = flow->layout->fonts[TEXT_BODY];
    int count = screen->scale_max - screen->scale_min + 1;
    char low[16], high[16];
    snprintf(low, sizeof low, "%d", screen->scale_min);
    snprintf(high, sizeof high, "%d", screen->scale_max);
    double widest = fmax(font_width_px(font, low, strlen(low)), font_width_px(font, high, strlen(high)));
    double cell = widest + 1.5 * font_width_px(font, "0", 1);
    int most = (int)((flow->room_x - 2.0 * flow->margin) / cell);
    most = most < 1 ? 1 : most;
    int lines = (count + most - 1) / most;
    return (count + lines - 1) / lines;
}

static void add_ends(struct flow *flow, const struct text_screen *screen)
{
    struct text_layout *layout = flow->layout;
    const char *low = screen->scale_low ? screen->scale_low : "",
               *high = screen->scale_high ? screen->scale_high : "";
    double width = font_width_px(layout->fonts[TEXT_HINT], high, strlen(high));
    add_run(flow, (struct text_run){.text = low, .bytes = strlen(low), .style = TEXT_HINT, .x = flow->margin});
    add_run(flow, (struct text_run){.text = high,
                                    .bytes = strlen(high),
                                    .style = TEXT_HINT,
                                    .x = flow->room_x - flow->margin - width});
    flow->y += font_line_px(layout->fonts[TEXT_BODY]);
}

// Numbers spread over the panel, the meanings of the ends below them.
static void add_scale(struct flow *flow, const struct text_screen *screen)
{
    struct text_layout *layout = flow->layout;
    int count = screen->scale_max - screen->scale_min + 1;
    if (count < 2 || count > (int)(sizeof layout->numbers / sizeof layout->numbers[0]))
        return;
    double line = font_line_px(layout->fonts[TEXT_BODY]);
    bool ends = screen->scale_low || screen->scale_high;
    int columns = scale_columns(flow, screen), lines = (count + columns - 1) / columns;
    if (flow->y + (1.2 * lines + (ends ? 1.0 : -0.2)) * line > flow->bottom && flow->y > flow->margin)
        end_page(flow);
    double cell = (flow->room_x - 2.0 * flow->margin) / columns;
    for (int i = 0; i < count; i++) {
        char *number = layout->numbers[i];
        snprintf(number, sizeof layout->numbers[i], "%d", screen->scale_min + i);
        double width = font_width_px(layout->fonts[TEXT_BODY], number, strlen(number));
        if (i > 0 && i % columns == 0)
            flow->y += 1.2 * line;
        add_run(flow, (struct text_run){.text = number,
                                        .bytes = strlen(number),
                                        .style = TEXT_BODY,
                                        .marked = screen->scale_min + i == screen->scale_selected,
                                        .x = flow->margin + cell * (i % columns + 0.5) - width / 2});
    }
    flow->y += 1.2 * line;
    if (ends)
        add_ends(flow, screen);
}

static void destroy_fonts(struct text_layout *layout)
{
    for (int i = 0; i < TEXT_STYLES; i++) {
        font_destroy(layout->fonts[i]);
        layout->fonts[i] = NULL;
    }
}

static bool create_fonts(struct text_layout *layout, double cap_px)
{
    destroy_fonts(layout);
    layout->cap_px = cap_px;
    layout->run_count = 0;
    for (int i = 0; i < TEXT_STYLES; i++)
        if (!(layout->fonts[i] = font_create(cap_px * style_size[i])))
            return false;
    return true;
}

static void lay_out(struct flow *flow, const struct text_screen *screen)
{
    struct text_layout *layout = flow->layout;
    flow->margin = 0.6 * font_line_px(layout->fonts[TEXT_BODY]);
    flow->more = screen->more;
    flow->bottom = flow->room_y - flow->margin;
    if (screen->more)
        flow->bottom -= 1.5 * font_line_px(layout->fonts[TEXT_HINT]);
    flow->y = flow->margin;
    flow->page = 0;
    add_text(flow, screen->title, TEXT_TITLE);
    if (screen->title && *screen->title && screen->body && *screen->body)
        add_gap(flow);
    add_text(flow, screen->body, TEXT_BODY);
    if (screen->scale_max > screen->scale_min) {
        add_gap(flow);
        add_scale(flow, screen);
    }
    if (screen->hint && *screen->hint)
        add_gap(flow);
    add_text(flow, screen->hint, TEXT_HINT);
    layout->height[flow->page] = flow->y + flow->margin;
    layout->page_count = flow->page + 1;
    layout->width = flow->room_x;
}

// Runs are centred in the room; the panel is only as wide as the widest needs.
static void trim(struct text_layout *layout, double margin, bool keep_width)
{
    double left = layout->width, right = 0.0;
    for (size_t i = 0; i < layout->run_count; i++) {
        left = fmin(left, layout->runs[i].x);
        right = fmax(right, layout->runs[i].x + layout->runs[i].width);
    }
    if (keep_width || right <= left)
        return;
    double cut = fmax(0.0, fmin(left, layout->width - right) - margin);
    for (size_t i = 0; i < layout->run_count; i++)
        layout->runs[i].x -= cut;
    layout->width -= 2.0 * cut;
}

bool text_layout_init(struct text_layout *layout, const struct text_view *view,
                      const struct text_screen *screen)
{
    *layout = (struct text_layout){.page_count = 1};
    const double radians = 3.14159265358979323846 / 180.0;
    const struct viewing_fov *fov = &view->fov[EYE_LEFT];
    double per_tan_x = view->width / (fov->tan_left + fov->tan_right);
    double per_tan_y = view->height / (fov->tan_down + fov->tan_up);
    double shift = per_tan_x * view->ipd_m / TEXT_DISTANCE_M; // both eyes' half, twice: the panel stays inside
    struct flow flow = {
        .layout = layout,
        .room_x = fmin(fmax(2.0 * per_tan_x * tan(PANEL_HALF_X_DEG * radians), PANEL_LEAST_PX),
                       view->width * PANEL_MOST - shift),
        .room_y = fmin(fmax(2.0 * per_tan_y * tan(PANEL_HALF_Y_DEG * radians), PANEL_LEAST_PX),
                       view->height * PANEL_MOST),
    };
    double size = screen->size > 0.0 ? screen->size : 1.0;
    double cap = size * fmax(per_tan_y * tan(TEXT_CAP_DEG * radians), TEXT_CAP_MIN_PX);
    double small = fmin(fmax(flow.room_y / LINES_LEAST, CAP_LEAST_PX), CAP_SMALL_PX);
    double least = fmin(cap, fmax(small, per_tan_y * tan(CAP_LEAST_SHARE * TEXT_CAP_DEG * radians)));
    layout->runs = calloc(TEXT_RUNS, sizeof *layout->runs);
    bool done = layout->runs && create_fonts(layout, cap);
    if (done)
        lay_out(&flow, screen);
    while (done && (layout->page_count > 1 || layout->height[0] > flow.room_y) && cap > least) {
        cap = fmax(cap * CAP_SHRINK, least);
        done = create_fonts(layout, cap);
        if (done)
            lay_out(&flow, screen);
    }
    if (!done) {
        text_layout_finish(layout);
        return false;
    }
    trim(layout, flow.margin, screen->scale_max > screen->scale_min);
    return true;
}

void text_layout_finish(struct text_layout *layout)
{
    destroy_fonts(layout);
    free(layout->runs);
    layout->runs = NULL;
}
