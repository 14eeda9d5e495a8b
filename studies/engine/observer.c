#include "studies/engine/observer.h"

#include "studies/engine/random.h"
#include "studies/protocol/read.h"

#include <errno.h>
#include <math.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum purpose {
    PURPOSE_KEY = 64,
    PURPOSE_WAIT,
    PURPOSE_TOGGLES,
    PURPOSE_DWELL,
    PURPOSE_CHOICE,
    PURPOSE_RATING,
    PURPOSE_ADJUST,
    PURPOSE_LATE
};

enum { OBSERVER_ADJUSTMENTS = 40 };

static const struct knob {
    const char *name;
    size_t offset;
    double min, max, fallback;
} knobs[] = {
#define KNOB(name) #name, offsetof(struct observer_parameters, name)
    {KNOB(threshold), 1e-9, 1e9, 0.02}, // our choice; the caller's metric sets its unit
    {KNOB(slope), 0.05, 20, 1},
    {KNOB(lapse), 0, 1, 0.02}, // Wichmann and Hill 2001: lapses of
                               // practised observers lie under about 5 %
    {KNOB(side_bias), -20, 20, 0},
    {KNOB(toggles_mean), 1, 100, 6}, // Franke 2021, section 8.2: more than
                                     // five switches on average
    {KNOB(dwell_s), 0.05, 600, 0.5}, // with six toggles of half a second a trial lasts about seven seconds
    {KNOB(dwell_spread), 0, 3, 0.4},
    {KNOB(rating_mean), -100, 100, 6.4}, // Franke 2021, section 8.2: first
                                         // ratings 6.36 (sd 1.5) and 6.33
                                         // (sd 2.0)
    {KNOB(rating_sd), 0, 100, 1.75},
    {KNOB(rating_drop), 0, 100, 0.5},
    {KNOB(view_s), 0.05, 600, 4.5},
    {KNOB(answer_s), 0.05, 600, 1},
    {KNOB(equal_band), 0, 20, 0.7}, // ours: "equal" in a third of looks at no difference
    {KNOB(count_error), 0, 100, 0.5},
    {KNOB(late), 0, 0.9, 0}, // of a trial that comes again as well, so that some attempt is in time
#undef KNOB
};

enum { KNOBS = sizeof knobs / sizeof knobs[0] };

static double *knob_value(struct observer_parameters *parameters, const struct knob *knob)
{
    return (double *)(void *)((char *)parameters + knob->offset);
}

void observer_defaults(struct observer_parameters *out)
{
    *out = (struct observer_parameters){0};
    for (size_t i = 0; i < KNOBS; i++)
        *knob_value(out, &knobs[i]) = knobs[i].fallback;
}

static bool parse_number(const struct knob *knob, const char *text, double *out, char *error, size_t error_size)
{
    char *end = NULL;
    double value = *text && strspn(text, "+-.0123456789eE") == strlen(text) ? strtod(text, &end) : 0;
    if (!end || *end || !isfinite(value))
        snprintf(error, error_size, "observer: %s is a number, not '%.60s'", knob->name, text);
    else if (value < knob->min || value > knob->max)
        snprintf(error, error_size, "observer: %s is %.60s; it must lie between %g and %g", knob->name, text,
                 knob->min, knob->max);
    else {
        *out = value;
        return true;
    }
    return false;
}

static bool parse_pair(char *pair, struct observer_parameters *out, char *error, size_t error_size)
{
    char *value = strchr(pair, '=');
    if (!value) {
        snprintf(error, error_size, "observer: '%.60s' has no value; write name=value", pair);
        return false;
    }
    *value++ = '\0';
    if (strcmp(pair, "errors") == 0) {
        if (*value && strlen(value) < sizeof out->errors) {
            memcpy(out->errors, value, strlen(value) + 1);
            return true;
        }
        snprintf(error, error_size, "observer: errors names a file by 1 to %d characters", OBSERVER_PATH - 1);
        return false;
    }
    const char *names[KNOBS + 2] = {NULL};
    for (size_t i = 0; i < KNOBS; i++) {
        names[i] = knobs[i].name;
        if (strcmp(pair, knobs[i].name) == 0)
            return parse_number(&knobs[i], value, knob_value(out, &knobs[i]), error, error_size);
    }
    names[KNOBS] = "errors";
    const char *nearest = read_nearest(pair, names);
    snprintf(error, error_size, "observer: parameter '%.60s' is not known; %s%s%s", pair,
             nearest ? "did you mean '" : "the help lists them", nearest ? nearest : "", nearest ? "'?" : "");
    return false;
}

