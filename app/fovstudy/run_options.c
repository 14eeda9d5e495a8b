#include "app/fovstudy/run_options.h"

#include "app/command/options.h"
#include "app/display/display.h"
#include "stimuli/viewing.h"
#include "studies/engine/observer.h"

#include <stdlib.h>
#include <string.h>

enum option {
    DB,
    PARTICIPANT,
    PARTICIPANTS, // run only
    SEED,
    NUMBER,
    DISPLAY,
    SIZE,
    FOV,
    REFRESH,
    GAZE,
    OBSERVER,
    DEVICE,
    SCENE,
    ATTRIBUTE,
    EVENTS,
    UNBLIND,
    PATIENCE,
    PREFLIGHT,
    NO_PREFLIGHT,
    PLAYBACK,
    AGAIN,        // run only
    NEW_PROTOCOL, // run only
    PROTOCOL,     // resume only
    OPTIONS
};

#define UNATTENDED_PATIENCE_S 600.0

static const struct option_spec specs[OPTIONS + 1] = {
    [DB] = {"db", "FILE", "the study file; made where there is none"},
    [PARTICIPANT] = {"participant", "CODE",
                     "a code for the participant, never a name: 1 to 32 of A-Z a-z 0-9 . _ -"},
    [PARTICIPANTS] =
        {"participants", "N",
         "N simulated ones instead, one after the other: S001, S002, ...; those complete are passed over"},
    [SEED] = {"seed", "N", "instead of the protocol's seed"},
    [NUMBER] = {"number", "N", "the participant's number, from 1; else the first free one"},
    [DISPLAY] = {"display", "D", "window (default), monitor:N, headless, or none: nothing is drawn"},
    [SIZE] = {"size", "WxH", "pixels of each eye"},
    [FOV] = {"fov", "DEG", "vertical field of view of each eye, default 100"},
    [REFRESH] = {"refresh", "HZ", "rate of the headless clock, default 90"},
    [GAZE] = {"gaze", "G", "mouse (default in a window) or sim (default headless)"},
    [OBSERVER] = {"observer", "sim[:..]", "a simulated participant: sim:name=value,... as below"},
    [DEVICE] = {"device", "NAME", "part of a GPU's name"},
    [SCENE] = {"scene", "NAME=SPEC", "a scene of the protocol is this file or built-in scene; repeatable"},
    [ATTRIBUTE] = {"attribute", "k=v", "what the protocol asks about the participant; repeatable"},
    [EVENTS] = {"events", "FILE|-", "one JSON object a line on what happens"},
    [UNBLIND] = {"unblind", NULL, "name the options on the terminal (logged)"},
    [PATIENCE] = {"patience", "S", "seconds to wait for a full disk; else for ever, with --observer 600"},
    [PREFLIGHT] = {"preflight", "N",
                   "draw each option N frames before its block, headless too; default 1000 on a display"},
    [NO_PREFLIGHT] = {"no-preflight", NULL, "show what is too slow, to try things out (logged)"},
    [PLAYBACK] = {"playback-mb", "N", "memory for prerendered pictures, default half of what is free"},
    [AGAIN] = {"again", NULL, "the participant may have an earlier session in this file (logged)"},
    [NEW_PROTOCOL] =
        {"new-protocol", NULL,
         "the file may hold sessions of another protocol, or of another text of this one (logged)"},
    [PROTOCOL] = {"protocol", "FILE|-", "this file must be the session's protocol; -: look at none"},
    [OPTIONS] = {NULL, NULL, NULL},
};

// Whether `fovstudy run`, or `fovstudy resume`, takes an option of the table.
static bool taken(bool resume, int option)
{
    return resume ? option != AGAIN && option != NEW_PROTOCOL && option != PARTICIPANTS : option != PROTOCOL;
}

static const char about_resume[] =
    "Goes on with a session that was interrupted: the one of that number, else the last unfinished one.\n"
    "Display, size, field of view, gaze, scenes and observer are those it was started with; options that\n"
    "differ are refused, since they would change the conditions. The interrupted trial begins anew; what was\n"
    "answered stays. A protocol file that was changed since is refused; --protocol - goes on with the text\n"
    "that the study file holds.";

