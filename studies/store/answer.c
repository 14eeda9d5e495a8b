// Trials, answers and what goes with them.
#include "studies/store/rows.h"
#include "studies/store/sql.h"

#include <math.h>

static enum store_result trial_changed(struct store *store, int64_t trial_id, const char *what,
                                       struct store_error *error)
{
    if (sqlite3_changes(store->db) > 0)
        return STORE_OK;
    sql_say(error, "%s: trial %lld %s", store->path, (long long)trial_id, what);
    return STORE_REFUSED;
}

enum store_result store_start_trial(struct store *store, int64_t trial_id, int64_t segment_id,
                                    int64_t started_ns, int64_t *out_attempt, struct store_error *error)
{
    const struct sql_value values[] = {sql_id(trial_id), sql_id(segment_id), sql_integer(started_ns)};
    struct sql_value attempt = {0};
    bool found = false;
    enum store_result result = sql_begin(store, error);
    if (result == STORE_OK)
        result = sql_run(store, SQL_START_TRIAL, values, countof(values), NULL, error);
    if (result == STORE_OK)
        result = trial_changed(store, trial_id, "is neither planned nor running", error);
    if (result == STORE_OK)
        result = sql_get(store, SQL_GET_ATTEMPT, values, 1, &attempt, 1, &found, error);
    if (result == STORE_OK && out_attempt)
        *out_attempt = attempt.integer;
    return sql_end(store, result, error);
}

enum store_result store_set_trial_option(struct store *store, int64_t trial_id, enum store_slot slot,
                                         int64_t condition_id, struct store_error *error)
{
    const struct sql_value values[] = {sql_id(trial_id), sql_slot(slot), sql_id(condition_id)};
    enum store_result result = sql_begin(store, error);
    if (result == STORE_OK)
        result = sql_run(store, SQL_SET_TRIAL_OPTION, values, countof(values), NULL, error);
    if (result == STORE_OK)
        result = trial_changed(store, trial_id, "does not exist", error);
    return sql_end(store, result, error);
}

static enum store_result end_trial(struct store *store, int64_t trial_id, const char *status, int64_t ended_ns,
                                   struct store_error *error)
{
    const struct sql_value values[] = {sql_id(trial_id), sql_text(status), sql_integer(ended_ns)};
    enum store_result result = sql_run(store, SQL_END_TRIAL, values, countof(values), NULL, error);
    return result == STORE_OK ? trial_changed(store, trial_id, "does not exist", error) : result;
}

enum store_result store_end_trial(struct store *store, int64_t trial_id, const char *status, int64_t ended_ns,
                                  struct store_error *error)
{
    enum store_result result = sql_begin(store, error);
    if (result == STORE_OK)
        result = end_trial(store, trial_id, status, ended_ns, error);
    return sql_end(store, result, error);
}

enum store_result store_repeat_trial(struct store *store, int64_t trial_id, int64_t ordinal, int64_t ended_ns,
                                     int64_t *out_id, struct store_error *error)
{
    const struct sql_value values[] = {sql_id(trial_id), sql_integer(ordinal)};
    *out_id = 0;
    enum store_result result = sql_begin(store, error);
    if (result == STORE_OK)
        result = end_trial(store, trial_id, "invalid", ended_ns, error);
    if (result == STORE_OK && ordinal > 0)
        result = sql_run(store, SQL_REPEAT_TRIAL, values, countof(values), out_id, error);
    return sql_end(store, result, error);
}

static enum store_result insert_step(struct store *store, int64_t trial_id,
                                     const struct store_staircase_step *step, int64_t *out_id,
                                     struct store_error *error)
{
    const struct sql_value values[] = {sql_id(trial_id), sql_real(step->level), sql_integer(step->outcome),
                                       sql_truth(step->reversal), sql_real(step->estimate)};
    return sql_run(store, SQL_INSERT_STAIRCASE_STEP, values, countof(values), out_id, error);
}

enum store_result store_answer_choice(struct store *store, const struct store_choice *choice, int64_t *out_id,
                                      struct store_error *error)
{
    int64_t correct = choice->correct == STORE_NO_VERDICT ? STORE_UNKNOWN : choice->correct == STORE_CORRECT;
    const struct sql_value values[] = {sql_id(choice->trial_id),         sql_id(choice->segment_id),
                                       sql_slot(choice->chosen),         sql_integer(correct),
                                       sql_integer(choice->reaction_ns), sql_integer(choice->answered_ns),
                                       sql_integer(choice->toggles)};
    enum store_result result = sql_begin(store, error);
    if (result == STORE_OK)
        result = sql_run(store, SQL_INSERT_CHOICE, values, countof(values), out_id, error);
    if (result == STORE_OK && choice->step)
        result = insert_step(store, choice->trial_id, choice->step, NULL, error);
    if (result == STORE_OK && choice->ends_trial)
        result = end_trial(store, choice->trial_id, "done", choice->answered_ns, error);
    return sql_end(store, result, error);
}