bool observer_json(const struct observer_parameters *parameters, char *out, size_t out_size)
{
    size_t used = 0;
    for (size_t i = 0; i < KNOBS; i++) {
        struct observer_parameters copy = *parameters;
        int wrote = snprintf(out + used, out_size - used, "%s\"%s\":%.17g", i ? "," : "{", knobs[i].name,
                             *knob_value(&copy, &knobs[i]));
        if (wrote < 0 || (size_t)wrote >= out_size - used)
            return false;
        used += (size_t)wrote;
    }
    return snprintf(out + used, out_size - used, "}") < (int)(out_size - used);
}

bool observer_parse(const char *spec, struct observer_parameters *out, char *error, size_t error_size)
{
    observer_defaults(out);
    if (strcmp(spec, "sim") == 0)
        return true;
    if (strncmp(spec, "sim:", 4) != 0) {
        snprintf(error, error_size, "observer '%.60s' is not known; it is sim or sim:name=value,...", spec);
        return false;
    }
    char copy[2048];
    if (strlen(spec + 4) >= sizeof copy) {
        snprintf(error, error_size, "observer: more than %d characters; shorten it", (int)sizeof copy - 1);
        return false;
    }
    memcpy(copy, spec + 4, strlen(spec + 4) + 1);
    for (char *pair = copy; pair;) {
        char *comma = strchr(pair, ',');
        if (comma)
            *comma = '\0';
        if (!parse_pair(pair, out, error, error_size))
            return false;
        pair = comma ? comma + 1 : NULL;
    }
    return true;
}

// Fowler, Noll and Vo's hash FNV-1a.
uint32_t observer_subject(const char *code)
{
    uint32_t hash = 2166136261u;
    for (; *code; code++)
        hash = (hash ^ (uint8_t)*code) * 16777619u;
    return hash;
}

void observer_start(struct observer *observer, const struct observer_parameters *parameters, uint64_t seed,
                    uint32_t subject)
{
    struct random_stream stream = random_stream(seed, PURPOSE_KEY, subject, 0);
    *observer = (struct observer){.parameters = *parameters,
                                  .key = random_u64(&stream),
                                  .screen = MACHINE_END,
                                  .trial = UINT32_MAX,
                                  .looking = PLAN_SLOT_NONE};
}

// A log-normal time within two standard deviations, so that no wait is endless.
static int64_t wait_ns(struct random_stream *stream, double median_s, double spread)
{
    double deviate = random_normal(stream);
    deviate = deviate > 2 ? 2 : deviate < -2 ? -2 : deviate;
    return (int64_t)(median_s * exp(spread * deviate) * 1e9);
}

static struct random_stream trial_stream(const struct observer *observer, enum purpose purpose, uint32_t step)
{
    return random_stream(observer->key, purpose, observer->trial, observer->attempt << 16 | (step & 0xffff));
}

static void arm(struct observer *observer, int64_t due_ns, enum machine_event_kind kind)
{
    observer->armed = true;
    observer->due_ns = due_ns;
    observer->next = (struct machine_event){kind, 0};
}

// Times to answer a screen vary little.
#define OBSERVER_ANSWER_SPREAD 0.25

#define OBSERVER_HURRY 0.6          // share of a deadline after which it answers; one more switch fits behind
#define OBSERVER_LATE_NS 1000000000 // that a missed deadline lies behind, so that a slow frame notes it too

