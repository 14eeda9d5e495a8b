// Franke et al. 2021, "Time-Warped Foveated Rendering for Virtual Reality Headsets", Figure 7, with each cell's
// own null region where the paper draws one for all. That region is of a binomial test; where a person answered
// several times in a cell, the interval is drawn instead.
#include "analysis/report/figures.h"
#include "analysis/report/level.h"

#include <inttypes.h>
#include <math.h>
#include <string.h>

enum { CROWDED = 18, NARROW_CROWDED = 9 }; // bars beyond which numbers in them no longer fit
enum { FONT_PX = 15, NARROW_FONT_PX = 12 };
enum { UNDER = 12 }; // of the upright axis: the room that two lines of numbers under the bars take

static const double group_gap = 0.5, number_gap = 0.1; // in bar slots, between groups; where bars bear numbers

static const char regions[] =
    "'data' index 0 using 1:3:($1-0.5):($1+0.5):3:4 with boxxyerror fs solid noborder fc rgb "
    "'" FIGURE_GREEN "', ";
static const char region_edges[] =
    ", '' index 0 using ($1-0.5):3:(1):(0) with vectors nohead lw 1.5 lc rgb '" FIGURE_GREEN_EDGE
    "', '' index 0 using ($1-0.5):4:(1):(0) with vectors nohead lw 1.5 lc rgb '" FIGURE_GREEN_EDGE "'";
#define INTERVAL_INK " lw 1.6 lc rgb '" FIGURE_INK "'"
static const char intervals[] =
    ", '' index 0 using 1:5:(0):($6-$5) with vectors nohead" INTERVAL_INK
    ", '' index 0 using ($1-0.08):7:(0.16):(0) with vectors nohead" INTERVAL_INK
    ", '' index 0 using ($1-0.08):8:(0.16):(0) with vectors nohead" INTERVAL_INK
    ", '' index 0 using 1:($9+3):(0):(-3) with vectors " FIGURE_CUT_HEAD INTERVAL_INK
    ", '' index 0 using 1:($10-3):(0):(3) with vectors " FIGURE_CUT_HEAD INTERVAL_INK
    ", '' index 0 using 1:($2+0*$5) with points pt 7 ps 0.4 lc rgb '" FIGURE_INK "'";

// gnuplot leaves out what is NaN; the axis ends at 0 and 100, beyond which no count lies.
static void write_region(FILE *data, bool any, double low, double high)
{
    if (any)
        fprintf(data, "%.6f %.6f ", fmax(0, low), fmin(100, high));
    else
        fputs("NaN NaN ", data);
}

// Columns: place, percent, null region, six of an interval, three words: the last is the number, where there is
// one.
static void write_bar(FILE *data, const struct choice_cell *cell, size_t number, double x, bool narrow)
{
    const struct stat_region *region = &cell->binomial.null_region;
    double n = (double)cell->n;
    char word[96];
    fprintf(data, "%.3f %.6f ", x, 100 * cell->estimate);
    write_region(data, !cell->several, 100 * ((double)region->low - 0.5) / n,
                 100 * ((double)region->high + 0.5) / n);
    double none = (double)NAN;
    figure_interval(data, cell->several ? 100 * cell->ci.low : none, cell->several ? 100 * cell->ci.high : none,
                    0, 100);
    snprintf(word, sizeof word, narrow ? "%.0f" : "%.0f %%", 100 * cell->estimate);
    figure_word(data, word);
    if (cell->several) // all answers together have another share than their people's mean
        snprintf(word, sizeof word, "n %zu", stat_people_sum(cell->counts, cell->people).people);
    else
        snprintf(word, sizeof word, "%" PRId64 "/%" PRId64, cell->chosen, cell->n);
    fputc(' ', data);
    figure_word(data, word);
    if (number)
        snprintf(word, sizeof word, "%zu", number);
    else
        level_words(cell->levels[cell->level_count - 1].factor, cell->levels[cell->level_count - 1].value,
                    !narrow, word);
    fputc(' ', data);
    figure_word(data, word);
    fputc('\n', data);
}

