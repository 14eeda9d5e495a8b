// Options that are too slow to be live: their frames along the trial's flight are rendered before the trial,
// kept packed in memory, and played at the rate of the screen (Weier et al. 2016 showed their full ray tracer
// so).
//
// Frame n is the option at n / rate seconds of the flight, with what was drawn before it as history, as it
// would be live. Use, with the trial's options on the stage: playback_prepare until nothing is left -> per
// frame playback_take, playback_show. Nothing is made on the GPU after playback_create, and nothing waits for
// the unpacking unless asked to: a frame that is not there holds the one before it. Does not: know the gaze
// (the protocol allows only what does not depend on it), fade, draw text or targets: those are laid over as
// over any option.
#ifndef APP_SESSION_PLAYBACK_H
#define APP_SESSION_PLAYBACK_H

#include "app/session/stage.h"
#include "studies/store/store.h"

struct playback_desc {
    struct renderer *renderer; // borrowed
    struct stage *stage;       // borrowed
    uint32_t width, height;    // of each eye
    uint64_t budget_bytes;     // of memory for packed pictures; 0: half of what is free when an option is begun
    // Where the fovea is in a frame whose target is known beforehand; false: it is nowhere. NULL: never.
    bool (*fovea)(void *user, const struct machine_view *view, struct fovea_use *out);
    // After each frame that was drawn, e.g. to measure it; false: failed. NULL: nothing.
    bool (*drawn)(void *user, const struct machine_view *view, uint32_t number, const struct frame *frame);
    void *user;
};

struct playback;
struct playback *playback_create(const struct playback_desc *desc); // NULL: no memory, here or on the GPU
void playback_destroy(struct playback *playback);                   // before the renderer; NULL is fine
bool playback_needed(const struct plan *plan);                      // whether any of its trials plays back

// Renders what the view's trial plays back, for about slice_s and one frame at least. rate_hz: at which it will
// be shown. out_done: the share that is ready, 1: all, and wound back to its first frame: not to be called
// again while the trial runs. False with a sentence.
bool playback_prepare(struct playback *playback, const struct machine_view *view, double rate_hz,
                      double slice_s, double *out_done, char *error, size_t error_size);

bool playback_plays(const struct playback *playback, const struct machine_view *view); // the view's option
// The frame for the view's time. Fills the row's effective, shaded_px, triangles, head pose and fovea; gpu_us
// and cpu_us stay unknown, since nothing is drawn now. out_new: another picture than the last one taken;
// out_held: the right one was not there.
void playback_take(struct playback *playback, const struct machine_view *view, bool wait,
                   struct store_frame *row, bool *out_new, bool *out_held);
bool playback_show(struct playback *playback, enum plan_slot slot, double fade); // what was taken last
// As playback_show, of a picture that means nothing: to measure how long it takes.
bool playback_show_any(struct playback *playback, double fade);
// Of the view's option: frames, and bytes of memory they take.
void playback_size(const struct playback *playback, enum plan_slot slot, uint32_t *out_frames,
                   uint64_t *out_bytes);

#endif
