// The monitors of this computer, for --display monitor:N.
#ifndef APP_DISPLAY_MONITORS_H
#define APP_DISPLAY_MONITORS_H

#include <stddef.h>

struct monitor {
    char name[64];
    int width_px, height_px, refresh_hz; // of its present mode
};

// How many were written to `out`; 0 without a display server. Not while a window is open.
size_t monitors_list(struct monitor *out, size_t capacity);

#endif
