#include "app/fovbench/figures.h"

#include "app/command/options.h"
#include "app/command/output.h"

#include <string.h>

enum { TABLES = 8, ERROR_SIZE = 4608 };

static const struct {
    const char *file;
    bool of_frames; // drawn from a file of --frames-csv
    bool (*draw)(FILE *out, const struct csv_table *table, char *why, size_t why_size);
} figures[] = {
    {"figure06-epsilon", false, figure_epsilon},    {"figure10-resolution", false, figure_resolution},
    {"figure12-triangles", true, figure_triangles}, {"figure13-shaded", true, figure_shaded},
    {"figure14-moving", true, figure_moving},
};
enum { FIGURES = sizeof figures / sizeof figures[0] };

enum option { OUT, OPTIONS };

static const struct option_spec specs[OPTIONS + 1] = {
    [OUT] = {"o", "DIR", "folder for the figures, made where missing"},
    [OPTIONS] = {NULL, NULL, NULL},
};

// The figure's number-th sheet: 1 written, 0 nothing to show (why says it), -1 failed (said).
static int write_figure(size_t figure, const struct csv_table *table, size_t number, const char *folder,
                        char why[ERROR_SIZE])
{
    struct output output;
    char path[ERROR_SIZE - 512], error[ERROR_SIZE], suffix[16] = "";
    if (number > 0)
        snprintf(suffix, sizeof suffix, "-%zu", number + 1);
    snprintf(path, sizeof path, "%s/%s%s.svg", folder, figures[figure].file, suffix);
    bool ok = output_open(&output, path, error, sizeof error), drawn = false;
    if (ok) {
        drawn = figures[figure].draw(output.file, table, why, ERROR_SIZE);
        ok = output_close(&output, drawn, error, sizeof error);
    }
    if (!ok) {
        fprintf(stderr, "fovbench figures: %s\n", error);
        return -1;
    }
    if (drawn)
        printf("%s\n", path);
    return drawn;
}

// From every table of its kind; how many sheets, -1 where writing failed.
static int draw_figure(size_t figure, const struct csv_table *tables, size_t count, const char *folder)
{
    char why[ERROR_SIZE] = "there is no file of its kind";
    int drawn = 0;
    for (size_t t = 0; t < count; t++) {
        if ((csv_column(&tables[t], "frame") >= 0) != figures[figure].of_frames)
            continue;
        int result = write_figure(figure, &tables[t], (size_t)drawn, folder, why);
        if (result < 0)
            return -1;
        drawn += result;
    }
    if (!drawn)
        fprintf(stderr, "fovbench figures: no %s: %s\n", figures[figure].file, why);
    return drawn;
}

static int draw_all(const struct csv_table *tables, size_t count, const char *folder)
{
    int written = 0;
    for (size_t f = 0; f < FIGURES; f++) {
        int result = draw_figure(f, tables, count, folder);
        if (result < 0)
            return EXIT_FAILED;
        written += result;
    }
    if (written)
        return EXIT_DONE;
    fprintf(stderr, "fovbench figures: nothing could be drawn from these files\n");
    return EXIT_FAILED;
}

static int run(const char *const *paths, size_t count, const char *folder)
{
    struct csv_table tables[TABLES] = {0};
    char error[ERROR_SIZE];
    int status = EXIT_DONE;
    for (size_t i = 0; i < count && status == EXIT_DONE; i++)
        if (!csv_read(&tables[i], paths[i], error, sizeof error)) {
            fprintf(stderr, "fovbench figures: %s\n", error);
            status = EXIT_FAILED;
        } else if (csv_column(&tables[i], "scene") < 0 || tables[i].row_count == 0) {
            fprintf(
                stderr,
                "fovbench figures: %s: this is no file of fovbench --csv or --frames-csv, or it has no line\n",
                paths[i]);
            status = EXIT_FAILED;
        }
    if (status == EXIT_DONE && !output_make_folder(folder, error, sizeof error)) {
        fprintf(stderr, "fovbench figures: %s\n", error);
        status = EXIT_FAILED;
    }
    if (status == EXIT_DONE)
        status = draw_all(tables, count, folder);
    for (size_t i = 0; i < TABLES; i++)
        csv_finish(&tables[i]);
    return status;
}

int command_figures(int argc, char **argv)
{
    struct options options;
    const char *paths[TABLES], *folder = NULL;
    size_t count = 0;
    options_start(&options, argc, argv, "fovbench figures", specs);
    for (int i = options_next(&options); i != OPTIONS_DONE; i = options_next(&options)) {
        if (i == OPTIONS_HELP) {
            options_help(
                stdout, "fovbench figures FILE.csv... -o DIR",
                "Draws figures like the paper's as SVG: from a file of --csv Figure 6 (time against epsilon\n"
                "by pass; wants --pass-times) and 10 (time against resolution), from one of --frames-csv\n"
                "Figures 12 (triangles), 13 (pixels shaded) and 14 (time against the share of moving pixels).",
                specs);
            return EXIT_DONE;
        }
        if (i == OPTIONS_ERROR)
            return EXIT_USAGE;
        if (i == OUT)
            folder = options.value;
        else if (count == TABLES)
            return options_wrong("fovbench figures", "at most %d files", TABLES);
        else
            paths[count++] = options.value;
    }
    if (!folder || !count)
        return options_wrong("fovbench figures", "%s is missing", folder ? "FILE.csv" : "-o DIR");
    return run(paths, count, folder);
}
