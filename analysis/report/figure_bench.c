// Speed against error, one scene: to the right is faster, above is nearer to the reference.
#include "analysis/report/figures.h"

#include <math.h>
#include <string.h>

bool figure_bench(const struct bench *bench, const char *scene, const struct figure_desc *desc, char **out_svg,
                  char *error, size_t error_size)
{
    struct figure figure;
    int font = desc->narrow ? 12 : 15;
    if (!figure_begin(&figure, desc->narrow ? FIGURE_NARROW_PX : FIGURE_WIDE_PX, desc->narrow ? 320 : 400, font,
                      error, error_size))
        return false;
    double low = 1, high = 1;                 // of speed
    for (int front = 0; front < 2; front++) { // block 0: beaten ones; block 1: the front
        fputs("nan nan \"\"\n", figure.data);
        for (size_t i = 0; i < bench->count; i++) {
            const struct bench_row *row = &bench->rows[i];
            if (!row->number || row->front != front || strcmp(row->scene, scene) != 0)
                continue;
            low = fmin(low, row->speed);
            high = fmax(high, row->speed);
            char label[BENCH_WORD + 24];
            snprintf(label, sizeof label, desc->narrow ? "%zu" : "%zu %s", row->number, row->mode);
            fprintf(figure.data, "%.9g %.9g ", row->speed, row->wpsnr_db);
            figure_word(figure.data, label);
            fputc('\n', figure.data);
        }
        fputs("\n\n", figure.data);
    }
    const char *device = "";
    for (size_t i = 0; i < bench->count; i++)
        if (strcmp(bench->rows[i].scene, scene) == 0)
            device = bench->rows[i].device;
    char where[2 * BENCH_WORD];
    snprintf(where, sizeof where, desc->narrow ? "%.30s" : "%.40s on %.60s", scene, device);
    fputs("1 1 ", figure.data); // block 2: above the right corner; block 3: above the left one
    figure_word(figure.data, where);
    fputs("\n\n\n0 1 \"weighted PSNR\"\n", figure.data);
    if (high > low)
        fprintf(figure.script, "set xtics %.9g\n", figure_tic_step(1.3 * (high - low), desc->narrow ? 4 : 8));
    fputs("set x2range [0:1]\nset y2range [0:1]\nset offsets graph 0.06,graph 0.22,graph 0.1,graph 0.08\nset "
          "lmargin 7\nset rmargin 3\nset tmargin "
          "1.8\n"
          "set bmargin 3\nset xtics format '%gx'\nset ytics format '%g dB' offset 0.5,0\n"
          "set grid xtics ytics lw 0.6 lt 1 lc rgb '#dfe2e8'\n"
          "set xlabel 'speed relative to regular' tc rgb '" FIGURE_INK "' offset 0,0.3\n"
          "plot 'data' index 1 using 1:2 smooth unique with lines lw 1.5 lc rgb '" FIGURE_BLUE "'"
          ", '' index 0 using 1:2 with points pt 7 ps 0.9 lc rgb '" FIGURE_PALE "'"
          ", '' index 1 using 1:2 with points pt 7 ps 1.2 lc rgb '" FIGURE_BLUE "'"
          ", '' index 0 using 1:2:3 with labels left offset 0.8,-0.6 tc rgb '" FIGURE_INK "'"
          ", '' index 1 using 1:2:3 with labels left offset 0.8,0.6 tc rgb '" FIGURE_INK "'"
          ", '' index 2 using 1:2:3 axes x2y2 with labels right offset 0,0.8 tc rgb '" FIGURE_INK "'"
          ", '' index 3 using 1:2:3 axes x2y2 with labels left offset -5,0.8 tc rgb '" FIGURE_INK "'\n",
          figure.script);
    return figure_end(&figure, desc->text, out_svg, error, error_size);
}
