// What every renderer test needs: a device with the validation layer listening, frames along a path, pictures.
#ifndef TESTS_RENDERER_STAGE_H
#define TESTS_RENDERER_STAGE_H

#include "renderer/renderer.h"

struct stage {
    struct renderer *renderer;
    uint32_t width, height;
    char log[4096]; // every sentence so far
};

// False where there is no Vulkan device: the test exits with 77. pass_times: one submission per pass.
bool stage_open(struct stage *stage, uint32_t width, uint32_t height);
bool stage_open_timed(struct stage *stage, uint32_t width, uint32_t height, bool pass_times);
// Fails the test if the validation layer said anything.
void stage_close(struct stage *stage);

struct renderer_option *stage_option(struct stage *stage, struct renderer_scene *scene, const char *mode);
struct renderer_option *stage_option_set(struct stage *stage, struct renderer_scene *scene, const char *mode,
                                         const struct renderer_settings *settings);

// The frame a path reaches at a time, gaze in the same direction for both eyes.
struct frame stage_frame(const struct stage *stage, const struct scene *scene, uint64_t number, double time_s,
                         double gaze_x_deg, double gaze_y_deg);

// rgba8 of one eye; freed by the caller.
uint8_t *stage_read(const struct stage *stage, struct renderer_option *option, int eye);

struct stage_difference {
    double mean; // over rgb of all pixels, 0..255
    int max;
};
struct stage_difference stage_compare(const struct stage *stage, const uint8_t *a, const uint8_t *b);
// Of two options' last frames, both eyes.
struct stage_difference stage_differ(const struct stage *stage, struct renderer_option *a,
                                     struct renderer_option *b);

#endif
