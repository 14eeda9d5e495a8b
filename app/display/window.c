// A GLFW window: both eyes side by side. As `monitor:N` it fills that monitor, as a headset in extended mode
// needs.
#define GLFW_INCLUDE_NONE
#include <vulkan/vulkan.h>

#include <GLFW/glfw3.h>

#include "app/display/display.h"

#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

enum { KEYS = 64 }; // more key events than a person makes between two frames; the oldest stay

struct window {
    struct display base;
    GLFWwindow *glfw;
    struct display_key keys[KEYS];
    size_t key_first, key_count;
    bool resized;
};

static int64_t clock_ns(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (int64_t)now.tv_sec * 1000000000 + now.tv_nsec;
}

static void on_key(GLFWwindow *glfw, int key, int scancode, int action, int mods)
{
    struct window *window = glfwGetWindowUserPointer(glfw);
    (void)scancode;
    (void)mods;
    if (action == GLFW_REPEAT || window->key_count == KEYS)
        return;
    window->keys[(window->key_first + window->key_count++) % KEYS] =
        (struct display_key){.at_ns = clock_ns(), .key = key, .pressed = action == GLFW_PRESS};
}

static void on_size(GLFWwindow *glfw, int width, int height)
{
    struct window *window = glfwGetWindowUserPointer(glfw);
    (void)width;
    (void)height;
    window->resized = true;
}

// GLFW's last error as the end of a sentence.
static void say(char *error, size_t error_size, const char *what)
{
    const char *why = NULL;
    glfwGetError(&why);
    snprintf(error, error_size, "%s: %s", what, why ? why : "the window system gave no reason");
}

static GLFWmonitor *find_monitor(const char *detail, char *error, size_t error_size)
{
    int count = 0;
    GLFWmonitor **monitors = glfwGetMonitors(&count);
    char *end = NULL;
    long number = detail && isdigit((unsigned char)*detail) ? strtol(detail, &end, 10) : -1;
    if (number < 0 || *end) {
        snprintf(error, error_size,
                 "display 'monitor' wants a number: monitor:0; 'fovstudy devices' lists them");
        return NULL;
    }
    if (number >= count) {
        snprintf(error, error_size, "there is no monitor %ld, only %d of them; 'fovstudy devices' lists them",
                 number, count);
        return NULL;
    }
    return monitors[number];
}

static bool make(struct window *window, GLFWmonitor *monitor, const struct display_desc *desc, char *error,
                 size_t error_size)
{
    GLFWmonitor *on = monitor ? monitor : glfwGetPrimaryMonitor();
    const GLFWvidmode *mode = on ? glfwGetVideoMode(on) : NULL;
    uint32_t width = desc->width ? desc->width : monitor && mode ? (uint32_t)mode->width / 2 : 640;
    uint32_t height = desc->height ? desc->height : monitor && mode ? (uint32_t)mode->height : 720;
    int full_width = monitor && mode ? mode->width : (int)(2 * width);
    int full_height = monitor && mode ? mode->height : (int)height;
    glfwWindowHint(GLFW_CLIENT_API, GLFW_NO_API);
    glfwWindowHint(GLFW_AUTO_ICONIFY, GLFW_FALSE);
    window->glfw = glfwCreateWindow(full_width, full_height, "fovstudy", monitor, NULL);
    if (!window->glfw) {
        say(error, error_size, "no window could be opened");
        return false;
    }
    window->base.width = width;
    window->base.height = height;
    window->base.refresh_hz = mode ? mode->refreshRate : 0.0;
    if (monitor)
        snprintf(window->base.name, sizeof window->base.name, "monitor %s", glfwGetMonitorName(monitor));
    else
        snprintf(window->base.name, sizeof window->base.name, "window %dx%d", full_width, full_height);
    glfwSetWindowUserPointer(window->glfw, window);
    glfwSetKeyCallback(window->glfw, on_key);
    glfwSetFramebufferSizeCallback(window->glfw, on_size);
    glfwSetInputMode(window->glfw, GLFW_CURSOR, GLFW_CURSOR_HIDDEN);
    return true;
}