static int64_t answer_ns(const struct observer *observer)
{
    struct random_stream stream = random_stream(observer->key, PURPOSE_WAIT, observer->events, 0);
    return wait_ns(&stream, observer->parameters.answer_s, OBSERVER_ANSWER_SPREAD);
}

static void arm_screen(struct observer *observer, int64_t now_ns, enum machine_event_kind kind)
{
    arm(observer, now_ns + answer_ns(observer), kind);
}

// Only a trial's first answer has a deadline, and only where the stimulus did not have it.
static void arm_question(struct observer *observer, int64_t now_ns, const struct machine_view *view)
{
    const struct plan_trial *trial = view->trial;
    int64_t wait = answer_ns(observer), deadline = trial ? trial->resolved->deadline_ns : 0;
    bool first = observer->questions++ == 0 && trial &&
                 (!protocol_kind_is_pair(trial->kind) || trial->kind == PROTOCOL_SEQUENTIAL);
    if (first && deadline > 0 && observer->late)
        wait += deadline + OBSERVER_LATE_NS;
    else if (first && deadline > 0 && (double)wait > OBSERVER_HURRY * (double)deadline)
        wait = (int64_t)(OBSERVER_HURRY * (double)deadline);
    arm(observer, now_ns + wait,
        view->question && view->question->type == PROTOCOL_ASK_CHOICE ? MACHINE_CHOOSE : MACHINE_RATE);
}

// Toggles before the choice: the mean, up to two more or less.
static uint32_t plan_toggles(const struct observer *observer)
{
    struct random_stream stream = trial_stream(observer, PURPOSE_TOGGLES, 0);
    double whole = floor(observer->parameters.toggles_mean);
    uint32_t mean = (uint32_t)whole + (random_unit(&stream) < observer->parameters.toggles_mean - whole);
    uint32_t reach = mean > 2 ? 2 : mean - 1;
    return mean - reach + random_below(&stream, 2 * reach + 1);
}

// The next switch, or the answer where none is planned or the time runs out.
static void arm_pair(struct observer *observer, int64_t now_ns, const struct machine_view *view)
{
    const struct observer_parameters *p = &observer->parameters;
    const struct protocol_settings *settings = view->trial->resolved;
    struct random_stream stream = trial_stream(observer, PURPOSE_DWELL, observer->step);
    enum machine_event_kind last = view->question ? MACHINE_CHOOSE : MACHINE_START;
    int64_t wait = wait_ns(&stream, p->dwell_s, p->dwell_spread);
    if (observer->step == 0 && settings->deadline_ns > 0)
        observer->hurry_ns = now_ns + (int64_t)(OBSERVER_HURRY * (double)settings->deadline_ns);
    bool hurries = now_ns + wait > observer->hurry_ns;
    bool answers = hurries || observer->step >= observer->toggles_planned;
    if (answers && observer->late && settings->deadline_ns > 0)
        wait += settings->deadline_ns + OBSERVER_LATE_NS;
    else if (hurries) {
        int64_t left = observer->hurry_ns > now_ns ? observer->hurry_ns - now_ns : 0;
        left = left > settings->min_exposure_ns ? left : settings->min_exposure_ns;
        wait = wait < left ? wait : left;
    }
    arm(observer, now_ns + wait, answers ? last : MACHINE_TOGGLE_KEY);
    observer->step++;
}

static void arm_stimulus(struct observer *observer, int64_t now_ns, const struct machine_view *view)
{
    if (view->fade > 0 || view->slot == PLAN_SLOT_NONE || view->slot == observer->looking || !view->trial)
        return; // nothing new to look at yet
    observer->looking = view->slot;
    bool pair = protocol_kind_is_pair(view->trial->kind);
    if (view->trial->kind == PROTOCOL_SEQUENTIAL || (!pair && view->trial->resolved->view_ns > 0))
        return; // it goes by itself
    if (pair) {
        arm_pair(observer, now_ns, view);
        return;
    }
    struct random_stream stream = trial_stream(observer, PURPOSE_DWELL, observer->step++);
    arm(observer, now_ns + wait_ns(&stream, observer->parameters.view_s, OBSERVER_ANSWER_SPREAD),
        MACHINE_START);
}

