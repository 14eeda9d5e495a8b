// Figure 10: time against resolution, for each mode, with how many times as long regular takes.
#include "app/chart/chart.h"
#include "app/fovbench/figure_data.h"
#include "app/fovbench/figures.h"

#include <math.h>

enum { SIZES = 16 };
#define PANEL_WIDTH 560.0
#define PANEL_HEIGHT 340.0

static const char *const without_size[] = {"device", "scene", "gaze", "ssao", "taa", "rest", NULL};

struct line {
    char name[FIGURE_TEXT], texts[SIZES][16];
    const char *labels[SIZES];
    double megapixels[SIZES], ms[SIZES];
    size_t count;
};

static void add(const struct csv_table *table, size_t row, struct line *line)
{
    size_t at = line->count;
    double megapixels = figure_number(table, row, "width") * figure_number(table, row, "height") / 1e6;
    double ratio = figure_number(table, row, "ratio_to_regular");
    if (line->count == SIZES)
        return;
    for (; at > 0 && line->megapixels[at - 1] > megapixels; at--) {
        line->megapixels[at] = line->megapixels[at - 1];
        line->ms[at] = line->ms[at - 1];
        snprintf(line->texts[at], sizeof line->texts[at], "%s", line->texts[at - 1]);
    }
    line->megapixels[at] = megapixels;
    line->ms[at] = figure_number(table, row, "gpu_ms_median");
    snprintf(line->texts[at], sizeof line->texts[at], "%.2fx", ratio);
    if (isnan(ratio) || figure_cell(table, row, "mode")[0] == 'r')
        line->texts[at][0] = '\0';
    line->count++;
}

static size_t gather(const struct csv_table *table, size_t first, struct line *lines)
{
    size_t modes[FIGURE_GROUPS], count = figure_groups(table, figure_mode, modes), used = 0, most = 0;
    for (size_t m = 0; m < count && used < FIGURE_SERIES; m++) {
        struct line *line = &lines[used];
        *line = (struct line){.count = 0};
        figure_mode_name(table, modes[m], line->name);
        for (size_t row = 0; row < table->row_count; row++)
            if (figure_same(table, row, first, without_size) && figure_same(table, row, modes[m], figure_mode))
                add(table, row, line);
        for (size_t i = 0; i < line->count; i++)
            line->labels[i] = line->texts[i];
        most = line->count > most ? line->count : most;
        used += line->count > 0;
    }
    return most > 1 ? used : 0;
}

static void draw(FILE *out, const struct csv_table *table, size_t first, const struct line *lines, size_t count,
                 size_t number, double top)
{
    struct chart_series series[FIGURE_SERIES];
    char title[FIGURE_TEXT];
    for (size_t i = 0; i < count; i++)
        series[i] = (struct chart_series){.name = lines[i].name,
                                          .style = CHART_LINE_POINTS,
                                          .colour = (int)i - 1, // regular, the first, is gray
                                          .x = lines[i].megapixels,
                                          .y = lines[i].ms,
                                          .labels = lines[i].labels,
                                          .count = lines[i].count};
    snprintf(title, sizeof title, "%s, gaze %s", figure_cell(table, first, "scene"),
             figure_cell(table, first, "gaze"));
    const struct chart_panel panel = {
        .title = title,
        .x = {"megapixels per eye", (double)NAN, (double)NAN, true, false},
        .y = {"GPU time per frame, ms (median)", (double)NAN, (double)NAN, true, false},
        .series = series,
        .series_count = count};
    chart_panel(out, &panel,
                (struct chart_rect){8, top + (double)number * PANEL_HEIGHT, PANEL_WIDTH, PANEL_HEIGHT});
    if (number == 0)
        chart_legend(out, series, count, 16, CHART_HEADING + 8, PANEL_WIDTH);
}

bool figure_resolution(FILE *out, const struct csv_table *table, char *why, size_t why_size)
{
    static const char subtitle[] = "numbers: how many times as long regular takes; ";
    struct line lines[FIGURE_SERIES];
    size_t groups[FIGURE_GROUPS], shown = 0, count = figure_groups(table, without_size, groups), modes = 0;
    char text[FIGURE_TEXT * 2];
    for (size_t i = 0; i < count; i++) {
        size_t here = gather(table, groups[i], lines);
        modes = here > modes ? here : modes;
        groups[shown] = groups[i];
        shown += here > 0;
    }
    if (!shown) {
        snprintf(why, why_size, "it wants one scene at two sizes or more");
        return false;
    }
    const double top = CHART_HEADING + 20 + 18 * (double)((modes + 2) / 3);
    snprintf(text, sizeof text, "%s%s", subtitle, figure_cell(table, 0, "device"));
    chart_begin(out, PANEL_WIDTH + 16, top + (double)shown * PANEL_HEIGHT + 8, "Time against resolution", text);
    for (size_t i = 0; i < shown; i++)
        draw(out, table, groups[i], lines, gather(table, groups[i], lines), i, top);
    chart_end(out);
    return true;
}
