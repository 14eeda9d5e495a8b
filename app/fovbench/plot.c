#include "app/fovbench/plot.h"

#include "app/chart/chart.h"
#include "app/fovbench/pareto.h"
#include "app/fovbench/request.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define PANEL_WIDTH 470.0
#define PANEL_HEIGHT 330.0
#define LEGEND_HEIGHT 30.0
#define SHEET_MARGIN 8.0

// One measure of a group's modes over their times.
struct points {
    double ms[REQUEST_MODES], value[REQUEST_MODES], cost[REQUEST_MODES]; // cost: less is better
    const char *labels[REQUEST_MODES];
    bool on_front[REQUEST_MODES];
    size_t count;
};

struct measure {
    const char *label;
    void (*value)(const struct row *row, double *out_value, double *out_cost);
};

// The reference has an infinite PSNR: it stands as a line, not as a point.
static void weighted_psnr(const struct row *row, double *out_value, double *out_cost)
{
    *out_value = row->error.wpsnr_db;
    *out_cost = -row->error.wpsnr_db;
}

static void flip(const struct row *row, double *out_value, double *out_cost)
{
    *out_value = *out_cost = row->error.flip;
}

static const struct measure measures[] = {
    {"eccentricity-weighted PSNR, dB (up is better)", weighted_psnr},
    {"mean FLIP (down is better)", flip},
};
enum { MEASURES = sizeof measures / sizeof measures[0] };

// What distinguishes a point beside its colour: its parameters as the command line had them.
static const char *point_label(const struct row *row)
{
    const char *colon = strchr(row->label, ':');
    return colon ? colon + 1 : row->label;
}

static int colour_of(const struct row *rows, size_t mode)
{
    int colour = CHART_GRAY;
    for (size_t i = 0; i <= mode; i++) {
        bool seen = false;
        for (size_t j = 0; j < i; j++)
            seen = seen || strcmp(rows[j].mode, rows[i].mode) == 0;
        if (!seen && i > 0)
            colour++;
        if (strcmp(rows[i].mode, rows[mode].mode) == 0)
            break;
    }
    return colour;
}

static bool gather(const struct row *rows, size_t mode_count, const struct measure *measure, struct points *out)
{
    out->count = mode_count;
    for (size_t i = 0; i < mode_count; i++) {
        out->ms[i] = rows[i].times.gpu_ms_median;
        out->labels[i] = point_label(&rows[i]);
        measure->value(&rows[i], &out->value[i], &out->cost[i]);
    }
    return pareto_front(out->ms, out->cost, mode_count, out->on_front);
}

// The front's points in the order of time.
static size_t front_line(const struct points *p, double *x, double *y)
{
    size_t count = 0;
    double last = -(double)INFINITY;
    for (;;) {
        size_t next = p->count;
        for (size_t i = 0; i < p->count; i++)
            if (p->on_front[i] && isfinite(p->value[i]) && p->ms[i] > last &&
                (next == p->count || p->ms[i] < p->ms[next]))
                next = i;
        if (next == p->count)
            return count;
        last = x[count] = p->ms[next];
        y[count++] = p->value[next];
    }
}

// One series for each point, for each has its own colour and may be hollow.
static size_t point_series(const struct row *rows, const struct points *p, struct chart_series *out)
{
    for (size_t i = 0; i < p->count; i++)
        out[i] = (struct chart_series){.name = rows[i].mode,
                                       .style = CHART_POINTS,
                                       .colour = colour_of(rows, i),
                                       .x = &p->ms[i],
                                       .y = &p->value[i],
                                       .labels = &p->labels[i],
                                       .count = 1,
                                       .hollow = !p->on_front[i],
                                       .size = 4.5};
    return p->count;
}

static bool write_panel(FILE *out, const struct row *rows, size_t mode_count, const struct measure *measure,
                        struct chart_rect place)
{
    struct points points;
    struct chart_series series[REQUEST_MODES + 2];
    double x[REQUEST_MODES], y[REQUEST_MODES];
    char title[512];
    if (!gather(rows, mode_count, measure, &points))
        return false;
    const double regular_x[] = {points.ms[0], points.ms[0]};
    double low = (double)INFINITY, high = -(double)INFINITY;
    for (size_t i = 0; i < points.count; i++)
        if (isfinite(points.value[i])) {
            low = fmin(low, points.value[i]);
            high = fmax(high, points.value[i]);
        }
    const double regular_y[] = {low, high};
    size_t count = 0;
    series[count++] = (struct chart_series){
        .style = CHART_LINE, .colour = CHART_GRAY, .x = regular_x, .y = regular_y, .count = 2, .dashed = true};
    size_t front = front_line(&points, x, y);
    series[count++] =
        (struct chart_series){.style = CHART_STEP, .colour = CHART_GRAY, .x = x, .y = y, .count = front};
    count += point_series(rows, &points, series + count);
    snprintf(title, sizeof title, "%s, %ux%u, gaze %s", rows[0].scene, rows[0].width, rows[0].height,
             rows[0].gaze);
    const struct chart_panel panel = {
        .title = title,
        .x = {"GPU time per frame, ms (median)", (double)NAN, (double)NAN, true, false},
        .y = {measure->label, (double)NAN, (double)NAN, false, false},
        .series = series,
        .series_count = count};
    chart_panel(out, &panel, place);
    return true;
}

static void write_legend(FILE *out, const struct row *rows, size_t mode_count)
{
    struct chart_series series[REQUEST_MODES + 4];
    size_t count = 0;
    for (size_t i = 0; i < mode_count; i++)
        series[count++] =
            (struct chart_series){.name = rows[i].mode, .style = CHART_POINTS, .colour = colour_of(rows, i)};
    series[count++] = (struct chart_series){
        .name = "beaten by another", .style = CHART_POINTS, .colour = CHART_GRAY, .hollow = true};
    series[count++] = (struct chart_series){.name = "Pareto front", .style = CHART_STEP, .colour = CHART_GRAY};
    series[count++] = (struct chart_series){
        .name = "time of regular", .style = CHART_LINE, .colour = CHART_GRAY, .dashed = true};
    chart_legend(out, series, count, 16, CHART_HEADING + 14, MEASURES * PANEL_WIDTH);
}

bool plot_write(FILE *out, const struct row *rows, size_t group_count, size_t mode_count)
{
    char subtitle[512];
    const double top = CHART_HEADING + LEGEND_HEIGHT;
    bool ok = true;
    snprintf(subtitle, sizeof subtitle,
             "%s; median of %llu frames, errors against regular over %llu of them%s%s", rows[0].device,
             (unsigned long long)rows[0].frames, (unsigned long long)rows[0].error_frames,
             rows[0].ssao ? "; SSAO" : "", rows[0].taa ? "; TAA" : "");
    chart_begin(out, MEASURES * PANEL_WIDTH + 2 * SHEET_MARGIN,
                top + (double)group_count * PANEL_HEIGHT + SHEET_MARGIN, "Error over time", subtitle);
    write_legend(out, rows, mode_count);
    for (size_t g = 0; g < group_count; g++)
        for (size_t i = 0; ok && i < MEASURES; i++)
            ok = write_panel(out, rows + g * mode_count, mode_count, &measures[i],
                             (struct chart_rect){SHEET_MARGIN + (double)i * PANEL_WIDTH,
                                                 top + (double)g * PANEL_HEIGHT, PANEL_WIDTH, PANEL_HEIGHT});
    chart_end(out);
    return ok;
}
