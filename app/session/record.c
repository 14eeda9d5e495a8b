#include "app/session/record.h"

#include <errno.h>
#include <inttypes.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

void record_time_utc(char out[RECORD_TIME])
{
    time_t now = time(NULL);
    struct tm utc;
    gmtime_r(&now, &utc);
    strftime(out, RECORD_TIME, "%Y-%m-%dT%H:%M:%SZ", &utc);
}

static enum store_slot stored_slot(enum plan_slot slot)
{
    return slot == PLAN_SLOT_A ? STORE_A : slot == PLAN_SLOT_B ? STORE_B : STORE_NO_SLOT;
}

static const char *slot_word(enum plan_slot slot)
{
    return slot == PLAN_SLOT_NONE ? "none" : plan_slot_name(slot);
}

// What a handler below has in hand: the line to write after its rows, and the store's sentence.
static void set_line(struct recorder *recorder, const char *event, const char *format, ...)
    __attribute__((format(printf, 3, 4)));
static void set_line(struct recorder *recorder, const char *event, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(recorder->details, sizeof recorder->details, format, arguments);
    va_end(arguments);
    recorder->event = event;
}

bool recorder_init(struct recorder *recorder, uint32_t places)
{
    uint32_t capacity = places + 16;
    recorder->trial_ids = calloc(capacity, sizeof *recorder->trial_ids);
    recorder->capacity = recorder->trial_ids ? capacity : 0;
    for (uint32_t i = 0; i < places && recorder->trial_ids; i++)
        recorder->trial_ids[i] = recorder->ids->trial_ids[i];
    return recorder->trial_ids != NULL;
}

void recorder_finish(struct recorder *recorder)
{
    free(recorder->trial_ids);
}

static const struct plan_trial *trial_of(const struct recorder *recorder, const struct machine_record *record)
{
    return machine_trial(recorder->machine, record->trial);
}

static enum store_result add_option(struct recorder *recorder, const struct plan_trial *trial,
                                    const struct protocol_option *option, int64_t *out_id,
                                    struct store_error *why)
{
    const struct protocol *protocol = recorder->plan->protocol;
    char parameters[PLAN_JSON];
    if (!protocol_option_json(protocol, option, parameters, sizeof parameters)) {
        snprintf(why->text, sizeof why->text, "the parameters of trial %" PRIu32 " are too long",
                 trial->ordinal);
        return STORE_REFUSED;
    }
    struct store_condition row = {protocol->catalogue->modes[option->mode].name, parameters};
    return store_add_condition(recorder->store, &row, out_id, why);
}

// A staircase's option is known now; the row gets it.
static enum store_result set_level(struct recorder *recorder, const struct machine_record *record,
                                   struct store_error *why)
{
    const struct plan_trial *trial = trial_of(recorder, record);
    int64_t condition = 0;
    if (isnan(record->level))
        return STORE_OK;
    struct protocol_option option = plan_level_option(recorder->plan, trial, record->level);
    enum store_result result = add_option(recorder, trial, &option, &condition, why);
    if (result == STORE_OK)
        result = store_set_trial_option(recorder->store, recorder->trial_ids[record->trial],
                                        stored_slot(trial->test_slot), condition, why);
    recorder->level_condition = condition;
    return result;
}

// What was set is an option of its own, which later ratings are about.
static enum store_result keep_adjusted(struct recorder *recorder, const struct machine_record *record,
                                       struct store_error *why)
{
    struct protocol_option option;
    const struct plan_trial *trial = trial_of(recorder, record);
    if (record->number_count == 0 || record->ends_trial ||
        !machine_option(recorder->machine, trial->test_slot, &option))
        return STORE_OK;
    return add_option(recorder, trial, &option, &recorder->level_condition, why);
}

static enum store_result start_trial(struct recorder *recorder, const struct machine_record *record,
                                     struct store_error *why)
{
    const struct plan_trial *trial = trial_of(recorder, record);
    int64_t id = recorder->trial_ids[record->trial], attempt = 0;
    recorder->level_condition = 0;
    enum store_result result = set_level(recorder, record, why);
    if (result == STORE_OK && record->number_count > 0)
        result = keep_adjusted(recorder, record, why);
    if (result == STORE_OK)
        result =
            store_start_trial(recorder->store, id, recorder->ids->segment_id, record->at_ns, &attempt, why);
    if (result != STORE_OK)
        return result;
    recorder->trial_id = id;
    recorder->attempt = (uint32_t)attempt;
    set_line(recorder, "trial",
             "\"trial\":%" PRIu32 ",\"attempt\":%" PRId64 ",\"of\":%" PRIu32 ",\"kind\":\"%s\"",
             record->trial + 1, attempt, recorder->plan->trial_count, plan_trial_kind(trial));
    return STORE_OK;
}

