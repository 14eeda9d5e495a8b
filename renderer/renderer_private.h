// What the renderer's own files share.
#ifndef RENDERER_RENDERER_PRIVATE_H
#define RENDERER_RENDERER_PRIVATE_H

#include "renderer/gpu/frame.h"
#include "renderer/modes/room.h"
#include "renderer/passes/screen/screen.h"
#include "renderer/passes/shadow/shadow.h"
#include "renderer/renderer.h"
#include "renderer/scene/scene_gpu.h"

struct renderer {
    struct renderer_log log;
    struct renderer_device device;
    uint32_t width, height;
    struct gpu *gpu;
    struct gpu_frame frame;
    struct gpu_present *present; // NULL when headless
    struct screen screen;
};

struct renderer_scene {
    struct renderer *renderer;
    struct scene_gpu *gpu;
    struct shadow shadow; // of the sun; without a map where there is none
};

struct renderer_option {
    struct renderer *renderer;
    struct renderer_scene *scene;
    const struct mode *mode;
    struct mode_state *state;
    double values[MODE_PARAMETERS];
    struct gpu_buffer constants; // shared_frame
    struct gpu_buffer counters;  // shared_counters
    struct mode_explanation explanation;
    struct mode_result result; // of the last frame
    bool drawn;
    uint64_t last_number;
    double last_animation_s;
    bool last_moving;
    struct frame_eye last_eyes[EYES];
    struct renderer_settings settings;
    struct dvec3 last_origin;
};

// A sentence for the application's log; user: the renderer.
void renderer_relay(void *user, int level, const char *sentence);

// Ends a frame that gpu_frame_begin began: screen pass and presenting. colour NULL: gray.
bool renderer_show_image(struct renderer *renderer, const struct gpu_image *colour, double fade);

// Fills the option's shared_frame.
void renderer_fill_constants(struct renderer_option *option, const struct frame *frame);

#endif
