// `fovstudy render`: walks a scene's camera path in one mode and writes pictures.
#include "app/command/options.h"
#include "app/command/output.h"
#include "app/command/png.h"
#include "app/command/walk.h"
#include "app/fovstudy/commands.h"
#include "app/fovstudy/picture.h"
#include "renderer/renderer.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// What draws: the mode asked for and, where there is one, the mode it is held against.
struct drawing {
    struct renderer_option *option, *against;
};

struct request {
    struct mode_choice choice;
    struct mode_choice against; // mode NULL: none
    struct renderer_settings settings;
    double anisotropy; // 0: what suits the device
    const char *scene;
    const char *out; // NULL: no pictures
    const char *device;
    uint64_t frames;
    struct walk walk;
    bool explain, all, redraw_map, times;
};

enum {
    OPTION_MODE,
    OPTION_AGAINST,
    OPTION_SCENE,
    OPTION_OUT,
    OPTION_FRAMES,
    OPTION_SIZE,
    OPTION_GAZE,
    OPTION_FOV,
    OPTION_START,
    OPTION_ANISOTROPY,
    OPTION_STILL,
    OPTION_SSAO,
    OPTION_TAA,
    OPTION_REST,
    OPTION_ALL,
    OPTION_REDRAW_MAP,
    OPTION_TIMES,
    OPTION_EXPLAIN,
    OPTION_DEVICE
};

static const struct option_spec specs[] = {
    [OPTION_MODE] = {"mode", "MODE[:p=v,...]", "rendering mode, see 'fovstudy modes'"},
    [OPTION_AGAINST] =
        {"against", "MODE[:p=v,...]",
         "draw a second mode too: NNNN-left-against.png, and NNNN-left-difference.png, 8 times as strong"},
    [OPTION_SCENE] = {"scene", "NAME|FILE", "a built-in scene, see 'fovstudy scenes', or a .gltf or .glb file"},
    [OPTION_OUT] = {"out", "DIR", "folder for the pictures, made where missing: NNNN-left.png, NNNN-right.png"},
    [OPTION_FRAMES] = {"frames", "N", "frames to walk, 1/90 s each (1)"},
    [OPTION_SIZE] = {"size", "WxH", "pixels per eye (1280x1440)"},
    [OPTION_GAZE] = {"gaze", "centre|script|X,Y",
                     "where the eyes look; degrees, right and up positive (centre)"},
    [OPTION_FOV] = {"fov", "DEG", "vertical field of view (100)"},
    [OPTION_START] = {"start", "S", "where on the path to begin, seconds (0)"},
    [OPTION_SSAO] = {"ssao", NULL, "with ambient occlusion"},
    [OPTION_TAA] = {"taa", NULL, "with temporal antialiasing"},
    [OPTION_ANISOTROPY] = {"anisotropy", "N",
                           "of texture filtering, 1 to 16 (8 on a GPU, 1 on a software driver)"},
    [OPTION_STILL] = {"still", NULL, "keep the camera where it starts"},
    [OPTION_REST] = {"rest", NULL, "keep moving objects at rest"},
    [OPTION_ALL] = {"all", NULL, "write every frame, not only the last"},
    [OPTION_REDRAW_MAP] = {"redraw-map", NULL, "write NNNN-left-redraw.png too: white was drawn anew"},
    [OPTION_TIMES] = {"times", NULL, "print each pass's time in the last frame, one submission per pass"},
    [OPTION_EXPLAIN] = {"explain", NULL, "print what was built, why, and its memory"},
    [OPTION_DEVICE] = {"device", "NAME", "part of the GPU's name"},
    {NULL, NULL, NULL},
};

static const char *wrong_value(int option, const char *value, struct request *r)
{
    switch (option) {
    case OPTION_FRAMES:
        return options_uint64(value, 1, 1000000, &r->frames) ? NULL : "a whole number from 1 to 1000000";
    case OPTION_ANISOTROPY:
        return options_double(value, 1, 16, &r->anisotropy) ? NULL : "a number from 1 to 16";
    default:
        return walk_option(&r->walk, specs[option].name, value);
    }
}

