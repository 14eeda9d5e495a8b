#include "app/session/playback.h"

#include "app/session/player.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#define LATE_START_S 0.1 // how much later than planned the view time may begin before the last frame is held
enum { FORECAST_FRAMES = 8, EFFECTIVE = 96 };

// What was rendered, apart from where on the screen it is shown. Settings are one per cell of the protocol.
struct key {
    int32_t condition;
    const char *scene;
    const struct protocol_settings *settings;
    uint32_t target_seed;
    double rate_hz;
};

struct film {
    struct key key;
    struct recording *recording; // owned; NULL: none
    const struct plan_trial *by; // the trial that began it
    uint64_t budget_bytes;
};

// One slot's place on the GPU.
struct projector {
    struct renderer_picture *picture; // owned
    struct player *player;            // owned
    const struct film *film;          // NULL: none
    int buffer;                       // to upload at the next show; -1: none
    int64_t frame;                    // on the picture or to be there next; -1: none
    char effective[EFFECTIVE];
};

struct playback {
    struct playback_desc desc;
    struct film films[2];
    struct projector projectors[2];
    uint8_t *rgba[EYES];
};

bool playback_needed(const struct plan *plan)
{
    for (uint32_t i = 0; i < plan->trial_count; i++)
        if (plan->trials[i].prerendered[0] || plan->trials[i].prerendered[1])
            return true;
    return false;
}

static bool make_projector(const struct playback_desc *desc, struct projector *projector)
{
    uint8_t *buffers[PLAYER_BUFFERS];
    *projector = (struct projector){.buffer = -1, .frame = -1};
    projector->picture = renderer_picture_create(desc->renderer, PLAYER_BUFFERS);
    for (uint32_t i = 0; projector->picture && i < PLAYER_BUFFERS; i++)
        buffers[i] = renderer_picture_buffer(projector->picture, i);
    projector->player = projector->picture ? player_create(buffers, desc->width, desc->height) : NULL;
    return projector->player != NULL;
}

struct playback *playback_create(const struct playback_desc *desc)
{
    struct playback *playback = calloc(1, sizeof *playback);
    if (!playback)
        return NULL;
    playback->desc = *desc;
    bool good = true;
    for (int i = 0; good && i < 2; i++) {
        playback->rgba[i] = malloc((size_t)4 * desc->width * desc->height);
        good = playback->rgba[i] && make_projector(desc, &playback->projectors[i]);
    }
    if (good)
        return playback;
    playback_destroy(playback);
    return NULL;
}

void playback_destroy(struct playback *playback)
{
    if (!playback)
        return;
    for (int i = 0; i < 2; i++) {
        player_destroy(playback->projectors[i].player);
        renderer_picture_destroy(playback->projectors[i].picture);
        recording_destroy(playback->films[i].recording);
        free(playback->rgba[i]);
    }
    free(playback);
}

static void drop(struct playback *playback, struct film *film)
{
    for (int slot = 0; slot < 2; slot++) {
        struct projector *projector = &playback->projectors[slot];
        if (projector->film != film)
            continue;
        player_load(projector->player, NULL);
        projector->film = NULL;
        projector->frame = projector->buffer = -1;
    }
    recording_destroy(film->recording);
    *film = (struct film){0};
}

static bool same_key(const struct key *a, const struct key *b)
{
    return a->condition == b->condition && a->scene == b->scene && a->settings == b->settings &&
           a->target_seed == b->target_seed && !(a->rate_hz < b->rate_hz) && !(a->rate_hz > b->rate_hz);
}

static struct key key_of(const struct plan_trial *trial, int slot, double rate_hz)
{
    return (struct key){trial->option[slot], trial->scene, trial->resolved, trial->target_seed, rate_hz};
}

static struct film *find(struct playback *playback, const struct key *key)
{
    for (int i = 0; i < 2; i++)
        if (playback->films[i].recording && same_key(&playback->films[i].key, key))
            return &playback->films[i];
    return NULL;
}

// Half of the memory that is free; all there is to go by where Linux does not tell.
static uint64_t free_budget(void)
{
    char line[128];
    uint64_t kib = 0;
    FILE *file = fopen("/proc/meminfo", "r");
    while (file && fgets(line, sizeof line, file))
        if (sscanf(line, "MemAvailable: %" SCNu64, &kib) == 1)
            break;
    if (file)
        fclose(file);
    return kib ? kib * 1024 / 2 : UINT64_MAX;
}

// The flight from the first frame to the last that can be shown; one frame more, since the view time is counted
// from a frame on.
static uint32_t frames_of(const struct plan_trial *trial, double rate_hz)
{
    const struct protocol_settings *settings = trial->resolved;
    int64_t fade_out_ns = trial->kind == PROTOCOL_SEQUENTIAL ? settings->fade_to_gray_ns : 0;
    double shown_s = (double)(settings->fade_from_gray_ns + settings->view_ns + fade_out_ns) * 1e-9;
    return (uint32_t)ceil((shown_s + LATE_START_S) * rate_hz) + 2;
}

