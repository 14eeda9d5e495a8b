#include "studies/store/resume.h"

#include "studies/store/sql.h"

#include <stdlib.h>
#include <string.h>

// The columns stand in the order of enum column.
static const char session_query[] =
    "SELECT s.id, s.participant_id, s.protocol_id, p.number, s.seed, p.kind = 'simulated', s.refresh_hz, "
    "s.fov_deg, s.settings ->> '$.step_hz', s.width_px, s.height_px, "
    "(SELECT count(*) FROM segment WHERE session_id = s.id), "
    "g.mono_origin_ns + max("
    "coalesce((SELECT start_ns FROM frame WHERE id = (SELECT max(id) FROM frame) AND segment_id = g.id), 0), "
    "coalesce((SELECT at_ns FROM event WHERE id = (SELECT max(id) FROM event) AND segment_id = g.id), 0), "
    "coalesce((SELECT max(max(coalesce(started_ns, 0), coalesce(ended_ns, 0))) FROM trial "
    "WHERE session_id = s.id AND segment_id = g.id), 0)), "
    "s.status, p.code, p.attributes, s.started_at, s.consent_at, r.name, r.text, s.device, s.display, "
    "s.settings ->> '$.gaze', "
    "(SELECT 'sim:' || group_concat(key || '=' || (s.settings -> ('$.observer.' || key))) "
    "FROM json_each(s.settings, '$.observer')), "
    "s.settings ->> '$.errors_file', s.settings ->> '$.protocol_file', g.boot_id "
    "FROM session AS s JOIN participant AS p ON p.id = s.participant_id JOIN protocol AS r ON r.id = "
    "s.protocol_id "
    "LEFT JOIN segment AS g ON g.id = (SELECT max(id) FROM segment WHERE session_id = s.id) "
    "WHERE s.id = CASE ?1 WHEN 0 THEN "
    "coalesce((SELECT max(id) FROM session WHERE status = 'running'), (SELECT max(id) FROM session)) ELSE ?1 "
    "END";

static const char scenes_query[] =
    "SELECT e.key, e.value FROM session AS s, json_each(s.settings, '$.scenes') AS e WHERE s.id = ?1";

static const char planned_query[] =
    "SELECT t.id, t.ordinal, t.attempt, t.repeat_of, t.option_a, t.option_b, t.seed, t.block, t.kind, t.scene, "
    "t.settings, t.factors, t.test_slot, t.first_shown, t.fixation, t.status, a.mode, a.parameters, b.mode, "
    "b.parameters, (SELECT count(*) FROM choice AS c WHERE c.trial_id = t.id), "
    "(SELECT count(*) FROM rating AS r WHERE r.trial_id = t.id), "
    "(SELECT count(*) FROM response AS r WHERE r.trial_id = t.id), "
    "coalesce((SELECT outcome FROM staircase_step AS s WHERE s.trial_id = t.id), -1) FROM trial AS t LEFT JOIN "
    "condition AS a ON a.id = t.option_a "
    "LEFT JOIN condition AS b ON b.id = t.option_b WHERE t.session_id = ?1 ORDER BY t.ordinal";

static const char *text(sqlite3_stmt *row, int column)
{
    const unsigned char *value = sqlite3_column_text(row, column);
    return value ? (const char *)value : "";
}

static bool fill_start(sqlite3_stmt *row, struct store_session_start *out)
{
    char **const texts[] = {&out->status,        &out->code,          &out->attributes,    &out->started_at,
                            &out->consent_at,    &out->protocol_name, &out->protocol_text, &out->device,
                            &out->display,       &out->gaze,          &out->observer,      &out->errors_file,
                            &out->protocol_file, &out->last_boot_id};
    enum { NUMBERS = 13 };
    out->session_id = sqlite3_column_int64(row, 0);
    out->participant_id = sqlite3_column_int64(row, 1);
    out->protocol_id = sqlite3_column_int64(row, 2);
    out->number = sqlite3_column_int64(row, 3);
    out->seed = (uint64_t)sqlite3_column_int64(row, 4);
    out->simulated = sqlite3_column_int(row, 5) != 0;
    out->refresh_hz = sqlite3_column_double(row, 6);
    out->fov_deg = sqlite3_column_double(row, 7);
    out->step_hz = sqlite3_column_double(row, 8);
    out->width_px = sqlite3_column_int64(row, 9);
    out->height_px = sqlite3_column_int64(row, 10);
    out->segments = sqlite3_column_int64(row, 11);
    out->last_clock_ns = sqlite3_column_int64(row, 12);
    for (size_t i = 0; i < countof(texts); i++) {
        *texts[i] = strdup(text(row, NUMBERS + (int)i));
        if (!*texts[i])
            return false;
    }
    return true;
}

static bool fill_scene(sqlite3_stmt *row, struct store_session_start *out)
{
    if (out->scene_count == STORE_SCENES)
        return true;
    struct store_bound_scene *scene = &out->scenes[out->scene_count++];
    scene->name = strdup(text(row, 0));
    scene->spec = strdup(text(row, 1));
    return scene->name && scene->spec;
}

