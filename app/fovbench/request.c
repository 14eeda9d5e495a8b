#include "app/fovbench/request.h"

#include "app/command/options.h"
#include "stimuli/viewing.h"

#include <string.h>

static const char about[] =
    "Draws every mode on the same frames of a scene's camera path, frame by frame in turn, and measures\n"
    "time and error. The first mode is always 'regular': the others' times are also given as ratios to its\n"
    "time in the same frame, and errors are against its picture. Modes, scenes, sizes and gazes take several\n"
    "values each; every scene is measured at every size with every gaze.\n"
    "\n"
    "also: fovbench compare OLD.csv NEW.csv      what got slower or worse\n"
    "      fovbench figures FILE.csv... -o DIR   figures like the paper's 6, 10, 12, 13 and 14";

enum option {
    MODES,
    SCENES,
    SIZE,
    SIZES,
    GAZE,
    FRAMES,
    SSAO,
    TAA,
    REST,
    FOV,
    START,
    PASS_TIMES,
    ERROR_EVERY,
    STILL_FRAMES,
    SUPERSAMPLED,
    NO_ERRORS,
    CSV,
    JSON,
    PLOT,
    FRAMES_CSV,
    DEVICE,
    OPTIONS
};

static const struct option_spec specs[OPTIONS + 1] = {
    [MODES] = {"modes", "MODE[:p=v,...]...",
               "modes with parameters (regular and time_warped); see 'fovstudy modes'"},
    [SCENES] = {"scenes", "NAME|FILE...", "built-in scenes, see 'fovstudy scenes', or glTF files (atrium)"},
    [SIZE] = {"size", "WxH", "pixels per eye (640x720)"},
    [SIZES] = {"sizes", "WxH...", "the same"},
    [GAZE] = {"gaze", "centre|script|X,Y...", "where the eyes look; degrees, right and up positive (centre)"},
    [FRAMES] = {"frames", "N", "measured frames, 1/90 s each, after 10 unmeasured ones (60)"},
    [SSAO] = {"ssao", NULL, "with ambient occlusion"},
    [TAA] = {"taa", NULL, "with temporal antialiasing"},
    [REST] = {"rest", NULL, "keep moving objects at rest"},
    [FOV] = {"fov", "DEG", "vertical field of view (100)"},
    [START] = {"start", "S", "where on the path to begin, seconds (0)"},
    [PASS_TIMES] = {"pass-times", NULL, "each pass's time from a second walk with one submission per pass"},
    [ERROR_EVERY] = {"error-every", "N",
                     "compare pictures at every N-th frame (a twelfth of --frames, at least 2)"},
    [STILL_FRAMES] = {"still-frames", "N",
                      "frames of the still stretch for flicker_still, 4 to 256; 0 for none (30)"},
    [SUPERSAMPLED] = {"supersampled", "N",
                      "frames also compared with a supersampled reference, in the JSON (0)"},
    [NO_ERRORS] = {"no-errors", NULL, "measure time only"},
    [CSV] = {"csv", "FILE", "one line per mode, scene, size and gaze; - is standard output"},
    [JSON] = {"json", "FILE", "the same with passes, rings, redraw causes and the supersampled reference"},
    [PLOT] = {"plot", "FILE.svg", "error over time with the Pareto front"},
    [FRAMES_CSV] = {"frames-csv", "FILE", "one line per measured frame"},
    [DEVICE] = {"device", "NAME", "part of the GPU's name"},
    [OPTIONS] = {NULL, NULL, NULL},
};

static int too_many(int option, size_t most)
{
    return options_wrong("fovbench", "--%s takes at most %zu values", specs[option].name, most);
}

static int wrong(int option, const char *value, const char *expected)
{
    return options_wrong("fovbench", "--%s is '%s', not %s", specs[option].name, value, expected);
}

static int add_mode(struct request *r, const char *text)
{
    char error[1024];
    struct request_mode mode = {.text = text};
    if (!mode_parse(text, &mode.choice, error, sizeof error))
        return options_wrong("fovbench", "%s", error);
    for (size_t i = 0; i < r->mode_count; i++)
        if (r->modes[i].choice.mode == mode.choice.mode &&
            memcmp(r->modes[i].choice.values, mode.choice.values, sizeof mode.choice.values) == 0)
            // the first is the reference, which is there without being named
            return i == 0 ? -1 : options_wrong("fovbench", "mode '%s' is there twice", text);
    if (r->mode_count == REQUEST_MODES)
        return too_many(MODES, REQUEST_MODES - 1);
    r->modes[r->mode_count++] = mode;
    return -1;
}

static int add_size(struct request *r, int option, const char *text)
{
    if (r->size_count == REQUEST_SIZES)
        return too_many(option, REQUEST_SIZES);
    struct request_size *size = &r->sizes[r->size_count++];
    return options_size(text, &size->width, &size->height)
               ? -1
               : wrong(option, text, "WIDTHxHEIGHT, 16 to 16384 each");
}

static int add_gaze(struct request *r, const char *text)
{
    if (r->gaze_count == REQUEST_GAZES)
        return too_many(GAZE, REQUEST_GAZES);
    struct request_gaze *gaze = &r->gazes[r->gaze_count++];
    gaze->text = text;
    return walk_gaze_read(text, &gaze->gaze) ? -1 : wrong(GAZE, text, "centre, script or X,Y in degrees");
}

