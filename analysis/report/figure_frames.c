#include "analysis/report/figures.h"

#include <math.h>
#include <string.h>

static bool drawn(const struct frame_group *g)
{
    return g->condition != SAMPLE_NONE && strcmp(g->phase, "stimulus") == 0 && (g->gpu.count || g->cpu.count);
}

size_t figure_frames_rows(const struct frames *frames)
{
    size_t rows = 0;
    for (size_t i = 0; i < frames->group_count; i++)
        rows += drawn(&frames->groups[i]);
    return rows;
}

// Whose time is drawn.
static const char *clock_words(const struct frames *frames)
{
    size_t gpu = 0, rows = figure_frames_rows(frames);
    for (size_t i = 0; i < frames->group_count; i++)
        gpu += drawn(&frames->groups[i]) && frames->groups[i].gpu.count;
    return gpu == rows ? "GPU" : gpu == 0 ? "CPU" : "GPU or CPU";
}

static double write_rows(FILE *data, const struct sample *sample, const struct frames *frames)
{
    double most = 0;
    size_t row = 0;
    for (size_t i = 0; i < frames->group_count; i++) {
        const struct frame_group *g = &frames->groups[i];
        if (!drawn(g))
            continue;
        const struct frame_times *t = g->gpu.count ? &g->gpu : &g->cpu;
        fprintf(data, "%zu %.6f %.6f %.6f ", row++, t->median, t->p95, t->p99);
        char words[320];
        snprintf(words, sizeof words, "%s: %.*f ms", sample->conditions[g->condition].words,
                 t->median < 10 ? 2 : 1, t->median);
        figure_word(data, words);
        fputc('\n', data);
        most = fmax(most, t->p99);
    }
    return most;
}

bool figure_frames(const struct sample *sample, const struct frames *frames, const struct figure_desc *desc,
                   char **out_svg, char *error, size_t error_size)
{
    struct figure figure;
    size_t rows = figure_frames_rows(frames);
    int font = desc->narrow ? 12 : 14;
    if (!figure_begin(&figure, desc->narrow ? FIGURE_NARROW_PX : FIGURE_WIDE_PX, 80 + 44 * (int)rows, font,
                      error, error_size))
        return false;
    double most = fmax(write_rows(figure.data, sample, frames), 0.001);
    fprintf(figure.script,
            "set yrange [%.2f:-0.75]\nset xrange [0:%.6g]\nunset ytics\nset xtics 0,%.6g format '%%g ms'\n"
            "set lmargin 3\nset rmargin 3\nset tmargin 0.5\nset bmargin 3\n"
            "set xlabel '%s time per frame' tc rgb '" FIGURE_INK "' offset 0,0.4\n"
            "set grid xtics lw 0.6 lt 1 lc rgb '#dfe2e8'\n",
            (double)rows - 0.4, most * 1.04, figure_tic_step(most, desc->narrow ? 5 : 8), clock_words(frames));
    fputs("plot 'data' using 2:1:($4-$2):(0) with vectors nohead lw 5 lc rgb '" FIGURE_GREEN
          "', '' using 2:1:($3-$2):(0) with vectors nohead lw 5 lc rgb '" FIGURE_GREEN_EDGE
          "', '' using 2:1 with points pt 7 ps 1.2 lc rgb '" FIGURE_ORANGE
          "', '' using (0):($1-0.42):5 with labels left offset 0.3,0 tc rgb '" FIGURE_INK "'\n",
          figure.script);
    return figure_end(&figure, desc->text, out_svg, error, error_size);
}