int64_t recorder_condition(const struct recorder *recorder, const struct plan_trial *trial, enum plan_slot slot)
{
    if (slot == PLAN_SLOT_NONE || trial->option[slot] < 0)
        return 0;
    if (recorder->level_condition && slot == trial->test_slot)
        return recorder->level_condition;
    return recorder->ids->condition_ids[trial->option[slot]];
}

static void forget_trial(struct recorder *recorder)
{
    recorder->trial_id = 0;
    recorder->attempt = 0;
    recorder->level_condition = 0;
}

static void push_event(struct recorder *recorder, const struct machine_record *record, const char *detail)
{
    bool in_trial = record->trial != UINT32_MAX;
    store_push_event(recorder->store,
                     &(struct store_event){.session_id = recorder->ids->session_id,
                                           .segment_id = recorder->ids->segment_id,
                                           .trial_id = in_trial ? recorder->trial_ids[record->trial] : 0,
                                           .at_ns = record->at_ns,
                                           .kind = machine_record_name(record->kind),
                                           .detail = detail});
}

// Invalid and planned again in one transaction; the new row's id is kept for its place.
static enum store_result end_invalid(struct recorder *recorder, const struct machine_record *record,
                                     struct store_error *why)
{
    int64_t id = recorder->trial_ids[record->trial], again = 0;
    bool repeats = record->again != UINT32_MAX;
    if (repeats && record->again >= recorder->capacity) {
        uint32_t capacity = 2 * record->again;
        int64_t *ids = realloc(recorder->trial_ids, capacity * sizeof *ids);
        if (!ids) {
            snprintf(why->text, sizeof why->text, "out of memory");
            return STORE_FAILED;
        }
        recorder->trial_ids = ids;
        recorder->capacity = capacity;
    }
    enum store_result result = store_repeat_trial(recorder->store, id, repeats ? (int64_t)record->again + 1 : 0,
                                                  record->at_ns, &again, why);
    if (result != STORE_OK)
        return result;
    if (repeats)
        recorder->trial_ids[record->again] = again;
    if (id == recorder->trial_id)
        forget_trial(recorder);
    push_event(recorder, record, record->late ? "{\"reason\":\"late\"}" : "{\"reason\":\"flagged\"}");
    set_line(recorder, "invalid", "\"trial\":%" PRIu32 ",\"reason\":\"%s\",\"again\":%" PRIu32,
             record->trial + 1, record->late ? "late" : "flagged", repeats ? record->again + 1 : 0);
    return STORE_OK;
}

static struct store_staircase_step stored_step(const struct staircase_step *step)
{
    return (struct store_staircase_step){.level = plan_level(step->level),
                                         .outcome = step->outcome,
                                         .reversal = step->reversal,
                                         .estimate = step->estimate};
}

static enum store_result store_choice_row(struct recorder *recorder, const struct machine_record *record,
                                          int64_t *out_row, struct store_error *why)
{
    const struct store_staircase_step step = stored_step(&record->step);
    struct store_choice choice = {.trial_id = recorder->trial_ids[record->trial],
                                  .segment_id = recorder->ids->segment_id,
                                  .chosen =
                                      record->slot == PLAN_SLOT_NONE ? STORE_EQUAL : stored_slot(record->slot),
                                  .correct = record->correct < 0 ? STORE_NO_VERDICT
                                             : record->correct   ? STORE_CORRECT
                                                                 : STORE_WRONG,
                                  .reaction_ns = record->reaction_ns,
                                  .answered_ns = record->at_ns,
                                  .toggles = record->toggles,
                                  .ends_trial = record->ends_trial,
                                  .step = record->has_step ? &step : NULL};
    return store_answer_choice(recorder->store, &choice, out_row, why);
}

static enum store_result store_rating_row(struct recorder *recorder, const struct machine_record *record,
                                          int64_t *out_row, struct store_error *why)
{
    const struct plan_trial *trial = trial_of(recorder, record);
    const struct store_staircase_step step = stored_step(&record->step);
    bool of_one = record->slot != PLAN_SLOT_NONE;
    enum plan_slot shown = of_one                               ? record->slot
                           : protocol_kind_is_pair(trial->kind) ? PLAN_SLOT_NONE
                                                                : PLAN_SLOT_A;
    struct store_rating rating = {.trial_id = recorder->trial_ids[record->trial],
                                  .segment_id = recorder->ids->segment_id,
                                  .question = record->question->name,
                                  .subject = of_one ? plan_slot_name(record->slot) : "scene",
                                  .condition_id = recorder_condition(recorder, trial, shown),
                                  .value = record->value,
                                  .scale_min = record->question->scale_min,
                                  .scale_max = record->question->scale_max,
                                  .answered_ns = record->at_ns,
                                  .ends_trial = record->ends_trial,
                                  .step = record->has_step ? &step : NULL};
    return store_answer_rating(recorder->store, &rating, out_row, why);
}

