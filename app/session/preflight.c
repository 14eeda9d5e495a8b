#include "app/session/preflight.h"

#include "analysis/stats/quantile.h"
#include "app/gaze/script.h"
#include "app/session/wait.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

enum { TRIED = 256 }; // distinct options of a block, more than any protocol has in one

// An option as its drawing time depends on it.
struct tried {
    int32_t condition;
    const char *scene;
    enum protocol_camera camera;
    int64_t path_start_ns;
    double render[CATALOGUE_SETTINGS];
    bool prerendered;
};

struct preflight {
    struct show *show;
    uint32_t block;
    int64_t at_ns;
    struct tried tried[TRIED];
    uint32_t held[TRIED]; // divisor of the refresh rate, 0: none
    uint32_t count, planned;
    double *frame_ms; // room for the frames of one option
    uint32_t frames;  // as many
    uint32_t slowest; // divisor that all hold which are paced
    char refused[512];
    char *error;
    size_t error_size;
};

static double now_ms(void)
{
    struct timespec time;
    clock_gettime(CLOCK_MONOTONIC, &time);
    return (double)time.tv_sec * 1e3 + (double)time.tv_nsec * 1e-6;
}

static struct tried tried_of(const struct plan_trial *trial, int slot)
{
    struct tried tried = {.condition = trial->option[slot],
                          .scene = trial->scene,
                          .camera = trial->resolved->camera,
                          .path_start_ns = trial->resolved->path_start_ns,
                          .prerendered = trial->prerendered[slot]};
    memcpy(tried.render, trial->resolved->render, sizeof tried.render);
    return tried;
}

static bool same(const struct tried *a, const struct tried *b)
{
    return a->condition == b->condition && a->scene == b->scene && a->camera == b->camera &&
           a->path_start_ns == b->path_start_ns && a->prerendered == b->prerendered &&
           memcmp(a->render, b->render, sizeof a->render) == 0;
}

// Where it stands among those that were tried; count: not yet.
static uint32_t find(const struct preflight *p, const struct tried *tried)
{
    uint32_t i = 0;
    while (i < p->count && !same(&p->tried[i], tried))
        i++;
    return i;
}

static struct frame frame_at(const struct preflight *p, const struct plan_trial *trial, uint32_t place,
                             int slot, uint32_t number)
{
    struct pose head;
    struct fovea_use use = {.known = false};
    const struct session_desc *desc = p->show->desc;
    double time_s = (double)number / desc->display->refresh_hz;
    struct machine_view view = {.screen = MACHINE_STIMULUS,
                                .trial = trial,
                                .trial_index = place,
                                .attempt = 1,
                                .slot = (enum plan_slot)slot,
                                .condition = trial->option[slot],
                                .trial_started = number == 0,
                                .stimulus_ns = llround(time_s * 1e9),
                                .level = NAN};
    if (!show_target_fovea(p->show, &view, &use)) {
        gaze_script(desc->plan->seed, time_s, &use.x_deg[EYE_LEFT], &use.y_deg[EYE_LEFT]);
        use.x_deg[EYE_RIGHT] = use.x_deg[EYE_LEFT];
        use.y_deg[EYE_RIGHT] = use.y_deg[EYE_LEFT];
    }
    return stage_frame(desc->stage, &view, number, &use, &head);
}

// One frame from its beginning until it was presented, in milliseconds; negative: it failed.
static double draw_one(const struct preflight *p, const struct plan_trial *trial, uint32_t place, int slot,
                       uint32_t number)
{
    struct frame_stats stats;
    const struct session_desc *desc = p->show->desc;
    double start_ms = now_ms();
    bool good;
    if (trial->prerendered[slot]) {
        good = playback_show_any(p->show->playback, 1.0);
    } else {
        struct frame frame = frame_at(p, trial, place, slot, number);
        struct renderer_option *option = stage_option(desc->stage, (enum plan_slot)slot);
        good = option && renderer_draw(option, &frame, &stats) && renderer_show(desc->renderer, option, 1.0);
    }
    return good ? now_ms() - start_ms : -1.0;
}

static enum preflight_result look(const struct preflight *p, double done)
{
    struct screen screen;
    struct display *display = p->show->desc->display;
    enum wait_result result = wait_look(display);
    if (result != WAIT_ON)
        return result == WAIT_CLOSED ? PREFLIGHT_CLOSED : PREFLIGHT_STOPPED;
    wait_screen(done, &screen);
    if (overlay_set(&p->show->overlay, &screen))
        return PREFLIGHT_PASSED;
    snprintf(p->error, p->error_size, "there is no memory for a text");
    return PREFLIGHT_REFUSED;
}

