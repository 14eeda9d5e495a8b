#include "app/session/stage.h"

#include "app/session/live.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// Which attempt of which trial the stage is set for; of a staircase its level too.
struct turn {
    const struct plan_trial *trial; // NULL: none
    uint32_t place, attempt;
    double level;
};

struct stage {
    struct stage_desc desc;
    struct mode_choice reference_choice; // desc.reference points here, where there is one
    struct turn turn;                    // prepared
    struct stage_scene *scene;
    struct renderer_option *options[2];
    struct mode_choice conditions[2], now[2]; // of the options: as the plan has them, as they are drawn
    char effective[2][STAGE_EFFECTIVE];       // "" where both are the same
    struct renderer_option *reference;
    struct targets targets;
    uint64_t uses;
};

struct stage *stage_create(const struct stage_desc *desc)
{
    struct stage *stage = calloc(1, sizeof *stage);
    if (!stage)
        return NULL;
    stage->desc = *desc;
    if (desc->reference) {
        stage->reference_choice = *desc->reference;
        stage->desc.reference = &stage->reference_choice;
    }
    return stage;
}

static void clear_options(struct stage *stage)
{
    for (int slot = 0; slot < 2; slot++) {
        renderer_option_destroy(stage->options[slot]);
        stage->options[slot] = NULL;
    }
    renderer_option_destroy(stage->reference);
    stage->reference = NULL;
    targets_finish(&stage->targets);
    stage->turn.trial = NULL;
}

static void evict(struct stage_scene *scene)
{
    renderer_scene_destroy(scene->resident);
    scene->resident = NULL;
}

void stage_destroy(struct stage *stage)
{
    if (!stage)
        return;
    clear_options(stage);
    for (size_t i = 0; i < stage->desc.scene_count; i++) {
        struct stage_scene *scene = &stage->desc.scenes[i];
        if (scene->resident)
            evict(scene);
        ray_scene_destroy(scene->rays);
        scene->rays = NULL;
    }
    free(stage);
}

bool stage_choice(const struct plan_condition *condition, struct mode_choice *out)
{
    *out = (struct mode_choice){.mode = mode_find(condition->mode)};
    for (uint32_t i = 0; out->mode && i < out->mode->parameter_count; i++)
        out->values[i] = condition->values[i];
    return out->mode != NULL;
}

// Puts the scene on the GPU; the one unused the longest makes room.
static bool bring(struct stage *stage, struct stage_scene *scene)
{
    size_t resident = 0;
    struct stage_scene *oldest = NULL;
    scene->used = ++stage->uses;
    if (scene->resident)
        return true;
    for (size_t i = 0; i < stage->desc.scene_count; i++) {
        struct stage_scene *other = &stage->desc.scenes[i];
        if (!other->resident)
            continue;
        resident++;
        if (!oldest || other->used < oldest->used)
            oldest = other;
    }
    if (resident >= STAGE_RESIDENT)
        evict(oldest);
    scene->resident = renderer_scene_create(stage->desc.renderer, scene->scene);
    return scene->resident != NULL;
}

static struct stage_scene *find_scene(struct stage *stage, const char *name)
{
    for (size_t i = 0; i < stage->desc.scene_count; i++)
        if (strcmp(stage->desc.scenes[i].name, name) == 0)
            return &stage->desc.scenes[i];
    return NULL;
}

static bool is_on(const struct protocol_settings *settings, int index)
{
    return index >= 0 && settings->render[index] > 0.5;
}

static struct renderer_settings render_settings(const struct stage *stage,
                                                const struct protocol_settings *settings)
{
    return (struct renderer_settings){.ssao = is_on(settings, stage->desc.ssao_setting),
                                      .taa = is_on(settings, stage->desc.taa_setting)};
}

static void note_effective(struct stage *stage, int slot)
{
    char *out = stage->effective[slot];
    if (!live_effective(&stage->conditions[slot], &stage->now[slot], out, sizeof stage->effective[slot]))
        out[0] = '\0';
}