static const char about[] =
    "Runs a session and records it. Keys of the participant: Space switches, Left or 1 chooses A,\n"
    "Right or 2 chooses B, numbers and arrows mark a rating, Enter confirms, P pauses, Escape ends.\n"
    "\n"
    "A simulated observer (--observer sim:name=value,...) has threshold, slope, lapse, side_bias,\n"
    "toggles_mean, dwell_s, dwell_spread, rating_mean, rating_sd, rating_drop, view_s, answer_s, equal_band,\n"
    "count_error, late (share of deadlines missed), and errors=FILE. With --display none it answers from the "
    "errors that an earlier session measured and\n"
    "left in the study file, else from that file: lines of SCENE,ERROR,MODE[:p=v,...], ERROR the\n"
    "eccentricity-weighted RMSE against the reference, 0 to 1.";

static const char *command_name(const struct run_options *out)
{
    return out->resume ? "fovstudy resume" : "fovstudy run";
}

static int wrong_value(const struct run_options *out, enum option option, const char *value, const char *want)
{
    return options_wrong(command_name(out), "--%s '%s' is not right: %s", specs[option].name, value, want);
}

static int set_numbers(struct run_options *out, enum option option, const char *value)
{
    switch (option) {
    case SEED:
        out->has_seed = options_uint64(value, 0, INT64_MAX, &out->seed);
        return out->has_seed ? -1 : wrong_value(out, option, value, "a whole number from 0 to 2^63-1");
    case NUMBER:
        out->has_number = options_uint64(value, 1, 1000000, &out->number);
        return out->has_number ? -1 : wrong_value(out, option, value, "a whole number from 1 to 1000000");
    case PARTICIPANTS:
        return options_uint64(value, 1, RUN_PARTICIPANTS, &out->participants)
                   ? -1
                   : wrong_value(out, option, value, "a whole number from 1 to 999");
    case SIZE:
        return options_size(value, &out->width, &out->height)
                   ? -1
                   : wrong_value(out, option, value, "WIDTHxHEIGHT, each from 16 to 16384");
    case FOV:
        return options_double(value, 1.0, 170.0, &out->fov_deg)
                   ? -1
                   : wrong_value(out, option, value, "degrees, 1 to 170");
    case PREFLIGHT:
        return options_uint64(value, 1, 1000000, &out->preflight)
                   ? -1
                   : wrong_value(out, option, value, "a whole number of frames from 1 to 1000000");
    case PLAYBACK:
        return options_uint64(value, 1, UINT64_MAX >> 20, &out->playback_mb)
                   ? -1
                   : wrong_value(out, option, value, "a whole number of MB (10^6 bytes)");
    case PATIENCE:
        return options_double(value, 0.1, 1e6, &out->patience_s)
                   ? -1
                   : wrong_value(out, option, value, "0.1 s or more");
    default:
        return options_double(value, 1.0, 1000.0, &out->refresh_hz)
                   ? -1
                   : wrong_value(out, option, value, "1 to 1000 Hz");
    }
}

static int set_lists(struct run_options *out, enum option option, const char *value)
{
    char error[256];
    if (option == SCENE)
        return study_bind_scene(out->scenes, &out->scene_count, value, error, sizeof error)
                   ? -1
                   : options_wrong(command_name(out), "%s", error);
    if (out->attribute_count == RUN_ATTRIBUTES || !strchr(value, '='))
        return wrong_value(out, option, value, "NAME=VALUE, as the protocol's participant section names them");
    out->attributes[out->attribute_count++] = value;
    return -1;
}

static int set_word(struct run_options *out, const char *value)
{
    uint64_t id = 0;
    if (!out->resume && out->protocol)
        return options_wrong("fovstudy run", "one protocol at a time, not also '%s'", value);
    if (!out->resume) {
        out->protocol = value;
        return -1;
    }
    if (out->session)
        return options_wrong("fovstudy resume", "one session at a time, not also '%s'", value);
    if (!options_uint64(value, 1, INT64_MAX, &id))
        return options_wrong("fovstudy resume", "'%s' is no session; it is the number that 'run' gave it",
                             value);
    out->session = (int64_t)id;
    return -1;
}

