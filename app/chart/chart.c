// Colours: Okabe & Ito 2008, "Color Universal Design", told apart by every kind of colour vision; their yellow
// is left out, too light on white.
#include "app/chart/chart.h"

#include <math.h>
#include <string.h>

static const char *const palette[CHART_COLOURS] = {"#0072b2", "#d55e00", "#009e73", "#cc79a7",
                                                   "#e69f00", "#56b4e9", "#6a3d9a", "#000000"};
static const char *const gray = "#8a8f98", *const ink = "#22262b", *const grid = "#e4e7eb";

enum { TICKS = 6, LOG_TICKS = 24 };
#define POINT_RADIUS 3.5
#define MARGIN_LEFT 62.0
#define MARGIN_BOTTOM 44.0
#define MARGIN_TOP 26.0
#define MARGIN_RIGHT 14.0

// Where values fall.
struct frame_map {
    double x_min, x_max, y_min, y_max;
    bool x_log, y_log;
    struct chart_rect plot;
};

static const char *colour_of(int colour)
{
    return colour < 0 ? gray : palette[colour % CHART_COLOURS];
}

static void text(FILE *out, const char *value)
{
    for (; *value; value++)
        if (*value == '<' || *value == '>' || *value == '&')
            fprintf(out, "&#%d;", *value);
        else
            fputc(*value, out);
}

static void label(FILE *out, double x, double y, const char *attributes, const char *value)
{
    fprintf(out, "<text x=\"%.1f\" y=\"%.1f\" %s>", x, y, attributes);
    text(out, value);
    fputs("</text>\n", out);
}

void chart_begin(FILE *out, double width, double height, const char *title, const char *subtitle)
{
    fprintf(
        out,
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"%.0f\" height=\"%.0f\" viewBox=\"0 0 %.0f %.0f\" "
        "font-family=\"Helvetica, Arial, 'DejaVu Sans', sans-serif\" font-size=\"12\" fill=\"%s\">\n"
        "<rect width=\"100%%\" height=\"100%%\" fill=\"#ffffff\"/>\n",
        width, height, width, height, ink);
    label(out, 16, 24, "font-size=\"16\" font-weight=\"bold\"", title);
    label(out, 16, 44, "fill=\"#555b63\"", subtitle);
}

void chart_end(FILE *out)
{
    fputs("</svg>\n", out);
}

static bool usable(double value, bool logarithmic)
{
    return isfinite(value) && (!logarithmic || value > 0);
}

static void widen(const double *values, size_t count, bool logarithmic, double *min, double *max)
{
    for (size_t i = 0; values && i < count; i++)
        if (usable(values[i], logarithmic)) {
            *min = fmin(*min, values[i]);
            *max = fmax(*max, values[i]);
        }
}

// The axis's ends: those given, else those of the data with a margin of 5 %.
static void finish_range(const struct chart_axis *axis, double *min, double *max)
{
    if (!(*min <= *max)) {
        *min = axis->logarithmic ? 1 : 0;
        *max = axis->logarithmic ? 10 : 1;
    }
    if (axis->logarithmic) {
        double margin = fmax(pow(*max / *min, 0.06), 1.08);
        *min /= margin;
        *max *= margin;
    } else {
        double margin = *max > *min ? 0.06 * (*max - *min) : fmax(fabs(*max) * 0.1, 0.1);
        *min = axis->from_zero && *min >= 0 ? 0 : *min - margin;
        *max += margin;
    }
    *min = isnan(axis->min) ? *min : axis->min;
    *max = isnan(axis->max) ? *max : axis->max;
}

static struct frame_map map_of(const struct chart_panel *panel, struct chart_rect place)
{
    struct frame_map m = {.x_min = (double)INFINITY,
                          .x_max = -(double)INFINITY,
                          .y_min = (double)INFINITY,
                          .y_max = -(double)INFINITY,
                          .x_log = panel->x.logarithmic,
                          .y_log = panel->y.logarithmic,
                          .plot = {place.left + MARGIN_LEFT, place.top + MARGIN_TOP,
                                   place.width - MARGIN_LEFT - MARGIN_RIGHT,
                                   place.height - MARGIN_TOP - MARGIN_BOTTOM}};
    for (size_t i = 0; i < panel->series_count; i++) {
        const struct chart_series *s = &panel->series[i];
        widen(s->x, s->count, m.x_log, &m.x_min, &m.x_max);
        widen(s->y, s->count, m.y_log, &m.y_min, &m.y_max);
        widen(s->base, s->count, m.y_log, &m.y_min, &m.y_max);
    }
    finish_range(&panel->x, &m.x_min, &m.x_max);
    finish_range(&panel->y, &m.y_min, &m.y_max);
    return m;
}