static const char *adjusted_name(const struct recorder *recorder, const struct machine_record *record,
                                 uint32_t index)
{
    const struct protocol *protocol = recorder->plan->protocol;
    const struct protocol_block *block = &protocol->blocks[trial_of(recorder, record)->block];
    uint32_t mode = protocol->options[block->options[0]].mode;
    return protocol->catalogue->modes[mode].parameters[block->adjusts[index].parameter].name;
}

static enum store_result store_response_rows(struct recorder *recorder, const struct machine_record *record,
                                             int64_t *out_row, struct store_error *why)
{
    struct store_response rows[PROTOCOL_ADJUSTED];
    uint32_t count = record->number_count > 0 ? record->number_count : 1;
    for (uint32_t i = 0; i < count; i++)
        rows[i] = (struct store_response){
            .trial_id = recorder->trial_ids[record->trial],
            .segment_id = recorder->ids->segment_id,
            .question = record->number_count > 0 ? adjusted_name(recorder, record, i) : record->question->name,
            .value = record->number_count > 0 ? record->numbers[i] : record->value,
            .expected = record->number_count > 0 ? (double)NAN : (double)record->expected,
            .answered_ns = record->at_ns,
            .device = recorder->device,
            .ends_trial = record->ends_trial && i + 1 == count};
    return store_answer_responses(recorder->store, rows, count, out_row, why);
}

static enum store_result store_answer(struct recorder *recorder, const struct machine_record *record,
                                      struct store_error *why)
{
    int64_t row = 0;
    const char *table = record->kind == MACHINE_CHOICE   ? "choice"
                        : record->kind == MACHINE_RATING ? "rating"
                                                         : "response";
    enum store_result result = keep_adjusted(recorder, record, why);
    if (result != STORE_OK)
        return result;
    result = record->kind == MACHINE_CHOICE   ? store_choice_row(recorder, record, &row, why)
             : record->kind == MACHINE_RATING ? store_rating_row(recorder, record, &row, why)
                                              : store_response_rows(recorder, record, &row, why);
    char value[32];
    if (result != STORE_OK)
        return result;
    if (record->kind == MACHINE_CHOICE)
        snprintf(value, sizeof value, "\"%s\"",
                 record->slot == PLAN_SLOT_NONE ? "equal" : plan_slot_name(record->slot));
    else if (record->number_count > 0)
        snprintf(value, sizeof value, "%.9g", record->numbers[0]);
    else
        snprintf(value, sizeof value, "%" PRId32, record->value);
    set_line(recorder, "answer", "\"table\":\"%s\",\"row\":%" PRId64 ",\"trial\":%" PRIu32 ",\"value\":%s",
             table, row, record->trial + 1, value);
    return STORE_OK;
}

static enum store_result push_adjust_step(struct recorder *recorder, const struct machine_record *record)
{
    store_push_adjust_step(recorder->store, &(struct store_adjust_step){
                                                .trial_id = recorder->trial_ids[record->trial],
                                                .segment_id = recorder->ids->segment_id,
                                                .at_ns = record->at_ns,
                                                .parameter = adjusted_name(recorder, record, record->parameter),
                                                .value = record->numbers[0]});
    return STORE_OK;
}

static enum store_result push_exposure(struct recorder *recorder, const struct machine_record *record)
{
    bool full = record->full_start_ns >= 0 && record->full_end_ns >= 0;
    // A dropped row is counted and reported by the store itself.
    store_push_exposure(recorder->store,
                        &(struct store_exposure){.trial_id = recorder->trial_ids[record->trial],
                                                 .segment_id = recorder->ids->segment_id,
                                                 .attempt = record->attempt,
                                                 .option = stored_slot(record->slot),
                                                 .start_ns = record->start_ns,
                                                 .end_ns = record->end_ns,
                                                 .full_start_ns = full ? record->full_start_ns : STORE_UNKNOWN,
                                                 .full_end_ns = full ? record->full_end_ns : STORE_UNKNOWN});
    return STORE_OK;
}