// A film for the key in the place of one that the trial does not need.
static struct film *begin(struct playback *playback, const struct plan_trial *trial, const struct key *key,
                          double rate_hz)
{
    struct film *film = NULL;
    for (int i = 0; i < 2 && !film; i++) {
        bool needed = false;
        for (int slot = 0; slot < 2; slot++) {
            struct key other = key_of(trial, slot, rate_hz);
            needed = needed || (trial->prerendered[slot] && find(playback, &other) == &playback->films[i]);
        }
        if (!needed)
            film = &playback->films[i];
    }
    drop(playback, film);
    *film = (struct film){.key = *key, .by = trial, .budget_bytes = playback->desc.budget_bytes};
    uint64_t other = playback->films[film == playback->films].recording
                         ? playback->films[film == playback->films].recording->bytes
                         : 0;
    if (!film->budget_bytes)
        film->budget_bytes = free_budget();
    else
        film->budget_bytes -= other < film->budget_bytes ? other : film->budget_bytes;
    film->recording = recording_create(playback->desc.width, playback->desc.height, frames_of(trial, rate_hz));
    return film;
}

// What the machine would show at a frame of the recording.
static struct machine_view view_at(const struct machine_view *view, int slot, uint32_t number, double rate_hz)
{
    struct machine_view at = *view;
    at.screen = MACHINE_STIMULUS;
    at.slot = (enum plan_slot)slot;
    at.condition = view->trial->option[slot];
    at.fade = 0.0;
    at.showing = view->trial->kind == PROTOCOL_SEQUENTIAL && at.slot != view->trial->first_shown;
    at.trial_started = number == 0;
    at.stimulus_ns = (int64_t)llround(number * 1e9 / rate_hz);
    return at;
}

static struct frame frame_at(const struct playback *playback, const struct machine_view *at, uint32_t number,
                             struct fovea_use *out_use, bool *out_known, struct pose *out_head)
{
    *out_use = (struct fovea_use){.x_deg = {NAN, NAN}, .y_deg = {NAN, NAN}};
    *out_known = playback->desc.fovea && playback->desc.fovea(playback->desc.user, at, out_use);
    return stage_frame(playback->desc.stage, at, number, out_use, out_head);
}

static bool too_large(const struct film *film, char *error, size_t error_size)
{
    const struct recording *recording = film->recording;
    uint64_t bytes = recording_forecast(recording);
    if (recording->count < FORECAST_FRAMES && recording->count < recording->capacity)
        bytes = recording->bytes;
    if (bytes <= film->budget_bytes)
        return false;
    snprintf(
        error, error_size,
        "the %u prerendered pictures of an option in trial %u need about %.1f MB of memory, and %.1f MB may be "
        "used; give a smaller --size, a shorter view_s, or more with --playback-mb (unset: half of what is "
        "free)",
        recording->capacity, film->by->ordinal, (double)bytes * 1e-6, (double)film->budget_bytes * 1e-6);
    return true;
}

static bool render_next(struct playback *playback, const struct machine_view *view, int slot, struct film *film,
                        char *error, size_t error_size)
{
    bool known = false;
    struct pose head;
    struct fovea_use use;
    struct frame_stats stats;
    uint32_t number = film->recording->count;
    struct renderer_option *option = stage_option(playback->desc.stage, (enum plan_slot)slot);
    struct machine_view at = view_at(view, slot, number, film->key.rate_hz);
    struct frame frame = frame_at(playback, &at, number, &use, &known, &head);
    bool good = option && renderer_draw(option, &frame, &stats);
    for (int eye = 0; good && eye < EYES; eye++)
        good = renderer_read(option, eye, playback->rgba[eye]);
    good = good && (!playback->desc.drawn || playback->desc.drawn(playback->desc.user, &at, number, &frame));
    if (!good) {
        snprintf(error, error_size, "frame %u of a prerendered option could not be drawn", number);
        return false;
    }
    const uint8_t *const rgba[EYES] = {playback->rgba[EYE_LEFT], playback->rgba[EYE_RIGHT]};
    if (recording_add(film->recording, rgba, (int64_t)stats.shaded_px, (int64_t)stats.triangles))
        return !too_large(film, error, error_size);
    snprintf(error, error_size, "there is no memory for prerendered frame %u", number);
    return false;
}

static double now_s(void)
{
    struct timespec time;
    clock_gettime(CLOCK_MONOTONIC, &time);
    return (double)time.tv_sec + (double)time.tv_nsec * 1e-9;
}

// Options of another trial have left the stage, and with them the history that half a film would need.
static void drop_unfinished(struct playback *playback, const struct plan_trial *trial)
{
    for (int i = 0; i < 2; i++) {
        struct film *film = &playback->films[i];
        if (film->recording && film->by != trial && film->recording->count < film->recording->capacity)
            drop(playback, film);
    }
}