static void take_flag(int option, struct request *r)
{
    switch (option) {
    case OPTION_SSAO:
        r->settings.ssao = true;
        break;
    case OPTION_TAA:
        r->settings.taa = true;
        break;
    case OPTION_STILL:
        r->walk.still = true;
        break;
    case OPTION_REST:
        r->walk.rest = true;
        break;
    case OPTION_ALL:
        r->all = true;
        break;
    case OPTION_REDRAW_MAP:
        r->redraw_map = true;
        break;
    case OPTION_TIMES:
        r->times = true;
        break;
    default:
        r->explain = true;
        break;
    }
}

// -1 to go on, else the exit status.
static int read_options(int argc, char **argv, struct request *r)
{
    struct options options;
    const char *mode = NULL, *against = NULL;
    char error[1024];
    options_start(&options, argc, argv, "fovstudy render", specs);
    for (int i = options_next(&options); i != OPTIONS_DONE; i = options_next(&options)) {
        const char *expected = NULL;
        if (i == OPTIONS_ERROR)
            return EXIT_USAGE;
        if (i == OPTIONS_HELP) {
            options_help(
                stdout, "fovstudy render --mode MODE[:p=v,...] --scene NAME|FILE [--out DIR] [options]",
                "Walks a scene's camera path in one mode and writes the last frame, one PNG per eye.", specs);
            return EXIT_DONE;
        }
        if (i == OPTIONS_WORD)
            return options_wrong("fovstudy render", "'%s' is not expected here", options.value);
        if (!specs[i].argument)
            take_flag(i, r);
        else if (i == OPTION_MODE)
            mode = options.value;
        else if (i == OPTION_AGAINST)
            against = options.value;
        else if (i == OPTION_SCENE)
            r->scene = options.value;
        else if (i == OPTION_OUT)
            r->out = options.value;
        else if (i == OPTION_DEVICE)
            r->device = options.value;
        else if ((expected = wrong_value(i, options.value, r)))
            return options_wrong("fovstudy render", "--%s is '%s', not %s", specs[i].name, options.value,
                                 expected);
    }
    if (!mode || !r->scene)
        return options_wrong("fovstudy render", "%s is missing", mode ? "--scene" : "--mode");
    if (!r->out && !r->explain && !r->times)
        return options_wrong("fovstudy render", "--out DIR is missing (or --explain, or --times)");
    if (!mode_parse(mode, &r->choice, error, sizeof error) ||
        (against && !mode_parse(against, &r->against, error, sizeof error)))
        return options_wrong("fovstudy render", "%s", error);
    return -1;
}

static bool write_picture(const struct request *r, uint64_t number, int eye, const char *what, int channels,
                          const uint8_t *pixels)
{
    char path[4096];
    snprintf(path, sizeof path, "%s/%04llu-%s%s.png", r->out, (unsigned long long)number,
             eye ? "right" : "left", what);
    if (png_write(path, r->walk.width, r->walk.height, channels, pixels))
        return true;
    fprintf(stderr, "fovstudy: cannot write %s: %s\n", path, strerror(errno));
    return false;
}

static bool write_eye(const struct request *r, const struct drawing *d, uint64_t number, int eye,
                      uint8_t *pixels[2], struct picture_difference *difference)
{
    if (!renderer_read(d->option, eye, pixels[0]) || !write_picture(r, number, eye, "", 4, pixels[0]))
        return false;
    if (d->against) {
        if (!renderer_read(d->against, eye, pixels[1]) ||
            !write_picture(r, number, eye, "-against", 4, pixels[1]))
            return false;
        picture_subtract(pixels[0], pixels[1], (size_t)r->walk.width * r->walk.height, pixels[1], difference);
        if (!write_picture(r, number, eye, "-difference", 4, pixels[1]))
            return false;
    }
    return !r->redraw_map || (renderer_read_redraw_map(d->option, eye, pixels[0]) &&
                              write_picture(r, number, eye, "-redraw", 1, pixels[0]));
}

