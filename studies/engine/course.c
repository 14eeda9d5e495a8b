// The course of a session: which trial comes next, what it asks, what its answers lead to.
#include "studies/engine/machine_state.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

uint32_t course_places(const struct machine *machine)
{
    return machine->plan->trial_count + machine->repeat_count;
}

const struct plan_trial *machine_trial(const struct machine *machine, uint32_t place)
{
    uint32_t planned = machine->plan->trial_count;
    return &machine->plan->trials[place < planned ? place : machine->repeats[place - planned]];
}

const struct plan_trial *machine_running(const struct machine *machine)
{
    return machine_trial(machine, machine->trial);
}

const struct protocol_block *machine_block(const struct machine *machine)
{
    return &machine->plan->protocol->blocks[machine_running(machine)->block];
}

// The n-th rating of a list of questions, each asked of both options in turn.
static bool ask_both(const struct protocol *protocol, const struct protocol_settings *settings, uint32_t index,
                     struct machine_ask *out)
{
    if (index >= 2 * settings->rating_count)
        return false;
    *out =
        (struct machine_ask){&protocol->questions[settings->ratings[index / 2]], (enum plan_slot)(index % 2)};
    return true;
}

bool machine_ask(const struct plan *plan, const struct plan_trial *trial, uint32_t index,
                 struct machine_ask *out)
{
    const struct protocol *protocol = plan->protocol;
    const struct protocol_settings *settings = trial->resolved;
    bool pair = protocol_kind_is_pair(trial->kind);
    uint32_t own = trial->kind == PROTOCOL_ADJUST ? 1 : settings->asked_count;
    uint32_t ratings = pair ? 2 * settings->rating_count : 0;
    if (index < own) {
        *out = (struct machine_ask){
            trial->kind == PROTOCOL_ADJUST ? NULL : &protocol->questions[settings->asked[index]],
            PLAN_SLOT_NONE};
        return true;
    }
    if (index < own + ratings)
        return ask_both(protocol, settings, index - own, out);
    if (index > own + ratings || settings->count_question < 0)
        return false;
    *out = (struct machine_ask){&protocol->questions[settings->count_question], PLAN_SLOT_NONE};
    return true;
}

// --- creation ---

static bool grow(struct machine *machine, uint32_t places)
{
    uint32_t capacity = machine->capacity ? 2 * machine->capacity : 64;
    if (places <= machine->capacity)
        return true;
    while (capacity < places)
        capacity *= 2;
    bool *done = realloc(machine->done, capacity * sizeof *done);
    machine->done = done ? done : machine->done;
    uint32_t *attempts = realloc(machine->attempts, capacity * sizeof *attempts);
    machine->attempts = attempts ? attempts : machine->attempts;
    uint32_t *answers = realloc(machine->answers, capacity * sizeof *answers);
    machine->answers = answers ? answers : machine->answers;
    uint32_t *repeats = realloc(machine->repeats, capacity * sizeof *repeats);
    machine->repeats = repeats ? repeats : machine->repeats;
    if (!done || !attempts || !answers || !repeats)
        return false;
    for (uint32_t i = machine->capacity; i < capacity; i++) {
        done[i] = false;
        attempts[i] = answers[i] = repeats[i] = 0;
    }
    machine->capacity = capacity;
    return true;
}

static struct course_staircase *staircase_of(const struct machine *machine, const struct plan_trial *trial)
{
    for (uint32_t i = 0; i < machine->staircase_count; i++)
        if (machine->staircases[i].block == trial->block && machine->staircases[i].cell == trial->cell)
            return &machine->staircases[i];
    return NULL;
}

static bool create_staircases(struct machine *machine)
{
    const struct plan *plan = machine->plan;
    machine->staircases = calloc(plan->trial_count + 1, sizeof *machine->staircases);
    if (!machine->staircases)
        return false;
    for (uint32_t i = 0; i < plan->trial_count; i++) {
        const struct plan_trial *trial = &plan->trials[i];
        if (trial->kind != PROTOCOL_STAIRCASE || staircase_of(machine, trial))
            continue;
        struct course_staircase *made = &machine->staircases[machine->staircase_count++];
        *made = (struct course_staircase){
            trial->block, trial->cell, staircase_create(&plan->protocol->blocks[trial->block].staircase.desc)};
        if (!made->staircase)
            return false;
    }
    return true;
}

