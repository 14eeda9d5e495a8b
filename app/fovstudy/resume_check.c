#include "app/fovstudy/resume_check.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { VALUE = 256 }; // of a value as a sentence shows it

struct check {
    const struct store_session_start *start;
    char *error;
    size_t error_size;
};

static bool differs(const struct check *check, const char *name, const char *stored, const char *given)
{
    snprintf(check->error, check->error_size,
             "session %" PRId64
             " was started with %s %.*s, not %.*s; that would change what is compared: leave the "
             "option out, or begin another session with fovstudy run",
             check->start->session_id, name, VALUE, *stored ? stored : "none", VALUE, given);
    return false;
}

static bool same_text(const struct check *check, const char *name, const char **given, const char *stored)
{
    if (*given && strcmp(*given, stored) != 0)
        return differs(check, name, stored, *given);
    *given = *stored ? stored : NULL;
    return true;
}

// `stored` 0: the session has no such number, and what is given is not used.
static bool same_number(const struct check *check, const char *name, double *given, double stored)
{
    char was[VALUE], is[VALUE];
    if (*given > 0.0 && stored > 0.0 && fabs(*given - stored) > 1e-9 * stored) {
        snprintf(was, sizeof was, "%.9g", stored);
        snprintf(is, sizeof is, "%.9g", *given);
        return differs(check, name, was, is);
    }
    *given = stored;
    return true;
}

static bool same_whole(const struct check *check, const char *name, bool given, uint64_t value, uint64_t stored)
{
    char was[VALUE], is[VALUE];
    if (!given || value == stored)
        return true;
    snprintf(was, sizeof was, "%" PRIu64, stored);
    snprintf(is, sizeof is, "%" PRIu64, value);
    return differs(check, name, was, is);
}

static bool same_size(const struct check *check, struct run_options *options)
{
    const struct store_session_start *start = check->start;
    char was[VALUE], is[VALUE];
    if (options->width && start->width_px &&
        (options->width != start->width_px || options->height != start->height_px)) {
        snprintf(was, sizeof was, "%" PRId64 "x%" PRId64, start->width_px, start->height_px);
        snprintf(is, sizeof is, "%" PRIu32 "x%" PRIu32, options->width, options->height);
        return differs(check, "--size", was, is);
    }
    options->width = (uint32_t)start->width_px;
    options->height = (uint32_t)start->height_px;
    return true;
}

static bool same_scenes(const struct check *check, struct run_options *options)
{
    const struct store_session_start *start = check->start;
    char was[VALUE], is[VALUE];
    for (size_t i = 0; i < options->scene_count; i++) {
        const struct bound_scene *given = &options->scenes[i];
        for (size_t s = 0; s < start->scene_count; s++) {
            const struct store_bound_scene *stored = &start->scenes[s];
            if (strcmp(stored->name, given->name) != 0 || strcmp(stored->spec, given->spec) == 0)
                continue;
            snprintf(was, sizeof was, "%s=%s", stored->name, stored->spec);
            snprintf(is, sizeof is, "%s=%s", given->name, given->spec);
            return differs(check, "--scene", was, is);
        }
    }
    options->scene_count = 0;
    for (size_t s = 0; s < start->scene_count; s++) {
        struct bound_scene *scene = &options->scenes[options->scene_count];
        if (strcmp(start->scenes[s].name, start->scenes[s].spec) == 0)
            continue; // stands for itself
        snprintf(scene->name, sizeof scene->name, "%s", start->scenes[s].name);
        scene->spec = start->scenes[s].spec;
        options->scene_count++;
    }
    return true;
}