static int add_scene(struct request *r, const char *text)
{
    if (r->scene_count == REQUEST_SCENES)
        return too_many(SCENES, REQUEST_SCENES);
    r->scenes[r->scene_count++] = text;
    return -1;
}

static bool is_list(int option)
{
    return option == MODES || option == SCENES || option == SIZE || option == SIZES || option == GAZE;
}

static int add_to_list(struct request *r, int option, const char *text)
{
    switch (option) {
    case MODES:
        return add_mode(r, text);
    case SCENES:
        return add_scene(r, text);
    case GAZE:
        return add_gaze(r, text);
    default:
        return add_size(r, option, text);
    }
}

static int take_number(struct request *r, int option, const char *text)
{
    switch (option) {
    case FRAMES:
        return options_uint64(text, 1, 1000000, &r->frames)
                   ? -1
                   : wrong(option, text, "a whole number from 1 to 1000000");
    case ERROR_EVERY:
        return options_uint64(text, 1, 1000000, &r->error_every)
                   ? -1
                   : wrong(option, text, "a whole number from 1 to 1000000");
    case STILL_FRAMES:
        return (options_uint64(text, 0, 0, &r->still_frames) || options_uint64(text, 4, 256, &r->still_frames))
                   ? -1
                   : wrong(option, text, "0 or a whole number from 4 to 256");
    case SUPERSAMPLED:
        return options_uint64(text, 0, 10000, &r->supersampled)
                   ? -1
                   : wrong(option, text, "a whole number from 0 to 10000");
    case FOV:
        return options_double(text, 1, 170, &r->fov_deg)
                   ? -1
                   : wrong(option, text, "a number of degrees from 1 to 170");
    default:
        return options_double(text, 0, 1e6, &r->start_s)
                   ? -1
                   : wrong(option, text, "a number of seconds from 0 to 1000000");
    }
}

static int take_text(struct request *r, int option, const char *text)
{
    const char **places[] = {[CSV] = &r->outputs.csv,
                             [JSON] = &r->outputs.json,
                             [PLOT] = &r->outputs.plot,
                             [FRAMES_CSV] = &r->outputs.frames_csv,
                             [DEVICE] = &r->device};
    *places[option] = text;
    return -1;
}

static void take_flag(struct request *r, int option, bool *no_errors)
{
    bool *flags[] = {[SSAO] = &r->ssao,
                     [TAA] = &r->taa,
                     [REST] = &r->rest,
                     [PASS_TIMES] = &r->pass_times,
                     [NO_ERRORS] = no_errors};
    *flags[option] = true;
}

static int take(struct request *r, int option, const char *value, bool *no_errors)
{
    if (!specs[option].argument) {
        take_flag(r, option, no_errors);
        return -1;
    }
    if (is_list(option))
        return add_to_list(r, option, value);
    return option >= CSV ? take_text(r, option, value) : take_number(r, option, value);
}

// What was not said. Errors need two frames in a row, so the least interval is 2.
static int complete(struct request *r, bool no_errors, bool modes_said)
{
    if (!modes_said)
        add_mode(r, "time_warped");
    if (r->scene_count == 0)
        add_scene(r, "atrium");
    if (r->size_count == 0)
        r->sizes[r->size_count++] = (struct request_size){640, 720};
    if (r->gaze_count == 0)
        add_gaze(r, "centre");
    if (no_errors && (r->error_every || r->supersampled))
        return options_wrong("fovbench", "--no-errors and errors at the same time");
    if (no_errors)
        r->still_frames = r->error_every = 0;
    else if (r->error_every == 0)
        r->error_every = r->frames / 12 > 2 ? r->frames / 12 : 2;
    if (r->error_every > r->frames)
        r->error_every = r->frames;
    return -1;
}

int request_read(struct request *out, int argc, char **argv)
{
    struct options options;
    int list = OPTIONS_WORD; // which option a word that follows belongs to
    bool no_errors = false, modes_said = false;
    *out =
        (struct request){.frames = 60, .still_frames = 30, .fov_deg = VIEWING_DEFAULT_FOV_DEG, .mode_count = 1};
    char error[256];
    out->modes[0].text = "regular";
    if (!mode_parse("regular", &out->modes[0].choice, error, sizeof error))
        return options_wrong("fovbench", "%s", error);
    options_start(&options, argc, argv, "fovbench", specs);
    for (int i = options_next(&options); i != OPTIONS_DONE; i = options_next(&options)) {
        if (i == OPTIONS_HELP) {
            options_help(stdout, "fovbench [--modes M[:p=v,...]...] [--scenes NAME|FILE...] [options]", about,
                         specs);
            return EXIT_DONE;
        }
        if (i == OPTIONS_ERROR)
            return EXIT_USAGE;
        if (i == OPTIONS_WORD && list == OPTIONS_WORD)
            return options_wrong("fovbench", "'%s' is not expected here", options.value);
        int option = i == OPTIONS_WORD ? list : i;
        list = is_list(option) ? option : OPTIONS_WORD;
        modes_said = modes_said || option == MODES;
        int status = take(out, option, options.value, &no_errors);
        if (status >= 0)
            return status;
    }
    return complete(out, no_errors, modes_said);
}
