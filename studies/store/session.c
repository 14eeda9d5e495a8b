#include "studies/store/resume.h"
#include "studies/store/rows.h"
#include "studies/store/sql.h"

#include <math.h>

enum store_result store_participant_number(struct store *store, const char *code, int64_t wanted,
                                           int64_t *out_number, struct store_error *error)
{
    enum store_result result = sql_begin(store, error);
    struct sql_value columns[2] = {{0}};
    bool found = false, taken = false;
    if (result == STORE_OK)
        result = sql_get(store, SQL_FIND_PARTICIPANT, (struct sql_value[]){sql_text(code), sql_text("")}, 2,
                         columns, 2, &found, error);
    if (result == STORE_OK && found) {
        *out_number = columns[1].integer;
        if (wanted != 0 && wanted != *out_number) {
            sql_say(error, "%s: participant %s has the number %lld, not %lld; leave the number out",
                    store->path, code, (long long)*out_number, (long long)wanted);
            result = STORE_REFUSED;
        }
    } else if (result == STORE_OK && wanted != 0) {
        *out_number = wanted;
        result = sql_get(store, SQL_NUMBER_TAKEN, (struct sql_value[]){sql_integer(wanted)}, 1, columns, 1,
                         &taken, error);
        if (result == STORE_OK && (taken || wanted < 1)) {
            sql_say(error, "%s: the participant number %lld is %s; choose another or leave it out", store->path,
                    (long long)wanted, taken ? "taken" : "not positive");
            result = STORE_REFUSED;
        }
    } else if (result == STORE_OK) {
        result = sql_get(store, SQL_FIRST_FREE_NUMBER, NULL, 0, columns, 1, &found, error);
        *out_number = columns[0].integer;
    }
    return sql_end(store, result, error);
}

// Of one protocol's sessions: another protocol in the file has its own.
static enum store_result check_seed(struct store *store, uint64_t seed, const char *protocol,
                                    struct store_error *error)
{
    struct sql_value other = {0};
    bool found = false;
    enum store_result result =
        sql_get(store, SQL_OTHER_SEED, (struct sql_value[]){sql_seed(seed), sql_text(protocol)}, 2, &other, 1,
                &found, error);
    if (result != STORE_OK || !found)
        return result;
    sql_say(error, "%s: its sessions have the seed %llu, not %llu; use that seed or a new file", store->path,
            (unsigned long long)other.integer, (unsigned long long)seed);
    return STORE_REFUSED;
}

static enum store_result add_protocol(struct store *store, const struct store_protocol *protocol,
                                      int64_t *out_id, struct store_error *error)
{
    struct sql_value id = {0};
    bool found = false;
    enum store_result result = sql_get(
        store, SQL_FIND_PROTOCOL, (struct sql_value[]){sql_text(protocol->sha256)}, 1, &id, 1, &found, error);
    *out_id = id.integer;
    if (result != STORE_OK || found)
        return result;
    const struct sql_value values[] = {sql_text(protocol->name), sql_text(protocol->sha256),
                                       sql_text(protocol->text)};
    return sql_run(store, SQL_INSERT_PROTOCOL, values, countof(values), out_id, error);
}

static enum store_result add_participant(struct store *store, const struct store_participant *participant,
                                         bool again, int64_t *out_id, struct store_error *error)
{
    const struct sql_value key[] = {sql_text(participant->code), sql_text(participant->kind)};
    struct sql_value columns[4] = {{0}}; // id, number, same kind, has a session
    bool found = false;
    enum store_result result =
        sql_get(store, SQL_FIND_PARTICIPANT, key, countof(key), columns, countof(columns), &found, error);
    if (result != STORE_OK)
        return result;
    if (!found) {
        const struct sql_value values[] = {sql_integer(participant->number), sql_text(participant->code),
                                           sql_text(participant->kind), sql_json(participant->attributes)};
        return sql_run(store, SQL_INSERT_PARTICIPANT, values, countof(values), out_id, error);
    }
    *out_id = columns[0].integer;
    if (columns[2].integer != 1)
        sql_say(error,
                "%s: participant %s is not of kind %s; simulated observers and people never share a study file",
                store->path, participant->code, participant->kind);
    else if (columns[1].integer != participant->number)
        sql_say(error, "%s: participant %s has the number %lld, not %lld; use that one", store->path,
                participant->code, (long long)columns[1].integer, (long long)participant->number);
    else if (columns[3].integer && !again)
        sql_say(error, "%s: participant %s has a session already in this file; give another code", store->path,
                participant->code);
    else
        return STORE_OK;
    return STORE_REFUSED;
}