static int set(struct run_options *out, int option, const char *value)
{
    if (!taken(out->resume, option))
        return options_wrong(command_name(out), "there is no option '--%s' here", specs[option].name);
    switch (option) {
    case OPTIONS_WORD:
        return set_word(out, value);
    case PROTOCOL:
        out->protocol = value;
        return -1;
    case AGAIN:
        out->again = true;
        return -1;
    case NEW_PROTOCOL:
        out->new_protocol = true;
        return -1;
    case DB:
        out->database = value;
        return -1;
    case PARTICIPANT:
        out->participant = value;
        return -1;
    case DISPLAY:
        out->display = value;
        return -1;
    case GAZE:
        out->gaze = value;
        return -1;
    case OBSERVER:
        out->observer = value;
        return -1;
    case DEVICE:
        out->device = value;
        return -1;
    case EVENTS:
        out->events = value;
        return -1;
    case UNBLIND:
        out->unblind = true;
        return -1;
    case NO_PREFLIGHT:
        out->no_preflight = true;
        return -1;
    case SCENE:
    case ATTRIBUTE:
        return set_lists(out, (enum option)option, value);
    default:
        return set_numbers(out, (enum option)option, value);
    }
}

double run_step_hz(const struct run_options *options)
{
    return options->refresh_hz > 0.0 ? options->refresh_hz : DISPLAY_HEADLESS_HZ;
}

void run_options_patience(struct run_options *options)
{
    if (options->observer && !(options->patience_s > 0.0))
        options->patience_s = UNATTENDED_PATIENCE_S;
}

int run_options_code(const char *command, const char *code)
{
    size_t length = strlen(code);
    if (strncmp(code, "forgotten-", 10) == 0)
        return options_wrong(command, "'%.64s' is kept for people who were erased; give another code", code);
    if (length >= 1 && length <= 32 &&
        strspn(code, "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789._-") == length)
        return -1;
    return options_wrong(
        command,
        "'%.64s' is no code for a participant: give 1 to 32 of A-Z, a-z, 0-9, '.', '_' and '-', "
        "and no name, since it stands in the file and its reports",
        code);
}

// Values that need no protocol to be judged.
static int check_values(const struct run_options *options)
{
    struct observer_parameters observer;
    char error[512];
    observer_defaults(&observer);
    if (options->observer && !observer_parse(options->observer, &observer, error, sizeof error))
        return options_wrong(command_name(options), "%s", error);
    return options->resume || !options->participant ? -1
                                                    : run_options_code("fovstudy run", options->participant);
}

static int answerable(const struct run_options *options)
{
    bool blind = strcmp(options->display, "headless") == 0 || strcmp(options->display, "none") == 0;
    if (blind && !options->observer)
        return options_wrong(command_name(options), "nobody can answer with --display %s; give --observer sim",
                             options->display);
    return -1;
}

static int check(struct run_options *out)
{
    if (!out->resume && !out->protocol)
        return options_wrong("fovstudy run", "which protocol? name its file");
    if (!out->database)
        return options_wrong(command_name(out),
                             out->resume ? "of which study? give --db FILE" : "where to? give --db FILE");
    if (out->no_preflight && out->preflight)
        return options_wrong(command_name(out), "--preflight and --no-preflight contradict each other");
    if (out->resume)
        return check_values(out);
    if (out->participants && (out->participant || out->has_number || !out->observer))
        return options_wrong("fovstudy run",
                             "--participants is for simulated ones, who have codes and numbers of "
                             "their own: give --observer sim, and no --participant or --number");
    if (!out->participants && (!out->participant || !*out->participant))
        return options_wrong("fovstudy run", "who takes part? give --participant CODE");
    int status = check_values(out);
    if (status >= 0)
        return status;
    if (!out->display)
        out->display = "window";
    if (!(out->fov_deg > 0.0))
        out->fov_deg = VIEWING_DEFAULT_FOV_DEG;
    run_options_patience(out);
    return answerable(out);
}

static void help(bool resume)
{
    struct option_spec listed[OPTIONS + 1];
    size_t count = 0;
    for (int i = 0; i < OPTIONS; i++)
        if (taken(resume, i))
            listed[count++] = specs[i];
    listed[count] = specs[OPTIONS];
    if (resume)
        options_help(stdout, "fovstudy resume --db FILE [SESSION] [options]", about_resume, listed);
    else
        options_help(stdout, "fovstudy run PROTOCOL --db FILE --participant CODE [options]", about, listed);
}

int run_options_read(struct run_options *out, bool resume, int argc, char **argv)
{
    struct options options;
    *out = (struct run_options){.resume = resume};
    options_start(&options, argc, argv, command_name(out), specs);
    for (int i = options_next(&options); i != OPTIONS_DONE; i = options_next(&options)) {
        if (i == OPTIONS_HELP) {
            help(resume);
            return EXIT_DONE;
        }
        if (i == OPTIONS_ERROR)
            return EXIT_USAGE;
        int status = set(out, i, options.value);
        if (status >= 0)
            return status;
    }
    return check(out);
}