static double part(double value, double min, double max, bool logarithmic)
{
    return logarithmic ? log(value / min) / log(max / min) : (value - min) / (max - min);
}

static double map_x(const struct frame_map *m, double x)
{
    return m->plot.left + m->plot.width * part(x, m->x_min, m->x_max, m->x_log);
}

static double map_y(const struct frame_map *m, double y)
{
    return m->plot.top + m->plot.height * (1 - part(y, m->y_min, m->y_max, m->y_log));
}

static size_t log_ticks(double min, double max, double *out)
{
    static const double parts[] = {1, 2, 5};
    size_t count = 0;
    for (double power = pow(10, floor(log10(min))); power <= max; power *= 10)
        for (size_t i = 0; i < 3 && count < LOG_TICKS; i++)
            if (power * parts[i] >= min && power * parts[i] <= max)
                out[count++] = power * parts[i];
    return count;
}

static void number_text(double value, char out[32])
{
    const double size = fabs(value);
    if (size >= 1e6)
        snprintf(out, 32, "%.4gM", value / 1e6);
    else if (size >= 1e4)
        snprintf(out, 32, "%.4gk", value / 1e3);
    else
        snprintf(out, 32, "%.4g", size < 1e-12 ? 0 : value);
}

static void write_grid(FILE *out, const struct frame_map *m)
{
    double ticks[LOG_TICKS];
    char number[32];
    size_t count =
        m->x_log ? log_ticks(m->x_min, m->x_max, ticks) : chart_ticks(m->x_min, m->x_max, TICKS, ticks);
    const double bottom = m->plot.top + m->plot.height, right = m->plot.left + m->plot.width;
    for (size_t i = 0; i < count; i++) {
        double x = map_x(m, ticks[i]);
        fprintf(out, "<path d=\"M%.1f %.1fV%.1f\" stroke=\"%s\"/>\n", x, m->plot.top, bottom, grid);
        number_text(ticks[i], number);
        label(out, x, bottom + 16, "text-anchor=\"middle\" font-size=\"11\"", number);
    }
    count = m->y_log ? log_ticks(m->y_min, m->y_max, ticks) : chart_ticks(m->y_min, m->y_max, TICKS, ticks);
    for (size_t i = 0; i < count; i++) {
        double y = map_y(m, ticks[i]);
        fprintf(out, "<path d=\"M%.1f %.1fH%.1f\" stroke=\"%s\"/>\n", m->plot.left, y, right, grid);
        number_text(ticks[i], number);
        label(out, m->plot.left - 6, y + 4, "text-anchor=\"end\" font-size=\"11\"", number);
    }
    fprintf(out, "<path d=\"M%.1f %.1fV%.1fH%.1f\" fill=\"none\" stroke=\"%s\"/>\n", m->plot.left, m->plot.top,
            bottom, right, ink);
}

static void write_axis_labels(FILE *out, const struct chart_panel *panel, const struct frame_map *m)
{
    char turned[128];
    const double middle = m->plot.top + m->plot.height / 2, left = m->plot.left - 46;
    label(out, m->plot.left, m->plot.top - 10, "font-weight=\"bold\"", panel->title);
    label(out, m->plot.left + m->plot.width / 2, m->plot.top + m->plot.height + 36, "text-anchor=\"middle\"",
          panel->x.label);
    snprintf(turned, sizeof turned, "text-anchor=\"middle\" transform=\"rotate(-90 %.1f %.1f)\"", left, middle);
    label(out, left, middle, turned, panel->y.label);
}

static bool shown(const struct frame_map *m, const struct chart_series *s, size_t i)
{
    return usable(s->x[i], m->x_log) && usable(s->y[i], m->y_log);
}

static void write_line(FILE *out, const struct frame_map *m, const struct chart_series *s)
{
    bool pen = false;
    fputs("<path d=\"", out);
    for (size_t i = 0; i < s->count; i++) {
        if (!shown(m, s, i)) {
            pen = false;
            continue;
        }
        double x = map_x(m, s->x[i]), y = map_y(m, s->y[i]);
        if (pen && s->style == CHART_STEP)
            fprintf(out, "H%.2f", x);
        fprintf(out, "%c%.2f %.2f", pen ? 'L' : 'M', x, y);
        pen = true;
    }
    fprintf(out, "\" fill=\"none\" stroke=\"%s\" stroke-width=\"%s\"%s stroke-linejoin=\"round\"/>\n",
            colour_of(s->colour), s->count > 200 ? "1" : "1.8", s->dashed ? " stroke-dasharray=\"5 4\"" : "");
}

