// Stengel et al. 2016, "Adaptive image-space sampling for gaze-contingent real-time rendering", Figure 7, as
// net preferences: per cell the mean over people of test minus reference over all answers, with its t interval,
// from -1 (always the reference) to 1. The paper draws shares of pooled trials; here each person counts the
// same.
#include "analysis/report/choice_three.h"
#include "analysis/report/figures.h"
#include "analysis/report/level.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { FONT_PX = 14, NARROW_FONT_PX = 11, ROW_PX = 30, WORDS = 320 };
enum { LONGEST = 46, NARROW_LONGEST = 18 }; // bytes of words that leave half the figure to its dots

size_t figure_three_rows(const struct choices *c)
{
    size_t rows = 0;
    for (size_t i = 0; i < c->cell_count; i++)
        rows += choice_three_applies(c, &c->cells[i]);
    return rows;
}

// The cell's words, cut where they are longer than `most` bytes.
static void words_of(const struct choice_cell *cell, size_t most, char out[WORDS])
{
    char levels[256];
    if (cell->level_count)
        level_join(cell, 0, cell->level_count, levels);
    else
        snprintf(levels, sizeof levels, "%s", cell->label);
    snprintf(out, WORDS - 4, "%.40s%s%s", cell->name_block ? cell->block : "", cell->name_block ? ": " : "",
             levels);
    figure_cut(out, most);
}

// A row each: place, net preference, the columns of its interval, words, the number as a word. So few people's
// t interval may reach beyond what a net preference can be.
static bool write_rows(FILE *data, const struct choices *c, size_t most, size_t *out_widest)
{
    size_t row = 0;
    *out_widest = 4;
    for (size_t i = 0; i < c->cell_count; i++) {
        struct choice_three x;
        char words[WORDS], number[16];
        if (!choice_three_applies(c, &c->cells[i]))
            continue;
        if (!choice_three_of(c, &c->cells[i], &x))
            return false;
        words_of(&c->cells[i], most, words);
        size_t length = strlen(words);
        *out_widest = length > *out_widest ? length : *out_widest;
        snprintf(number, sizeof number, "%s%.2f", x.net < 0 ? "\u2212" : x.net > 0 ? "+" : "", fabs(x.net));
        fprintf(data, "%zu %.6f ", row++, x.net);
        figure_interval(data, x.net_ci.low, x.net_ci.high, -1, 1);
        figure_word(data, words);
        fputc(' ', data);
        figure_word(data, number);
        fputc('\n', data);
    }
    return true;
}

bool figure_three(const struct choices *c, const struct figure_desc *desc, char **out_svg, char *error,
                  size_t error_size)
{
    struct figure figure;
    const size_t rows = figure_three_rows(c);
    const int font = desc->narrow ? NARROW_FONT_PX : FONT_PX;
    size_t widest;
    if (!figure_begin(&figure, desc->narrow ? FIGURE_NARROW_PX : FIGURE_WIDE_PX, 70 + ROW_PX * (int)rows, font,
                      error, error_size))
        return false;
    if (!write_rows(figure.data, c, desc->narrow ? NARROW_LONGEST : LONGEST, &widest)) {
        figure_abandon(&figure);
        snprintf(error, error_size, "not enough memory");
        return false;
    }
    fprintf(
        figure.script,
        "set yrange [%.1f:-0.9]\nset xrange [-1.03:1.03]\nunset ytics\n"
        "set xtics ('\u22121' -1, '%s' -0.5, '0' 0, '%s' 0.5, '1' 1)\n"
        "set lmargin %zu\nset rmargin 6\nset tmargin 0.3\nset bmargin 3\n"
        "set grid xtics lw 0.6 lt 1 lc rgb '#dfe2e8'\n"
        "set arrow from first 0, graph 0 to first 0, graph 1 nohead front lw 1.2 dt (6,4) lc rgb '" FIGURE_INK
        "'\n",
        (double)rows - 0.3, desc->narrow ? "" : "\u22120.5", desc->narrow ? "" : "0.5",
        (desc->narrow ? widest * 3 / 4 : widest) + 2);
    fprintf(figure.script,
            "set label 'reference%s' at first -1, graph 0 left offset 0,-2 tc rgb '" FIGURE_INK "'\n"
            "set label 'test%s' at first 1, graph 0 right offset 0,-2 tc rgb '" FIGURE_INK "'\n",
            desc->narrow ? "" : " preferred", desc->narrow ? "" : " option preferred");
    fprintf(figure.script,
            "plot 'data' index 0 using 3:1:($4-$3):(0) with vectors nohead lw 3 lc rgb '" FIGURE_BLUE "'"
            ", '' index 0 using 7:1:(-0.03):(0) with vectors " FIGURE_CUT_HEAD " lw 1.5 lc rgb '" FIGURE_BLUE
            "'"
            ", '' index 0 using 8:1:(0.03):(0) with vectors " FIGURE_CUT_HEAD " lw 1.5 lc rgb '" FIGURE_BLUE "'"
            ", '' index 0 using 2:1 with points pt 7 ps %s lc rgb '" FIGURE_BLUE "'"
            ", '' index 0 using (-1.03):1:9 with labels right offset -1,0 tc rgb '" FIGURE_INK "'"
            ", '' index 0 using (1.03):1:10 with labels left offset 0.6,0 tc rgb '" FIGURE_INK "'\n",
            desc->narrow ? "0.7" : "0.9");
    return figure_end(&figure, desc->text, out_svg, error, error_size);
}
