#include "studies/engine/duration.h"

static double seconds(int64_t ns)
{
    return (double)ns / 1e9;
}

static double larger(double a, double b)
{
    return a > b ? a : b;
}

// Two options to switch between: toggles_mean switches make one more looks, each option long enough.
static void add_toggling(const struct protocol_settings *s, const struct observer_parameters *pace,
                         struct duration *out)
{
    double fade = seconds(s->fade_to_gray_ns + s->fade_gray_ns + s->fade_from_gray_ns);
    out->looking += larger((pace->toggles_mean + 1) * pace->dwell_s, 2 * seconds(s->min_exposure_ns));
    out->fading += seconds(s->fade_from_gray_ns) + pace->toggles_mean * fade;
}

static void add_trial(const struct plan_trial *trial, const struct observer_parameters *pace,
                      struct duration *out)
{
    const struct protocol_settings *s = trial->resolved;
    bool pair = protocol_kind_is_pair(trial->kind);
    bool screen = !pair || trial->kind == PROTOCOL_SEQUENTIAL; // asks after looking
    if (trial->kind == PROTOCOL_SEQUENTIAL) {
        out->looking += 2 * seconds(s->view_ns);
        out->fading += 2 * seconds(s->fade_from_gray_ns + s->fade_to_gray_ns) + seconds(s->gap_ns);
    } else if (pair) {
        add_toggling(s, pace, out);
    } else {
        out->looking += s->view_ns > 0 ? seconds(s->view_ns) : pace->view_s;
        out->fading += seconds(s->fade_from_gray_ns);
    }
    uint32_t asked = screen ? s->asked_count : trial->question && trial->question->type == PROTOCOL_ASK_RATING;
    asked += (pair ? 2 : 1) * s->rating_count + (s->count_question >= 0);
    out->answers += asked * pace->answer_s;
    out->screens += seconds(s->confirm_ns);
}

// Before each trial but a block's first: a rest, or a break, which the participant ends.
static void add_rest(const struct plan *plan, const struct plan_trial *trial,
                     const struct observer_parameters *pace, struct duration *out)
{
    const struct protocol_settings *s = trial->resolved;
    bool key = s->advance == PROTOCOL_ADVANCE_KEY || trial->break_before;
    int64_t least = trial->break_before ? plan->protocol->blocks[trial->block].break_ns : s->rest_ns;
    out->resting += seconds(least) + (key ? pace->answer_s : 0);
}

void duration_of(const struct plan *plan, const struct observer_parameters *pace, struct duration *out)
{
    *out = (struct duration){.screens = 2 * pace->answer_s}; // consent, instructions
    for (uint32_t i = 0; i < plan->trial_count; i++) {
        const struct plan_trial *trial = &plan->trials[i];
        if (i == 0 || trial->block != plan->trials[i - 1].block)
            out->screens += pace->answer_s; // the block's instructions, or "begin"
        else
            add_rest(plan, trial, pace, out);
        add_trial(trial, pace, out);
    }
    out->total = out->looking + out->fading + out->answers + out->screens + out->resting;
}