static void arm_any(struct observer *observer, int64_t now_ns, const struct machine_view *view)
{
    switch (view->screen) {
    case MACHINE_CONSENT:
        arm_screen(observer, now_ns, MACHINE_YES);
        break;
    case MACHINE_REST:
    case MACHINE_BREAK:
        if (view->may_choose)
            arm_screen(observer, now_ns, MACHINE_START);
        break;
    case MACHINE_INSTRUCTIONS:
    case MACHINE_READY:
    case MACHINE_PAUSED:
        arm_screen(observer, now_ns, MACHINE_START);
        break;
    case MACHINE_QUESTION:
        arm_question(observer, now_ns, view);
        break;
    case MACHINE_ABORT:
        arm_screen(observer, now_ns, MACHINE_NO);
        break;
    case MACHINE_STIMULUS:
        arm_stimulus(observer, now_ns, view);
        break;
    case MACHINE_STORING:
    case MACHINE_CONFIRMATION:
    case MACHINE_END:
        break;
    }
}

static double logit_a(const struct observer_parameters *parameters, const struct observer_errors *errors)
{
    double difference = (errors->slot[1] - errors->slot[0]) / parameters->threshold,
           logit = parameters->side_bias;
    if (difference > 0 || difference < 0) // an error that is no number is no difference
        logit += copysign(log(3) * pow(fabs(difference), parameters->slope), difference);
    return logit;
}

double observer_probability_a(const struct observer_parameters *parameters,
                              const struct observer_errors *errors)
{
    return parameters->lapse / 2 + (1 - parameters->lapse) / (1 + exp(-logit_a(parameters, errors)));
}

// It answers the question: where the tested option is the right answer ("Which one looks worse?"), it looks for
// the larger error.
static int32_t choose(const struct observer *observer, const struct observer_errors *seen,
                      const struct protocol_question *question)
{
    const struct observer_parameters *p = &observer->parameters;
    bool equal = question && question->equal, worse = question && question->correct == PROTOCOL_CORRECT_TESTED;
    const struct observer_errors turned = {{seen->slot[1], seen->slot[0]}}, *errors = worse ? &turned : seen;
    struct random_stream stream = trial_stream(observer, PURPOSE_CHOICE, 0);
    double u = random_unit(&stream);
    if (!equal)
        return u < observer_probability_a(p, errors) ? PLAN_SLOT_A : PLAN_SLOT_B;
    if (random_unit(&stream) < p->lapse)
        return (int32_t)random_below(&stream, 3);
    double latent = logit_a(p, errors) + log(u / (1 - u));
    return latent > p->equal_band ? PLAN_SLOT_A : latent < -p->equal_band ? PLAN_SLOT_B : PLAN_SLOT_NONE;
}

// Names a draw by what is asked and of which option.
static uint32_t question_part(const struct machine_view *view)
{
    return observer_subject(view->question->name) << 2 | (uint32_t)view->subject;
}

// The latent value falls between criteria half a point apart from the whole numbers; the ends take what lies
// beyond.
static int32_t rate(const struct observer *observer, const struct observer_errors *errors,
                    const struct machine_view *view)
{
    const struct protocol_question *question = view->question;
    const struct observer_parameters *p = &observer->parameters;
    struct random_stream stream = trial_stream(observer, PURPOSE_RATING, question_part(view));
    double error = errors->slot[view->subject == PLAN_SLOT_B],
           seen = isfinite(error) ? error / p->threshold : 0;
    double latent = p->rating_mean - p->rating_drop * seen + p->rating_sd * random_normal(&stream);
    if (question->type == PROTOCOL_ASK_COUNT)
        latent = view->trial->spheres[0] + view->trial->spheres[1] + p->count_error * random_normal(&stream);
    latent = floor(latent + 0.5);
    return latent < question->scale_min   ? question->scale_min
           : latent > question->scale_max ? question->scale_max
                                          : (int32_t)latent;
}