// Puts a finished film on, wound back. The first picture is there before anybody asks.
static void thread(struct projector *projector, const struct film *film)
{
    if (projector->film != film)
        player_load(projector->player, film->recording);
    projector->film = film;
    projector->frame = projector->buffer = -1;
    player_take(projector->player, 0, true);
}

bool playback_prepare(struct playback *playback, const struct machine_view *view, double rate_hz,
                      double slice_s, double *out_done, char *error, size_t error_size)
{
    const struct plan_trial *trial = view->trial;
    double until_s = now_s() + slice_s, done = 0.0;
    int needed = trial->prerendered[0] + trial->prerendered[1];
    drop_unfinished(playback, trial);
    *out_done = 1.0;
    for (int slot = 0; slot < 2; slot++) {
        if (!trial->prerendered[slot])
            continue;
        const struct key key = key_of(trial, slot, rate_hz);
        struct film *film = find(playback, &key);
        if (!film)
            film = begin(playback, trial, &key, rate_hz);
        struct recording *recording = film->recording;
        if (!recording) {
            snprintf(error, error_size, "there is no memory for prerendered pictures");
            return false;
        }
        while (recording->count < recording->capacity) {
            if (!render_next(playback, view, slot, film, error, error_size)) {
                drop(playback, film);
                return false;
            }
            if (recording->count < recording->capacity && now_s() >= until_s) {
                *out_done = (done + (double)recording->count / recording->capacity) / needed;
                return true;
            }
        }
        thread(&playback->projectors[slot], film);
        done += 1.0;
    }
    return true;
}

bool playback_plays(const struct playback *playback, const struct machine_view *view)
{
    return playback && view->slot != PLAN_SLOT_NONE && view->trial->prerendered[view->slot];
}

static void fill_row(const struct playback *playback, const struct machine_view *view,
                     struct projector *projector, struct store_frame *row)
{
    bool known = false;
    struct fovea_use use;
    const struct film *film = projector->film;
    uint32_t number = (uint32_t)projector->frame;
    struct machine_view at = view_at(view, (int)view->slot, number, film->key.rate_hz);
    frame_at(playback, &at, number, &use, &known, &row->head_pose);
    if (known) {
        for (int eye = 0; eye < EYES; eye++) {
            row->fovea_deg[eye][0] = use.x_deg[eye];
            row->fovea_deg[eye][1] = use.y_deg[eye];
        }
        row->fovea_source = STORE_FOVEA_TARGET;
    }
    snprintf(projector->effective, sizeof projector->effective, "{\"playback\":\"prerendered\",\"frame\":%u}",
             number);
    row->effective = projector->effective;
    row->shaded_px = film->recording->frames[number].shaded_px;
    row->triangles = film->recording->frames[number].triangles;
}

void playback_take(struct playback *playback, const struct machine_view *view, bool wait,
                   struct store_frame *row, bool *out_new, bool *out_held)
{
    struct projector *projector = &playback->projectors[view->slot];
    const struct film *film = projector->film;
    *out_new = *out_held = false;
    if (!film)
        return;
    int64_t wanted = llround((double)view->stimulus_ns * 1e-9 * film->key.rate_hz),
            last = film->recording->count - 1;
    bool past = wanted > last;
    wanted = wanted < 0 ? 0 : past ? last : wanted;
    if (wanted != projector->frame) {
        // The very first picture of a showing is waited for: there is none to hold.
        int buffer = player_take(projector->player, (uint32_t)wanted,
                                 wait || view->trial_started || projector->frame < 0);
        if (buffer >= 0) {
            projector->buffer = buffer;
            projector->frame = wanted;
            *out_new = true;
        }
    }
    *out_held = past || projector->frame != wanted;
    if (projector->frame >= 0)
        fill_row(playback, view, projector, row);
}

bool playback_show(struct playback *playback, enum plan_slot slot, double fade)
{
    struct projector *projector = &playback->projectors[slot];
    bool shown = renderer_show_picture(playback->desc.renderer, projector->picture, projector->buffer, fade);
    projector->buffer = -1;
    return shown;
}

// Buffers hold black or an old picture; the image is uploaded anew before it is next looked at.
bool playback_show_any(struct playback *playback, double fade)
{
    struct projector *projector = &playback->projectors[0];
    projector->frame = -1;
    return renderer_show_picture(playback->desc.renderer, projector->picture, 0, fade);
}

void playback_size(const struct playback *playback, enum plan_slot slot, uint32_t *out_frames,
                   uint64_t *out_bytes)
{
    const struct film *film = playback->projectors[slot].film;
    *out_frames = film ? film->recording->count : 0;
    *out_bytes = film ? film->recording->bytes : 0;
}