static struct display *open_window(const struct display_kind *kind, const struct display_desc *desc,
                                   char *error, size_t error_size)
{
    struct window *window = calloc(1, sizeof *window);
    if (!window) {
        snprintf(error, error_size, "out of memory");
        return NULL;
    }
    window->base.kind = kind;
    if (!glfwInit()) {
        say(error, error_size, "no window can be opened here (is DISPLAY set?)");
        free(window);
        return NULL;
    }
    GLFWmonitor *monitor = NULL;
    if (kind == &display_monitor && !(monitor = find_monitor(desc->detail, error, error_size)))
        goto failed;
    if (!glfwVulkanSupported()) {
        snprintf(error, error_size,
                 "no Vulkan driver is installed; install mesa-vulkan-drivers or the GPU's own");
        goto failed;
    }
    if (!make(window, monitor, desc, error, error_size))
        goto failed;
    return &window->base;
failed:
    glfwTerminate();
    free(window);
    return NULL;
}

static struct display *create_window(const struct display_desc *desc, char *error, size_t error_size)
{
    if (desc->detail) {
        snprintf(error, error_size, "display 'window' takes nothing after its name; did you mean monitor:N?");
        return NULL;
    }
    return open_window(&display_window, desc, error, error_size);
}

static struct display *create_monitor(const struct display_desc *desc, char *error, size_t error_size)
{
    return open_window(&display_monitor, desc, error, error_size);
}

static void destroy(struct display *display)
{
    struct window *window = (struct window *)display;
    glfwDestroyWindow(window->glfw);
    glfwTerminate();
    free(window);
}

static int create_surface(void *user, void *instance, void *out_surface)
{
    struct window *window = user;
    return glfwCreateWindowSurface(instance, window->glfw, NULL, out_surface);
}

static void surface(struct display *display, struct renderer_desc *out)
{
    out->create_surface = create_surface;
    out->surface_user = display;
    out->instance_extensions = glfwGetRequiredInstanceExtensions(&out->instance_extension_count);
}

static int64_t now_ns(struct display *display)
{
    (void)display;
    return clock_ns();
}

static bool poll_window(struct display *display)
{
    glfwPollEvents();
    return !glfwWindowShouldClose(((struct window *)display)->glfw);
}

static bool next_key(struct display *display, struct display_key *out)
{
    struct window *window = (struct window *)display;
    if (window->key_count == 0)
        return false;
    *out = window->keys[window->key_first];
    window->key_first = (window->key_first + 1) % KEYS;
    window->key_count--;
    return true;
}

static void shown(struct display *display)
{
    (void)display; // time passes by itself
}

// The window may have been scaled: its left half shows the left eye, its right half the right eye.
static bool cursor(struct display *display, double *out_x_px, double *out_y_px)
{
    struct window *window = (struct window *)display;
    double x = 0.0, y = 0.0;
    int width = 0, height = 0;
    glfwGetCursorPos(window->glfw, &x, &y);
    glfwGetWindowSize(window->glfw, &width, &height);
    if (x < 0.0 || y < 0.0 || x >= width || y >= height)
        return false;
    double half = width / 2.0;
    *out_x_px = (x < half ? x : x - half) / half * display->width;
    *out_y_px = y / height * display->height;
    return true;
}

static bool resized(struct display *display)
{
    struct window *window = (struct window *)display;
    bool was = window->resized;
    window->resized = false;
    return was;
}

#define WINDOW_CALLS                                                                                           \
    .destroy = destroy, .surface = surface, .now_ns = now_ns, .poll = poll_window, .key = next_key,            \
    .shown = shown, .cursor = cursor, .resized = resized

const struct display_kind display_window = {
    .name = "window",
    .description = "a window, both eyes side by side",
    .create = create_window,
    WINDOW_CALLS,
};

const struct display_kind display_monitor = {
    .name = "monitor",
    .description = "a whole monitor, both eyes side by side (monitor:N)",
    .create = create_monitor,
    WINDOW_CALLS,
};