// Fills frame_ms; *out_count: how many.
static enum preflight_result draw_all(struct preflight *p, const struct plan_trial *trial, uint32_t place,
                                      int slot, size_t *out_count)
{
    double begin_ms = now_ms();
    size_t count = 0;
    for (uint32_t number = 0; count < p->frames; number++) {
        enum preflight_result result = look(p, ((double)p->count + (double)count / p->frames) /
                                                   (p->planned > p->count ? p->planned : p->count + 1));
        if (result != PREFLIGHT_PASSED)
            return result;
        double ms = draw_one(p, trial, place, slot, number);
        if (ms < 0.0) {
            snprintf(p->error, p->error_size, "a frame of '%s' could not be drawn for the preflight",
                     p->show->desc->plan->conditions[trial->option[slot]].mode);
            return PREFLIGHT_REFUSED;
        }
        if (number >= PREFLIGHT_WARM)
            p->frame_ms[count++] = ms;
        if (count >= PREFLIGHT_LEAST && now_ms() - begin_ms > PREFLIGHT_S * 1e3)
            break;
    }
    *out_count = count;
    return PREFLIGHT_PASSED;
}

// As the protocol calls it, and its number in the list that `fovstudy check` prints.
static void name_option(const struct plan *plan, const struct plan_trial *trial, int slot, char *out,
                        size_t size)
{
    const struct protocol_block *block = &plan->protocol->blocks[trial->block];
    const struct protocol_cell *cell = trial->cell < block->cell_count
                                           ? &block->cells[trial->cell]
                                           : &block->extras[trial->cell - block->cell_count].cell;
    uint32_t place = trial->test_slot == (enum plan_slot)slot ? 0 : block->option_count - 1;
    snprintf(out, size, "%s (condition %d)", plan->protocol->options[cell->shown[place]].name,
             trial->option[slot] + 1);
}

// Into the store and to the experimenter; and into the sentence where the refresh rate is not held.
static void tell(struct preflight *p, const struct plan_trial *trial, int slot, size_t count, uint32_t held,
                 double late)
{
    char text[STORE_DETAIL_SIZE], name[PROTOCOL_NAME + 32], rate[32] = "no rate";
    const struct session_desc *desc = p->show->desc;
    const char *block = desc->plan->protocol->blocks[p->block].name;
    name_option(desc->plan, trial, slot, name, sizeof name);
    if (held)
        snprintf(rate, sizeof rate, "%.4g Hz", desc->display->refresh_hz / held);
    double p50 = stat_quantile(p->frame_ms, count, 0.5), p95 = stat_quantile(p->frame_ms, count, 0.95),
           p99 = stat_quantile(p->frame_ms, count, 0.99);
    double refresh_hz = desc->display->refresh_hz, hz = held ? refresh_hz / held : 0.0;
    snprintf(text, sizeof text,
             "{\"condition\":%" PRId64 ",\"scene\":\"%s\",\"block\":\"%s\",\"frames\":%zu,\"late\":%.4g,"
             "\"p50_ms\":%.3f,\"p95_ms\":%.3f,\"p99_ms\":%.3f,\"hz\":%.4g}",
             desc->ids->condition_ids[trial->option[slot]], trial->scene, block, count, late, p50, p95, p99,
             hz);
    store_push_event(desc->store, &(struct store_event){.session_id = desc->ids->session_id,
                                                        .segment_id = desc->ids->segment_id,
                                                        .at_ns = p->at_ns,
                                                        .kind = "preflight",
                                                        .detail = text});
    snprintf(text, sizeof text, "preflight of '%s': %s on '%s', %.1f ms a frame (99 %%: %.1f), holds %s", block,
             name, trial->scene, p50, p99, rate);
    if (desc->say)
        desc->say(desc->say_user, text);
    size_t used = strlen(p->refused);
    if (held != 1 && used < sizeof p->refused)
        snprintf(p->refused + used, sizeof p->refused - used, "%s%s on '%s' %.1f ms, %s", used ? "; " : "",
                 name, trial->scene, p99, rate);
}