static void group_name(const struct choice_cell *cell, char out[256])
{
    char levels[256];
    level_join(cell, 0, cell->level_count ? cell->level_count - 1 : 0, levels);
    if (cell->name_block)
        snprintf(out, 256, "%.80s%s%.160s", cell->block, levels[0] ? ": " : "", levels);
    else
        snprintf(out, 256, "%s", levels);
}

// Cells of one group share the block and all levels but the last.
static bool same_group(const struct choice_cell *a, const struct choice_cell *b)
{
    char x[256], y[256];
    group_name(a, x);
    group_name(b, y);
    return strcmp(a->block, b->block) == 0 && strcmp(x, y) == 0;
}

// Whether words of so many letters, about 0.55 of the font's size wide each, fit.
static bool fits(const char *words, double px)
{
    return 0.55 * FONT_PX * (double)strlen(words) <= px;
}

const char *figure_choices_what(const struct choices *c)
{
    size_t right = 0;
    for (size_t i = 0; i < c->cell_count; i++)
        right += c->cells[i].right;
    return right == 0               ? "choices for the test option"
           : right == c->cell_count ? "right answers"
                                    : "choices for the test option, or right answers";
}

bool figure_choices_numbered(const struct choices *c)
{
    double slots = 0.2;
    for (size_t i = 0; i < c->cell_count; i++)
        slots += i && !same_group(&c->cells[i - 1], &c->cells[i]) ? 1 + group_gap : 1;
    double slot_px = 0.93 * FIGURE_WIDE_PX / slots, group_px = 0;
    bool numbered = false;
    for (size_t i = 0; i < c->cell_count && !numbered; i++) {
        const struct choice_cell *cell = &c->cells[i];
        char word[96], name[256];
        numbered = cell->level_count == 0;
        if (numbered)
            break;
        const struct choice_level *last = &cell->levels[cell->level_count - 1];
        level_words(last->factor, last->value, true, word);
        group_name(cell, name);
        group_px += slot_px;
        bool ends = i + 1 == c->cell_count || !same_group(cell, &c->cells[i + 1]);
        numbered = !fits(word, 1.1 * slot_px) || (ends && !fits(name, group_px + group_gap * slot_px));
        group_px = ends ? 0 : group_px;
    }
    return numbered;
}

// The factor whose levels stand under all bars, with its unit; false where there is none.
static bool bar_factor(const struct choices *c, char out[96])
{
    const char *factor = NULL;
    for (size_t i = 0; i < c->cell_count; i++) {
        const struct choice_cell *cell = &c->cells[i];
        const char *last = cell->level_count ? cell->levels[cell->level_count - 1].factor : NULL;
        if (!last || (factor && strcmp(factor, last) != 0))
            return false;
        factor = last;
    }
    if (factor)
        level_name(factor, out);
    return factor != NULL;
}

// Returns where the last bar stands; bars are block 0 of the data file, groups block 1. *named: a group has a
// name.
static double write_data(FILE *data, const struct choices *c, bool narrow, bool *named, bool *factor_named)
{
    const bool numbered = figure_choices_numbered(c);
    const double gap = numbered ? number_gap : group_gap;
    double x = 0;
    *named = *factor_named = false;
    for (size_t i = 0; i < c->cell_count; i++) {
        if (i)
            x += same_group(&c->cells[i - 1], &c->cells[i]) ? 1 : 1 + gap;
        if (c->cells[i].n) // a cell of nothing but "equal" has no percent
            write_bar(data, &c->cells[i], numbered ? i + 1 : 0, x, narrow);
    }
    fputs("\n\n", data);
    double last = x, start = 0;
    x = 0;
    for (size_t i = 0; i < c->cell_count; i++) {
        bool ends = i + 1 == c->cell_count || !same_group(&c->cells[i], &c->cells[i + 1]);
        if (ends && !numbered) {
            char name[256];
            group_name(&c->cells[i], name);
            fprintf(data, "%.3f ", (start + x) / 2);
            figure_word(data, name);
            fputc('\n', data);
            *named = *named || name[0];
        }
        x += ends ? 1 + gap : 1;
        start = ends ? x : start;
    }
    char factor[96]; // block 2: what a narrow figure's bars have no room for
    if (narrow && !numbered && bar_factor(c, factor)) {
        fprintf(data, "\n\n%.3f ", last / 2);
        figure_word(data, factor);
        fputc('\n', data);
        *factor_named = true;
    }
    return last;
}