// The stored text is the parameters of the law; which file the errors come from changes nothing.
static bool same_observer(const struct check *check, struct run_options *options,
                          char observer[RESUME_OBSERVER])
{
    const struct store_session_start *start = check->start;
    struct observer_parameters stored, given;
    if (options->observer && !start->simulated)
        return differs(check, "--observer", "", options->observer);
    if (!start->simulated)
        return true;
    observer_defaults(&stored);
    observer_defaults(&given);
    const char *spec = *start->observer ? start->observer : "sim";
    if (!observer_parse(spec, &stored, check->error, check->error_size))
        return false;
    if (options->observer) {
        if (!observer_parse(options->observer, &given, check->error, check->error_size))
            return false;
        if (memcmp(&stored, &given, offsetof(struct observer_parameters, errors)) != 0)
            return differs(check, "--observer", spec, options->observer);
        return true;
    }
    snprintf(observer, RESUME_OBSERVER, "%s%s%s", spec,
             *start->errors_file ? strchr(spec, ':') ? ",errors=" : ":errors=" : "", start->errors_file);
    options->observer = observer;
    return true;
}

// A GPU is named by a part of its name.
static bool same_device(const struct check *check, struct run_options *options)
{
    const char *stored = check->start->device;
    if (options->device && *stored && !strstr(stored, options->device))
        return differs(check, "--device", stored, options->device);
    options->device = *stored ? stored : NULL;
    return true;
}

bool resume_options(struct run_options *options, const struct store_session_start *start,
                    char observer[RESUME_OBSERVER], char *error, size_t error_size)
{
    const struct check check = {start, error, error_size};
    bool headless = strcmp(start->display, "headless") == 0;
    const char *gaze = strcmp(start->gaze, "none") == 0 ? "" : start->gaze;
    double clock_hz = headless ? start->refresh_hz : start->step_hz;
    return same_text(&check, "--participant", &options->participant, start->code) &&
           same_whole(&check, "--number", options->has_number, options->number, (uint64_t)start->number) &&
           same_whole(&check, "--seed", options->has_seed, options->seed, start->seed) &&
           same_text(&check, "--display", &options->display, start->display) && same_size(&check, options) &&
           same_number(&check, "--fov", &options->fov_deg, start->fov_deg) &&
           same_number(&check, "--refresh", &options->refresh_hz, clock_hz) &&
           same_text(&check, "--gaze", &options->gaze, gaze) && same_device(&check, options) &&
           same_scenes(&check, options) && same_observer(&check, options, observer);
}

bool resume_attributes(const struct protocol *protocol, const struct run_options *options,
                       const struct store_session_start *start, char *error, size_t error_size)
{
    const struct check check = {start, error, error_size};
    for (size_t i = 0; i < options->attribute_count; i++) {
        char name[PROTOCOL_NAME], value[VALUE], member[PROTOCOL_NAME + VALUE + 8];
        size_t length = strcspn(options->attributes[i], "=");
        snprintf(name, sizeof name, "%.*s", (int)length, options->attributes[i]);
        const struct protocol_attribute *attribute = protocol_attribute_find(protocol, name);
        if (!attribute) {
            snprintf(error, error_size, "the protocol asks for no attribute '%s'; see its participant section",
                     name);
            return false;
        }
        if (!protocol_attribute_json(attribute, options->attributes[i] + length + 1, value, sizeof value, error,
                                     error_size))
            return false;
        // As run_study.c wrote it: members without spaces between them.
        snprintf(member, sizeof member, "\"%s\":%s", name, value);
        const char *found = strstr(start->attributes, member);
        if (!found || !strchr(",}", found[strlen(member)]))
            return differs(&check, "the attributes", start->attributes, member);
    }
    return true;
}

bool resume_view(const struct run_view *view, const struct store_session_start *start, char *error,
                 size_t error_size)
{
    const struct display *display = view->display;
    if (!display)
        return true;
    bool same_rate = !(start->refresh_hz > 0.0) || fabs(display->refresh_hz - start->refresh_hz) < 0.5;
    if (display->width == start->width_px && display->height == start->height_px && same_rate)
        return true;
    snprintf(
        error, error_size,
        "session %" PRId64 " was shown with %" PRId64 "x%" PRId64 " per eye at %.4g Hz, and this display has "
        "%" PRIu32 "x%" PRIu32 " at %.4g Hz; that would change what is compared: use the display it began on",
        start->session_id, start->width_px, start->height_px, start->refresh_hz, display->width,
        display->height, display->refresh_hz);
    return false;
}

// --- the plan ---