static bool write_frame(const struct request *r, const struct drawing *d, uint64_t number)
{
    const size_t size = 4 * (size_t)r->walk.width * r->walk.height;
    uint8_t *pixels[2] = {malloc(size), malloc(size)};
    struct picture_difference difference = {0};
    bool ok = pixels[0] && pixels[1];
    for (int eye = 0; eye < EYES && ok; eye++)
        ok = write_eye(r, d, number, eye, pixels, &difference);
    if (ok && d->against)
        printf("frame %llu: mean difference %.4f, largest %d of 255\n", (unsigned long long)number,
               difference.total / difference.values, difference.max);
    free(pixels[0]);
    free(pixels[1]);
    return ok;
}

static void print_times(const struct request *r, const struct frame_stats *s)
{
    double all = 2.0 * r->walk.width * r->walk.height;
    printf("frame %llu: %.2f ms on the GPU, %.2f ms on the CPU; shaded %llu px (%.2f %%), %llu triangles in "
           "%llu submodels\n",
           (unsigned long long)r->frames - 1, s->gpu_ms, s->cpu_ms, (unsigned long long)s->shaded_px,
           100 * (double)s->shaded_px / all, (unsigned long long)s->triangles,
           (unsigned long long)s->submodels);
    for (uint32_t i = 0; i < s->timer_count; i++)
        printf("  %-20s %8.3f ms\n", s->timers[i].name, s->timers[i].ms);
}

static bool walk(const struct request *r, const struct scene *scene, const struct drawing *drawing)
{
    struct frame_stats stats = {0};
    for (uint64_t n = 0; n < r->frames; n++) {
        struct frame frame;
        walk_frame(&r->walk, scene, n, &frame);
        if (!renderer_draw(drawing->option, &frame, &stats) ||
            (drawing->against && !renderer_draw(drawing->against, &frame, NULL)))
            return false;
        if (r->out && (r->all || n + 1 == r->frames) && !write_frame(r, drawing, n))
            return false;
    }
    if (r->times)
        print_times(r, &stats);
    return true;
}

static bool make_folder(const char *path)
{
    char error[4608];
    if (output_make_folder(path, error, sizeof error))
        return true;
    fprintf(stderr, "fovstudy: %s\n", error);
    return false;
}

static bool render(const struct request *r, const struct scene *scene)
{
    const struct renderer_desc desc = {.log = {picture_log, NULL},
                                       .device = r->device,
                                       .width = r->walk.width,
                                       .height = r->walk.height,
                                       .validation = getenv("FOVSTUDY_VALIDATION") != NULL,
                                       .anisotropy = (float)r->anisotropy,
                                       .pass_times = r->times};
    struct renderer *renderer = renderer_create(&desc);
    struct renderer_scene *uploaded = renderer ? renderer_scene_create(renderer, scene) : NULL;
    struct drawing drawing = {0};
    if (uploaded)
        drawing.option = renderer_option_create(renderer, uploaded, &r->choice, &r->settings);
    if (drawing.option && r->against.mode)
        drawing.against = renderer_option_create(renderer, uploaded, &r->against, &r->settings);
    bool ok = drawing.option && (drawing.against || !r->against.mode);
    if (ok && r->explain) {
        char text[10240];
        ok = renderer_option_explain(drawing.option, text, sizeof text);
        printf("%s on %s\n%s", scene->name, renderer_device(renderer)->name, text);
    }
    ok = ok && (!r->out || make_folder(r->out)) && walk(r, scene, &drawing);
    renderer_option_destroy(drawing.option);
    renderer_option_destroy(drawing.against);
    renderer_scene_destroy(uploaded);
    if (renderer && renderer_validation_messages(renderer))
        ok = false;
    renderer_destroy(renderer);
    return ok;
}

int command_render(int argc, char **argv)
{
    struct request request = {.frames = 1,
                              .walk = {.width = 1280, .height = 1440, .fov_deg = VIEWING_DEFAULT_FOV_DEG}};
    int status = read_options(argc, argv, &request);
    if (status >= 0)
        return status;
    char error[1024];
    struct scene *scene = scene_open(request.scene, error, sizeof error);
    if (!scene) {
        fprintf(stderr, "fovstudy: %s\n", error);
        return EXIT_FAILED;
    }
    fputs(scene->notes, stderr);
    bool ok = render(&request, scene);
    scene_destroy(scene);
    return ok ? EXIT_DONE : EXIT_FAILED;
}