bool figure_choices(const struct choices *choices, const struct figure_desc *desc, char **out_svg, char *error,
                    size_t error_size)
{
    struct figure figure;
    int font = desc->narrow ? NARROW_FONT_PX : FONT_PX;
    if (!figure_begin(&figure, desc->narrow ? FIGURE_NARROW_PX : FIGURE_WIDE_PX, desc->narrow ? 330 : 430, font,
                      error, error_size))
        return false;
    bool named, factor_named;
    double last = write_data(figure.data, choices, desc->narrow, &named, &factor_named);
    bool numbers = choices->cell_count <= (desc->narrow ? NARROW_CROWDED : CROWDED);
    // Lines of intervals would strike numbers in the bars through: those stand under them then.
    bool under = numbers && choices->several;
    double below = under ? UNDER : 0, group_y = -14 - below, factor_y = group_y - (named ? 8 : 0);
    fprintf(
        figure.script,
        "set xrange [-0.6:%.3f]\nset yrange [%d:101]\nunset xtics\nset label '%s' " FIGURE_UPRIGHT "\n"
        "set ytics 0,25,100 format '%%g %%%%' offset 0.5,0\n"
        "set lmargin %d\nset rmargin 0.5\nset tmargin 1.8\nset bmargin 0\n"
        "do for [y=0:100:25] { set arrow from graph 0, first y to graph 1, first y nohead back lw 0.6 "
        "lc rgb (y == 0 ? '" FIGURE_INK "' : '#dfe2e8') }\n"
        "set arrow from graph 0, first 50 to graph 1, first 50 nohead front lw 1.2 dt (6,4) lc rgb '" FIGURE_INK
        "'\n",
        last + 0.6, (named ? -21 : -10) - (factor_named ? 8 : 0) - (under ? UNDER : 0),
        figure_choices_what(choices), 6);
    fprintf(figure.script,
            "plot %s'data' index 0 using 1:2:(%s) with boxes fs solid noborder fc rgb '" FIGURE_ORANGE "'%s%s",
            choices->one_each ? regions : "", figure_choices_numbered(choices) ? "0.8" : "0.6",
            choices->one_each ? region_edges : "", choices->several ? intervals : "");
    fprintf(figure.script, ", '' index 0 using 1:(-5):13 with labels tc rgb '" FIGURE_INK "'");
    if (named)
        fprintf(figure.script, ", '' index 1 using 1:(%g):2 with labels font ',%d' tc rgb '" FIGURE_INK "'",
                group_y, font + 1);
    if (factor_named)
        fprintf(figure.script, ", '' index 2 using 1:(%g):2 with labels tc rgb '" FIGURE_INK "'", factor_y);
    if (numbers)
        fprintf(figure.script,
                ", '' index 0 using 1:(%d):11 with labels tc rgb '" FIGURE_INK "'"
                ", '' index 0 using 1:(%d):12 with labels font ',%d' tc rgb '" FIGURE_INK "'",
                under          ? -11
                : desc->narrow ? 11
                               : 10,
                under ? -17 : 4, font - 2);
    fputc('\n', figure.script);
    return figure_end(&figure, desc->text, out_svg, error, error_size);
}
