// Diverging bars of what was answered, as Weier et al. 2016 draw Figures 6 and 7: answers below the scale's
// middle to the left of zero, those above it to the right, the middle one half and half.
#include "analysis/report/figures.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

enum { POINTS = 11 };

static size_t points_of(const struct factorial *f)
{
    double points = f->scale_max - f->scale_min + 1;
    return points >= 2 && points <= POINTS && points == floor(points) ? (size_t)points : 0;
}

bool figure_likert_possible(const struct factorial *f)
{
    for (size_t i = 0; i < f->rating_count; i++) {
        double place = f->ratings[i].value - f->scale_min;
        if (place != floor(place))
            return false;
    }
    return !f->refusal[0] && points_of(f) > 0;
}

static bool complete(const struct factorial *f, size_t person)
{
    for (size_t i = 0; i < f->left_count; i++)
        if (f->left[i].person == person)
            return false;
    return true;
}

static void count_level(const struct factorial *f, size_t stride, size_t levels, size_t level,
                        double counts[POINTS])
{
    memset(counts, 0, POINTS * sizeof counts[0]);
    for (size_t i = 0; i < f->rating_count; i++)
        if (f->ratings[i].place / stride % levels == level && complete(f, f->ratings[i].person))
            counts[(size_t)(f->ratings[i].value - f->scale_min)]++;
}

// A row of segments, each with its point of the scale; then the row's words and shares. Returns how far it
// reaches.
static double write_row(FILE *segments, FILE *words, size_t row, const double *counts, size_t points,
                        const char *level)
{
    double total = 0, below = 0, above = 0, x = 0;
    for (size_t k = 0; k < points; k++) {
        total += counts[k];
        below += 2 * k + 1 < points ? counts[k] : 0;
        above += 2 * k + 1 > points ? counts[k] : 0;
    }
    double percent = 100 / total, middle = total - below - above;
    double low = x = -(below + middle / 2) * percent, high = low + 100;
    for (size_t k = 0; k < points; k++) {
        if (counts[k] > 0)
            fprintf(segments, "%zu %.4f %.4f %zu\n", row, x, x + counts[k] * percent, k);
        x += counts[k] * percent;
    }
    fprintf(words, "%zu %.4f %.4f \"%.0f %%\" \"%.0f %%\" ", row, low, high, below * percent, above * percent);
    figure_cut_word(words, level, FIGURE_LEVEL_LONGEST);
    fputc('\n', words);
    return fmax(-low, high);
}

// Orange below the middle and blue above, the paler the nearer to it.
static unsigned colour(size_t point, size_t points)
{
    static const double pale[2][3] = {{249, 220, 184}, {190, 213, 235}},
                        full[2][3] = {{196, 104, 16}, {31, 84, 134}};
    double t = (2 * (double)point - ((double)points - 1)) / ((double)points - 1), depth = fabs(t);
    unsigned rgb = 0;
    if (t == 0)
        return 0xd9dde4;
    for (int i = 0; i < 3; i++)
        rgb = rgb << 8 | (unsigned)lround(pale[t > 0][i] + depth * (full[t > 0][i] - pale[t > 0][i]));
    return rgb;
}

// The data: segments, level rows, factor names. Words wait in memory until the segments are out.
static double write_data(FILE *data, const struct factorial *f, size_t *rows, size_t *widest)
{
    char *words = NULL;
    size_t size = 0, row = 0, points = points_of(f), stride = f->cells;
    FILE *memory = open_memstream(&words, &size);
    double reach = 0, counts[POINTS];
    *widest = 4;
    for (size_t j = 0; memory && j < f->factor_count; j++) {
        stride /= f->factors[j].level_count;
        row++;
        for (size_t k = 0; k < f->factors[j].level_count; k++) {
            size_t length = strlen(f->factors[j].levels[k]);
            *widest = length > *widest ? length : *widest;
            count_level(f, stride, f->factors[j].level_count, k, counts);
            reach = fmax(reach, write_row(data, memory, row++, counts, points, f->factors[j].levels[k]));
        }
    }
    *rows = row;
    *widest = *widest < FIGURE_LEVEL_LONGEST ? *widest : FIGURE_LEVEL_LONGEST;
    if (!memory || fclose(memory) != 0)
        return (double)NAN;
    fprintf(data, "\n\n%s\n\n", words);
    free(words);
    row = 0;
    for (size_t j = 0; j < f->factor_count; j++) {
        fprintf(data, "%zu ", row);
        figure_cut_word(data, f->factors[j].name, 40);
        fputc('\n', data);
        row += 1 + f->factors[j].level_count;
    }
    return reach;
}

bool figure_likert(const struct factorial *f, const struct figure_desc *desc, char **out_svg, char *error,
                   size_t error_size)
{
    struct figure figure;
    size_t rows = f->factor_count, widest;
    int font = desc->narrow ? 12 : 14;
    for (size_t j = 0; j < f->factor_count; j++)
        rows += f->factors[j].level_count;
    if (!figure_begin(&figure, desc->narrow ? FIGURE_NARROW_PX : FIGURE_WIDE_PX, 60 + 24 * (int)rows, font,
                      error, error_size))
        return false;
    double reach = write_data(figure.data, f, &rows, &widest);
    if (isnan(reach)) {
        figure_abandon(&figure);
        snprintf(error, error_size, "not enough memory");
        return false;
    }
    double edge = reach * (desc->narrow ? 1.6 : 1.22);
    fprintf(figure.script,
            "set yrange [%.1f:-0.7]\nset xrange [%.4f:%.4f]\nunset ytics\nset style fill solid 1 noborder\n"
            "set xtics ('100 %%%%' -100, '%s' -50, '0' 0, '%s' 50, '100 %%%%' 100)\n"
            "set lmargin %zu\nset rmargin 2\nset tmargin 0.3\nset bmargin 3\nset xlabel 'share of answers' tc "
            "rgb '" FIGURE_INK "' offset 0,0.4\n"
            "set grid xtics lw 0.6 lt 1 lc rgb '#dfe2e8'\nplot ",
            (double)rows - 0.4, -edge, edge, desc->narrow ? "" : "50 %%", desc->narrow ? "" : "50 %%",
            widest + 2);
    size_t points = points_of(f);
    for (size_t k = 0; k < points; k++)
        fprintf(figure.script,
                "'data' index 0 using ($4==%zu?($2+$3)/2:NaN):1:2:3:($1-0.36):($1+0.36) with boxxyerror lc rgb "
                "'#%06x', ",
                k, colour(k, points));
    fprintf(figure.script,
            "'data' index 1 using 2:1:4 with labels right offset -0.4,0 tc rgb '" FIGURE_INK "'"
            ", '' index 1 using 3:1:5 with labels left offset 0.4,0 tc rgb '" FIGURE_INK "'"
            ", '' index 1 using (%.4f):1:6 with labels right offset -0.6,0 tc rgb '" FIGURE_INK "'"
            ", '' index 2 using (%.4f):1:2 with labels left offset 0.3,0 font ',%d' tc rgb '" FIGURE_INK "'\n",
            -edge, -edge, font + 1);
    return figure_end(&figure, desc->text, out_svg, error, error_size);
}
