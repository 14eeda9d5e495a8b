#include "app/fovstudy/run_study.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static void hear(void *user, enum renderer_log_level level, const char *sentence)
{
    struct run_view *view = user;
    if (level == RENDERER_ERROR)
        snprintf(view->renderer_error, sizeof view->renderer_error, "%s", sentence);
    else if (level == RENDERER_WARNING)
        fprintf(stderr, "fovstudy: %s\n", sentence);
}

static bool open_display(struct run_view *view, const struct run_options *options, char *error,
                         size_t error_size)
{
    struct display_desc desc = {
        .width = options->width, .height = options->height, .refresh_hz = options->refresh_hz};
    view->display = display_open(options->display, &desc, error, error_size);
    if (!view->display)
        return false;
    view->fov = viewing_symmetric_fov(options->fov_deg, view->display->width, view->display->height);
    if (viewing_fov_ok(&view->fov))
        return true;
    snprintf(error, error_size, "a field of view of %g degrees does not fit an eye of %ux%u pixels",
             options->fov_deg, view->display->width, view->display->height);
    return false;
}

static bool open_renderer(struct run_view *view, const struct run_options *options, char *error,
                          size_t error_size)
{
    struct renderer_desc desc = {
        .log = {.write = hear, .user = view},
        .device = options->device,
        .width = view->display->width,
        .height = view->display->height,
    };
    display_surface(view->display, &desc);
    view->renderer = renderer_create(&desc);
    if (view->renderer)
        return true;
    snprintf(error, error_size, "%s", view->renderer_error[0] ? view->renderer_error : "no GPU can draw here");
    return false;
}

static struct scene *opened(const struct run_view *view, const char *spec)
{
    for (size_t i = 0; i < view->scene_count; i++)
        if (strcmp(view->scenes[i].spec, spec) == 0)
            return view->scenes[i].scene;
    return NULL;
}

// Every scene of the protocol, so that a missing or broken file is found before the participant sits down.
static bool open_scenes(struct run_view *view, const struct run_options *options,
                        const struct protocol *protocol, char *error, size_t error_size)
{
    for (uint32_t i = 0; i < protocol->scene_count; i++) {
        const char *name = protocol->scenes[i];
        const char *spec = study_shown_scene(protocol, i, options->scenes, options->scene_count);
        struct scene *scene = opened(view, spec); // several names may show the same
        bool shared = scene != NULL;
        if (!shared)
            scene = scene_open(spec, error, error_size);
        if (!scene)
            return false;
        if (scene->notes[0] && !shared)
            fprintf(stderr, "fovstudy: %s\n", scene->notes);
        view->scenes[view->scene_count++] = (struct stage_scene){.name = name, .spec = spec, .scene = scene};
    }
    return true;
}

bool run_view_init(struct run_view *view, const struct run_options *options, const struct protocol *protocol,
                   char *error, size_t error_size)
{
    memset(view, 0, sizeof *view);
    view->gaze_name = "none";
    if (strcmp(options->display, "none") == 0)
        return true;
    return open_display(view, options, error, error_size) && open_renderer(view, options, error, error_size) &&
           open_scenes(view, options, protocol, error, error_size);
}

static bool cursor(void *user, double *out_x_px, double *out_y_px)
{
    return display_cursor(user, out_x_px, out_y_px);
}

bool run_view_gaze(struct run_view *view, const struct run_options *options, uint64_t seed, char *error,
                   size_t error_size)
{
    const char *spec = options->gaze;
    bool window = view->display && !view->display->simulated_clock;
    if (!spec && !view->display)
        return true;
    view->gaze_name = spec ? spec : options->observer || !window ? "sim" : "mouse";
    struct gaze_desc desc = {
        .seed = seed,
        .ipd_m = VIEWING_DEFAULT_IPD_M,
        .cursor = window ? cursor : NULL,
        .cursor_user = view->display,
        .fov = view->fov,
        .width = view->display ? view->display->width : 0,
        .height = view->display ? view->display->height : 0,
    };
    view->gaze = gaze_open(view->gaze_name, &desc, error, error_size);
    return view->gaze != NULL;
}

void run_view_finish(struct run_view *view)
{
    gaze_close(view->gaze);
    renderer_destroy(view->renderer);
    display_close(view->display);
    for (size_t i = 0; i < view->scene_count; i++) {
        bool again = false; // an earlier name shows the same
        for (size_t k = 0; k < i; k++)
            again = again || view->scenes[k].scene == view->scenes[i].scene;
        if (!again)
            scene_destroy(view->scenes[i].scene);
    }
}