// turn NULL: as the condition says.
static bool make_option(struct stage *stage, int slot, uint32_t condition, const struct turn *turn,
                        struct renderer_settings settings, char *error, size_t error_size)
{
    char why[256];
    const struct plan *plan = stage->desc.plan;
    struct mode_choice *now = &stage->now[slot];
    if (stage_choice(&plan->conditions[condition], now)) {
        stage->conditions[slot] = *now;
        if (turn)
            live_choice(plan->protocol, turn->trial, (enum plan_slot)slot, turn->level,
                        turn->trial->adjust_start, now);
        settings.adjustable =
            turn && live_adjusts(turn->trial) && turn->trial->test_slot == (enum plan_slot)slot;
        if (settings.adjustable && !mode_check(now, why, sizeof why))
            *now = stage->conditions[slot];
        if (settings.adjustable && !now->mode->set) {
            snprintf(error, error_size, "the mode '%s' cannot be changed while it runs; adjust another one",
                     now->mode->name);
            return false;
        }
        stage->options[slot] =
            renderer_option_create(stage->desc.renderer, stage->scene->resident, now, &settings);
    }
    note_effective(stage, slot);
    if (stage->options[slot])
        return true;
    snprintf(error, error_size, "the mode '%s' cannot be set up on this device for the scene '%s'",
             plan->conditions[condition].mode, stage->scene->name);
    return false;
}

static bool make_reference(struct stage *stage, const struct renderer_settings *settings, char *error,
                           size_t error_size)
{
    if (!stage->desc.reference)
        return true;
    stage->reference =
        renderer_option_create(stage->desc.renderer, stage->scene->resident, stage->desc.reference, settings);
    if (!stage->reference)
        snprintf(error, error_size, "the reference cannot be set up on this device for the scene '%s'",
                 stage->scene->name);
    return stage->reference != NULL;
}

static bool enter_scene(struct stage *stage, struct stage_scene *scene, const char *name, char *error,
                        size_t error_size)
{
    clear_options(stage);
    stage->scene = scene;
    if (scene && bring(stage, scene))
        return true;
    snprintf(error, error_size, "the scene '%s' cannot be put on the GPU", name);
    return false;
}

static bool prepare_targets(struct stage *stage, const struct plan_trial *trial, char *error, size_t error_size)
{
    struct stage_scene *scene = stage->scene;
    if (!targets_needed(trial))
        return true;
    if (!scene->rays)
        scene->rays = ray_scene_create(scene->scene);
    if (scene->rays && targets_prepare(&stage->targets, &(struct targets_desc){.trial = trial,
                                                                               .rays = scene->rays,
                                                                               .path = &scene->scene->path,
                                                                               .fov = stage->desc.fov,
                                                                               .ipd_m = stage->desc.ipd_m}))
        return true;
    snprintf(error, error_size, "there is no memory for the targets of trial %u", trial->ordinal);
    return false;
}

// An attempt begins with its stimulus; before that the view still counts the one before.
static struct turn turn_of(const struct machine_view *view)
{
    return (struct turn){view->trial, view->trial_index,
                         view->attempt + (view->screen == MACHINE_STIMULUS ? 0 : 1), view->level};
}

static bool same_turn(const struct turn *a, const struct turn *b)
{
    return a->trial == b->trial && a->place == b->place && a->attempt == b->attempt && !(a->level < b->level) &&
           !(a->level > b->level);
}

bool stage_prepare(struct stage *stage, const struct machine_view *view, char *error, size_t error_size)
{
    const struct turn turn = turn_of(view);
    const struct plan_trial *trial = turn.trial;
    if (same_turn(&stage->turn, &turn))
        return true;
    const struct renderer_settings settings = render_settings(stage, trial->resolved);
    bool done = enter_scene(stage, find_scene(stage, trial->scene), trial->scene, error, error_size);
    for (int slot = 0; done && slot < 2; slot++)
        if (trial->option[slot] >= 0)
            done = make_option(stage, slot, (uint32_t)trial->option[slot], &turn, settings, error, error_size);
    done = done && make_reference(stage, &settings, error, error_size) &&
           prepare_targets(stage, trial, error, error_size);
    if (done)
        stage->turn = turn;
    else
        clear_options(stage);
    return done;
}