// A step of a parameter in place of the end, as long as steps help: the first direction is a guess, a step that
// makes it worse turns it, the second turn goes back to the best and on to the next parameter.
static bool adjust(struct observer *observer, const struct machine_view *view,
                   const struct observer_errors *errors, struct machine_event *out)
{
    double difference = fabs(errors->slot[1] - errors->slot[0]);
    bool settled = observer->turns >= 2, more = view->adjusting + 1 < view->adjust_count;
    if (!(difference > observer->parameters.threshold / 3) || observer->due_ns >= observer->hurry_ns ||
        observer->step > observer->toggles_planned + OBSERVER_ADJUSTMENTS || (settled && !more))
        return false;
    if (view->slot != view->trial->test_slot) {
        out->kind = MACHINE_TOGGLE_KEY; // the steps can be seen there
        return true;
    }
    observer->looking = PLAN_SLOT_NONE; // looks again
    if (settled) {
        observer->turns = 0;
        observer->direction = 0;
        *out = (struct machine_event){MACHINE_ADJUST_NEXT, 1};
        return true;
    }
    struct random_stream stream = trial_stream(observer, PURPOSE_ADJUST, observer->step);
    if (observer->direction == 0)
        observer->direction = random_below(&stream, 2) ? 1 : -1;
    else if (difference >= observer->last_difference) { // or no better, as at its end
        observer->direction = -observer->direction;
        observer->turns++;
    }
    observer->last_difference = difference;
    *out = (struct machine_event){MACHINE_ADJUST, observer->direction};
    return true;
}

// What an armed event comes to in the moment that it is due.
static void decide(struct observer *observer, const struct machine_view *view,
                   const struct observer_errors *errors, struct machine_event *out)
{
    if (out->kind == MACHINE_CHOOSE && view->screen == MACHINE_STIMULUS && !view->may_choose)
        out->kind = MACHINE_TOGGLE_KEY; // not seen for long enough
    else if (out->kind == MACHINE_CHOOSE)
        out->value = choose(observer, errors, view->question);
    else if (out->kind == MACHINE_RATE)
        out->value = view->question ? rate(observer, errors, view) : 0;
    else if (out->kind == MACHINE_START && view->screen == MACHINE_STIMULUS &&
             !(view->adjust_count > 0 && adjust(observer, view, errors, out)) && !view->may_go_on)
        out->kind = MACHINE_TOGGLE_KEY; // START would be lost, and the trial would wait for ever
    if (out->kind == MACHINE_TOGGLE_KEY || out->kind == MACHINE_START)
        out->value = 0;
}

bool observer_next(struct observer *observer, int64_t now_ns, const struct machine_view *view,
                   const struct observer_errors *errors, int64_t *out_at_ns, struct machine_event *out_event)
{
    bool new_trial = view->trial_index != observer->trial || view->attempt != observer->attempt;
    if (new_trial || view->screen != observer->screen) {
        observer->armed = false;
        observer->screen = view->screen;
        observer->looking = PLAN_SLOT_NONE;
    }
    if (new_trial) {
        observer->trial = view->trial_index;
        observer->attempt = view->attempt;
        observer->step = 0;
        observer->direction = 0;
        observer->turns = observer->questions = 0;
        observer->hurry_ns = INT64_MAX;
        observer->toggles_planned = plan_toggles(observer);
        struct random_stream stream = trial_stream(observer, PURPOSE_LATE, 0);
        observer->late = random_unit(&stream) < observer->parameters.late;
    }
    if (!observer->armed)
        arm_any(observer, now_ns, view);
    if (!observer->armed || observer->due_ns > now_ns)
        return false;
    observer->armed = false;
    observer->events++;
    *out_at_ns = observer->due_ns;
    *out_event = observer->next;
    decide(observer, view, errors, out_event);
    return true;
}
