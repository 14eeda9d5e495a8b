// Figures 12 and 13: triangles and shaded pixels of every frame. Figure 14: time against the share of moving
// pixels.
#include "app/chart/chart.h"
#include "app/fovbench/figure_data.h"
#include "app/fovbench/figures.h"

#include <math.h>
#include <stdlib.h>

#define PANEL_WIDTH 760.0
#define PANEL_HEIGHT 300.0

struct kind {
    const char *title, *x_label, *y_label;
    const char *x_column, *y_column;
    double x_scale, y_scale;
    enum chart_style style;
    const char *nothing;
};

static const struct kind triangles = {
    "Triangles of every frame",   "frame", "triangles drawn, both eyes", "frame", "triangles", 1, 1, CHART_LINE,
    "it wants two frames or more"};
static const struct kind shaded = {
    "Pixels shaded in every frame", "frame", "pixels shaded per eye", "frame", "shaded_px", 1, 0.5, CHART_LINE,
    "it wants two frames or more"};
static const struct kind moving = {
    "Time against moving pixels",
    "share of pixels that something moving covers, %",
    "GPU time per frame, ms",
    "moving_share",
    "gpu_ms",
    100,
    1,
    CHART_POINTS,
    "it wants frames whose share of moving pixels was measured (without --no-errors), "
    "two or more and not all the same"};

struct curve {
    char name[FIGURE_TEXT];
    double *x, *y; // owned by one block
    size_t count;
};

static bool gather_curve(const struct csv_table *table, size_t place, size_t mode, const struct kind *kind,
                         struct curve *out)
{
    const int x = csv_column(table, kind->x_column), y = csv_column(table, kind->y_column);
    *out = (struct curve){.x = calloc(2 * table->row_count, sizeof(double))};
    if (!out->x)
        return false;
    out->y = out->x + table->row_count;
    figure_mode_name(table, mode, out->name);
    for (size_t row = 0; row < table->row_count; row++)
        if (figure_same(table, row, place, figure_place) && figure_same(table, row, mode, figure_mode) &&
            isfinite(csv_number(table, row, x))) {
            out->x[out->count] = kind->x_scale * csv_number(table, row, x);
            out->y[out->count++] = kind->y_scale * csv_number(table, row, y);
        }
    return true;
}

static void finish(struct curve *curves, size_t count)
{
    for (size_t i = 0; i < count; i++)
        free(curves[i].x);
}

static size_t gather(const struct csv_table *table, size_t place, const struct kind *kind, struct curve *curves)
{
    size_t modes[FIGURE_GROUPS], count = figure_groups(table, figure_mode, modes), used = 0;
    for (size_t m = 0; m < count && used < FIGURE_SERIES; m++)
        if (gather_curve(table, place, modes[m], kind, &curves[used])) {
            const struct curve *c = &curves[used];
            bool spread = false;
            for (size_t i = 1; i < c->count; i++)
                spread = spread || c->x[i] != c->x[0];
            if (spread)
                used++;
            else
                finish(&curves[used], 1);
        }
    return used;
}

static void mean_label(const struct curve *c, const struct kind *kind, char out[FIGURE_TEXT + 32])
{
    double sum = 0;
    for (size_t i = 0; i < c->count; i++)
        sum += c->y[i] / (double)c->count;
    if (kind->style == CHART_LINE)
        snprintf(out, FIGURE_TEXT + 32, "%.*s (mean %.0f)", FIGURE_TEXT, c->name, sum);
    else
        snprintf(out, FIGURE_TEXT + 32, "%.*s", FIGURE_TEXT, c->name);
}

// The legend stands above each panel: it tells that panel's means.
static void draw(FILE *out, const struct csv_table *table, size_t place, const struct kind *kind,
                 const struct curve *curves, size_t count, double top, double legend_height)
{
    struct chart_series series[FIGURE_SERIES];
    char title[FIGURE_TEXT], names[FIGURE_SERIES][FIGURE_TEXT + 32];
    for (size_t i = 0; i < count; i++) {
        mean_label(&curves[i], kind, names[i]);
        series[i] = (struct chart_series){.name = names[i],
                                          .style = kind->style,
                                          .colour = (int)i - 1, // regular, the first, is gray
                                          .x = curves[i].x,
                                          .y = curves[i].y,
                                          .count = curves[i].count};
    }
    figure_place_name(table, place, title);
    const struct chart_panel panel = {.title = title,
                                      .x = {kind->x_label, (double)NAN, (double)NAN, true, false},
                                      .y = {kind->y_label, (double)NAN, (double)NAN, true, false},
                                      .series = series,
                                      .series_count = count};
    chart_legend(out, series, count, 16, top + 8, PANEL_WIDTH - 16);
    chart_panel(out, &panel, (struct chart_rect){8, top + legend_height, PANEL_WIDTH, PANEL_HEIGHT});
}

static bool sheet(FILE *out, const struct csv_table *table, const struct kind *kind, char *why, size_t why_size)
{
    struct curve curves[FIGURE_SERIES];
    size_t places[FIGURE_GROUPS], shown = 0, count = figure_groups(table, figure_place, places), most = 0;
    for (size_t i = 0; i < count; i++) {
        size_t here = gather(table, places[i], kind, curves);
        finish(curves, here);
        most = here > most ? here : most;
        places[shown] = places[i];
        shown += here > 0;
    }
    if (!shown) {
        snprintf(why, why_size, "%s", kind->nothing);
        return false;
    }
    const double legend_height = 16 + 18 * (double)((most + 1) / 2), height = PANEL_HEIGHT + legend_height;
    chart_begin(out, PANEL_WIDTH + 16, CHART_HEADING + (double)shown * height + 8, kind->title,
                figure_cell(table, 0, "device"));
    for (size_t i = 0; i < shown; i++) {
        size_t here = gather(table, places[i], kind, curves);
        draw(out, table, places[i], kind, curves, here, CHART_HEADING + (double)i * height, legend_height);
        finish(curves, here);
    }
    chart_end(out);
    return true;
}

bool figure_triangles(FILE *out, const struct csv_table *table, char *why, size_t why_size)
{
    return sheet(out, table, &triangles, why, why_size);
}

bool figure_shaded(FILE *out, const struct csv_table *table, char *why, size_t why_size)
{
    return sheet(out, table, &shaded, why, why_size);
}

bool figure_moving(FILE *out, const struct csv_table *table, char *why, size_t why_size)
{
    return sheet(out, table, &moving, why, why_size);
}
