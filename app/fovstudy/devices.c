// `fovstudy devices`: what can draw and what can show.
#include "app/command/options.h"
#include "app/display/monitors.h"
#include "app/fovstudy/commands.h"
#include "renderer/renderer.h"

#include <stdio.h>
#include <string.h>

static void keep_error(void *user, enum renderer_log_level level, const char *sentence)
{
    if (level == RENDERER_ERROR)
        snprintf(user, 512, "%s", sentence);
}

int command_devices(int argc, char **argv)
{
    static const struct option_spec specs[] = {
        {"device", "NAME", "part of a device's name, to ask for that one"}, {NULL, NULL, NULL}};
    struct options options;
    char error[512] = "";
    struct renderer_desc desc = {.log = {.write = keep_error, .user = error}, .width = 16, .height = 16};
    options_start(&options, argc, argv, "fovstudy devices", specs);
    for (int i = options_next(&options); i != OPTIONS_DONE; i = options_next(&options)) {
        if (i == OPTIONS_HELP) {
            options_help(stdout, "fovstudy devices [--device NAME]",
                         "Names the GPU that would be used, and the monitors for --display monitor:N.", specs);
            return EXIT_DONE;
        }
        if (i == OPTIONS_ERROR)
            return EXIT_USAGE;
        if (i == OPTIONS_WORD)
            return options_wrong("fovstudy devices", "'%s' is not expected here", options.value);
        desc.device = options.value;
    }
    struct renderer *renderer = renderer_create(&desc);
    if (renderer) {
        const struct renderer_device *device = renderer_device(renderer);
        printf("GPU: %s (%s)%s\n", device->name, device->driver, device->software ? ", software" : "");
        renderer_destroy(renderer);
    }
    struct monitor monitors[16];
    size_t count = monitors_list(monitors, sizeof monitors / sizeof monitors[0]);
    for (size_t i = 0; i < count; i++)
        printf("monitor:%zu: %s, %dx%d at %d Hz\n", i, monitors[i].name, monitors[i].width_px,
               monitors[i].height_px, monitors[i].refresh_hz);
    if (count == 0)
        printf("no monitor, or no display server; --display headless works without\n");
    if (!renderer)
        fprintf(stderr, "fovstudy: %s\n", *error ? error : "no GPU can draw here");
    return renderer ? EXIT_DONE : EXIT_FAILED;
}
