#include "app/display/monitors.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <stdio.h>

size_t monitors_list(struct monitor *out, size_t capacity)
{
    if (!glfwInit())
        return 0;
    int found = 0;
    GLFWmonitor **monitors = glfwGetMonitors(&found);
    size_t count = 0;
    for (int i = 0; i < found && count < capacity; i++) {
        const GLFWvidmode *mode = glfwGetVideoMode(monitors[i]);
        if (!mode)
            continue;
        struct monitor *monitor = &out[count++];
        snprintf(monitor->name, sizeof monitor->name, "%s", glfwGetMonitorName(monitors[i]));
        monitor->width_px = mode->width;
        monitor->height_px = mode->height;
        monitor->refresh_hz = mode->refreshRate;
    }
    glfwTerminate();
    return count;
}
