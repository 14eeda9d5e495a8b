#include "analysis/report/figures.h"

#include <math.h>
#include <string.h>

// A heading for each factor and a row for each of its levels.
static size_t row_count(const struct factorial *f)
{
    size_t rows = 0;
    for (size_t j = 0; j < f->factor_count; j++)
        rows += 1 + f->factors[j].level_count;
    return rows;
}

static void write_rows(FILE *data, const struct factorial *f)
{
    size_t row = 0;
    for (size_t j = 0; j < f->factor_count; j++) {
        const struct factorial_factor *factor = &f->factors[j];
        row++;
        for (size_t k = 0; k < factor->level_count; k++) {
            double half = factor->half_width[k]; // may reach beyond the scale
            fprintf(data, "%zu %.6f ", row++, factor->mean[k]);
            figure_interval(data, factor->mean[k] - half, factor->mean[k] + half, f->scale_min, f->scale_max);
            figure_cut_word(data, factor->levels[k], FIGURE_LEVEL_LONGEST);
            fprintf(data, " \"%.2f\"\n", factor->mean[k]);
        }
    }
    fputs("\n\n", data);
    row = 0;
    for (size_t j = 0; j < f->factor_count; j++) {
        fprintf(data, "%zu ", row);
        figure_cut_word(data, f->factors[j].name, 40);
        fputc('\n', data);
        row += 1 + f->factors[j].level_count;
    }
}

// The longest level in characters, for the room to the left.
static size_t widest(const struct factorial *f)
{
    size_t most = 4;
    for (size_t j = 0; j < f->factor_count; j++)
        for (size_t k = 0; k < f->factors[j].level_count; k++) {
            size_t length = strlen(f->factors[j].levels[k]);
            most = length > most ? length : most;
        }
    return most < FIGURE_LEVEL_LONGEST ? most : FIGURE_LEVEL_LONGEST;
}

bool figure_factorial(const struct factorial *f, const struct figure_desc *desc, char **out_svg, char *error,
                      size_t error_size)
{
    struct figure figure;
    size_t rows = row_count(f);
    int font = desc->narrow ? 12 : 14;
    if (!figure_begin(&figure, desc->narrow ? FIGURE_NARROW_PX : FIGURE_WIDE_PX, 60 + 24 * (int)rows, font,
                      error, error_size))
        return false;
    write_rows(figure.data, f);
    double span = f->scale_max - f->scale_min, margin = 0.03 * span, left = f->scale_min - margin,
           right = f->scale_max + margin;
    fprintf(figure.script,
            "set yrange [%.1f:-0.7]\nset xrange [%.6g:%.6g]\nunset ytics\nset xtics %.6g,%.6g,%.6g\n"
            "set lmargin %zu\nset rmargin 7\nset tmargin 0.3\nset bmargin 3\nset xlabel 'mean rating' tc rgb "
            "'" FIGURE_INK "' offset 0,0.4\n"
            "set grid xtics lw 0.6 lt 1 lc rgb '#dfe2e8'\n",
            (double)rows - 0.4, left, right, f->scale_min, span > 12 ? span / 5 : 1, f->scale_max,
            widest(f) + 2);
    fprintf(figure.script,
            "plot 'data' index 0 using 3:1:($4-$3):(0) with vectors nohead lw 3 lc rgb '" FIGURE_BLUE "'"
            ", '' index 0 using 7:1:(-%.6g):(0) with vectors " FIGURE_CUT_HEAD " lw 1.5 lc rgb '" FIGURE_BLUE
            "'"
            ", '' index 0 using 8:1:(%.6g):(0) with vectors " FIGURE_CUT_HEAD " lw 1.5 lc rgb '" FIGURE_BLUE "'"
            ", '' index 0 using 2:1 with points pt 7 ps %s lc rgb '" FIGURE_BLUE "'"
            ", '' index 0 using (%.6g):1:9 with labels right offset -1,0 tc rgb '" FIGURE_INK "'"
            ", '' index 0 using (%.6g):1:10 with labels left offset 0.6,0 tc rgb '" FIGURE_INK "'"
            ", '' index 1 using (%.6g):1:2 with labels left offset 0.3,0 font ',%d' tc rgb '" FIGURE_INK "'\n",
            margin, margin, desc->narrow ? "0.7" : "0.9", left, right, left, font + 1);
    return figure_end(&figure, desc->text, out_svg, error, error_size);
}
