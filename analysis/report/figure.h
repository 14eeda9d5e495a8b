// A figure: gnuplot as a process draws it as SVG, which is then made fit to stand inside an HTML page.
//
// Use: figure_begin(), fprintf() plain numbers and figure_word() texts into `data`, constant commands into
// `script`, figure_end(). The script runs in a private folder and reads the file "data"; texts of a study reach
// gnuplot only through that file, as quoted words, never as commands. No shell is involved.
// Does not: choose colours or sizes beyond the canvas (figure_* files do).
#ifndef ANALYSIS_REPORT_FIGURE_H
#define ANALYSIS_REPORT_FIGURE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

struct figure {
    FILE *script, *data;
    char folder[64];
};

// What the page knows of a figure.
struct figure_text {
    const char *id;          // unique in the page, letters, digits and '-' only; every id inside begins with it
    const char *title;       // for people who do not see it
    const char *description; // what it shows, with its numbers or where they stand
    const char *css_class;
};

enum { FIGURE_ERROR_SIZE = 512 };

// Colours that stay apart for colour-blind readers and in gray print; contrast of text at least 4.5 to 1.
#define FIGURE_ORANGE "#e8912d" // the test option, as in Franke 2021, Figure 7
#define FIGURE_GREEN "#cfe6d2"  // the null region, same
#define FIGURE_GREEN_EDGE "#4d8f5b"
#define FIGURE_BLUE "#2f6da8"
#define FIGURE_INK "#1f2430"
#define FIGURE_PALE "#9aa1ad"

// False with a sentence. The canvas in pixels is also the SVG's view box.
bool figure_begin(struct figure *figure, int width, int height, int font_px, char *error, size_t error_size);

// A quoted word of the data file: what gnuplot could read as more than text is replaced.
void figure_word(FILE *data, const char *text);

// Cuts between letters what is longer than `most` bytes, and puts "…" there; `text` has room for 4 more.
void figure_cut(char *text, size_t most);

// The same of a word for the data file; `most` is at most 200.
void figure_cut_word(FILE *data, const char *text, size_t most);
enum { FIGURE_LEVEL_LONGEST = 24 }; // bytes of a level's name to the left of a row

// Six columns of the data file: an interval as far as an axis from `least` to `most` shows it, its ends that
// the axis shows, and its ends that the axis cuts, for FIGURE_CUT_HEAD; NaN where there is none.
void figure_interval(FILE *data, double low, double high, double least, double most);
// An interval that goes on beyond the axis ends in an arrow: nobody takes the axis' end for its own.
#define FIGURE_CUT_HEAD "head filled size screen 0.012,24,60 fixed"

// Where a label says what the upright axis shows: above the left corner. Give it a line at the top.
#define FIGURE_UPRIGHT "at graph 0, graph 1 left offset -4,0.8 tc rgb '" FIGURE_INK "'"

// Runs gnuplot and removes the folder. *out_svg is freed by the caller. False with a sentence. Numbers that
// gnuplot refuses (an infinite scale, levels equal to its last digit) are no failure: the picture is then a
// sentence.
bool figure_end(struct figure *figure, const struct figure_text *text, char **out_svg, char *error,
                size_t error_size);

// Removes the folder without drawing.
void figure_abandon(struct figure *figure);

// The SVG text of gnuplot as an element of a page: no prolog, no titles of its own, ids prefixed. NULL: not an
// SVG, or memory.
char *figure_embeddable(const char *svg, const struct figure_text *text);

// 1, 2 or 5 times a power of ten, so that at most `most_tics` steps fit into `range` > 0.
double figure_tic_step(double range, int most_tics);

#endif