static enum preflight_result try_option(struct preflight *p, uint32_t place, int slot, uint32_t *out_held)
{
    size_t count = 0;
    const struct session_desc *desc = p->show->desc;
    const struct plan_trial *trial = &desc->plan->trials[place];
    struct tried tried = tried_of(trial, slot);
    uint32_t at = find(p, &tried);
    if (at < p->count) {
        *out_held = p->held[at];
        return PREFLIGHT_PASSED;
    }
    const struct machine_view at_rest = {.screen = MACHINE_REST,
                                         .trial = trial,
                                         .trial_index = place,
                                         .slot = PLAN_SLOT_NONE,
                                         .condition = -1,
                                         .level = NAN};
    if (!stage_prepare(desc->stage, &at_rest, p->error, p->error_size))
        return PREFLIGHT_REFUSED;
    enum preflight_result result = draw_all(p, trial, place, slot, &count);
    if (result != PREFLIGHT_PASSED)
        return result;
    // A frame that waits for the screen takes whole refreshes.
    double slack = desc->display->simulated_clock ? 0.0 : 0.5, refresh_hz = desc->display->refresh_hz;
    *out_held = pace_held(p->frame_ms, count, refresh_hz, slack);
    double late = pace_late_share(p->frame_ms, count, refresh_hz, 1, slack);
    stat_sort(p->frame_ms, count);
    tell(p, trial, slot, count, *out_held, late);
    if (p->count < TRIED) {
        p->tried[p->count] = tried;
        p->held[p->count++] = *out_held;
    }
    return PREFLIGHT_PASSED;
}

static enum preflight_result refuse(struct preflight *p)
{
    const struct session_desc *desc = p->show->desc;
    snprintf(p->error, p->error_size,
             "block '%s' is not shown, since frames would come late at %.4g Hz: %s (99 %% of the frame times "
             "are below, "
             "the rate that is held); set 'pace: common', make --size smaller, or play back what is slow with "
             "'playback: prerendered' "
             "(--no-preflight shows it anyway, to try things out)",
             desc->plan->protocol->blocks[p->block].name, desc->display->refresh_hz, p->refused);
    return PREFLIGHT_REFUSED;
}

// One rate for the whole block: trials at different rates could not be compared.
static enum preflight_result try_block(struct preflight *p)
{
    bool refused = false;
    const struct plan *plan = p->show->desc->plan;
    for (uint32_t place = 0; place < plan->trial_count; place++) {
        const struct plan_trial *trial = &plan->trials[place];
        for (int slot = 0; trial->block == p->block && slot < 2; slot++) {
            uint32_t held = 0;
            if (trial->option[slot] < 0)
                continue;
            enum preflight_result result = try_option(p, place, slot, &held);
            if (result != PREFLIGHT_PASSED)
                return result;
            bool paced = trial->resolved->pace == PROTOCOL_PACE_COMMON;
            refused = refused || held == 0 || (held > 1 && !paced);
            p->slowest = held > p->slowest ? held : p->slowest;
        }
    }
    return refused ? refuse(p) : PREFLIGHT_PASSED;
}

// Distinct options, for the progress.
static uint32_t count_options(struct preflight *p)
{
    const struct plan *plan = p->show->desc->plan;
    for (uint32_t place = 0; place < plan->trial_count; place++)
        for (int slot = 0; slot < 2; slot++) {
            struct tried tried = tried_of(&plan->trials[place], slot);
            if (plan->trials[place].block == p->block && tried.condition >= 0 && p->count < TRIED &&
                find(p, &tried) == p->count)
                p->tried[p->count++] = tried;
        }
    uint32_t count = p->count;
    p->count = 0;
    return count;
}

enum preflight_result preflight_block(struct show *show, uint32_t block, int64_t at_ns, uint32_t *out_divisor,
                                      char *error, size_t error_size)
{
    struct preflight *p = calloc(1, sizeof *p);
    uint32_t frames = show->desc->preflight_frames ? show->desc->preflight_frames : PREFLIGHT_FRAMES;
    double *frame_ms = malloc(frames * sizeof *frame_ms);
    enum preflight_result result = PREFLIGHT_REFUSED;
    snprintf(error, error_size, "out of memory");
    if (p && frame_ms) {
        *p = (struct preflight){.show = show,
                                .block = block,
                                .at_ns = at_ns,
                                .frame_ms = frame_ms,
                                .frames = frames,
                                .slowest = 1,
                                .error = error,
                                .error_size = error_size};
        p->planned = count_options(p);
        result = try_block(p);
        *out_divisor = p->slowest;
    }
    show->pace.present_ns = -1;
    free(frame_ms);
    free(p);
    return result;
}
