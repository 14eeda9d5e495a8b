// What one attempt of a trial shows: fades by time, exposures, which options were seen.
#include "studies/engine/machine_state.h"

void stimulus_begin(struct machine *machine)
{
    enum plan_slot first = machine_running(machine)->first_shown;
    machine->stimulus = (struct stimulus){
        .starting = true, .full_ns = -1, .slot = first, .target = first, .fade = FADE_IN, .level = 1};
    machine->attempts[machine->trial]++;
}

void stimulus_close_exposure(struct machine *machine)
{
    if (!machine->stimulus.exposed)
        return;
    machine->stimulus.exposed = false;
    struct machine_record *record = machine_push(machine, MACHINE_EXPOSURE, machine->stimulus.exposure.end_ns);
    if (!record)
        return;
    record->slot = machine->stimulus.exposure.slot;
    record->start_ns = machine->stimulus.exposure.start_ns;
    record->end_ns = machine->stimulus.exposure.end_ns;
    record->full_start_ns = machine->stimulus.exposure.full_start_ns;
    record->full_end_ns = machine->stimulus.exposure.full_end_ns;
}

static void note_exposure(struct machine *machine, int64_t now_ns)
{
    struct stimulus *s = &machine->stimulus;
    if (s->level >= 1)
        return;
    if (s->exposed && s->exposure.slot != s->slot)
        stimulus_close_exposure(machine);
    if (!s->exposed) {
        s->exposed = true;
        s->exposure = (struct machine_record){
            .slot = s->slot, .start_ns = now_ns, .full_start_ns = -1, .full_end_ns = -1};
    }
    s->exposure.end_ns = now_ns;
    if (s->level > 0)
        return;
    if (s->exposure.full_start_ns < 0)
        s->exposure.full_start_ns = now_ns;
    // A full frame stays until the next one of the same option; one after a fade or a pause counts from itself
    // on.
    if (s->exposure.full_end_ns >= 0 && s->exposure.full_end_ns == s->last_frame_ns)
        s->seen_ns[s->slot] += now_ns - s->last_frame_ns;
    s->exposure.full_end_ns = now_ns;
    s->last_full_ns = now_ns;
    s->seen[s->slot] = true;
    if (s->full_ns < 0)
        s->full_ns = now_ns;
}

// Part of a stretch that has passed, 0..1; a stretch of no length has passed.
static double part(int64_t passed_ns, int64_t length_ns)
{
    return passed_ns >= length_ns ? 1 : passed_ns <= 0 ? 0 : (double)passed_ns / (double)length_ns;
}

static void fade_in(struct stimulus *s, const struct protocol_settings *settings, int64_t now_ns)
{
    s->level = 1 - part(now_ns - s->fade_ns, settings->fade_from_gray_ns);
    if (s->level <= 0)
        s->fade = FADE_NONE;
}

static void fade_switch(struct stimulus *s, const struct protocol_settings *settings, int64_t now_ns)
{
    int64_t to_gray = settings->fade_to_gray_ns, gray = settings->fade_gray_ns, back = to_gray + gray;
    int64_t passed = now_ns - s->fade_ns;
    if (passed < to_gray) {
        s->level = part(passed, to_gray);
        return;
    }
    if (passed >= back && !s->gray_shown && gray > 0) {
        s->fade_ns = now_ns - back; // no frame was gray: this one is, and the way back starts here
        passed = back;
    }
    s->gray_shown = true;
    if (passed - to_gray >= gray / 2)
        s->slot = s->target;
    s->level = passed < back ? 1 : 1 - part(passed - back, settings->fade_from_gray_ns);
    if (s->level <= 0)
        s->fade = FADE_NONE;
}

// Of a sequential trial: out of the image when its time is over, the gap, the second image, the end.
static void fade_sequence(struct machine *machine, const struct protocol_settings *settings, int64_t now_ns)
{
    struct stimulus *s = &machine->stimulus;
    if (s->fade == FADE_NONE && stimulus_reaction(machine, now_ns) >= settings->view_ns) {
        s->fade = FADE_OUT;
        s->fade_ns = s->full_ns + s->paused_full_ns + settings->view_ns;
    }
    if (s->fade == FADE_OUT) {
        s->level = part(now_ns - s->fade_ns, settings->fade_to_gray_ns);
        if (s->level < 1)
            return;
        stimulus_close_exposure(machine);
        s->fade = FADE_GAP;
        s->fade_ns += settings->fade_to_gray_ns;
        s->shown = s->showing == 1;
    }
    if (s->fade == FADE_GAP && !s->shown && now_ns - s->fade_ns >= settings->gap_ns) {
        s->showing = 1;
        s->slot = s->target = (enum plan_slot)(1 - (int)s->slot);
        s->fade = FADE_IN;
        s->start_ns = s->fade_ns = now_ns;
        s->paused_ns = s->paused_full_ns = 0;
        s->full_ns = -1;
        s->began_now = true;
    }
}