static void write_area(FILE *out, const struct frame_map *m, const struct chart_series *s)
{
    fputs("<path d=\"", out);
    for (size_t i = 0; i < s->count; i++)
        fprintf(out, "%c%.2f %.2f", i ? 'L' : 'M', map_x(m, s->x[i]), map_y(m, s->y[i]));
    for (size_t i = s->count; i > 0; i--)
        fprintf(out, "L%.2f %.2f", map_x(m, s->x[i - 1]), map_y(m, s->base ? s->base[i - 1] : 0));
    fprintf(out, "Z\" fill=\"%s\" fill-opacity=\"0.8\"/>\n", colour_of(s->colour));
}

static void write_points(FILE *out, const struct frame_map *m, const struct chart_series *s)
{
    const char *colour = colour_of(s->colour);
    for (size_t i = 0; i < s->count; i++) {
        if (!shown(m, s, i))
            continue;
        double x = map_x(m, s->x[i]), y = map_y(m, s->y[i]);
        fprintf(out,
                "<circle cx=\"%.2f\" cy=\"%.2f\" r=\"%.1f\" fill=\"%s\" stroke=\"%s\" stroke-width=\"1.5\"/>\n",
                x, y, s->size > 0 ? s->size : POINT_RADIUS, s->hollow ? "#ffffff" : colour,
                s->hollow ? colour : "none");
        if (s->labels && s->labels[i])
            label(out, x + 7, y - 6,
                  "font-size=\"10\" paint-order=\"stroke\" stroke=\"#ffffff\" stroke-width=\"3\"",
                  s->labels[i]);
    }
}

void chart_panel(FILE *out, const struct chart_panel *panel, struct chart_rect place)
{
    const struct frame_map m = map_of(panel, place);
    write_grid(out, &m);
    for (size_t i = 0; i < panel->series_count; i++) {
        const struct chart_series *s = &panel->series[i];
        if (s->style == CHART_AREA)
            write_area(out, &m, s);
        if (s->style == CHART_LINE || s->style == CHART_LINE_POINTS || s->style == CHART_STEP)
            write_line(out, &m, s);
        if (s->style == CHART_POINTS || s->style == CHART_LINE_POINTS)
            write_points(out, &m, s);
    }
    write_axis_labels(out, panel, &m);
}

static void write_mark(FILE *out, const struct chart_series *s, double x, double y)
{
    const char *colour = colour_of(s->colour);
    if (s->style == CHART_AREA)
        fprintf(out,
                "<rect x=\"%.1f\" y=\"%.1f\" width=\"18\" height=\"10\" fill=\"%s\" fill-opacity=\"0.8\"/>\n",
                x, y - 9, colour);
    else if (s->style == CHART_POINTS)
        fprintf(out,
                "<circle cx=\"%.1f\" cy=\"%.1f\" r=\"4\" fill=\"%s\" stroke=\"%s\" stroke-width=\"1.5\"/>\n",
                x + 9, y - 4, s->hollow ? "#ffffff" : colour, s->hollow ? colour : "none");
    else
        fprintf(out, "<path d=\"M%.1f %.1fh18\" stroke=\"%s\" stroke-width=\"2\"%s/>\n", x, y - 4, colour,
                s->dashed ? " stroke-dasharray=\"5 4\"" : "");
}

void chart_legend(FILE *out, const struct chart_series *series, size_t count, double left, double top,
                  double width)
{
    double x = left, y = top;
    for (size_t i = 0; i < count; i++) {
        bool known = !series[i].name;
        for (size_t j = 0; j < i && !known; j++)
            known = series[j].name && strcmp(series[j].name, series[i].name) == 0;
        if (known)
            continue;
        double needed = 36 + 6.8 * (double)strlen(series[i].name); // a guess at the width of 12 px letters
        if (x > left && x + needed > left + width) {
            x = left;
            y += 18;
        }
        write_mark(out, &series[i], x, y);
        label(out, x + 24, y, "", series[i].name);
        x += needed;
    }
}
