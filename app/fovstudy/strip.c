// `fovstudy strip`: several modes along one walk, side by side: pictures, differences to `regular`, redraw
// maps.
#include "app/command/options.h"
#include "app/command/output.h"
#include "app/command/walk.h"
#include "app/fovstudy/commands.h"
#include "app/fovstudy/picture.h"
#include "app/fovstudy/sheet.h"
#include "renderer/renderer.h"

#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MODES = 8, ERROR = 4608 };

struct request {
    const char *names[MODES];
    struct mode_choice choices[MODES];
    uint32_t mode_count;
    struct renderer_settings settings;
    const char *scene, *out, *device;
    uint64_t frames;
    struct walk walk;
};

struct shown {
    struct renderer_option *option;
    struct frame_stats stats; // of the last frame
    bool has_map;
};

struct drawing {
    struct renderer_option *reference; // `regular`
    struct shown modes[MODES];
};

enum {
    OPTION_MODES,
    OPTION_SCENE,
    OPTION_OUT,
    OPTION_FRAMES,
    OPTION_SIZE,
    OPTION_GAZE,
    OPTION_FOV,
    OPTION_START,
    OPTION_SSAO,
    OPTION_TAA,
    OPTION_STILL,
    OPTION_REST,
    OPTION_DEVICE
};

static const struct option_spec specs[] = {
    [OPTION_MODES] = {"modes", "MODE[:p=v,...]...", "a row each, see 'fovstudy modes'; at most 8"},
    [OPTION_SCENE] = {"scene", "NAME|FILE", "a built-in scene, see 'fovstudy scenes', or a .gltf or .glb file"},
    [OPTION_OUT] = {"out", "FILE.png", "the picture; its folder is made where missing"},
    [OPTION_FRAMES] = {"frames", "N", "frames to walk, 1/90 s each; the last one is shown (30)"},
    [OPTION_SIZE] = {"size", "WxH", "pixels per eye (640x720)"},
    [OPTION_GAZE] = {"gaze", "centre|script|X,Y",
                     "where the eyes look; degrees, right and up positive (centre)"},
    [OPTION_FOV] = {"fov", "DEG", "vertical field of view (100)"},
    [OPTION_START] = {"start", "S", "where on the path to begin, seconds (0)"},
    [OPTION_SSAO] = {"ssao", NULL, "with ambient occlusion"},
    [OPTION_TAA] = {"taa", NULL, "with temporal antialiasing"},
    [OPTION_STILL] = {"still", NULL, "keep the camera where it starts"},
    [OPTION_REST] = {"rest", NULL, "keep moving objects at rest"},
    [OPTION_DEVICE] = {"device", "NAME", "part of the GPU's name"},
    {NULL, NULL, NULL},
};

static const char about[] = "Walks a scene's camera path in several modes and puts the left eye's last frame "
                            "into one PNG, a row a mode:\n"
                            "the picture, its difference to `regular` (8 times as strong), and where the mode "
                            "keeps pixels what it drew anew.";

static int add_mode(struct request *r, const char *text)
{
    char error[ERROR];
    if (r->mode_count == MODES)
        return options_wrong("fovstudy strip", "more than %d modes are given", MODES);
    r->names[r->mode_count] = text;
    if (!mode_parse(text, &r->choices[r->mode_count++], error, sizeof error))
        return options_wrong("fovstudy strip", "%s", error);
    return -1;
}

static void take_flag(struct request *r, int option)
{
    bool *flags[] = {[OPTION_SSAO] = &r->settings.ssao,
                     [OPTION_TAA] = &r->settings.taa,
                     [OPTION_STILL] = &r->walk.still,
                     [OPTION_REST] = &r->walk.rest};
    *flags[option] = true;
}

// -1 to go on, else the exit status.
static int take(struct request *r, int option, const char *value)
{
    const char *expected = NULL;
    if (!specs[option].argument)
        take_flag(r, option);
    else if (option == OPTION_MODES)
        return add_mode(r, value);
    else if (option == OPTION_SCENE)
        r->scene = value;
    else if (option == OPTION_OUT)
        r->out = value;
    else if (option == OPTION_DEVICE)
        r->device = value;
    else if (option == OPTION_FRAMES)
        expected = options_uint64(value, 1, 1000000, &r->frames) ? NULL : "a whole number from 1 to 1000000";
    else
        expected = walk_option(&r->walk, specs[option].name, value);
    if (!expected)
        return -1;
    return options_wrong("fovstudy strip", "--%s is '%s', not %s", specs[option].name, value, expected);
}