void stimulus_frame(struct machine *machine, int64_t now_ns)
{
    struct stimulus *s = &machine->stimulus;
    const struct plan_trial *trial = machine_running(machine);
    const struct protocol_settings *settings = trial->resolved;
    s->began_now = s->starting;
    if (s->starting) {
        s->starting = false;
        s->start_ns = s->fade_ns = now_ns;
        struct machine_record *record = machine_push(machine, MACHINE_TRIAL_STARTED, now_ns);
        if (record && trial->kind == PROTOCOL_ADJUST && machine->answers[machine->trial] > 0)
            record->number_count = machine_block(machine)->adjust_count;
    }
    if (s->fade_ns == STIMULUS_NOT_YET)
        s->fade_ns = now_ns; // the first frame after a pause
    if (s->fade == FADE_IN)
        fade_in(s, settings, now_ns);
    else if (s->fade == FADE_SWITCH)
        fade_switch(s, settings, now_ns);
    if (trial->kind == PROTOCOL_SEQUENTIAL && s->full_ns >= 0)
        fade_sequence(machine, settings, now_ns);
    s->camera_ns = now_ns - s->start_ns - s->paused_ns;
    note_exposure(machine, now_ns);
    s->last_frame_ns = now_ns;
}

void stimulus_toggle(struct machine *machine, int64_t now_ns)
{
    struct stimulus *s = &machine->stimulus;
    bool taken = !s->starting && s->fade == FADE_NONE;
    struct machine_record *record =
        machine_push(machine, taken ? MACHINE_TOGGLE : MACHINE_TOGGLE_IGNORED, now_ns);
    if (record)
        record->slot = taken ? (enum plan_slot)(1 - (int)s->slot) : s->target;
    if (!taken)
        return;
    s->toggles++;
    s->target = (enum plan_slot)(1 - (int)s->slot);
    s->fade = FADE_SWITCH;
    s->fade_ns = s->last_full_ns; // the half second counts from the last full frame, not from the key
    s->gray_shown = false;
}

void stimulus_resume(struct machine *machine, int64_t paused_ns)
{
    struct stimulus *s = &machine->stimulus;
    if (s->starting)
        return;
    s->paused_ns += paused_ns;
    if (s->full_ns >= 0)
        s->paused_full_ns += paused_ns;
    if (s->fade == FADE_OUT || s->fade == FADE_GAP) { // nothing more of this showing is to come
        s->fade_ns += paused_ns;
        return;
    }
    s->slot = s->target;
    s->fade = FADE_IN;
    s->fade_ns = STIMULUS_NOT_YET;
    s->level = 1;
}

int64_t stimulus_reaction(const struct machine *machine, int64_t now_ns)
{
    return now_ns - machine->stimulus.full_ns - machine->stimulus.paused_full_ns;
}

int64_t stimulus_next_ns(const struct machine *machine)
{
    const struct stimulus *s = &machine->stimulus;
    const struct plan_trial *trial = machine_running(machine);
    const struct protocol_settings *settings = trial->resolved;
    bool timed =
        trial->kind == PROTOCOL_SEQUENTIAL || (!protocol_kind_is_pair(trial->kind) && settings->view_ns > 0);
    if (s->fade == FADE_GAP && !s->starting && !s->shown)
        return s->fade_ns + settings->gap_ns;
    if (s->starting || s->fade != FADE_NONE || s->fade_ns == STIMULUS_NOT_YET || s->full_ns < 0)
        return INT64_MIN;
    return timed ? s->full_ns + s->paused_full_ns + settings->view_ns : INT64_MAX;
}

bool stimulus_seen(const struct machine *machine)
{
    const struct stimulus *s = &machine->stimulus;
    int64_t least = machine_running(machine)->resolved->min_exposure_ns;
    return s->seen[0] && s->seen[1] && s->seen_ns[0] >= least && s->seen_ns[1] >= least;
}

bool stimulus_timed_out(const struct machine *machine, int64_t now_ns)
{
    const struct plan_trial *trial = machine_running(machine);
    int64_t view_ns = trial->resolved->view_ns;
    if (trial->kind == PROTOCOL_SEQUENTIAL)
        return machine->stimulus.shown;
    return !protocol_kind_is_pair(trial->kind) && view_ns > 0 && machine->stimulus.full_ns >= 0 &&
           stimulus_reaction(machine, now_ns) >= view_ns;
}