enum store_result store_answer_rating(struct store *store, const struct store_rating *rating, int64_t *out_id,
                                      struct store_error *error)
{
    const struct sql_value values[] = {sql_id(rating->trial_id),    sql_id(rating->session_id),
                                       sql_id(rating->segment_id),  sql_text(rating->question),
                                       sql_text(rating->subject),   sql_id(rating->condition_id),
                                       sql_real(rating->value),     sql_real(rating->scale_min),
                                       sql_real(rating->scale_max), sql_integer(rating->answered_ns)};
    enum store_result result = sql_begin(store, error);
    if (result == STORE_OK)
        result = sql_run(store, SQL_INSERT_RATING, values, countof(values), out_id, error);
    if (result == STORE_OK && rating->step)
        result = insert_step(store, rating->trial_id, rating->step, NULL, error);
    if (result == STORE_OK && rating->ends_trial)
        result = end_trial(store, rating->trial_id, "done", rating->answered_ns, error);
    return sql_end(store, result, error);
}

enum store_result store_answer_responses(struct store *store, const struct store_response *responses,
                                         uint32_t count, int64_t *out_id, struct store_error *error)
{
    enum store_result result = sql_begin(store, error);
    for (uint32_t i = 0; i < count && result == STORE_OK; i++) {
        const struct store_response *response = &responses[i];
        const struct sql_value values[] = {sql_id(response->trial_id),   sql_id(response->segment_id),
                                           sql_text(response->question), sql_real(response->value),
                                           sql_real(response->expected), sql_integer(response->answered_ns),
                                           sql_text(response->device)};
        result = sql_run(store, SQL_INSERT_RESPONSE, values, countof(values), i ? NULL : out_id, error);
        if (result == STORE_OK && response->ends_trial)
            result = end_trial(store, response->trial_id, "done", response->answered_ns, error);
    }
    return sql_end(store, result, error);
}

enum store_result store_add_staircase_step(struct store *store, int64_t trial_id,
                                           const struct store_staircase_step *step, int64_t *out_id,
                                           struct store_error *error)
{
    enum store_result result = sql_begin(store, error);
    if (result == STORE_OK)
        result = insert_step(store, trial_id, step, out_id, error);
    return sql_end(store, result, error);
}

enum store_result store_add_gaze_check(struct store *store, const struct store_gaze_check *check,
                                       int64_t *out_id, struct store_error *error)
{
    const struct sql_value values[] = {
        sql_id(check->session_id), sql_id(check->segment_id),     sql_integer(check->at_ns),
        sql_text(check->block),    sql_real(check->x_deg),        sql_real(check->y_deg),
        sql_eye(check->eye),       sql_real(check->accuracy_deg), sql_real(check->rms_s2s_deg),
        sql_real(check->sd_deg),   sql_real(check->loss),         sql_truth(check->passed)};
    enum store_result result = sql_begin(store, error);
    if (result == STORE_OK)
        result = sql_run(store, SQL_INSERT_GAZE_CHECK, values, countof(values), out_id, error);
    return sql_end(store, result, error);
}

enum store_result store_add_exclusion(struct store *store, const struct store_exclusion *exclusion,
                                      int64_t *out_id, struct store_error *error)
{
    const struct sql_value values[] = {sql_id(exclusion->trial_id),       sql_id(exclusion->session_id),
                                       sql_id(exclusion->participant_id), sql_text(exclusion->rule),
                                       sql_text(exclusion->rule_set),     sql_text(exclusion->reason),
                                       sql_text(exclusion->by),           sql_text(exclusion->applied_at)};
    enum store_result result = sql_begin(store, error);
    if (result == STORE_OK)
        result = sql_run(store, SQL_INSERT_EXCLUSION, values, countof(values), out_id, error);
    return sql_end(store, result, error);
}

enum store_result store_set_measured_error(struct store *store, const struct store_error_key *key, double value,
                                           struct store_error *error)
{
    const struct sql_value values[] = {sql_id(key->condition_id), sql_id(key->reference_id),
                                       sql_text(key->scene), sql_text(key->metric), sql_real(value)};
    enum store_result result = sql_begin(store, error);
    if (result == STORE_OK)
        result = sql_run(store, SQL_SET_MEASURED_ERROR, values, countof(values), NULL, error);
    return sql_end(store, result, error);
}

enum store_result store_get_measured_error(struct store *store, const struct store_error_key *key,
                                           double *out_value, struct store_error *error)
{
    const struct sql_value values[] = {sql_id(key->condition_id), sql_id(key->reference_id),
                                       sql_text(key->scene), sql_text(key->metric)};
    struct sql_value value = {0};
    bool found = false;
    sql_say(error, "%s", "");
    pthread_mutex_lock(&store->mutex);
    enum store_result result =
        sql_get(store, SQL_GET_MEASURED_ERROR, values, countof(values), &value, 1, &found, error);
    pthread_mutex_unlock(&store->mutex);
    *out_value = result == STORE_OK && found ? value.real : NAN;
    return result;
}

enum store_result store_add_event(struct store *store, const struct store_event *event, int64_t *out_id,
                                  struct store_error *error)
{
    struct sql_value values[ROWS_EVENT_COLUMNS];
    rows_event(event, event->kind, event->detail, values);
    enum store_result result = sql_begin(store, error);
    if (result == STORE_OK)
        result = sql_run(store, SQL_INSERT_EVENT, values, countof(values), out_id, error);
    return sql_end(store, result, error);
}