static enum store_result insert_segment(struct store *store, int64_t session_id,
                                        const struct store_segment *segment, int64_t *out_id,
                                        struct store_error *error)
{
    const struct sql_value values[] = {
        sql_id(session_id),       sql_text(segment->started_at), sql_integer(segment->mono_origin_ns),
        sql_text(segment->clock), sql_text(segment->boot_id),    sql_text(segment->app_version),
        sql_text(segment->reason)};
    return sql_run(store, SQL_INSERT_SEGMENT, values, countof(values), out_id, error);
}

static enum store_result insert_condition(struct store *store, const struct store_condition *condition,
                                          int64_t *out_id, struct store_error *error)
{
    const struct sql_value values[] = {sql_text(condition->mode), sql_text(condition->parameters)};
    struct sql_value id = {0};
    bool found = false;
    enum store_result result =
        sql_get(store, SQL_FIND_CONDITION, values, countof(values), &id, 1, &found, error);
    *out_id = id.integer;
    if (result != STORE_OK || found)
        return result;
    return sql_run(store, SQL_INSERT_CONDITION, values, countof(values), out_id, error);
}

static enum store_result insert_trial(struct store *store, int64_t session_id, const struct store_trial *trial,
                                      int64_t option_a_id, int64_t option_b_id, int64_t *out_id,
                                      struct store_error *error)
{
    const struct sql_value values[] = {
        sql_id(session_id),         sql_integer(trial->ordinal),  sql_text(trial->block),
        sql_text(trial->kind),      sql_text(trial->scene),       sql_json(trial->settings),
        sql_json(trial->factors),   sql_id(option_a_id),          sql_id(option_b_id),
        sql_slot(trial->test_slot), sql_slot(trial->first_shown), sql_text(trial->fixation),
        sql_seed(trial->seed),      sql_id(trial->repeat_of)};
    return sql_run(store, SQL_INSERT_TRIAL, values, countof(values), out_id, error);
}

// Not known as 0 in the desc is NULL in the table.
static struct sql_value positive(double value)
{
    return sql_real(value == 0 ? NAN : value);
}

static enum store_result insert_session(struct store *store, const struct store_session *session,
                                        const struct store_session_ids *ids, int64_t *out_id,
                                        struct store_error *error)
{
    const struct sql_value values[] = {
        sql_id(ids->protocol_id),      sql_id(ids->participant_id),   sql_seed(session->seed),
        sql_text(session->started_at), sql_text(session->consent_at), sql_text(session->consent_version),
        sql_text(session->device),     sql_text(session->driver),     sql_text(session->display),
        positive(session->refresh_hz), sql_id(session->width_px),     sql_id(session->height_px),
        positive(session->fov_deg),    sql_json(session->settings)};
    return sql_run(store, SQL_INSERT_SESSION, values, countof(values), out_id, error);
}

static enum store_result option_id(struct store *store, const struct store_session *session, int32_t index,
                                   int64_t ordinal, int64_t *out_id, struct store_error *error)
{
    *out_id = 0;
    if (index == -1)
        return STORE_OK;
    if (index >= 0 && (uint32_t)index < session->condition_count)
        return insert_condition(store, &session->conditions[index], out_id, error);
    sql_say(error, "%s: trial %lld names the condition %d of %u", store->path, (long long)ordinal, index,
            session->condition_count);
    return STORE_REFUSED;
}

static enum store_result insert_plan(struct store *store, const struct store_session *session,
                                     struct store_session_ids *out_ids, struct store_error *error)
{
    enum store_result result = STORE_OK;
    for (uint32_t i = 0; result == STORE_OK && i < session->condition_count; i++) {
        int64_t id = 0;
        result = insert_condition(store, &session->conditions[i], &id, error);
        if (out_ids->condition_ids)
            out_ids->condition_ids[i] = id;
    }
    for (uint32_t i = 0; result == STORE_OK && i < session->trial_count; i++) {
        const struct store_trial *trial = &session->trials[i];
        int64_t id = 0, option_a = 0, option_b = 0;
        result = option_id(store, session, trial->option_a, trial->ordinal, &option_a, error);
        if (result == STORE_OK)
            result = option_id(store, session, trial->option_b, trial->ordinal, &option_b, error);
        if (result == STORE_OK)
            result = insert_trial(store, out_ids->session_id, trial, option_a, option_b, &id, error);
        if (out_ids->trial_ids)
            out_ids->trial_ids[i] = id;
    }
    return result;
}