static int read_options(int argc, char **argv, struct request *r)
{
    struct options options;
    int list = OPTIONS_WORD; // words that follow --modes are modes
    options_start(&options, argc, argv, "fovstudy strip", specs);
    for (int i = options_next(&options); i != OPTIONS_DONE; i = options_next(&options)) {
        if (i == OPTIONS_ERROR)
            return EXIT_USAGE;
        if (i == OPTIONS_HELP) {
            options_help(stdout,
                         "fovstudy strip --modes MODE[:p=v,...]... --scene NAME|FILE --out FILE.png [options]",
                         about, specs);
            return EXIT_DONE;
        }
        if (i == OPTIONS_WORD && list == OPTIONS_WORD)
            return options_wrong("fovstudy strip", "'%s' is not expected here", options.value);
        const int option = i == OPTIONS_WORD ? list : i;
        list = option == OPTION_MODES ? option : OPTIONS_WORD;
        const int status = take(r, option, options.value);
        if (status >= 0)
            return status;
    }
    if (!r->mode_count || !r->scene || !r->out)
        return options_wrong("fovstudy strip", "%s is missing",
                             !r->mode_count ? "--modes"
                             : !r->scene    ? "--scene"
                                            : "--out");
    return -1;
}

static bool make_options(const struct request *r, struct renderer *renderer, struct renderer_scene *scene,
                         struct drawing *d)
{
    const struct mode_choice regular = {.mode = mode_find("regular")};
    d->reference = renderer_option_create(renderer, scene, &regular, &r->settings);
    for (uint32_t i = 0; d->reference && i < r->mode_count; i++) {
        d->modes[i].option = renderer_option_create(renderer, scene, &r->choices[i], &r->settings);
        if (!d->modes[i].option)
            return false;
    }
    return d->reference != NULL;
}

// What keeps nothing from frame to frame is drawn first and last only.
static bool draw_frame(const struct request *r, struct drawing *d, const struct frame *frame)
{
    const bool edge = frame->number == 0 || frame->number + 1 == r->frames || r->settings.taa;
    for (uint32_t i = 0; i < r->mode_count; i++) {
        struct shown *s = &d->modes[i];
        if (!edge && !s->has_map)
            continue;
        if (!renderer_draw(s->option, frame, &s->stats))
            return false;
        s->has_map =
            s->has_map || s->stats.redraw != FRAME_REDRAW_NONE; // why the first frame of a history is full
    }
    return !edge || renderer_draw(d->reference, frame, NULL);
}

static uint8_t *expand(const uint8_t *gray, size_t pixels)
{
    uint8_t *rgba = malloc(4 * pixels);
    for (size_t i = 0; rgba && i < pixels; i++) {
        memset(rgba + 4 * i, gray[i], 3);
        rgba[4 * i + 3] = 255;
    }
    return rgba;
}

// One row: the picture, and what it has beside it. `reference`: the left eye of `regular`.
static bool fill_row(const struct request *r, uint32_t row, struct shown *s, const uint8_t *reference,
                     struct sheet_cell *cells)
{
    const size_t pixels = (size_t)r->walk.width * r->walk.height;
    const double share = 50.0 * (double)s->stats.shaded_px / (double)pixels; // of both eyes
    cells[0].rgba = malloc(4 * pixels);
    if (!cells[0].rgba || !renderer_read(s->option, EYE_LEFT, cells[0].rgba))
        return false;
    snprintf(cells[0].label, SHEET_LABEL, "%s: %.1f %% shaded", r->names[row], share);
    if (strcmp(r->names[row], "regular") == 0)
        return true;
    struct picture_difference difference = {0};
    cells[1].rgba = malloc(4 * pixels);
    if (!cells[1].rgba)
        return false;
    picture_subtract(cells[0].rgba, reference, pixels, cells[1].rgba, &difference);
    snprintf(cells[1].label, SHEET_LABEL, "difference, %d times: mean %.2f, largest %d", PICTURE_STRONGER,
             difference.total / difference.values, difference.max);
    if (!s->has_map)
        return true;
    uint8_t *map = malloc(pixels);
    if (map && renderer_read_redraw_map(s->option, EYE_LEFT, map))
        cells[2].rgba = expand(map, pixels);
    free(map);
    snprintf(cells[2].label, SHEET_LABEL, "white: drawn anew");
    return cells[2].rgba != NULL;
}

