// Times are compared as ratios to `regular` of the same run, which hold on another machine and beside other
// work; `regular` itself has only its milliseconds, and they are compared on one device only.
#include "app/fovbench/compare.h"

#include "app/command/options.h"
#include "app/fovbench/csv.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum direction { MORE_IS_WORSE, LESS_IS_WORSE };

// Worse: by more than the larger of both tolerances. The part is of the old value.
struct figure {
    const char *column, *unit;
    enum direction direction;
    double part, least;
    const char *low, *high; // columns of its interval: it changed only where the intervals part; NULL: none
    bool same_device;       // says nothing across devices
    bool regular_only;
};

static const struct figure figures[] = {
    {"ratio_to_regular", "", LESS_IS_WORSE, 0.05, 0, "ratio_low", "ratio_high", false, false},
    {"gpu_ms_median", " ms", MORE_IS_WORSE, 0.25, 0, NULL, NULL, true, true},
    {"shaded_px", " px", MORE_IS_WORSE, 0.02, 0, NULL, NULL, false, false},
    {"triangles", "", MORE_IS_WORSE, 0.02, 0, NULL, NULL, false, false},
    {"memory_mb", " MB", MORE_IS_WORSE, 0.02, 0, NULL, NULL, true, false},
    {"psnr_db", " dB", LESS_IS_WORSE, 0, 0.2, NULL, NULL, false, false},
    {"ssim", "", LESS_IS_WORSE, 0, 0.002, NULL, NULL, false, false},
    {"flip", "", MORE_IS_WORSE, 0.02, 0.0005, NULL, NULL, false, false},
    {"wpsnr_db", " dB", LESS_IS_WORSE, 0, 0.2, NULL, NULL, false, false},
    {"flicker_excess", "", MORE_IS_WORSE, 0.05, 0.01, NULL, NULL, false, false},
    {"flicker_still", "", MORE_IS_WORSE, 0.05, 0.01, NULL, NULL, false, false},
};
enum { FIGURES = sizeof figures / sizeof figures[0] };

// What makes two lines the same one; a column that one file lacks does not count.
static const char *const keys[] = {"scene", "mode", "parameters", "width", "height",
                                   "gaze",  "ssao", "taa",        "rest"};
enum { KEYS = sizeof keys / sizeof keys[0] };

struct counts {
    size_t both, worse, better, missing;
};

static bool same(const struct csv_table *a, size_t row_a, const struct csv_table *b, size_t row_b)
{
    for (size_t i = 0; i < KEYS; i++) {
        int column_a = csv_column(a, keys[i]), column_b = csv_column(b, keys[i]);
        if (column_a >= 0 && column_b >= 0 &&
            strcmp(csv_cell(a, row_a, column_a), csv_cell(b, row_b, column_b)) != 0)
            return false;
    }
    return true;
}

static size_t find(const struct csv_table *in, const struct csv_table *table, size_t row)
{
    size_t i = 0;
    while (i < in->row_count && !same(table, row, in, i))
        i++;
    return i;
}

static void print_name(const struct csv_table *t, size_t row)
{
    const char *parameters = csv_cell(t, row, csv_column(t, "parameters"));
    const char *gaze = csv_cell(t, row, csv_column(t, "gaze"));
    printf("%s %s%s, %sx%s%s%s%s%s", csv_cell(t, row, csv_column(t, "scene")),
           csv_cell(t, row, csv_column(t, "mode")), strcmp(parameters, "{}") == 0 ? "" : parameters,
           csv_cell(t, row, csv_column(t, "width")), csv_cell(t, row, csv_column(t, "height")),
           *gaze ? ", gaze " : "", gaze, csv_number(t, row, csv_column(t, "ssao")) > 0 ? ", SSAO" : "",
           csv_number(t, row, csv_column(t, "taa")) > 0 ? ", TAA" : "");
}

// Positive: worse, and by how much.
static double change(const struct figure *f, double was, double is)
{
    if (was == is) // infinite ones too
        return 0;
    return f->direction == MORE_IS_WORSE ? is - was : was - is;
}

static bool intervals_part(const struct figure *f, const struct csv_table *a, size_t row_a,
                           const struct csv_table *b, size_t row_b)
{
    if (!f->low)
        return true;
    double low_a = csv_number(a, row_a, csv_column(a, f->low)),
           high_a = csv_number(a, row_a, csv_column(a, f->high));
    double low_b = csv_number(b, row_b, csv_column(b, f->low)),
           high_b = csv_number(b, row_b, csv_column(b, f->high));
    return !(low_a <= high_b && low_b <= high_a);
}

static void compare_figure(const struct figure *f, const struct csv_table *old, size_t row_old,
                           const struct csv_table *new, size_t row_new, struct counts *counts)
{
    double was = csv_number(old, row_old, csv_column(old, f->column));
    double is = csv_number(new, row_new, csv_column(new, f->column));
    if (isnan(was) || isnan(is))
        return;
    double by = change(f, was, is), tolerance = fmax(f->part * fabs(was), f->least);
    if (!(fabs(by) > tolerance) || !intervals_part(f, old, row_old, new, row_new))
        return;
    counts->worse += by > 0;
    counts->better += by < 0;
    printf("%s: ", by > 0 ? "worse" : "better");
    print_name(new, row_new);
    printf(": %s %.5g -> %.5g%s", f->column, was, is, f->unit);
    if (isfinite(was) && isfinite(is) && was != 0)
        printf(" (%+.1f %%)", 100 * (is - was) / fabs(was));
    printf("\n");
}

