// The renderer as the application sees it. It draws a scene for two eyes and knows nothing of studies.
//
// Use: renderer_create -> renderer_scene_create -> renderer_option_create (one per mode and parameter set)
//      -> per frame: renderer_draw, renderer_show, and renderer_read_* where pixels are wanted on the CPU.
// Does not: open windows (the application hands over a surface), read files, keep time or follow anyone's gaze.
// One thread. Every call that can fail returns false or NULL after one sentence to the log.
#ifndef RENDERER_RENDERER_H
#define RENDERER_RENDERER_H

#include "renderer/frame.h"
#include "renderer/mode.h"
#include "renderer/settings.h"
#include "stimuli/scene.h"

#include <stdbool.h>
#include <stdint.h>

struct renderer;
struct renderer_scene;
struct renderer_option;
struct renderer_picture;

enum renderer_log_level { RENDERER_ERROR, RENDERER_WARNING, RENDERER_INFO };

struct renderer_log {
    void (*write)(void *user, enum renderer_log_level level, const char *sentence); // NULL: silent
    void *user;
};

struct renderer_desc {
    struct renderer_log log;
    const char *device;     // part of a device's name; NULL: the best one that has what is needed
    uint32_t width, height; // per eye, pixels, 16..16384
    bool validation;        // load the validation layer; its messages are logged and counted
    float anisotropy;       // of texture filtering, 1: none; 0: 8 on a GPU, none on a software driver
    bool pass_times;        // one submission per pass, for true per-pass times on software drivers
    // A surface to present to. NULL: headless. create returns a VkResult; instance is a VkInstance and
    // out_surface a VkSurfaceKHR *.
    int (*create_surface)(void *user, void *instance, void *out_surface);
    void *surface_user;
    const char *const *instance_extensions; // needed by create_surface
    uint32_t instance_extension_count;
};

struct renderer_device {
    char name[256];
    char driver[528]; // name and version
    bool software;
};

struct renderer *renderer_create(const struct renderer_desc *desc);
void renderer_destroy(struct renderer *renderer); // after all scenes and options; NULL is fine
const struct renderer_device *renderer_device(const struct renderer *renderer);
uint32_t renderer_validation_messages(const struct renderer *renderer);

// Copies a scene to the GPU; `scene` must outlive the result (its animation is read every frame).
struct renderer_scene *renderer_scene_create(struct renderer *renderer, const struct scene *scene);
void renderer_scene_destroy(struct renderer_scene *scene);

// All targets and pipelines of one mode on one scene. settings NULL: all off.
struct renderer_option *renderer_option_create(struct renderer *renderer, struct renderer_scene *scene,
                                               const struct mode_choice *choice,
                                               const struct renderer_settings *settings);
void renderer_option_destroy(struct renderer_option *option);
// New numbers from the next frame on, for an option made with settings.adjustable; its mode and its switches
// must be the same. It draws what an option made with them would, history apart. False: it stays as it was.
bool renderer_option_set(struct renderer_option *option, const struct mode_choice *choice);
// What was built, why, and its memory, one line each; false: too small.
bool renderer_option_explain(const struct renderer_option *option, char *out, size_t out_size);
uint64_t renderer_option_memory(const struct renderer_option *option); // bytes of its targets and buffers
uint64_t renderer_memory(const struct renderer *renderer);             // bytes of all scenes and options now

// Draws one frame and waits for it. A gap in frame.number, frame.cut, frame.gaze_returned, or a change of
// frame.moving resets the option's history.
bool renderer_draw(struct renderer_option *option, const struct frame *frame, struct frame_stats *out_stats);

// An image laid over both eyes, e.g. text: rgba8, sRGB-encoded, straight alpha. Copied by renderer_set_overlay.
struct renderer_overlay {
    const uint8_t *rgba;
    uint32_t width, height;
    int32_t left[EYES], top[EYES]; // pixels from each eye's upper left corner
};
// NULL removes it.
bool renderer_set_overlay(struct renderer *renderer, const struct renderer_overlay *overlay);

// What stands over both eyes' pictures whatever the option and the fade: a thin cross with dark edges, or a
// ball, lit from above.
enum renderer_mark_kind { RENDERER_MARK_CROSS, RENDERER_MARK_BALL };
enum { RENDERER_MARKS = 80 };
struct renderer_mark {
    enum renderer_mark_kind kind;
    struct viewing_disc place[EYES]; // the ball's image; a cross fills it from rim to rim
    double opacity[EYES];            // 0: not in this eye
    float colour[3];                 // sRGB-encoded, 0..1
    double fade;                     // 1: gray, as the picture's; 0 for what stands out of every fade
};
// For every renderer_show until the next call; copied. Later ones lie over earlier ones. count 0: none. False:
// more than RENDERER_MARKS, or a place that is not finite.
bool renderer_set_marks(struct renderer *renderer, const struct renderer_mark *marks, uint32_t count);

// Puts the option's last frame on the screen, mixed with mid gray (sRGB 0.5) in linear light: fade 0 the image,
// 1 gray; then the marks, then the overlay. option NULL: gray. With a surface this presents and waits for the
// display's pace; without, the result only lies ready for renderer_read_screen.
bool renderer_show(struct renderer *renderer, struct renderer_option *option, double fade);

// Pictures made earlier, played back: an image of their own, and buffers to fill while others are shown.
// buffers: 1..16. NULL after a logged sentence; destroyed before the renderer.
struct renderer_picture *renderer_picture_create(struct renderer *renderer, uint32_t buffers);
void renderer_picture_destroy(struct renderer_picture *picture); // NULL is fine
// Where a buffer's pixels are written, by any thread: rgba8, sRGB-encoded, the left eye, then the right; slow
// to read.
uint8_t *renderer_picture_buffer(struct renderer_picture *picture, uint32_t buffer);
// As renderer_show, with that buffer's picture in place of an option's; -1: with the one it showed last. When
// it returns the buffer may be written again.
bool renderer_show_picture(struct renderer *renderer, struct renderer_picture *picture, int buffer,
                           double fade);

const char *renderer_redraw_name(enum frame_redraw redraw); // "first", "cut", ...; NULL for none
void renderer_resized(struct renderer *renderer); // the surface changed size; the next show rebuilds its images

// The option's last frame before fade and overlay: rgba8, sRGB-encoded, width * height * 4 bytes per eye.
bool renderer_read(struct renderer_option *option, int eye, uint8_t *out_rgba);
// What the participant sees after renderer_show, per eye.
bool renderer_read_screen(struct renderer *renderer, int eye, uint8_t *out_rgba);
// Where each pixel's surface was one frame ago, of an option made with settings.motion: four floats a pixel,
// its place in the last frame (pixels from the upper left corner, centres at +0.5), its distance in front of
// the eye then, and now (metres, 0: the background). Places behind the eye or off the image are as they come.
bool renderer_read_motion(struct renderer_option *option, int eye, float *out_xyzw);
// 255 where the pixel was drawn anew in the last frame, 0 where it was kept; all 255 for modes without history.
bool renderer_read_redraw_map(struct renderer_option *option, int eye, uint8_t *out);

#endif