bool course_create(struct machine *machine, const struct machine_start *start)
{
    static const struct machine_start fresh = {0};
    start = start ? start : &fresh;
    machine->repeat_count = start->repeat_count;
    uint32_t places = course_places(machine);
    if (!grow(machine, places + 1) || !create_staircases(machine))
        return false;
    for (uint32_t i = 0; i < places; i++) {
        machine->done[i] = start->done && start->done[i];
        machine->attempts[i] = start->attempts ? start->attempts[i] : 0;
        machine->answers[i] = start->answers ? start->answers[i] : 0;
    }
    for (uint32_t i = 0; i < start->repeat_count; i++)
        machine->repeats[i] = start->repeats[i];
    for (uint32_t i = 0; i < places && start->outcomes; i++) {
        struct course_staircase *staircase = staircase_of(machine, machine_trial(machine, i));
        struct staircase_step step;
        if (staircase && start->outcomes[i] >= 0)
            staircase_outcome(staircase->staircase, (uint32_t)start->outcomes[i], &step);
    }
    return true;
}

void course_destroy(struct machine *machine)
{
    for (uint32_t i = 0; i < machine->staircase_count; i++)
        staircase_destroy(machine->staircases[i].staircase);
    free(machine->staircases);
    free(machine->repeats);
    free(machine->answers);
    free(machine->attempts);
    free(machine->done);
}

// --- from trial to trial ---

uint32_t course_next(const struct machine *machine)
{
    uint32_t place = 0;
    while (place < course_places(machine) && machine->done[place])
        place++;
    return place;
}

double course_level(const struct machine *machine, uint32_t place)
{
    const struct course_staircase *staircase = staircase_of(machine, machine_trial(machine, place));
    return staircase ? staircase_level(staircase->staircase) : (double)NAN;
}

void course_begin(struct machine *machine)
{
    const struct plan_trial *trial = machine_running(machine);
    machine->screen = MACHINE_STIMULUS;
    machine->level = course_level(machine, machine->trial);
    machine->adjusting = 0;
    memcpy(machine->adjusted, trial->adjust_start, sizeof machine->adjusted);
    stimulus_begin(machine);
}

// Trials of a staircase that has ended are left out.
static void skip_ended(struct machine *machine)
{
    for (;;) {
        machine->trial = course_next(machine);
        if (machine->trial == course_places(machine))
            return;
        const struct course_staircase *staircase = staircase_of(machine, machine_running(machine));
        if (!staircase || !staircase_done(staircase->staircase))
            return;
        machine->done[machine->trial] = true;
        struct machine_record *record = machine_push(machine, MACHINE_TRIAL_SKIPPED, machine->now_ns);
        if (!record)
            return;
        record->trial = machine->trial;
    }
}

void course_go_on(struct machine *machine, enum machine_screen same_block)
{
    skip_ended(machine);
    if (machine->screen == MACHINE_END)
        return;
    if (machine->trial == course_places(machine)) {
        machine_end(machine, true);
        return;
    }
    uint32_t index = machine_running(machine)->block;
    if (index == machine->shown_block) {
        bool breaks = machine_running(machine)->break_before && machine->trial < machine->plan->trial_count &&
                      machine->broken != machine->trial && same_block == MACHINE_REST;
        machine->broken = breaks ? machine->trial : machine->broken;
        machine->screen = breaks ? MACHINE_BREAK : same_block;
        return;
    }
    machine->shown_block = index;
    machine->text = machine->plan->protocol->blocks[index].instructions;
    machine->screen = *machine->text ? MACHINE_INSTRUCTIONS : MACHINE_READY;
}

// The place at which a trial comes again, after all others; of a staircase the next trial takes its place.
// False: no memory.
static bool repeat(struct machine *machine, uint32_t place, uint32_t *out_again)
{
    *out_again = UINT32_MAX;
    if (machine_trial(machine, place)->kind == PROTOCOL_STAIRCASE)
        return true;
    uint32_t again = course_places(machine);
    if (!grow(machine, again + 2))
        return false;
    machine->repeats[machine->repeat_count++] =
        (uint32_t)(machine_trial(machine, place) - machine->plan->trials);
    *out_again = again;
    return true;
}

