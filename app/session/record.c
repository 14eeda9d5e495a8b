#include "app/session/record.h"

#include <errno.h>
#include <inttypes.h>
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

static bool say_line(struct recorder *recorder, const char *event, const struct machine_record *record,
                     const char *details, char *error, size_t error_size)
{
    if (event_line(recorder->lines, event, record->at_ns, details))
        return true;
    snprintf(error, error_size, "the events file cannot be written: %s; what was answered is stored",
             strerror(errno));
    return false;
}

static enum recorder_result finish(struct recorder *recorder, const char *event,
                                   const struct machine_record *record, const char *details, char *error,
                                   size_t error_size)
{
    return say_line(recorder, event, record, details, error, error_size) ? RECORDER_DONE : RECORDER_FAILED;
}

static enum recorder_result start_trial(struct recorder *recorder, const struct machine_record *record,
                                        char *error, size_t error_size)
{
    struct store_error why;
    const struct plan_trial *trial = &recorder->plan->trials[record->trial];
    int64_t id = recorder->ids->trial_ids[record->trial], attempt = 0;
    if (store_start_trial(recorder->store, id, recorder->ids->segment_id, record->at_ns, &attempt, &why) !=
        STORE_OK) {
        snprintf(error, error_size, "%s", why.text);
        return RECORDER_FAILED;
    }
    recorder->trial_id = id;
    recorder->attempt = (uint32_t)attempt;
    char details[256];
    snprintf(details, sizeof details,
             "\"trial\":%" PRIu32 ",\"attempt\":%" PRId64 ",\"of\":%" PRIu32 ",\"kind\":\"%s\"", trial->ordinal,
             attempt, recorder->plan->trial_count, plan_trial_kind(trial));
    return finish(recorder, "trial", record, details, error, error_size);
}

static enum recorder_result store_answer(struct recorder *recorder, const struct machine_record *record,
                                         char *error, size_t error_size)
{
    struct store_error why;
    enum store_result result;
    const struct plan_trial *trial = &recorder->plan->trials[record->trial];
    int64_t trial_id = recorder->ids->trial_ids[record->trial], row = 0;
    bool choice = record->kind == MACHINE_CHOICE;
    if (choice) {
        result = store_answer_choice(recorder->store,
                                     &(struct store_choice){.trial_id = trial_id,
                                                            .segment_id = recorder->ids->segment_id,
                                                            .chosen = stored_slot(record->slot),
                                                            .reaction_ns = record->reaction_ns,
                                                            .answered_ns = record->at_ns,
                                                            .toggles = record->toggles,
                                                            .ends_trial = true},
                                     &row, &why);
    } else {
        const struct protocol_question *question = trial->question;
        int64_t condition = trial->option[0] >= 0 ? recorder->ids->condition_ids[trial->option[0]] : 0;
        result = store_answer_rating(recorder->store,
                                     &(struct store_rating){.trial_id = trial_id,
                                                            .segment_id = recorder->ids->segment_id,
                                                            .question = question->name,
                                                            .subject = "scene",
                                                            .condition_id = condition,
                                                            .value = record->value,
                                                            .scale_min = question->scale_min,
                                                            .scale_max = question->scale_max,
                                                            .answered_ns = record->at_ns,
                                                            .ends_trial = true},
                                     &row, &why);
    }
    if (result != STORE_OK) {
        snprintf(error, error_size, "%s", why.text);
        return RECORDER_FAILED;
    }
    char details[256], value[16];
    snprintf(value, sizeof value, "%" PRId32, record->value);
    snprintf(details, sizeof details,
             "\"table\":\"%s\",\"row\":%" PRId64 ",\"trial\":%" PRIu32 ",\"value\":%s%s%s",
             choice ? "choice" : "rating", row, trial->ordinal, choice ? "\"" : "",
             choice ? slot_word(record->slot) : value, choice ? "\"" : "");
    if (!say_line(recorder, "answer", record, details, error, error_size))
        return RECORDER_FAILED;
    return RECORDER_ANSWERED;
}