static void compare_row(const struct csv_table *old, size_t row_old, const struct csv_table *new,
                        size_t row_new, struct counts *counts)
{
    const bool device = strcmp(csv_cell(old, row_old, csv_column(old, "device")),
                               csv_cell(new, row_new, csv_column(new, "device"))) == 0;
    const bool regular = strcmp(csv_cell(new, row_new, csv_column(new, "mode")), "regular") == 0;
    counts->both++;
    for (size_t i = 0; i < FIGURES; i++)
        if ((device || !figures[i].same_device) && (regular || !figures[i].regular_only))
            compare_figure(&figures[i], old, row_old, new, row_new, counts);
}

static void name_missing(const struct csv_table *here, const struct csv_table *there, const char *path,
                         struct counts *counts)
{
    for (size_t row = 0; row < here->row_count; row++)
        if (find(there, here, row) == there->row_count) {
            counts->missing++;
            printf("missing in %s: ", path);
            print_name(here, row);
            printf("\n");
        }
}

static void print_tolerances(void)
{
    printf("tolerances:");
    for (size_t i = 0; i < FIGURES; i++) {
        printf("%s %s", i ? "," : "", figures[i].column);
        if (figures[i].part > 0)
            printf(" %.3g %%", 100 * figures[i].part);
        if (figures[i].least > 0)
            printf("%s %.3g%s", figures[i].part > 0 ? " and" : "", figures[i].least, figures[i].unit);
    }
    printf("; a ratio also wants intervals that do not meet; the milliseconds of regular and memory count on "
           "one device "
           "only\n");
}

static bool usable(const struct csv_table *table, const char *path)
{
    static const char *const needed[] = {"device", "scene",  "mode",         "parameters",
                                         "width",  "height", "gpu_ms_median"};
    for (size_t i = 0; i < sizeof needed / sizeof needed[0]; i++)
        if (csv_column(table, needed[i]) < 0) {
            fprintf(stderr,
                    "fovbench compare: %s:1: there is no column '%s'; is it a file of fovbench --csv?\n", path,
                    needed[i]);
            return false;
        }
    return true;
}

static int compare(const struct csv_table *old, const struct csv_table *new, const char *old_path,
                   const char *new_path)
{
    struct counts counts = {0};
    for (size_t row = 0; row < new->row_count; row++) {
        size_t before = find(old, new, row);
        if (before < old->row_count)
            compare_row(old, before, new, row, &counts);
    }
    name_missing(old, new, new_path, &counts);
    name_missing(new, old, old_path, &counts);
    if (counts.both == 0) {
        fprintf(stderr, "fovbench compare: %s and %s have no line in common\n", old_path, new_path);
        return EXIT_FAILED;
    }
    printf("%zu lines compared: %zu figures worse, %zu better; %zu lines missing on one side\n", counts.both,
           counts.worse, counts.better, counts.missing);
    print_tolerances();
    return counts.worse ? EXIT_FAILED : EXIT_DONE;
}

int command_compare(int argc, char **argv)
{
    static const struct option_spec specs[] = {{NULL, NULL, NULL}};
    struct options options;
    struct csv_table tables[2] = {0};
    const char *paths[2] = {NULL, NULL};
    size_t count = 0;
    char error[4608];
    options_start(&options, argc, argv, "fovbench compare", specs);
    for (int i = options_next(&options); i != OPTIONS_DONE; i = options_next(&options)) {
        if (i == OPTIONS_HELP) {
            options_help(
                stdout, "fovbench compare OLD.csv NEW.csv",
                "Says what got slower or worse, and what better, beyond the tolerances it names. Exit status\n"
                "1 where something got worse, else 0. Times are compared as ratios to regular of the same\n"
                "run; regular's own milliseconds only where both files name one device.",
                specs);
            return EXIT_DONE;
        }
        if (i == OPTIONS_ERROR)
            return EXIT_USAGE;
        if (count == 2)
            return options_wrong("fovbench compare", "two files, not also '%s'", options.value);
        paths[count++] = options.value;
    }
    if (count < 2)
        return options_wrong("fovbench compare", "%s is missing", count ? "NEW.csv" : "OLD.csv");
    bool ok = true;
    for (size_t i = 0; i < 2 && ok; i++)
        if (!csv_read(&tables[i], paths[i], error, sizeof error)) {
            fprintf(stderr, "fovbench compare: %s\n", error);
            ok = false;
        } else {
            ok = usable(&tables[i], paths[i]);
        }
    int status = ok ? compare(&tables[0], &tables[1], paths[0], paths[1]) : EXIT_FAILED;
    csv_finish(&tables[0]);
    csv_finish(&tables[1]);
    return status;
}
