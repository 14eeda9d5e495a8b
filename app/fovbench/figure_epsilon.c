// Figure 6: time by group of passes against the confidence threshold, stacked.
#include "app/chart/chart.h"
#include "app/fovbench/figure_data.h"
#include "app/fovbench/figures.h"
#include "app/fovbench/passes.h"

#include <math.h>
#include <stdlib.h>

enum { POINTS = 32 };
#define PANEL_WIDTH 520.0
#define PANEL_HEIGHT 330.0
#define TOP (CHART_HEADING + 34)

struct stack {
    double epsilon[POINTS], edges[PASS_GROUPS + 1][POINTS]; // edges[0] is 0
    size_t count;
    double regular_ms; // all its passes
};

static const char *const group_labels[PASS_GROUPS] = {
    "reproject, fill, confidence", "cull and render", "SSAO", "shade", "tone map", "compose and TAA", "other"};

// Figure 6 varies epsilon alone: of lines with the same one the first counts.
static size_t place_of(struct stack *s, double epsilon)
{
    size_t at = s->count;
    for (size_t i = 0; i < s->count; i++)
        if (s->epsilon[i] == epsilon)
            return POINTS;
    if (s->count == POINTS)
        return POINTS;
    for (; at > 0 && s->epsilon[at - 1] > epsilon; at--) {
        s->epsilon[at] = s->epsilon[at - 1];
        for (int g = 0; g <= PASS_GROUPS; g++)
            s->edges[g][at] = s->edges[g][at - 1];
    }
    s->epsilon[at] = epsilon;
    s->count++;
    return at;
}

static double pass_ms(const struct csv_table *table, size_t row, int group)
{
    char column[64];
    snprintf(column, sizeof column, "%s_ms", pass_group_names[group]);
    return figure_number(table, row, column);
}

static void gather(const struct csv_table *table, size_t first, struct stack *out)
{
    *out = (struct stack){.regular_ms = (double)NAN};
    for (size_t row = 0; row < table->row_count; row++) {
        double epsilon = figure_parameter(table, row, "epsilon"), sum = 0;
        if (!figure_same(table, row, first, figure_place) || isnan(pass_ms(table, row, 0)))
            continue;
        size_t at = isnan(epsilon) ? POINTS : place_of(out, epsilon);
        for (int g = 0; g < PASS_GROUPS; g++) {
            sum += pass_ms(table, row, g);
            if (at < POINTS)
                out->edges[g + 1][at] = sum;
        }
        if (csv_column(table, "mode") >= 0 && figure_cell(table, row, "mode")[0] == 'r' && isnan(epsilon))
            out->regular_ms = isnan(out->regular_ms) ? sum : out->regular_ms;
    }
}

static size_t make_series(const struct stack *s, const double *ends_x, const double *ends_y,
                          struct chart_series *out)
{
    size_t count = 0;
    for (int g = 0; g < PASS_GROUPS; g++) {
        double most = 0;
        for (size_t i = 0; i < s->count; i++)
            most = fmax(most, s->edges[g + 1][i] - s->edges[g][i]);
        if (most > 0)
            out[count++] = (struct chart_series){.name = group_labels[g],
                                                 .style = CHART_AREA,
                                                 .colour = g,
                                                 .x = s->epsilon,
                                                 .y = s->edges[g + 1],
                                                 .base = s->edges[g],
                                                 .count = s->count};
    }
    out[count++] = (struct chart_series){.name = "regular, all passes",
                                         .style = CHART_LINE,
                                         .colour = CHART_GRAY,
                                         .x = ends_x,
                                         .y = ends_y,
                                         .count = 2,
                                         .dashed = true};
    return count;
}

static void draw(FILE *out, const struct csv_table *table, size_t first, const struct stack *s, size_t number)
{
    struct chart_series series[PASS_GROUPS + 1];
    char title[FIGURE_TEXT];
    const double ends_x[] = {s->epsilon[0], s->epsilon[s->count - 1]},
                 ends_y[] = {s->regular_ms, s->regular_ms};
    size_t count = make_series(s, ends_x, ends_y, series);
    figure_place_name(table, first, title);
    const struct chart_panel panel = {
        .title = title,
        .x = {"confidence threshold epsilon", s->epsilon[0], s->epsilon[s->count - 1], false, false},
        .y = {"time of the passes, ms (medians)", (double)NAN, (double)NAN, true, false},
        .series = series,
        .series_count = count};
    chart_panel(out, &panel,
                (struct chart_rect){8, TOP + (double)number * PANEL_HEIGHT, PANEL_WIDTH, PANEL_HEIGHT});
    if (number == 0)
        chart_legend(out, series, count, 16, CHART_HEADING + 8, PANEL_WIDTH);
}

bool figure_epsilon(FILE *out, const struct csv_table *table, char *why, size_t why_size)
{
    size_t groups[FIGURE_GROUPS], shown = 0, count = figure_groups(table, figure_place, groups);
    struct stack *stacks = calloc(FIGURE_GROUPS, sizeof *stacks);
    for (size_t i = 0; stacks && i < count; i++) {
        gather(table, groups[i], &stacks[shown]);
        groups[shown] = groups[i];
        shown += stacks[shown].count > 1;
    }
    if (shown) {
        chart_begin(out, PANEL_WIDTH + 16, TOP + (double)shown * PANEL_HEIGHT + 8,
                    "Time against the confidence threshold", figure_cell(table, 0, "device"));
        for (size_t i = 0; i < shown; i++)
            draw(out, table, groups[i], &stacks[i], i);
        chart_end(out);
    } else {
        snprintf(why, why_size,
                 stacks ? "it wants one scene with two values of epsilon or more, measured with --pass-times"
                        : "out of memory");
    }
    free(stacks);
    return shown > 0;
}