enum store_result store_create_session(struct store *store, const struct store_session *session,
                                       struct store_session_ids *out_ids, struct store_error *error)
{
    enum store_result result = sql_begin(store, error);
    if (result == STORE_OK)
        result = check_seed(store, session->seed, session->protocol.name, error);
    if (result == STORE_OK)
        result = add_protocol(store, &session->protocol, &out_ids->protocol_id, error);
    if (result == STORE_OK)
        result = add_participant(store, &session->participant, session->again, &out_ids->participant_id, error);
    if (result == STORE_OK)
        result = insert_session(store, session, out_ids, &out_ids->session_id, error);
    if (result == STORE_OK)
        result = insert_segment(store, out_ids->session_id, &session->segment, &out_ids->segment_id, error);
    if (result == STORE_OK)
        result = insert_plan(store, session, out_ids, error);
    return sql_end(store, result, error);
}

enum store_result store_resume_session(struct store *store, int64_t session_id,
                                       const struct store_segment *segment, const char *gap_detail,
                                       int64_t *out_segment_id, struct store_error *error)
{
    enum store_result result = sql_begin(store, error);
    if (result == STORE_OK)
        result = insert_segment(store, session_id, segment, out_segment_id, error);
    if (result == STORE_OK) {
        struct sql_value values[ROWS_EVENT_COLUMNS];
        struct store_event gap = {.session_id = session_id, .segment_id = *out_segment_id};
        rows_event(&gap, "gap", gap_detail, values);
        result = sql_run(store, SQL_INSERT_EVENT, values, countof(values), NULL, error);
    }
    return sql_end(store, result, error);
}

enum store_result store_add_segment(struct store *store, int64_t session_id,
                                    const struct store_segment *segment, int64_t *out_id,
                                    struct store_error *error)
{
    enum store_result result = sql_begin(store, error);
    if (result == STORE_OK)
        result = insert_segment(store, session_id, segment, out_id, error);
    return sql_end(store, result, error);
}

enum store_result store_add_trial(struct store *store, int64_t session_id, const struct store_trial *trial,
                                  int64_t option_a_id, int64_t option_b_id, int64_t *out_id,
                                  struct store_error *error)
{
    enum store_result result = sql_begin(store, error);
    if (result == STORE_OK)
        result = insert_trial(store, session_id, trial, option_a_id, option_b_id, out_id, error);
    return sql_end(store, result, error);
}

enum store_result store_add_condition(struct store *store, const struct store_condition *condition,
                                      int64_t *out_id, struct store_error *error)
{
    enum store_result result = sql_begin(store, error);
    if (result == STORE_OK)
        result = insert_condition(store, condition, out_id, error);
    return sql_end(store, result, error);
}

// An UPDATE that met no row.
static enum store_result nothing_changed(struct store *store, const char *what, int64_t id,
                                         struct store_error *error)
{
    if (sqlite3_changes(store->db) > 0)
        return STORE_OK;
    sql_say(error, "%s: session %lld %s", store->path, (long long)id, what);
    return STORE_REFUSED;
}

enum store_result store_set_consent(struct store *store, int64_t session_id, const char *consent_at,
                                    const char *consent_version, struct store_error *error)
{
    const struct sql_value values[] = {sql_id(session_id), sql_text(consent_at), sql_text(consent_version)};
    enum store_result result = sql_begin(store, error);
    if (result == STORE_OK)
        result = sql_run(store, SQL_SET_CONSENT, values, countof(values), NULL, error);
    if (result == STORE_OK)
        result = nothing_changed(store, "does not exist", session_id, error);
    return sql_end(store, result, error);
}

enum store_result store_end_session(struct store *store, int64_t session_id, const char *status,
                                    const char *ended_at, int64_t ended_ns, struct store_error *error)
{
    const struct sql_value values[] = {sql_id(session_id), sql_text(status), sql_text(ended_at)};
    const struct sql_value trial[] = {sql_id(session_id), sql_integer(ended_ns)};
    enum store_result result = sql_begin(store, error);
    if (result == STORE_OK)
        result = sql_run(store, SQL_END_SESSION, values, countof(values), NULL, error);
    if (result == STORE_OK)
        result = nothing_changed(store, "is not running", session_id, error);
    if (result == STORE_OK)
        result = sql_run(store, SQL_SKIP_RUNNING, trial, countof(trial), NULL, error);
    return sql_end(store, result, error);
}