struct comparison {
    struct check check;
    struct run_rows *rows;
    uint32_t count;
    bool same;
};

static bool changed(struct comparison *comparison, const struct store_planned *trial, const char *what,
                    const char *stored, const char *planned)
{
    const struct check *check = &comparison->check;
    comparison->same = false;
    snprintf(check->error, check->error_size,
             "session %" PRId64 ": the %s of trial %" PRId64
             " is %.*s in the study file and would now be %.*s, so the "
             "order would not be the one it began with; go on with the program that began it",
             check->start->session_id, what, trial->ordinal, VALUE, *stored ? stored : "none", VALUE,
             planned && *planned ? planned : "none");
    return false;
}

static bool same_option(struct comparison *comparison, const struct store_planned *trial, int32_t condition,
                        int64_t id, const char *mode, const char *parameters)
{
    const struct plan *plan = comparison->rows->plan;
    const char *planned_mode = condition >= 0 ? plan->conditions[condition].mode : "";
    const char *planned = condition >= 0 ? plan->conditions[condition].parameters : "";
    if (strcmp(mode, planned_mode) != 0)
        return changed(comparison, trial, "mode", mode, planned_mode);
    if (strcmp(parameters, planned) != 0)
        return changed(comparison, trial, "option", parameters, planned);
    if (condition >= 0)
        comparison->rows->ids.condition_ids[condition] = id;
    return true;
}

static bool same_words(struct comparison *comparison, const struct store_planned *trial,
                       const struct plan_trial *planned)
{
    const struct {
        const char *what, *stored, *planned;
    } words[] = {
        {"block", trial->block, comparison->rows->plan->protocol->blocks[planned->block].name},
        {"kind", trial->kind, plan_trial_kind(planned)},
        {"scene", trial->scene, planned->scene},
        {"settings", trial->settings, planned->settings},
        {"factors", trial->factors, planned->factors},
        {"test slot", trial->test_slot, plan_slot_name(planned->test_slot)},
        {"option that is shown first", trial->first_shown, plan_slot_name(planned->first_shown)},
        {"fixation", trial->fixation, planned->fixation},
    };
    for (size_t i = 0; i < sizeof words / sizeof words[0]; i++)
        if (strcmp(words[i].stored, words[i].planned ? words[i].planned : "") != 0)
            return changed(comparison, trial, words[i].what, words[i].stored, words[i].planned);
    return true;
}

// How many of a trial's answers are stored: the values of an adjustment are one.
static uint32_t answers_of(const struct plan *plan, const struct plan_trial *planned,
                           const struct store_planned *trial)
{
    int64_t adjusted =
        planned->kind == PROTOCOL_ADJUST ? plan->protocol->blocks[planned->block].adjust_count : 0;
    int64_t whole = adjusted > 0 && trial->responses >= adjusted;
    return (uint32_t)(trial->choices + trial->ratings + trial->responses - whole * (adjusted - 1));
}

static void note_place(struct run_rows *rows, uint32_t place, const struct plan_trial *planned,
                       const struct store_planned *trial)
{
    rows->ids.trial_ids[place] = trial->id;
    rows->attempts[place] = (uint32_t)trial->attempt;
    rows->answers[place] = answers_of(rows->plan, planned, trial);
    rows->outcomes[place] = (int32_t)trial->outcome;
    rows->done[place] = strcmp(trial->status, "planned") != 0 && strcmp(trial->status, "running") != 0;
    rows->done_count += rows->done[place];
}

static bool no_memory(struct comparison *comparison)
{
    comparison->same = false;
    snprintf(comparison->check.error, comparison->check.error_size, "out of memory");
    return false;
}

