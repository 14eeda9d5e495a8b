#include "analysis/report/frames.h"

#include "analysis/tools/arguments.h"
#include "analysis/tools/frames_pairs.h"
#include "analysis/tools/study_arguments.h"
#include "analysis/tools/table.h"

#include <inttypes.h>
#include <stdio.h>
#include <string.h>

static const char help[] =
    "usage: fovstats frames DB... [--audit] [--simulated] [--conf C] [--json]\n"
    "\n"
    "Frame times in milliseconds per option and phase: GPU, CPU and interval between frames (median, 95th\n"
    "and 99th percentile, type 7), late frames, and pixels shaded. Gray frames and text are not rendered.\n"
    "Then the test option against the reference within trials, with an interval over people.\n"
    "  --audit      instead: rows against frames submitted, late frames by phase, stale gaze, foveation that "
    "was not\n"
    "               the one asked for, and the fade of every switch against the protocol; names the trials\n"
    "  --simulated  analyse simulated sessions, which are left out otherwise\n"
    "  --protocol N analyse the sessions of this protocol; else of the one with most sessions\n"
    "  --conf C     confidence of the interval over people (0.95)\n"
    "  --json       one object with the groups in an array\n";

static void times_cells(struct table *t, const struct frame_times *times)
{
    const double values[] = {times->median, times->p95, times->p99};
    for (int i = 0; i < 3; i++) {
        if (times->count)
            table_cell(t, "%.3f", values[i]);
        else
            table_cell(t, "-");
    }
}

static bool print_text(const struct sample *sample, const struct frames *f, const struct frames_pairs *pairs,
                       double conf)
{
    const char *const headings[] = {"<phase",  "<option",      "frames", "late",    "late %",
                                    "GPU p50", "p95",          "p99",    "CPU p50", "p95",
                                    "p99",     "interval p50", "p95",    "p99",     NULL};
    struct table t;
    table_init(&t, headings);
    for (size_t i = 0; i < f->group_count; i++) {
        const struct frame_group *g = &f->groups[i];
        table_cell(&t, "%s", g->phase);
        table_cell(&t, "%s", g->label);
        table_cell(&t, "%" PRId64, g->frames);
        table_cell(&t, "%" PRId64, g->late);
        if (g->late_known)
            table_cell(&t, "%.2f", 100 * (double)g->late / (double)g->late_known);
        else
            table_cell(&t, "-");
        times_cells(&t, &g->gpu);
        times_cells(&t, &g->cpu);
        times_cells(&t, &g->interval);
    }
    bool ok = table_print(&t, stdout);
    table_finish(&t);
    printf("\nMilliseconds. Late: %" PRId64 " of %" PRId64 " frames.\n", f->late, f->late_known);
    if (f->late_known < f->frames)
        printf("Of %" PRId64
               " frames it is not known whether they were late: the display told no refresh rate; percentages "
               "are of the others.\n",
               f->frames - f->late_known);
    if (f->simulated_clock)
        puts("The clock was simulated: intervals and late frames are that clock's and say nothing of the "
             "machine.");
    ok = ok && frames_pairs_print(sample, pairs, conf);
    study_notes(sample);
    return ok;
}

static void times_json(struct json *json, const char *key, const struct frame_times *times)
{
    json_open(json, key, '{');
    json_integer(json, "frames", (int64_t)times->count);
    json_number(json, "median", times->median);
    json_number(json, "p95", times->p95);
    json_number(json, "p99", times->p99);
    json_close(json, '}');
}

static void print_json(const struct sample *sample, const struct frames *f, const struct frames_pairs *pairs)
{
    struct json json = {stdout, false};
    json_open(&json, NULL, '{');
    study_title_json(&json, sample);
    json_bool(&json, "simulated_clock", f->simulated_clock);
    json_integer(&json, "frames", f->frames);
    json_integer(&json, "late", f->late);
    json_integer(&json, "late_known", f->late_known);
    json_open(&json, "groups", '[');
    for (size_t i = 0; i < f->group_count; i++) {
        const struct frame_group *g = &f->groups[i];
        json_open(&json, NULL, '{');
        json_text(&json, "phase", g->phase);
        json_text(&json, "option", g->label);
        json_integer(&json, "frames", g->frames);
        json_integer(&json, "late", g->late);
        json_integer(&json, "late_known", g->late_known);
        times_json(&json, "gpu_ms", &g->gpu);
        times_json(&json, "cpu_ms", &g->cpu);
        times_json(&json, "interval_ms", &g->interval);
        json_number(&json, "shaded_px_mean", g->shaded_px_mean);
        json_close(&json, '}');
    }
    json_close(&json, ']');
    frames_pairs_json(&json, sample, pairs);
    json_close(&json, '}');
    putchar('\n');
}

// Takes --audit out of the arguments, which the other subcommands do not know.
static bool take_audit(int *argc, char **argv)
{
    int kept = 0;
    bool options = true, audit = false;
    for (int i = 0; i < *argc; i++) {
        options = options && strcmp(argv[i], "--") != 0;
        if (options && strcmp(argv[i], "--audit") == 0)
            audit = true;
        else
            argv[kept++] = argv[i];
    }
    *argc = kept;
    return audit;
}

static int run(const struct command *command, int argc, char **argv)
{
    struct study_arguments arguments;
    struct sample sample;
    bool audit = take_audit(&argc, argv);
    int code = study_arguments_load(command, argc, argv, false, &arguments, &sample);
    if (code >= 0)
        return code;
    if (audit) {
        code = frames_audit(command, &sample, arguments.json);
        sample_free(&sample);
        return code;
    }
    char error[SAMPLE_ERROR_SIZE];
    struct frames f;
    struct frames_pairs pairs;
    if (!frames_load(&f, &pairs, &sample, arguments.conf, error, sizeof error)) {
        code = command_fail(command, EXIT_FAILED, "%s", error);
    } else if (f.group_count == 0) {
        code =
            command_fail(command, EXIT_FAILED, "%s: no frame was recorded", store_reader_path(sample.files[0]));
    } else if (arguments.json) {
        print_json(&sample, &f, &pairs);
        code = command_finish(command);
    } else {
        study_title(&sample, "Frame times");
        code = print_text(&sample, &f, &pairs, arguments.conf)
                   ? command_finish(command)
                   : command_fail(command, EXIT_FAILED, "not enough memory");
    }
    frames_pairs_free(&pairs);
    frames_free(&f);
    sample_free(&sample);
    return code;
}

const struct command command_frames = {"frames", "frame times and late frames per option and phase", help, run};