// Prepares, binds `id`, and hands out the statement; NULL after a sentence.
static sqlite3_stmt *begin(struct store *store, const char *sql, int64_t id, struct store_error *error)
{
    sqlite3_stmt *statement = NULL;
    if (sqlite3_prepare_v2(store->db, sql, -1, &statement, NULL) == SQLITE_OK &&
        sqlite3_bind_int64(statement, 1, id) == SQLITE_OK)
        return statement;
    sql_failure(store, sqlite3_extended_errcode(store->db), error);
    sqlite3_finalize(statement);
    return NULL;
}

typedef bool (*fill_fn)(sqlite3_stmt *row, struct store_session_start *out);

static enum store_result read_start(struct store *store, const char *sql, int64_t id, fill_fn fill,
                                    struct store_session_start *out, struct store_error *error)
{
    sqlite3_stmt *statement = begin(store, sql, id, error);
    if (!statement)
        return STORE_FAILED;
    enum store_result result = STORE_OK;
    int code;
    while (result == STORE_OK && (code = sqlite3_step(statement)) != SQLITE_DONE) {
        if (code != SQLITE_ROW) {
            result = sql_failure(store, sqlite3_extended_errcode(store->db), error);
        } else if (!fill(statement, out)) {
            sql_say(error, "out of memory");
            result = STORE_FAILED;
        }
    }
    sqlite3_finalize(statement);
    return result;
}

enum store_result store_find_session(struct store *store, int64_t wanted, struct store_session_start *out,
                                     struct store_error *error)
{
    *out = (struct store_session_start){0};
    sql_say(error, "%s", "");
    pthread_mutex_lock(&store->mutex);
    enum store_result result = read_start(store, session_query, wanted, fill_start, out, error);
    if (result == STORE_OK && out->session_id)
        result = read_start(store, scenes_query, out->session_id, fill_scene, out, error);
    pthread_mutex_unlock(&store->mutex);
    if (result != STORE_OK)
        store_session_start_finish(out);
    return result;
}

void store_session_start_finish(struct store_session_start *start)
{
    char *const texts[] = {start->status,        start->code,          start->attributes,    start->started_at,
                           start->consent_at,    start->protocol_name, start->protocol_text, start->device,
                           start->display,       start->gaze,          start->observer,      start->errors_file,
                           start->protocol_file, start->last_boot_id};
    for (size_t i = 0; i < countof(texts); i++)
        free(texts[i]);
    for (size_t i = 0; i < start->scene_count; i++) {
        free(start->scenes[i].name);
        free(start->scenes[i].spec);
    }
    *start = (struct store_session_start){0};
}

static struct store_planned planned_row(sqlite3_stmt *row)
{
    return (struct store_planned){
        .id = sqlite3_column_int64(row, 0),
        .ordinal = sqlite3_column_int64(row, 1),
        .attempt = sqlite3_column_int64(row, 2),
        .repeat_of = sqlite3_column_int64(row, 3),
        .option_a = sqlite3_column_int64(row, 4),
        .option_b = sqlite3_column_int64(row, 5),
        .seed = (uint64_t)sqlite3_column_int64(row, 6),
        .block = text(row, 7),
        .kind = text(row, 8),
        .scene = text(row, 9),
        .settings = text(row, 10),
        .factors = text(row, 11),
        .test_slot = text(row, 12),
        .first_shown = text(row, 13),
        .fixation = text(row, 14),
        .status = text(row, 15),
        .mode_a = text(row, 16),
        .parameters_a = text(row, 17),
        .mode_b = text(row, 18),
        .parameters_b = text(row, 19),
        .choices = sqlite3_column_int64(row, 20),
        .ratings = sqlite3_column_int64(row, 21),
        .responses = sqlite3_column_int64(row, 22),
        .outcome = sqlite3_column_int64(row, 23),
    };
}

enum store_result store_read_planned(struct store *store, int64_t session_id, store_planned_fn each, void *user,
                                     struct store_error *error)
{
    sql_say(error, "%s", "");
    pthread_mutex_lock(&store->mutex);
    sqlite3_stmt *statement = begin(store, planned_query, session_id, error);
    enum store_result result = statement ? STORE_OK : STORE_FAILED;
    int code = SQLITE_DONE;
    while (statement && (code = sqlite3_step(statement)) == SQLITE_ROW) {
        struct store_planned trial = planned_row(statement);
        if (!each(user, &trial))
            break;
    }
    if (statement && code != SQLITE_ROW && code != SQLITE_DONE)
        result = sql_failure(store, sqlite3_extended_errcode(store->db), error);
    sqlite3_finalize(statement);
    pthread_mutex_unlock(&store->mutex);
    return result;
}

enum store_result store_count_sessions(struct store *store, const char *code, int64_t *out_count,
                                       int64_t *out_unfinished, struct store_error *error)
{
    struct sql_value columns[2] = {{0}};
    bool found = false;
    sql_say(error, "%s", "");
    pthread_mutex_lock(&store->mutex);
    enum store_result result =
        sql_get(store, SQL_COUNT_SESSIONS, (struct sql_value[]){sql_text(code)}, 1, columns, 2, &found, error);
    pthread_mutex_unlock(&store->mutex);
    *out_count = columns[0].integer;
    *out_unfinished = columns[1].integer;
    return result;
}