void stage_adjust(struct stage *stage, const struct machine_view *view)
{
    const struct plan_trial *trial = stage->turn.trial;
    if (!trial || !view->adjusted)
        return;
    for (int slot = 0; slot < 2; slot++) {
        char why[256];
        struct mode_choice wanted = stage->conditions[slot];
        live_choice(stage->desc.plan->protocol, trial, (enum plan_slot)slot, NAN, view->adjusted, &wanted);
        if (!stage->options[slot] || live_same(&wanted, &stage->now[slot]) ||
            !mode_check(&wanted, why, sizeof why) || !renderer_option_set(stage->options[slot], &wanted))
            continue;
        stage->now[slot] = wanted;
        note_effective(stage, slot);
    }
}

const struct mode_choice *stage_now(const struct stage *stage, enum plan_slot slot)
{
    return slot == PLAN_SLOT_NONE || !stage->options[slot] ? NULL : &stage->now[slot];
}

const char *stage_effective(const struct stage *stage, enum plan_slot slot)
{
    return slot == PLAN_SLOT_NONE || !stage->effective[slot][0] ? NULL : stage->effective[slot];
}

const struct targets *stage_targets(const struct stage *stage)
{
    return &stage->targets;
}

bool stage_prepare_option(struct stage *stage, const struct protocol_option *option,
                          const struct protocol_settings *settings, size_t scene, char *error,
                          size_t error_size)
{
    const struct catalogue *catalogue = stage->desc.plan->protocol->catalogue;
    const struct renderer_settings rendered = render_settings(stage, settings);
    struct stage_scene *wanted = &stage->desc.scenes[scene];
    struct mode_choice choice = {.mode = mode_find(catalogue->modes[option->mode].name)};
    for (uint32_t i = 0; choice.mode && i < choice.mode->parameter_count; i++)
        choice.values[i] = option->values[i];
    bool done = enter_scene(stage, wanted, wanted->name, error, error_size) &&
                make_reference(stage, &rendered, error, error_size);
    if (done && choice.mode)
        stage->options[PLAN_SLOT_A] =
            renderer_option_create(stage->desc.renderer, wanted->resident, &choice, &rendered);
    if (done && !stage->options[PLAN_SLOT_A])
        snprintf(error, error_size, "the mode '%s' cannot be set up on this device for the scene '%s'",
                 catalogue->modes[option->mode].name, wanted->name);
    done = done && stage->options[PLAN_SLOT_A];
    if (!done)
        clear_options(stage);
    return done;
}

struct renderer_option *stage_option(struct stage *stage, enum plan_slot slot)
{
    return slot == PLAN_SLOT_NONE ? NULL : stage->options[slot];
}

struct renderer_option *stage_reference(struct stage *stage)
{
    return stage->reference;
}

struct frame stage_frame(const struct stage *stage, const struct machine_view *view, uint64_t number,
                         const struct fovea_use *fovea, struct pose *out_head)
{
    const struct protocol_settings *settings = view->trial->resolved;
    double time_s = (double)view->stimulus_ns * 1e-9;
    const bool moving = is_on(settings, stage->desc.moving_setting);
    *out_head = targets_head(view->trial, &stage->scene->scene->path, time_s);
    struct frame frame = {
        .number = number,
        .moving = moving,
        .animation_s = moving ? time_s : 0.0,
        .cut = view->trial_started,
    };
    for (int eye = 0; eye < EYES; eye++)
        frame.eyes[eye] = (struct frame_eye){
            .pose = viewing_eye_pose(out_head, eye, stage->desc.ipd_m),
            .fov = stage->desc.fov,
            .gaze_x_deg = fovea->x_deg[eye],
            .gaze_y_deg = fovea->y_deg[eye],
        };
    return frame;
}
