#include "analysis/report/report.h"

#include "analysis/tools/arguments.h"
#include "analysis/tools/study_arguments.h"

static const char help[] =
    "usage: fovstats report DB... -o FILE.html [--conf C] [--simulated]\n"
    "\n"
    "Writes one HTML file with sample, methods, choices, ratings, frame times, quality, exclusions and\n"
    "definitions; its figures are inside it, and it opens without a network. Needs gnuplot.\n"
    "  -o FILE      where to; written whole or not at all\n"
    "  --conf C     confidence of intervals and null regions (0.95)\n"
    "  --simulated  report simulated sessions, which are left out otherwise; the report is branded\n"
    "  --protocol N report the sessions of this protocol; else of the one with most sessions\n";

static int run(const struct command *command, int argc, char **argv)
{
    struct study_arguments arguments;
    struct sample sample;
    int code = study_arguments_load(command, argc, argv, true, &arguments, &sample);
    if (code >= 0)
        return code;
    char error[SAMPLE_ERROR_SIZE];
    code = EXIT_DONE;
    if (!report_write(&sample, arguments.conf, arguments.output, error, sizeof error))
        code = command_fail(command, EXIT_FAILED, "%s", error);
    sample_free(&sample);
    return code;
}

const struct command command_report = {"report", "one HTML file with figures", help, run};
