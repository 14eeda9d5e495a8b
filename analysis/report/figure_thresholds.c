// A staircase cell: shares of right answers, each person's fitted function, and the staircases' thresholds.
#include "analysis/report/figures.h"
#include "analysis/report/level.h"

#include <math.h>
#include <stdlib.h>

enum { BINS = 12, CURVE = 60 };

struct bin {
    double level, right, n; // level: sum, until it is divided
};

static void widen(double value, double *low, double *high)
{
    *low = fmin(*low, value); // fmin leaves NaN out
    *high = fmax(*high, value);
}

static void level_range(const struct threshold_cell *cell, double *low, double *high)
{
    *low = INFINITY;
    *high = -INFINITY;
    for (size_t i = 0; i < cell->person_count; i++)
        for (size_t j = 0; j < cell->people[i].step_count; j++)
            widen(cell->people[i].steps[j].level, low, high);
}

// Block 0: the answers of all people in even bins of the level, for the eye only.
static void write_shares(FILE *data, const struct threshold_cell *cell, double low, double high)
{
    struct bin bins[BINS] = {0};
    for (size_t i = 0; i < cell->person_count; i++)
        for (size_t j = 0; j < cell->people[i].step_count; j++) {
            const struct stat_answers *step = &cell->people[i].steps[j];
            // Halves: the range of the largest numbers is infinite.
            double place = high > low ? (step->level / 2 - low / 2) / (high / 2 - low / 2) * BINS : 0;
            struct bin *bin = &bins[place < BINS ? (int)place : BINS - 1];
            bin->level += step->level;
            bin->right += (double)step->k;
            bin->n += (double)step->n;
        }
    for (int i = 0; i < BINS; i++)
        if (bins[i].n > 0)
            fprintf(data, "%.9g %.6f %.4f\n", bins[i].level / bins[i].n, 100 * bins[i].right / bins[i].n,
                    0.5 + 0.22 * sqrt(fmin(bins[i].n, 60)));
    fputs("\n\n", data);
}

// Block 1: the functions, one after another. Returns how many.
static size_t write_curves(FILE *data, const struct threshold_cell *cell, double low, double high)
{
    size_t count = 0;
    for (size_t i = 0; i < cell->person_count; i++) {
        const struct stat_fit *fit = &cell->people[i].fit;
        if (fit->status != STAT_FIT_OK)
            continue;
        for (int j = 0; j <= CURVE; j++) {
            double x = low * (CURVE - j) / CURVE + high * j / CURVE;
            double share = stat_psychometric(&fit->function, x);
            if (!isnan(share))
                fprintf(data, "%.9g %.6f\n", x, 100 * share);
        }
        fputc('\n', data);
        count++;
    }
    if (count == 0)
        fputs("nan nan\n", data);
    fputs("\n\n", data);
    return count;
}

// Block 2: the staircases' thresholds; block 3: their mean with its interval.
static void write_thresholds(FILE *data, const struct threshold_cell *cell)
{
    size_t count = 0;
    for (size_t i = 0; i < cell->person_count; i++)
        if (!isnan(cell->people[i].estimate)) {
            fprintf(data, "%.9g\n", cell->people[i].estimate);
            count++;
        }
    fputs(count ? "\n\n" : "nan\n\n\n", data);
    const struct threshold_mean *m = &cell->by_staircase;
    if (m->of.n && !isnan(m->t.ci_low))
        fprintf(data, "%.9g %.9g %.9g\n\n\n", m->of.mean, m->t.ci_low, m->t.ci_high);
    else
        fputs("nan nan nan\n\n\n", data);
}

// Estimates and their mean's interval may lie beyond the levels.
static void axis_range(const struct threshold_cell *cell, double *low, double *high)
{
    for (size_t i = 0; i < cell->person_count; i++)
        widen(cell->people[i].estimate, low, high);
    widen(cell->by_staircase.t.ci_low, low, high);
    widen(cell->by_staircase.t.ci_high, low, high);
    double margin = *high > *low ? 0.05 * (*high - *low) : 1;
    *low -= margin;
    *high += margin;
}

