#include "app/session/stage.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { NO_TRIAL = -1 };

struct stage {
    struct stage_desc desc;
    struct mode_choice reference_choice; // desc.reference points here, where there is one
    int64_t trial;                       // prepared, or NO_TRIAL
    struct stage_scene *scene;
    struct renderer_option *options[2];
    struct renderer_option *reference;
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
    stage->trial = NO_TRIAL;
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
    stage->trial = NO_TRIAL;
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
    for (size_t i = 0; i < stage->desc.scene_count; i++)
        if (stage->desc.scenes[i].resident)
            evict(&stage->desc.scenes[i]);
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

static bool make_option(struct stage *stage, int slot, uint32_t condition,
                        const struct renderer_settings *settings, char *error, size_t error_size)
{
    struct mode_choice choice;
    if (stage_choice(&stage->desc.plan->conditions[condition], &choice))
        stage->options[slot] =
            renderer_option_create(stage->desc.renderer, stage->scene->resident, &choice, settings);
    if (stage->options[slot])
        return true;
    snprintf(error, error_size, "the mode '%s' cannot be set up on this device for the scene '%s'",
             stage->desc.plan->conditions[condition].mode, stage->scene->name);
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

bool stage_prepare(struct stage *stage, uint32_t trial, char *error, size_t error_size)
{
    const struct plan_trial *planned = &stage->desc.plan->trials[trial];
    if (stage->trial == (int64_t)trial)
        return true;
    const struct renderer_settings settings = render_settings(stage, planned->resolved);
    bool done = enter_scene(stage, find_scene(stage, planned->scene), planned->scene, error, error_size);
    for (int slot = 0; done && slot < 2; slot++)
        if (planned->option[slot] >= 0)
            done = make_option(stage, slot, (uint32_t)planned->option[slot], &settings, error, error_size);
    done = done && make_reference(stage, &settings, error, error_size);
    if (done)
        stage->trial = (int64_t)trial;
    else
        clear_options(stage);
    return done;
}

// Those of the first trial that shows the condition; as in any trial that does, where all agree.
static struct renderer_settings settings_of_condition(const struct stage *stage, uint32_t condition)
{
    const struct plan *plan = stage->desc.plan;
    for (uint32_t i = 0; i < plan->trial_count; i++)
        for (int slot = 0; slot < 2; slot++)
            if (plan->trials[i].option[slot] == (int32_t)condition)
                return render_settings(stage, plan->trials[i].resolved);
    return (struct renderer_settings){0};
}

bool stage_prepare_condition(struct stage *stage, uint32_t condition, size_t scene, char *error,
                             size_t error_size)
{
    const struct renderer_settings settings = settings_of_condition(stage, condition);
    struct stage_scene *wanted = &stage->desc.scenes[scene];
    bool done = enter_scene(stage, wanted, wanted->name, error, error_size) &&
                make_option(stage, PLAN_SLOT_A, condition, &settings, error, error_size) &&
                make_reference(stage, &settings, error, error_size);
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
    *out_head =
        camera_path_pose(&stage->scene->scene->path, settings->camera == PROTOCOL_CAMERA_STILL ? 0.0 : time_s);
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
