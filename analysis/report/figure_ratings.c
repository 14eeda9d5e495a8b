#include "analysis/report/figures.h"

#include <string.h>

enum { LONGEST = 22, NARROW_LONGEST = 12 }; // bytes of a mode's name that do not meet the next one
static const double panel_width = 2.2; // between the first positions of two groups; the two ratings are 1 apart

// Orange is the option under test, as in every figure: not `regular`; of two others the first one.
static const char *colour(const struct sample *sample, const struct rating_group *g, bool second)
{
    bool first_regular = strcmp(sample->conditions[g->first_condition].mode, "regular") == 0;
    bool second_regular = strcmp(sample->conditions[g->second_condition].mode, "regular") == 0;
    bool orange = first_regular == second_regular ? (g->first_condition < g->second_condition) != second
                                                  : (second ? !second_regular : !first_regular);
    return orange ? FIGURE_ORANGE : FIGURE_BLUE;
}

// Equal ratings would hide each other: each line is set off by up to 0.16 of a point, in a fixed pattern.
static double offset(size_t i)
{
    return ((double)(i * 7 % 9) - 4) * 0.04;
}

static void write_lines(FILE *data, const struct rating_question *q)
{
    for (size_t g = 0; g < q->group_count; g++)
        for (size_t i = 0; i < q->groups[g].n; i++) {
            double x = panel_width * (double)g;
            fprintf(data, "%.3f %.4f\n%.3f %.4f\n\n", x, q->groups[g].first[i] + offset(i), x + 1,
                    q->groups[g].second[i] + offset(i));
        }
    fputs("\n", data);
}

static void write_option(FILE *data, const struct sample *sample, size_t condition, bool narrow)
{
    fputc(' ', data);
    figure_cut_word(data, sample->conditions[condition].mode, narrow ? NARROW_LONGEST : LONGEST);
}

// Block 1: the means, with what was rated and when.
static void write_means(FILE *data, const struct sample *sample, const struct rating_question *q, bool narrow)
{
    for (size_t g = 0; g < q->group_count; g++) {
        const struct rating_group *group = &q->groups[g];
        double x = panel_width * (double)g;
        fprintf(data, "%.3f %.4f %s \"%.1f\" \"first\"", x, group->first_of.mean,
                strcmp(colour(sample, group, false), FIGURE_ORANGE) == 0 ? "0xe8912d" : "0x2f6da8",
                group->first_of.mean);
        write_option(data, sample, group->first_condition, narrow);
        fprintf(data, " -1\n%.3f %.4f %s \"%.1f\" \"second\"", x + 1, group->second_of.mean,
                strcmp(colour(sample, group, true), FIGURE_ORANGE) == 0 ? "0xe8912d" : "0x2f6da8",
                group->second_of.mean);
        write_option(data, sample, group->second_condition, narrow);
        fputs(" 1\n\n", data);
    }
    fputs("\n", data);
    for (size_t g = 0; g < q->group_count; g++) // block 2: the panels
        fprintf(data, "%.3f \"%s%zu\"\n", panel_width * (double)g + 0.5,
                narrow ? "n " : "n = ", q->groups[g].n);
}

bool figure_ratings(const struct sample *sample, const struct rating_question *q,
                    const struct figure_desc *desc, char **out_svg, char *error, size_t error_size)
{
    struct figure figure;
    int font = desc->narrow ? 12 : 15;
    if (!figure_begin(&figure, desc->narrow ? FIGURE_NARROW_PX : FIGURE_WIDE_PX, desc->narrow ? 330 : 400, font,
                      error, error_size))
        return false;
    write_lines(figure.data, q);
    write_means(figure.data, sample, q, desc->narrow);
    double span = q->scale_max - q->scale_min;
    fprintf(
        figure.script,
        "set xrange [-0.6:%.3f]\nset yrange [%.4f:%.4f]\nunset xtics\nset ytics %.6g,%.6g,%.6g offset 0.5,0\n"
        "set lmargin 5\nset rmargin 0.5\nset tmargin 1.8\nset bmargin 0\nset label 'rating' " FIGURE_UPRIGHT
        "\nset grid ytics lw 0.6 lt 1 lc rgb "
        "'#dfe2e8'\n",
        panel_width * (double)(q->group_count - 1) + 1.6, q->scale_min - 0.24 * span,
        q->scale_max + 0.12 * span, q->scale_min, span > 12 ? span / 5 : 1, q->scale_max);
    fprintf(figure.script,
            "plot 'data' index 0 using 1:2 with linespoints pt 7 ps 0.35 lw 0.9 lc rgb '" FIGURE_PALE "'"
            ", '' index 1 using 1:2 with lines lw 3 lc rgb '" FIGURE_INK "'"
            ", '' index 1 using 1:2:3 with points pt 7 ps %s lc rgb variable"
            ", '' index 1 using ($1+0.2*$7):2:4 with labels font ',%d' tc rgb '" FIGURE_INK "'"
            ", '' index 1 using 1:(%.4f):5 with labels tc rgb '" FIGURE_INK "'"
            ", '' index 1 using 1:(%.4f):6 with labels font ',%d' tc rgb '" FIGURE_INK "'"
            ", '' index 2 using 1:(%.4f):2 with labels tc rgb '" FIGURE_INK "'\n",
            desc->narrow ? "1.0" : "1.3", font + 1, q->scale_min - 0.1 * span, q->scale_min - 0.18 * span,
            desc->narrow ? font - 1 : font, q->scale_max + 0.08 * span);
    return figure_end(&figure, desc->text, out_svg, error, error_size);
}