static bool make_room(struct run_rows *rows, uint32_t places)
{
    if (places <= rows->capacity)
        return true;
    uint32_t capacity = places + 64;
    int64_t *ids = realloc(rows->ids.trial_ids, capacity * sizeof *ids);
    rows->ids.trial_ids = ids ? ids : rows->ids.trial_ids;
    bool *done = realloc(rows->done, capacity * sizeof *done);
    rows->done = done ? done : rows->done;
    uint32_t *attempts = realloc(rows->attempts, capacity * sizeof *attempts);
    rows->attempts = attempts ? attempts : rows->attempts;
    uint32_t *answers = realloc(rows->answers, capacity * sizeof *answers);
    rows->answers = answers ? answers : rows->answers;
    uint32_t *repeats = realloc(rows->repeats, capacity * sizeof *repeats);
    rows->repeats = repeats ? repeats : rows->repeats;
    int32_t *outcomes = realloc(rows->outcomes, capacity * sizeof *outcomes);
    rows->outcomes = outcomes ? outcomes : rows->outcomes;
    if (!ids || !done || !attempts || !answers || !repeats || !outcomes)
        return false;
    rows->capacity = capacity;
    return true;
}

// A repetition after the plan: of which planned trial. Its row is a copy of that trial's.
static bool take_repeat(struct comparison *comparison, const struct store_planned *trial)
{
    struct run_rows *rows = comparison->rows;
    uint32_t place = rows->plan->trial_count + rows->repeat_count, origin = 0;
    while (origin < place && rows->ids.trial_ids[origin] != trial->repeat_of)
        origin++;
    if (origin == place || trial->ordinal != (int64_t)place + 1)
        return changed(comparison, trial, "place", "another", "after the plan");
    if (!make_room(rows, place + 2))
        return no_memory(comparison);
    origin = origin < rows->plan->trial_count ? origin : rows->repeats[origin - rows->plan->trial_count];
    rows->repeats[rows->repeat_count++] = origin;
    note_place(rows, place, &rows->plan->trials[origin], trial);
    return true;
}

// A staircase's option under test is known only once a trial has begun.
static bool same_options(struct comparison *comparison, const struct store_planned *trial,
                         const struct plan_trial *planned)
{
    bool drawn = planned->kind == PROTOCOL_STAIRCASE && trial->attempt > 0;
    return ((drawn && planned->test_slot == PLAN_SLOT_A) ||
            same_option(comparison, trial, planned->option[0], trial->option_a, trial->mode_a,
                        trial->parameters_a)) &&
           ((drawn && planned->test_slot == PLAN_SLOT_B) ||
            same_option(comparison, trial, planned->option[1], trial->option_b, trial->mode_b,
                        trial->parameters_b));
}

static bool compare_trial(void *user, const struct store_planned *trial)
{
    struct comparison *comparison = user;
    struct run_rows *rows = comparison->rows;
    if (trial->repeat_of)
        return take_repeat(comparison, trial);
    uint32_t index = comparison->count++;
    if (index >= rows->plan->trial_count)
        return true; // the count tells
    const struct plan_trial *planned = &rows->plan->trials[index];
    char was[32], is[32];
    snprintf(was, sizeof was, "%" PRIu64, trial->seed);
    snprintf(is, sizeof is, "%" PRIu64, planned->seed);
    if (trial->ordinal != planned->ordinal)
        return changed(comparison, trial, "place", "another", "the next");
    if (!same_words(comparison, trial, planned))
        return false;
    if (trial->seed != planned->seed)
        return changed(comparison, trial, "seed", was, is);
    if (!same_options(comparison, trial, planned))
        return false;
    note_place(rows, index, planned, trial);
    return true;
}

bool resume_plan(struct run_rows *rows, const struct store_session_start *start, char *error, size_t error_size)
{
    struct comparison comparison = {.check = {start, error, error_size}, .rows = rows, .same = true};
    struct store_error why;
    if (!make_room(rows, rows->plan->trial_count + 2)) {
        snprintf(error, error_size, "out of memory");
        return false;
    }
    if (store_read_planned(rows->store, start->session_id, compare_trial, &comparison, &why) != STORE_OK) {
        snprintf(error, error_size, "%s", why.text);
        return false;
    }
    if (comparison.same && comparison.count != rows->plan->trial_count) {
        snprintf(error, error_size,
                 "session %" PRId64 " has %" PRIu32
                 " planned trials in the study file and would now have %" PRIu32
                 "; go on with the program that began it",
                 start->session_id, comparison.count, rows->plan->trial_count);
        return false;
    }
    return comparison.same;
}
