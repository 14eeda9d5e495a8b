// Figures as SVG, written directly: lines, points, stacked areas and steps in panels with axes and a legend.
//
// Use: chart_begin -> chart_panel for each panel, at a place of the sheet -> chart_legend -> chart_end. Sizes
// are SVG pixels. Values that are not finite (or not positive on a logarithmic axis) are left out of a series;
// a line then has a gap. Does not: own data, choose what to show, or read files.
#ifndef APP_CHART_CHART_H
#define APP_CHART_CHART_H

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

enum chart_style { CHART_POINTS, CHART_LINE, CHART_LINE_POINTS, CHART_AREA, CHART_STEP };

struct chart_axis {
    const char *label;
    double min, max; // NaN: from the data, with a margin
    bool from_zero;  // min 0 where it comes from the data
    bool logarithmic;
};

struct chart_series {
    const char *name; // in the legend; NULL: not there
    enum chart_style style;
    int colour;                // index of the palette; CHART_GRAY
    const double *x, *y;       // borrowed
    const double *base;        // CHART_AREA: its lower edge; NULL: 0
    const char *const *labels; // beside points; NULL: none
    size_t count;
    bool dashed, hollow;
    double size; // of points, radius; 0: the default
};

enum { CHART_GRAY = -1, CHART_COLOURS = 8 };

struct chart_rect {
    double left, top, width, height;
};

struct chart_panel {
    const char *title;
    struct chart_axis x, y;
    const struct chart_series *series;
    size_t series_count;
};

void chart_begin(FILE *out, double width, double height, const char *title, const char *subtitle);
// The rectangle holds title, axes and their labels.
void chart_panel(FILE *out, const struct chart_panel *panel, struct chart_rect place);
// One row of names; from `left`, `top` down. Series with the name of an earlier one are left out.
void chart_legend(FILE *out, const struct chart_series *series, size_t count, double left, double top,
                  double width);
void chart_end(FILE *out);

// The height that chart_begin takes for title and subtitle.
#define CHART_HEADING 58.0

// Round numbers from min to max for an axis: the step is 1, 2 or 5 times a power of ten. Returns how many, at
// most `most`; none for an empty or endless range.
size_t chart_ticks(double min, double max, size_t most, double *out);

#endif
