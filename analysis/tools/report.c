#include "analysis/report/report.h"

#include "analysis/tools/arguments.h"
#include "analysis/tools/study_arguments.h"

#include <stdio.h>

static const char help[] =
    "usage: fovstats report DB... -o FILE.html [--figures FOLDER] [--bench FILE.csv] [--conf C] [--simulated]\n"
    "\n"
    "Writes one HTML file with sample, methods, choices, ratings, frame times, quality, exclusions and\n"
    "definitions; its figures are inside it, and it opens without a network. Needs gnuplot.\n"
    "  -o FILE      where to; written whole or not at all\n"
    "  --figures F  also write every figure into the folder F, as SVG and as PDF (by rsvg-convert): as wide "
    "as\n"
    "               a page, and NAME_narrow as wide as a column; a line in each names the data and the "
    "version\n"
    "  --bench F    also show speed against error from F, which fovbench --csv wrote; several such files may "
    "be\n"
    "               put together, and each device and scene is compared with its own 'regular'\n"
    "  --conf C     confidence of intervals and null regions (0.95)\n"
    "  --simulated  report simulated sessions, which are left out otherwise; the report is branded\n"
    "  --protocol N report the sessions of this protocol; else of the one with most sessions\n";

static int run(const struct command *command, int argc, char **argv)
{
    struct study_arguments arguments;
    struct sample sample;
    struct figure_files files = {0};
    const char *bench = NULL;
    const struct option own[] = {{"--figures", OPTION_TEXT, &files.folder}, {"--bench", OPTION_TEXT, &bench}};
    int code = study_arguments_load_with(command, argc, argv, true, own, 2, &arguments, &sample);
    if (code >= 0)
        return code;
    char error[SAMPLE_ERROR_SIZE];
    code = EXIT_DONE;
    files.sample = &sample;
    if (!report_write_with_figures(&sample, arguments.conf, arguments.output, bench,
                                   files.folder ? &files : NULL, error, sizeof error))
        code = command_fail(command, EXIT_FAILED, "%s", error);
    else if (files.no_pdf)
        fprintf(
            stderr,
            "fovstats report: the %zu figures in %s are SVG only: rsvg-convert is not installed, and PDF needs "
            "it: apt install librsvg2-bin\n",
            files.svgs, files.folder);
    sample_free(&sample);
    return code;
}

const struct command command_report = {"report", "one HTML file with figures", help, run};
