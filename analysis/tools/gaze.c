#include "analysis/tools/gaze_parts.h"
#include "analysis/tools/study_arguments.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static const char help[] =
    "usage: fovstats gaze DB... [--events] [--method ivt|idt] [OPTION...] [--simulated] [--json]\n"
    "\n"
    "The eye tracker's quality per person and eye (and per session, where somebody had several), from the "
    "samples\n"
    "of the last attempt of each trial: rate, data loss, accuracy, precision; fixations, saccades and their "
    "main\n"
    "sequence; distance of the gaze to the fixation target; age of the gaze in the frames that followed it.\n"
    "All angles are degrees of visual angle in the head's frame: right and up positive.\n"
    "\n"
    "  not valid  of the samples that came; missing: of the samples due at the nominal rate\n"
    "  accuracy   mean distance of all valid samples from a target at rest (a fixation cross), wherever they "
    "lie and\n"
    "             saccades included, and the mean offset; of one eye, from where that eye sees the target\n"
    "  RMS-S2S    root mean square from sample to sample; SD about the mean: both within fixations, in trials "
    "without\n"
    "             a moving target, horizontal, vertical, both\n"
    "  BCEA       2 k pi SDh SDv sqrt(1 - r^2), k = -ln(1 - P): the ellipse of a share P (Crossland & Rubin "
    "2002)\n"
    "  cut        events at a gap or a trial's end; their duration and amplitude are not known\n"
    "  Vmax, c    V = Vmax (1 - exp(-A / c)) of peak velocity and amplitude; k, b: V = k A^b. Vmax is not "
    "estimable\n"
    "             of trackers slower than 114 Hz, c, k and b of those slower than 235 Hz;\n"
    "             saccades with samples missing at their peak are left out, there and of the mean peak\n"
    "\n"
    "  --events           instead: every fixation and saccade, as CSV; a peak is empty where the samples are "
    "more\n"
    "                     than 17.5 ms apart around it (slower than 114 Hz, or missing)\n"
    "  --method M         ivt (default): by velocity; idt: by dispersion, fixations only (Salvucci & Goldberg "
    "2000)\n"
    "  --velocity V       ivt: a saccade is faster than V deg/s; default 30 (Olsen 2012)\n"
    "  --window-ms T      ivt: velocity between the samples at most T/2 before and after; default 20 (Olsen "
    "2012)\n"
    "  --peak-ms T        ivt: the same of a saccade's peak velocity; default 8\n"
    "  --dispersion D     idt: (max x - min x) + (max y - min y) of a fixation is at most D degrees; default "
    "1\n"
    "  --min-fixation-ms T  default 60 (ivt, Olsen 2012), 100 (idt, Salvucci & Goldberg 2000)\n"
    "  --min-saccade-ms T ivt: default 10\n"
    "  --merge-ms T, --merge-deg D  ivt: fixations closer in time and place are one; default 75, 0.5 (Olsen "
    "2012)\n"
    "  --gap-ms T         longer without a sample breaks an event; default 50\n"
    "  --rate HZ          the tracker's nominal rate; default: as measured\n"
    "  --region X,Y       samples whose distance to the target counts: within X degrees left and right, Y up "
    "and\n"
    "                     down; default 10.3,11.68 (Weier et al. 2016, section 4.2.2)\n"
    "  --bcea P           share of the ellipse; default 0.682\n"
    "  --conf C           confidence of intervals; default 0.95\n"
    "  --simulated        analyse simulated sessions, which are left out otherwise\n"
    "  --protocol N       analyse the sessions of this protocol; else of the one with most sessions\n"
    "  --json             one object; with --events, the events in an array\n";

struct own {
    bool events;
    const char *method, *region;
    double velocity, window, peak, dispersion, fixation, saccade, merge_ms, merge_deg, gap, rate,
        bcea; // NaN: not given
};

enum { OWN = 14 };

static void list_options(struct own *own, struct option out[OWN])
{
    *own = (struct own){.velocity = NAN,
                        .window = NAN,
                        .peak = NAN,
                        .dispersion = NAN,
                        .fixation = NAN,
                        .saccade = NAN,
                        .merge_ms = NAN,
                        .merge_deg = NAN,
                        .gap = NAN,
                        .rate = NAN,
                        .bcea = NAN};
    const struct option options[OWN] = {{"--events", OPTION_FLAG, &own->events},
                                        {"--method", OPTION_TEXT, &own->method},
                                        {"--region", OPTION_TEXT, &own->region},
                                        {"--velocity", OPTION_NUMBER, &own->velocity},
                                        {"--window-ms", OPTION_NUMBER, &own->window},
                                        {"--peak-ms", OPTION_NUMBER, &own->peak},
                                        {"--dispersion", OPTION_NUMBER, &own->dispersion},
                                        {"--min-fixation-ms", OPTION_NUMBER, &own->fixation},
                                        {"--min-saccade-ms", OPTION_NUMBER, &own->saccade},
                                        {"--merge-ms", OPTION_NUMBER, &own->merge_ms},
                                        {"--merge-deg", OPTION_NUMBER, &own->merge_deg},
                                        {"--gap-ms", OPTION_NUMBER, &own->gap},
                                        {"--rate", OPTION_NUMBER, &own->rate},
                                        {"--bcea", OPTION_NUMBER, &own->bcea}};
    memcpy(out, options, sizeof options);
}

