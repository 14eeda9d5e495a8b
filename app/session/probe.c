#include "app/session/probe.h"

#include "app/gaze/script.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

// As many frames as a look at one option takes in a session at the headless rates used for rehearsal (about a
// second at 15 to 25 Hz), and as many measured as such a look gives.
enum { PROBE_FRAMES = 20, PROBE_EVERY = 5 };

static struct frame frame_at(const struct session_desc *desc, uint32_t scene, uint64_t number)
{
    double refresh_hz = desc->display->refresh_hz > 0.0 ? desc->display->refresh_hz : DISPLAY_HEADLESS_HZ;
    double time_s = (double)number / refresh_hz, x_deg = 0.0, y_deg = 0.0;
    struct pose head = camera_path_pose(&desc->scenes[scene].scene->path, time_s);
    struct frame frame = {.number = number, .cut = number == 0};
    gaze_script(desc->plan->seed, time_s, &x_deg, &y_deg);
    for (int eye = 0; eye < EYES; eye++)
        frame.eyes[eye] = (struct frame_eye){.pose = viewing_eye_pose(&head, eye, desc->ipd_m),
                                             .fov = desc->fov,
                                             .gaze_x_deg = x_deg,
                                             .gaze_y_deg = y_deg};
    return frame;
}

// An option that some trial may show.
struct probe {
    const struct session_desc *desc;
    struct measure *measure;
    const struct plan_trial *trial;
    struct protocol_option option;
    char *error;
    size_t error_size;
};

static bool draw(const struct probe *probe, const struct measure_key *key)
{
    const struct session_desc *desc = probe->desc;
    if (!stage_prepare_option(desc->stage, &probe->option, probe->trial->resolved, key->scene, probe->error,
                              probe->error_size))
        return false;
    struct renderer_option *option = stage_option(desc->stage, PLAN_SLOT_A);
    for (uint64_t number = 0; number < PROBE_FRAMES; number++) {
        struct frame_stats stats;
        struct frame frame = frame_at(desc, key->scene, number);
        bool measured = number % PROBE_EVERY == PROBE_EVERY - 1;
        if (!renderer_draw(option, &frame, &stats) ||
            (measured && !measure_take(probe->measure, key, option, stage_reference(desc->stage), &frame))) {
            snprintf(probe->error, probe->error_size, "the image error on '%s' could not be measured",
                     desc->scenes[key->scene].name);
            return false;
        }
    }
    return true;
}

static bool find_condition(const struct probe *probe, int64_t *out_id, struct store_error *why)
{
    char parameters[PLAN_JSON];
    const struct protocol *protocol = probe->desc->plan->protocol;
    struct store_condition row = {protocol->catalogue->modes[probe->option.mode].name, parameters};
    snprintf(why->text, sizeof why->text, "the parameters of an option are too long");
    return protocol_option_json(protocol, &probe->option, parameters, sizeof parameters) &&
           store_add_condition(probe->desc->store, &row, out_id, why) == STORE_OK;
}

// On every scene where it was not measured.
static bool measure_option(const struct probe *probe, int64_t condition_id)
{
    struct store_error why;
    const struct session_desc *desc = probe->desc;
    struct measure_key key = {.condition_id = condition_id};
    measure_metric(desc->plan->protocol, probe->trial->resolved, key.metric);
    if (!condition_id && !find_condition(probe, &key.condition_id, &why)) {
        snprintf(probe->error, probe->error_size, "%s", why.text);
        return false;
    }
    for (; key.scene < desc->scene_count; key.scene++) {
        const struct store_error_key reference = {.condition_id = desc->reference_id,
                                                  .reference_id = desc->reference_id,
                                                  .scene = desc->scenes[key.scene].spec,
                                                  .metric = key.metric};
        bool is_reference = key.condition_id == desc->reference_id;
        if (!is_reference && isnan(measure_error(probe->measure, &key)) && !draw(probe, &key))
            return false;
        if (is_reference && store_set_measured_error(desc->store, &reference, 0.0, &why) != STORE_OK) {
            snprintf(probe->error, probe->error_size, "%s", why.text);
            return false;
        }
    }
    return true;
}

// A parameter's ends and middle.
static bool measure_range(struct probe *probe, uint32_t parameter, double min, double max, double middle)
{
    const double values[] = {min, middle, max};
    const double kept = probe->option.values[parameter];
    bool good = true;
    for (size_t i = 0; good && i < sizeof values / sizeof values[0]; i++) {
        probe->option.values[parameter] = plan_level(values[i]);
        good = measure_option(probe, 0);
    }
    probe->option.values[parameter] = kept;
    return good;
}

static bool measure_slot(struct probe *probe, int slot)
{
    const struct plan *plan = probe->desc->plan;
    const struct plan_trial *trial = probe->trial;
    const struct protocol_block *block = &plan->protocol->blocks[trial->block];
    const struct plan_condition *condition = &plan->conditions[trial->option[slot]];
    bool tested = slot == (int)trial->test_slot;
    probe->option = (struct protocol_option){.mode = condition->mode_index};
    memcpy(probe->option.values, condition->values, sizeof condition->values);
    if (tested && trial->kind == PROTOCOL_STAIRCASE) {
        const struct quest_plus_grid *level = &block->staircase.desc.level;
        double middle =
            level->spacing == QUEST_PLUS_LOG ? sqrt(level->min * level->max) : (level->min + level->max) / 2;
        return measure_range(probe, block->staircase.parameter, level->min, level->max, middle);
    }
    for (uint32_t i = 0; tested && trial->kind == PROTOCOL_ADJUST && i < block->adjust_count; i++) {
        const struct protocol_adjust *adjust = &block->adjusts[i];
        if (!measure_range(probe, adjust->parameter, adjust->min, adjust->max, (adjust->min + adjust->max) / 2))
            return false;
    }
    return measure_option(probe, probe->desc->ids->condition_ids[trial->option[slot]]);
}

// Trials of one cell show the same.
static bool is_new(const struct plan *plan, uint32_t trial)
{
    for (uint32_t i = 0; i < trial; i++)
        if (plan->trials[i].block == plan->trials[trial].block &&
            plan->trials[i].cell == plan->trials[trial].cell &&
            (plan->trials[i].option[0] == plan->trials[trial].option[0] ||
             plan->trials[i].option[0] == plan->trials[trial].option[1]))
            return false;
    return true;
}

bool probe_rest(const struct session_desc *desc, struct measure *measure, char *error, size_t error_size)
{
    struct probe probe = {.desc = desc, .measure = measure, .error = error, .error_size = error_size};
    for (uint32_t i = 0; i < desc->plan->trial_count; i++) {
        probe.trial = &desc->plan->trials[i];
        for (int slot = 0; slot < 2 && is_new(desc->plan, i); slot++)
            if (probe.trial->option[slot] >= 0 && !measure_slot(&probe, slot))
                return false;
    }
    return true;
}
