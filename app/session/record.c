#include "app/session/record.h"

#include <errno.h>
#include <inttypes.h>
#include <stdarg.h>
#include <stdio.h>
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

static enum store_result start_trial(struct recorder *recorder, const struct machine_record *record,
                                     struct store_error *why)
{
    const struct plan_trial *trial = &recorder->plan->trials[record->trial];
    int64_t id = recorder->ids->trial_ids[record->trial], attempt = 0;
    enum store_result result =
        store_start_trial(recorder->store, id, recorder->ids->segment_id, record->at_ns, &attempt, why);
    if (result != STORE_OK)
        return result;
    recorder->trial_id = id;
    recorder->attempt = (uint32_t)attempt;
    set_line(recorder, "trial",
             "\"trial\":%" PRIu32 ",\"attempt\":%" PRId64 ",\"of\":%" PRIu32 ",\"kind\":\"%s\"", trial->ordinal,
             attempt, recorder->plan->trial_count, protocol_kind_name(trial->kind));
    return STORE_OK;
}

static enum store_result store_choice_row(struct recorder *recorder, const struct machine_record *record,
                                          int64_t *out_row, struct store_error *why)
{
    struct store_choice choice = {.trial_id = recorder->ids->trial_ids[record->trial],
                                  .segment_id = recorder->ids->segment_id,
                                  .chosen = stored_slot(record->slot),
                                  .reaction_ns = record->reaction_ns,
                                  .answered_ns = record->at_ns,
                                  .toggles = record->toggles,
                                  .ends_trial = true};
    return store_answer_choice(recorder->store, &choice, out_row, why);
}

static enum store_result store_rating_row(struct recorder *recorder, const struct machine_record *record,
                                          int64_t *out_row, struct store_error *why)
{
    const struct plan_trial *trial = &recorder->plan->trials[record->trial];
    struct store_rating rating = {
        .trial_id = recorder->ids->trial_ids[record->trial],
        .segment_id = recorder->ids->segment_id,
        .question = trial->question->name,
        .subject = "scene",
        .condition_id = trial->option[0] >= 0 ? recorder->ids->condition_ids[trial->option[0]] : 0,
        .value = record->value,
        .scale_min = trial->question->scale_min,
        .scale_max = trial->question->scale_max,
        .answered_ns = record->at_ns,
        .ends_trial = true};
    return store_answer_rating(recorder->store, &rating, out_row, why);
}

static enum store_result store_answer(struct recorder *recorder, const struct machine_record *record,
                                      struct store_error *why)
{
    int64_t row = 0;
    bool choice = record->kind == MACHINE_CHOICE;
    uint32_t ordinal = recorder->plan->trials[record->trial].ordinal;
    enum store_result result =
        choice ? store_choice_row(recorder, record, &row, why) : store_rating_row(recorder, record, &row, why);
    if (result != STORE_OK)
        return result;
    if (choice)
        set_line(recorder, "answer",
                 "\"table\":\"choice\",\"row\":%" PRId64 ",\"trial\":%" PRIu32 ",\"value\":\"%s\"", row,
                 ordinal, slot_word(record->slot));
    else
        set_line(recorder, "answer",
                 "\"table\":\"rating\",\"row\":%" PRId64 ",\"trial\":%" PRIu32 ",\"value\":%" PRId32, row,
                 ordinal, record->value);
    return STORE_OK;
}

static enum store_result push_exposure(struct recorder *recorder, const struct machine_record *record)
{
    bool full = record->full_start_ns >= 0 && record->full_end_ns >= 0;
    // A dropped row is counted and reported by the store itself.
    store_push_exposure(recorder->store,
                        &(struct store_exposure){.trial_id = recorder->ids->trial_ids[record->trial],
                                                 .segment_id = recorder->ids->segment_id,
                                                 .attempt = record->attempt,
                                                 .option = stored_slot(record->slot),
                                                 .start_ns = record->start_ns,
                                                 .end_ns = record->end_ns,
                                                 .full_start_ns = full ? record->full_start_ns : STORE_UNKNOWN,
                                                 .full_end_ns = full ? record->full_end_ns : STORE_UNKNOWN});
    return STORE_OK;
}

static void push_event(struct recorder *recorder, const struct machine_record *record, const char *detail)
{
    bool in_trial = record->trial < recorder->plan->trial_count;
    store_push_event(recorder->store,
                     &(struct store_event){.session_id = recorder->ids->session_id,
                                           .segment_id = recorder->ids->segment_id,
                                           .trial_id = in_trial ? recorder->ids->trial_ids[record->trial] : 0,
                                           .at_ns = record->at_ns,
                                           .kind = machine_record_name(record->kind),
                                           .detail = detail});
}

static enum store_result note_toggle(struct recorder *recorder, const struct machine_record *record)
{
    char details[64];
    snprintf(details, sizeof details, "{\"slot\":\"%s\"}", slot_word(record->slot));
    push_event(recorder, record, details);
    set_line(recorder, "toggle", "\"trial\":%" PRIu32 ",\"slot\":\"%s\",\"ignored\":%s",
             recorder->plan->trials[record->trial].ordinal, slot_word(record->slot),
             record->kind == MACHINE_TOGGLE_IGNORED ? "true" : "false");
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
        recorder->trial_id = 0;
        recorder->attempt = 0;
        return STORE_OK;
    case MACHINE_EXPOSURE:
        return push_exposure(recorder, record);
    case MACHINE_TOGGLE:
    case MACHINE_TOGGLE_IGNORED:
        return note_toggle(recorder, record);
    case MACHINE_CHOICE:
    case MACHINE_RATING:
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
    bool answer = record->kind == MACHINE_CHOICE || record->kind == MACHINE_RATING;
    return answer ? RECORDER_ANSWERED : RECORDER_DONE;
}