static bool read_region(const char *text, struct gaze_options *options)
{
    char copy[64], *comma;
    if (snprintf(copy, sizeof copy, "%s", text) >= (int)sizeof copy || !(comma = strchr(copy, ',')))
        return false;
    *comma = '\0';
    return arguments_number(copy, &options->region_x_deg) &&
           arguments_number(comma + 1, &options->region_y_deg) && options->region_x_deg > 0 &&
           options->region_y_deg > 0;
}

// A number that was given takes the default's place where it is in its range; -1, or the exit code.
static int take(const struct command *command, const char *name, double given, double low, bool open,
                double high, double *value)
{
    if (isnan(given))
        return -1;
    if (given < low || (open && given <= low) || given >= high)
        return command_fail(command, EXIT_USAGE, "%s is %g but must be %s %g and below %g", name, given,
                            open ? "above" : "at least", low, high);
    *value = given;
    return -1;
}

static int read_options(const struct command *command, const struct own *own, struct gaze_options *out)
{
    bool idt = own->method && strcmp(own->method, "idt") == 0;
    if (own->method && !idt && strcmp(own->method, "ivt") != 0)
        return command_fail(command, EXIT_USAGE, "--method is \"%s\" but must be ivt or idt", own->method);
    *out = gaze_options(idt ? GAZE_IDT : GAZE_IVT);
    struct gaze_rules *rules = &out->rules;
    const struct {
        const char *name;
        double given, low;
        bool open;
        double high;
        double *value;
    } numbers[] = {{"--velocity", own->velocity, 0, true, 1e4, &rules->velocity_deg_s},
                   {"--window-ms", own->window, 0, false, 1000, &rules->window_ms},
                   {"--peak-ms", own->peak, 0, false, 1000, &rules->peak_ms},
                   {"--dispersion", own->dispersion, 0, true, 180, &rules->dispersion_deg},
                   {"--min-fixation-ms", own->fixation, 0, false, 1e5, &rules->min_fixation_ms},
                   {"--min-saccade-ms", own->saccade, 0, false, 1e4, &rules->min_saccade_ms},
                   {"--merge-ms", own->merge_ms, 0, false, 1e4, &rules->merge_ms},
                   {"--merge-deg", own->merge_deg, 0, false, 180, &rules->merge_deg},
                   {"--gap-ms", own->gap, 0, true, 1e5, &out->gap_ms},
                   {"--rate", own->rate, 0, true, 1e5, &out->rate_hz},
                   {"--bcea", own->bcea, 0, true, 1, &out->bcea_share}};
    for (size_t i = 0; i < sizeof numbers / sizeof numbers[0]; i++) {
        int code = take(command, numbers[i].name, numbers[i].given, numbers[i].low, numbers[i].open,
                        numbers[i].high, numbers[i].value);
        if (code >= 0)
            return code;
    }
    if (own->region && !read_region(own->region, out))
        return command_fail(command, EXIT_USAGE,
                            "--region is \"%s\" but must be two angles above 0, for example 10.3,11.68",
                            own->region);
    return -1;
}

static int print(const struct command *command, const struct sample *sample, const struct gaze_report *gaze,
                 bool json)
{
    struct gaze_over over;
    bool ok = gaze_over_people(&over, gaze);
    if (ok && json)
        gaze_print_json(sample, gaze, &over);
    else if (ok)
        ok = gaze_print_text(sample, gaze, &over);
    return ok ? command_finish(command) : command_fail(command, EXIT_FAILED, "not enough memory");
}

#define NO_ROOM "there is no room for the events on the disk of temporary files; make some"

static int analyse(const struct command *command, struct sample *sample, struct gaze_options *options,
                   bool events, bool json)
{
    char error[SAMPLE_ERROR_SIZE];
    struct gaze_report gaze = {.record_count = 0};
    struct gaze_events list = {.sample = sample, .as_json = json};
    int code = -1;
    if (events) {
        options->each = gaze_events_each;
        options->user = &list;
        if (!gaze_events_begin(&list))
            return command_fail(command, EXIT_FAILED, NO_ROOM);
    }
    if (!gaze_load(&gaze, sample, options, error, sizeof error))
        code = command_fail(command, EXIT_FAILED, "%s", error);
    else if (gaze.record_count + gaze.check_count + gaze.latency_count == 0)
        code = command_fail(command, EXIT_FAILED, "%s: no gaze sample was recorded in any session that counts",
                            store_reader_path(sample->files[0]));
    if (events && !gaze_events_end(&list, code < 0) && code < 0)
        code = command_fail(command, EXIT_FAILED, NO_ROOM);
    if (code < 0)
        code = events ? command_finish(command) : print(command, sample, &gaze, json);
    gaze_free(&gaze);
    return code;
}

static int run(const struct command *command, int argc, char **argv)
{
    struct study_arguments arguments;
    struct gaze_options options;
    struct sample sample;
    struct own own;
    struct option own_list[OWN];
    list_options(&own, own_list);
    int code = study_arguments_load_with(command, argc, argv, false, own_list, OWN, &arguments, &sample);
    if (code >= 0)
        return code;
    code = read_options(command, &own, &options);
    options.conf = arguments.conf;
    if (code < 0)
        code = analyse(command, &sample, &options, own.events, arguments.json);
    sample_free(&sample);
    return code;
}

const struct command command_gaze = {
    "gaze", "quality of eye tracking, fixations and saccades, distance to targets", help, run};