static enum recorder_result push_exposure(struct recorder *recorder, const struct machine_record *record)
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
    return RECORDER_DONE;
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

static enum recorder_result note_toggle(struct recorder *recorder, const struct machine_record *record,
                                        char *error, size_t error_size)
{
    char details[128];
    snprintf(details, sizeof details, "{\"slot\":\"%s\"}", slot_word(record->slot));
    push_event(recorder, record, details);
    snprintf(details, sizeof details, "\"trial\":%" PRIu32 ",\"slot\":\"%s\",\"ignored\":%s",
             recorder->plan->trials[record->trial].ordinal, slot_word(record->slot),
             record->kind == MACHINE_TOGGLE_IGNORED ? "true" : "false");
    return finish(recorder, "toggle", record, details, error, error_size);
}

static enum recorder_result note_gap(struct recorder *recorder, const struct machine_record *record,
                                     char *error, size_t error_size)
{
    char details[128];
    snprintf(details, sizeof details, "{\"ns\":%" PRId64 "}", record->value_ns);
    push_event(recorder, record, details);
    snprintf(details, sizeof details, "\"reason\":\"%s\",\"ns\":%" PRId64, machine_record_name(record->kind),
             record->value_ns);
    return finish(recorder, "gap", record, details, error, error_size);
}

static enum recorder_result give_consent(struct recorder *recorder, const struct machine_record *record,
                                         char *error, size_t error_size)
{
    char now[RECORD_TIME];
    struct store_error why;
    record_time_utc(now);
    push_event(recorder, record, NULL);
    const char *version = recorder->plan->protocol->consent_version;
    if (store_set_consent(recorder->store, recorder->ids->session_id, now, version, &why) == STORE_OK)
        return RECORDER_DONE;
    snprintf(error, error_size, "%s", why.text);
    return RECORDER_FAILED;
}

static enum recorder_result end_session(struct recorder *recorder, const struct machine_record *record,
                                        char *error, size_t error_size)
{
    char now[RECORD_TIME], details[64];
    struct store_error why;
    const char *status = record->complete ? "complete" : "aborted";
    record_time_utc(now);
    // A trial that was under way has no answer and gets none.
    if (recorder->trial_id &&
        store_end_trial(recorder->store, recorder->trial_id, "skipped", record->at_ns, &why) != STORE_OK) {
        snprintf(error, error_size, "%s", why.text);
        return RECORDER_FAILED;
    }
    if (store_end_session(recorder->store, recorder->ids->session_id, status, now, &why) != STORE_OK) {
        snprintf(error, error_size, "%s", why.text);
        return RECORDER_FAILED;
    }
    snprintf(details, sizeof details, "\"status\":\"%s\"", status);
    return finish(recorder, "end", record, details, error, error_size);
}

enum recorder_result recorder_take(struct recorder *recorder, const struct machine_record *record, char *error,
                                   size_t error_size)
{
    switch (record->kind) {
    case MACHINE_CONSENT_GIVEN:
        return give_consent(recorder, record, error, error_size);
    case MACHINE_TRIAL_STARTED:
        return start_trial(recorder, record, error, error_size);
    case MACHINE_TRIAL_DONE: // the answer's transaction ended the trial already
        recorder->trial_id = 0;
        recorder->attempt = 0;
        return RECORDER_DONE;
    case MACHINE_EXPOSURE:
        return push_exposure(recorder, record);
    case MACHINE_TOGGLE:
    case MACHINE_TOGGLE_IGNORED:
        return note_toggle(recorder, record, error, error_size);
    case MACHINE_CHOICE:
    case MACHINE_RATING:
        return store_answer(recorder, record, error, error_size);
    case MACHINE_CLOCK_BACK:
        return note_gap(recorder, record, error, error_size);
    case MACHINE_ENDED:
        return end_session(recorder, record, error, error_size);
    default:
        push_event(recorder, record, NULL);
        return RECORDER_DONE;
    }
}