void course_invalid(struct machine *machine, uint32_t place, bool late)
{
    uint32_t again;
    bool running = place == machine->trial && !machine->done[place];
    if (running && machine->screen == MACHINE_STIMULUS)
        stimulus_close_exposure(machine);
    if (!repeat(machine, place, &again)) {
        machine_end(machine, false);
        return;
    }
    machine->done[place] = true;
    machine->last_trial = UINT32_MAX;
    struct machine_record *record = machine_push(machine, MACHINE_TRIAL_INVALID, machine->now_ns);
    if (!record)
        return;
    record->trial = place;
    record->attempt = machine->attempts[place];
    record->late = late;
    record->again = again;
    if (running) {
        machine->screen = MACHINE_REST;
        machine->since_ns = machine->now_ns;
        course_go_on(machine, MACHINE_REST);
    }
}

// --- answers ---

void course_ask(struct machine *machine)
{
    machine->screen = MACHINE_QUESTION;
    machine->asked_ns = machine->now_ns;
}

// 1 right, 0 wrong, -1: there is no right answer. In a catch trial the reference is better for everybody to
// see.
static int32_t is_correct(const struct plan_trial *trial, const struct protocol_question *question,
                          int32_t slot)
{
    enum protocol_correct correct = question->correct;
    if (trial->role == PROTOCOL_CATCH && correct == PROTOCOL_NO_CORRECT)
        correct = PROTOCOL_CORRECT_REFERENCE;
    if (correct == PROTOCOL_NO_CORRECT || trial->role == PROTOCOL_NULL)
        return -1;
    bool tested = slot == (int32_t)trial->test_slot;
    return slot != PLAN_SLOT_NONE && tested == (correct == PROTOCOL_CORRECT_TESTED);
}

static void step_staircase(struct machine *machine, struct machine_record *record)
{
    struct course_staircase *staircase = staircase_of(machine, machine_running(machine));
    if (!staircase || machine->answers[machine->trial] > 0)
        return;
    const struct protocol_question *question = record->question;
    uint32_t outcome = question->type == PROTOCOL_ASK_RATING ? (uint32_t)(record->value - question->scale_min)
                       : !question->equal                    ? (uint32_t)record->correct
                       : record->slot == PLAN_SLOT_NONE      ? 1u
                                                             : 2u * (uint32_t)record->correct;
    record->has_step = staircase_outcome(staircase->staircase, outcome, &record->step);
}

void course_answer(struct machine *machine, enum machine_record_kind kind, int32_t value)
{
    const struct plan_trial *trial = machine_running(machine);
    struct machine_ask ask = {0}, more;
    uint32_t index = machine->answers[machine->trial];
    machine_ask(machine->plan, trial, index, &ask);
    int64_t asked = machine->screen == MACHINE_QUESTION ? machine->now_ns - machine->asked_ns
                                                        : stimulus_reaction(machine, machine->now_ns);
    struct machine_record *record = machine_push(machine, kind, machine->now_ns);
    if (!record)
        return;
    record->value = value;
    record->question = ask.question;
    record->slot = kind == MACHINE_CHOICE ? (enum plan_slot)value : ask.subject;
    record->correct = kind == MACHINE_CHOICE ? is_correct(trial, ask.question, value) : -1;
    record->expected = (int32_t)(trial->spheres[0] + trial->spheres[1]);
    record->reaction_ns = asked;
    record->toggles = machine->stimulus.toggles;
    record->ends_trial = !machine_ask(machine->plan, trial, index + 1, &more);
    if (kind == MACHINE_RESPONSES && !ask.question) {
        record->number_count = machine_block(machine)->adjust_count;
        memcpy(record->numbers, machine->adjusted, sizeof record->numbers);
    }
    step_staircase(machine, record);
    machine->last_value = value;
    if (record->ends_trial)
        machine_push(machine, MACHINE_TRIAL_DONE, machine->now_ns);
    machine->screen = machine->screen == MACHINE_END ? MACHINE_END : MACHINE_STORING;
}

void course_stored(struct machine *machine)
{
    struct machine_ask more;
    uint32_t index = ++machine->answers[machine->trial];
    if (machine_ask(machine->plan, machine_running(machine), index, &more)) {
        course_ask(machine);
        return;
    }
    machine->done[machine->trial] = true;
    machine->last_trial = machine->trial;
    machine->screen = MACHINE_CONFIRMATION;
    machine->since_ns = machine->now_ns;
}