bool figure_thresholds(const struct threshold_cell *cell, const struct figure_desc *desc, char **out_svg,
                       char *error, size_t error_size)
{
    struct figure figure;
    int font = desc->narrow ? 12 : 15;
    double low, high;
    level_range(cell, &low, &high);
    if (!figure_begin(&figure, desc->narrow ? FIGURE_NARROW_PX : FIGURE_WIDE_PX, desc->narrow ? 300 : 360, font,
                      error, error_size))
        return false;
    write_shares(figure.data, cell, low, high);
    write_curves(figure.data, cell, low, high);
    write_thresholds(figure.data, cell);
    axis_range(cell, &low, &high);
    char parameter[96]; // block 4: what the axis shows
    level_name(cell->parameter, parameter);
    fputs("0.5 0 ", figure.data);
    figure_word(figure.data, parameter);
    fprintf(
        figure.script,
        "set xrange [%.9g:%.9g]\nset yrange [-14:104]\nset xtics format '%%g' offset 0,0.3\n"
        "set x2range [0:1]\nset y2range [0:1]\nset label '%s' " FIGURE_UPRIGHT "\n"
        "set ytics 0,25,100 format '%%g %%%%' offset 0.5,0\nset lmargin 6.5\nset rmargin 1.5\nset tmargin 1.8\n"
        "set bmargin 2.8\n"
        "do for [y=0:100:25] { set arrow from graph 0, first y to graph 1, first y nohead back lw 0.6 "
        "lc rgb (y == 0 ? '" FIGURE_INK "' : '#dfe2e8') }\n"
        "plot 'data' index 3 using (($2+$3)/2):(45):(($3-$2)/2):(55) with boxxyerror fs solid noborder fc "
        "rgb '" FIGURE_GREEN "'"
        ", '' index 3 using 1:(-10):(0):(110) with vectors nohead lw 1.5 lc rgb '" FIGURE_GREEN_EDGE "'"
        ", '' index 1 using 1:2 with lines lw 1 lc rgb '" FIGURE_PALE "'"
        ", '' index 0 using 1:2:3 with points pt 7 ps variable lc rgb '" FIGURE_ORANGE "'"
        ", '' index 2 using 1:(-9.5):(0):(7) with vectors nohead lw 2 lc rgb '" FIGURE_BLUE "'"
        ", '' index 4 using 1:2:3 axes x2y2 with labels center offset 0,-2 tc rgb '" FIGURE_INK "'\n",
        low, high, cell->preference ? "choices for the test option" : "right answers");
    return figure_end(&figure, desc->text, out_svg, error, error_size);
}

bool figure_adjusted(const struct adjusted_cell *const *cells, size_t count, const struct figure_desc *desc,
                     char **out_svg, char *error, size_t error_size)
{
    struct figure figure;
    int font = desc->narrow ? 12 : 15;
    double low = INFINITY, high = -INFINITY;
    char parameter[96], range[80] = "";
    if (!figure_begin(&figure, desc->narrow ? FIGURE_NARROW_PX : FIGURE_WIDE_PX, desc->narrow ? 300 : 340, font,
                      error, error_size))
        return false;
    for (size_t i = 0; i < count; i++) // block 0: people side by side
        for (size_t j = 0; j < cells[i]->person_count; j++)
            fprintf(figure.data, "%.4f %.9g\n",
                    (double)i - 0.3 + 0.3 * (double)j / (double)cells[i]->person_count,
                    cells[i]->people[j].mean),
                widen(cells[i]->people[j].mean, &low, &high);
    fputs("\n\n", figure.data);
    for (size_t i = 0; i < count; i++) { // block 1: means with intervals
        const struct threshold_mean *m = &cells[i]->over_people;
        bool known = !isnan(m->t.ci_low);
        fprintf(figure.data, "%zu %.9g %.9g %.9g ", i, m->of.mean, known ? m->t.ci_low : m->of.mean,
                known ? m->t.ci_high : m->of.mean);
        figure_word(figure.data, cells[i]->words);
        fputc('\n', figure.data);
        widen(m->t.ci_low, &low, &high);
        widen(m->t.ci_high, &low, &high);
    }
    level_name(cells[0]->parameter, parameter); // block 2: what the axis shows
    fputs("\n\n0 1 ", figure.data);
    figure_word(figure.data, parameter);
    if (!(high - low > 1e-9 * fabs(high))) // else gnuplot shows digits that nobody set
        snprintf(range, sizeof range, "set yrange [%.9g:%.9g]\n", low == 0 ? -1 : low - 0.5 * fabs(low),
                 low == 0 ? 1 : low + 0.5 * fabs(low));
    fprintf(
        figure.script,
        "set xrange [-0.5:%.3f]\nset offsets 0,0,graph 0.05,graph 0.05\nset ytics format '%%g' offset 0.5,0\n"
        "set x2range [0:1]\nset y2range [0:1]\n%s"
        "set xtics scale 0 offset 0,0.2\nset lmargin 7\nset rmargin 0.5\nset tmargin 1.8\nset bmargin 1.6\n"
        "set grid ytics lw 0.6 lt 1 lc rgb '#dfe2e8'\n"
        "plot 'data' index 0 using 1:2 with points pt 7 ps 0.6 lc rgb '" FIGURE_PALE "'"
        ", '' index 1 using ($1+0.12):2:3:4 with yerrorbars pt 7 ps 1.1 lw 2 lc rgb '" FIGURE_ORANGE
        "', '' index 1 using 1:2:xtic(5) with points pt 7 ps 0.01"
        ", '' index 2 using 1:2:3 axes x2y2 with labels left offset -5,0.8 tc rgb '" FIGURE_INK "'\n",
        (double)count - 0.5, range);
    return figure_end(&figure, desc->text, out_svg, error, error_size);
}