static bool write_sheet(const struct request *r, struct drawing *d, const struct frame *last)
{
    char title[1024], error[ERROR] = "";
    struct sheet sheet;
    uint8_t *reference = malloc(4 * (size_t)r->walk.width * r->walk.height);
    snprintf(title, sizeof title, "%s, frame %llu, left eye, gaze at %.1f, %.1f degrees", r->scene,
             (unsigned long long)last->number, last->eyes[EYE_LEFT].gaze_x_deg,
             last->eyes[EYE_LEFT].gaze_y_deg);
    bool done = sheet_init(&sheet, r->mode_count, r->walk.width, r->walk.height) && reference &&
                renderer_read(d->reference, EYE_LEFT, reference);
    sheet.title = title;
    for (uint32_t row = 0; done && row < r->mode_count; row++)
        done = fill_row(r, row, &d->modes[row], reference, sheet.cells[row]);
    done = done && sheet_write(&sheet, r->out, error, sizeof error);
    if (!done)
        fprintf(stderr, "fovstudy: %s\n", error[0] ? error : "a picture could not be read back");
    sheet_finish(&sheet);
    free(reference);
    return done;
}

static bool strip(const struct request *r, const struct scene *scene)
{
    struct renderer *renderer =
        renderer_create(&(struct renderer_desc){.log = {picture_log, NULL},
                                                .device = r->device,
                                                .width = r->walk.width,
                                                .height = r->walk.height,
                                                .validation = getenv("FOVSTUDY_VALIDATION") != NULL});
    struct renderer_scene *uploaded = renderer ? renderer_scene_create(renderer, scene) : NULL;
    struct drawing drawing = {0};
    struct frame frame = {0};
    bool ok = uploaded && make_options(r, renderer, uploaded, &drawing);
    for (uint64_t n = 0; ok && n < r->frames; n++) {
        walk_frame(&r->walk, scene, n, &frame);
        ok = draw_frame(r, &drawing, &frame);
    }
    ok = ok && write_sheet(r, &drawing, &frame);
    for (uint32_t i = 0; i < r->mode_count; i++)
        renderer_option_destroy(drawing.modes[i].option);
    renderer_option_destroy(drawing.reference);
    renderer_scene_destroy(uploaded);
    ok = ok && renderer_validation_messages(renderer) == 0;
    renderer_destroy(renderer);
    return ok;
}

// Before the work, so that a place that cannot be written stops it at once.
static bool make_folder_of(const char *path, char *error, size_t error_size)
{
    char folder[4096];
    const char *slash = strrchr(path, '/');
    if (!slash || slash == path)
        return true;
    if (slash - path >= (ptrdiff_t)sizeof folder) {
        snprintf(error, error_size, "the name of the picture is too long");
        return false;
    }
    snprintf(folder, sizeof folder, "%.*s", (int)(slash - path), path);
    return output_make_folder(folder, error, error_size);
}

int command_strip(int argc, char **argv)
{
    struct request request = {.frames = 30,
                              .walk = {.width = 640, .height = 720, .fov_deg = VIEWING_DEFAULT_FOV_DEG}};
    char error[ERROR];
    int status = read_options(argc, argv, &request);
    if (status >= 0)
        return status;
    struct scene *scene = NULL;
    if (!make_folder_of(request.out, error, sizeof error) ||
        !(scene = scene_open(request.scene, error, sizeof error))) {
        fprintf(stderr, "fovstudy: %s\n", error);
        return EXIT_FAILED;
    }
    fputs(scene->notes, stderr);
    bool ok = strip(&request, scene);
    scene_destroy(scene);
    return ok ? EXIT_DONE : EXIT_FAILED;
}
