#include "app/session/stage.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct stage {
    struct stage_desc desc;
    struct mode_choice reference_choice; // desc.reference points here, where there is one
    const struct plan_trial *trial;      // prepared; NULL: none
    struct stage_scene *scene;
    struct renderer_option *options[2];
    struct mode_choice choices[2]; // of the options; mode NULL: none
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
    return stage;
}

static void clear_options(struct stage *stage)
{
    for (int slot = 0; slot < 2; slot++) {
        renderer_option_destroy(stage->options[slot]);
        stage->options[slot] = NULL;
        stage->choices[slot] = (struct mode_choice){0};
    }
    renderer_option_destroy(stage->reference);
    stage->reference = NULL;
    stage->trial = NULL;
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

static struct mode_choice choice_of(const struct stage *stage, const struct protocol_option *option)
{
    const struct catalogue *catalogue = stage->desc.plan->protocol->catalogue;
    struct mode_choice choice = {.mode = mode_find(catalogue->modes[option->mode].name)};
    for (uint32_t i = 0; choice.mode && i < choice.mode->parameter_count; i++)
        choice.values[i] = option->values[i];
    return choice;
}

// Nothing where the slot shows that already; what it showed before makes room.
static bool make_option(struct stage *stage, int slot, const struct protocol_option *option,
                        const struct renderer_settings *settings, char *error, size_t error_size)
{
    struct mode_choice choice = choice_of(stage, option);
    if (stage->options[slot] && memcmp(&choice, &stage->choices[slot], sizeof choice) == 0)
        return true;
    renderer_option_destroy(stage->options[slot]);
    stage->options[slot] =
        choice.mode ? renderer_option_create(stage->desc.renderer, stage->scene->resident, &choice, settings)
                    : NULL;
    stage->choices[slot] = choice;
    if (stage->options[slot])
        return true;
    snprintf(error, error_size, "the mode '%s' cannot be set up on this device for the scene '%s'",
             choice.mode ? choice.mode->name : "?", stage->scene->name);
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

bool stage_prepare(struct stage *stage, const struct machine *machine, const struct plan_trial *trial,
                   char *error, size_t error_size)
{
    struct protocol_option option;
    const struct renderer_settings settings = render_settings(stage, trial->resolved);
    bool ready = stage->trial == trial, done = true;
    if (!ready)
        done = enter_scene(stage, find_scene(stage, trial->scene), trial->scene, error, error_size);
    for (int slot = 0; done && slot < 2; slot++)
        if (machine_option(machine, (enum plan_slot)slot, &option))
            done = make_option(stage, slot, &option, &settings, error, error_size);
    done = done && (ready || make_reference(stage, &settings, error, error_size));
    if (done)
        stage->trial = trial;
    else
        clear_options(stage);
    return done;
}

bool stage_prepare_option(struct stage *stage, const struct protocol_option *option,
                          const struct protocol_settings *settings, size_t scene, char *error,
                          size_t error_size)
{
    const struct renderer_settings rendered = render_settings(stage, settings);
    struct stage_scene *wanted = &stage->desc.scenes[scene];
    bool done = enter_scene(stage, wanted, wanted->name, error, error_size) &&
                make_option(stage, PLAN_SLOT_A, option, &rendered, error, error_size) &&
                make_reference(stage, &rendered, error, error_size);
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
