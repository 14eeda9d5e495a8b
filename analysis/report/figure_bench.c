// Speed against error of one group: to the right is faster, above is nearer to the reference.
#include "analysis/report/figures.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { FONT_PX = 15, NARROW_FONT_PX = 12 };
enum { LONGEST = 100, NARROW_LONGEST = 50 }; // bytes of a heading that the figure is wide enough for

// Block 0: beaten points; block 1: the front. Returns how far speeds reach apart, 1 among them.
static double write_points(FILE *data, const struct bench *bench, size_t group, bool narrow)
{
    double low = 1, high = 1;
    for (int front = 0; front < 2; front++) {
        fputs("nan nan \"\"\n", data);
        for (size_t i = 0; i < bench->count; i++) {
            const struct bench_row *row = &bench->rows[i];
            if (row->group != group || !row->number || row->front != front)
                continue;
            low = fmin(low, row->speed);
            high = fmax(high, row->speed);
            char label[BENCH_WORD + 24];
            snprintf(label, sizeof label, narrow ? "%zu" : "%zu %s", row->number, row->mode);
            fprintf(data, "%.9g %.9g ", row->speed, row->wpsnr_db);
            figure_word(data, label);
            fputc('\n', data);
        }
        fputs("\n\n", data);
    }
    return high - low;
}

// Blocks 2 and 3: what was measured, and what the upright axis shows, above its left corner.
static void write_headings(FILE *data, const struct bench_group *group, bool narrow)
{
    char where[3 * BENCH_WORD + 32];
    snprintf(where, sizeof where, "%s on %s%s%s", group->scene, group->device, group->setting[0] ? ", " : "",
             group->setting);
    figure_cut(where, narrow ? NARROW_LONGEST : LONGEST);
    fputs("0 1 ", data);
    figure_word(data, where);
    fputs("\n\n\n0 1 \"PSNR against regular, weighted by eccentricity\"\n", data);
}

bool figure_bench(const struct bench *bench, size_t group, const struct figure_desc *desc, char **out_svg,
                  char *error, size_t error_size)
{
    struct figure figure;
    if (!figure_begin(&figure, desc->narrow ? FIGURE_NARROW_PX : FIGURE_WIDE_PX, desc->narrow ? 340 : 430,
                      desc->narrow ? NARROW_FONT_PX : FONT_PX, error, error_size))
        return false;
    double reach = write_points(figure.data, bench, group, desc->narrow);
    write_headings(figure.data, &bench->groups[group], desc->narrow);
    if (reach > 0)
        fprintf(figure.script, "set xtics %.9g\n", figure_tic_step(1.3 * reach, desc->narrow ? 4 : 8));
    fputs("set x2range [0:1]\nset y2range [0:1]\nset offsets graph 0.06,graph 0.22,graph 0.1,graph 0.08\n"
          "set lmargin 7\nset rmargin 3\nset tmargin 3.2\nset bmargin 3\n"
          "set xtics format '%g\u00d7'\nset ytics format '%g dB' offset 0.5,0\n"
          "set grid xtics ytics lw 0.6 lt 1 lc rgb '#dfe2e8'\n"
          "set xlabel 'speed relative to regular' tc rgb '" FIGURE_INK "' offset 0,0.3\n"
          "plot 'data' index 1 using 1:2 smooth unique with lines lw 1.5 lc rgb '" FIGURE_BLUE "'"
          ", '' index 0 using 1:2 with points pt 7 ps 0.9 lc rgb '" FIGURE_PALE "'"
          ", '' index 1 using 1:2 with points pt 7 ps 1.2 lc rgb '" FIGURE_BLUE "'"
          ", '' index 0 using 1:2:3 with labels left offset 0.8,-0.6 tc rgb '" FIGURE_INK "'"
          ", '' index 1 using 1:2:3 with labels left offset 0.8,0.6 tc rgb '" FIGURE_INK "'"
          ", '' index 2 using 1:2:3 axes x2y2 with labels left offset -5,2.2 tc rgb '" FIGURE_INK "'"
          ", '' index 3 using 1:2:3 axes x2y2 with labels left offset -5,0.9 tc rgb '" FIGURE_INK "'\n",
          figure.script);
    return figure_end(&figure, desc->text, out_svg, error, error_size);
}