static enum store_result note_toggle(struct recorder *recorder, const struct machine_record *record)
{
    char details[64];
    snprintf(details, sizeof details, "{\"slot\":\"%s\"}", slot_word(record->slot));
    push_event(recorder, record, details);
    set_line(recorder, "toggle", "\"trial\":%" PRIu32 ",\"slot\":\"%s\",\"ignored\":%s", record->trial + 1,
             slot_word(record->slot), record->kind == MACHINE_TOGGLE_IGNORED ? "true" : "false");
    return STORE_OK;
}

static enum store_result note_gap(struct recorder *recorder, const struct machine_record *record)
{
    char details[64];
    snprintf(details, sizeof details, "{\"ns\":%" PRId64 "}", record->value_ns);
    push_event(recorder, record, details);
    set_line(recorder, "gap", "\"reason\":\"%s\",\"ns\":%" PRId64, machine_record_name(record->kind),
             record->value_ns);
    return STORE_OK;
}

static enum store_result give_consent(struct recorder *recorder, const struct machine_record *record,
                                      struct store_error *why)
{
    char now[RECORD_TIME];
    record_time_utc(now);
    const char *version = recorder->plan->protocol->consent_version;
    enum store_result result = store_set_consent(recorder->store, recorder->ids->session_id, now, version, why);
    if (result == STORE_OK)
        push_event(recorder, record, NULL);
    return result;
}

static enum store_result end_session(struct recorder *recorder, const struct machine_record *record,
                                     struct store_error *why)
{
    char now[RECORD_TIME];
    const char *status = record->complete ? "complete" : "aborted";
    record_time_utc(now);
    enum store_result result =
        store_end_session(recorder->store, recorder->ids->session_id, status, now, record->at_ns, why);
    if (result == STORE_OK)
        set_line(recorder, "end", "\"status\":\"%s\"", status);
    return result;
}

static enum store_result write_rows(struct recorder *recorder, const struct machine_record *record,
                                    struct store_error *why)
{
    switch (record->kind) {
    case MACHINE_CONSENT_GIVEN:
        return give_consent(recorder, record, why);
    case MACHINE_TRIAL_STARTED:
        return start_trial(recorder, record, why);
    case MACHINE_TRIAL_DONE: // the answer's transaction ended the trial already
        forget_trial(recorder);
        return STORE_OK;
    case MACHINE_TRIAL_INVALID:
        return end_invalid(recorder, record, why);
    case MACHINE_TRIAL_SKIPPED:
        return store_end_trial(recorder->store, recorder->trial_ids[record->trial], "skipped", record->at_ns,
                               why);
    case MACHINE_ADJUSTED:
        return push_adjust_step(recorder, record);
    case MACHINE_EXPOSURE:
        return push_exposure(recorder, record);
    case MACHINE_TOGGLE:
    case MACHINE_TOGGLE_IGNORED:
        return note_toggle(recorder, record);
    case MACHINE_CHOICE:
    case MACHINE_RATING:
    case MACHINE_RESPONSES:
        return store_answer(recorder, record, why);
    case MACHINE_CLOCK_BACK:
        return note_gap(recorder, record);
    case MACHINE_ENDED:
        return end_session(recorder, record, why);
    default:
        push_event(recorder, record, NULL);
        return STORE_OK;
    }
}

// Whether a line may still get through later: a disk makes room, a reader that went away does not come back.
static bool passes(int reason)
{
    return reason == ENOSPC || reason == EDQUOT || reason == EFBIG || reason == EIO || reason == EAGAIN ||
           reason == EINTR;
}

enum recorder_result recorder_take(struct recorder *recorder, const struct machine_record *record, char *error,
                                   size_t error_size)
{
    if (!recorder->line_waits) {
        struct store_error why;
        recorder->event = NULL;
        enum store_result result = write_rows(recorder, record, &why);
        if (result != STORE_OK) {
            snprintf(error, error_size, "%s", why.text);
            return result == STORE_FAILED ? RECORDER_WAIT : RECORDER_FAILED;
        }
        recorder->line_waits = recorder->event != NULL;
    }
    if (recorder->line_waits &&
        !event_line(recorder->lines, recorder->event, record->at_ns, recorder->details)) {
        int reason = errno;
        snprintf(error, error_size, "the events file cannot be written: %s; what was answered is stored",
                 strerror(reason));
        return passes(reason) ? RECORDER_WAIT : RECORDER_FAILED;
    }
    recorder->line_waits = false;
    return machine_is_answer(record->kind) ? RECORDER_ANSWERED : RECORDER_DONE;
}
