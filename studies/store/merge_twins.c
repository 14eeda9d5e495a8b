// Which sessions of an input the output has already, and whose copy goes on further.
#include "studies/store/merge_private.h"
#include "studies/store/sitting.h"

#include <stdio.h>
#include <string.h>

#define SITTINGS(schema)                                                                                       \
    "SELECT s.id AS id, " SITTING(schema) " AS sitting FROM " schema ".session AS s JOIN " schema              \
                                          ".protocol AS o ON o.id = s.protocol_id JOIN " schema                \
                                          ".participant AS p ON p.id = s.participant_id"
static const char find_twins[] =
    "WITH here AS MATERIALIZED (" SITTINGS("src") "), there AS MATERIALIZED (" SITTINGS(
        "main") ") INSERT INTO temp.twin SELECT here.id, there.id FROM "
                "here JOIN there USING (sitting)";
#undef SITTINGS

// What grows at its end while a session goes on, without ids: the shorter copy must be the beginning of the
// longer. %s is the schema; ?1 the session.
#define TRIAL_ROWS(columns, table)                                                                             \
    "SELECT t.ordinal, " columns " FROM %s." table " AS x JOIN %s.trial AS t ON t.id = x.trial_id WHERE "      \
    "t.session_id = ?1 ORDER BY x.id"
static const struct {
    const char *name, *sql;
} logs[] = {
    {"trial",
     "SELECT ordinal, block, kind, scene, settings, factors, test_slot, first_shown, fixation, seed FROM "
     "%s.trial WHERE session_id = ?1 ORDER BY ordinal"},
    {"segment",
     "SELECT started_at, mono_origin_ns, clock, boot_id FROM %s.segment WHERE session_id = ?1 ORDER BY id"},
    {"choice", TRIAL_ROWS("chosen, correct, reaction_ns, answered_ns, toggles", "choice")},
    {"rating",
     "SELECT t.ordinal, question, subject, value, scale_min, scale_max, answered_ns FROM %s.rating AS x "
     "LEFT JOIN %s.trial AS t ON t.id = x.trial_id WHERE x.session_id = ?1 OR t.session_id = ?1 ORDER BY "
     "x.id"},
    {"response", TRIAL_ROWS("question, value, expected, answered_ns, device", "response")},
    {"adjust_step", TRIAL_ROWS("at_ns, parameter, value", "adjust_step")},
    {"staircase_step", TRIAL_ROWS("level, outcome, reversal, estimate", "staircase_step")},
    {"exposure", TRIAL_ROWS("x.attempt, option, start_ns, end_ns, full_start_ns, full_end_ns", "exposure")},
    {"gaze", "SELECT device_ns, host_ns, eye, x_deg, y_deg, pupil_mm, valid, confidence FROM %s.gaze WHERE "
             "session_id = ?1 ORDER BY id"},
    {"gaze_check", "SELECT at_ns, block, x_deg, y_deg, eye, accuracy_deg, rms_s2s_deg, sd_deg, loss, passed "
                   "FROM %s.gaze_check WHERE session_id = "
                   "?1 ORDER BY id"},
    {"frame",
     "SELECT number, option, phase, fade_level, start_ns, present_ns, late, fovea, effective FROM %s.frame "
     "WHERE session_id = ?1 ORDER BY id"},
    {"event",
     "SELECT at_ns, kind, detail FROM %s.event WHERE session_id = ?1 AND kind <> 'merged' ORDER BY id"},
    {"exclusion",
     "SELECT t.ordinal, rule, rule_set, reason, applied_at FROM %s.exclusion AS x LEFT JOIN %s.trial AS "
     "t ON t.id = x.trial_id WHERE x.session_id = ?1 OR t.session_id = ?1 ORDER BY x.id"},
};

static sqlite3_stmt *prepare(struct merging *m, const char *format, const char *schema, int64_t session)
{
    sqlite3_stmt *statement = NULL;
    char *sql = sqlite3_mprintf(format, schema, schema);
    if (sql && sqlite3_prepare_v2(m->db, sql, -1, &statement, NULL) == SQLITE_OK)
        sqlite3_bind_int64(statement, 1, session);
    sqlite3_free(sql);
    return statement;
}

static bool same_value(sqlite3_stmt *a, sqlite3_stmt *b, int column)
{
    int type = sqlite3_column_type(a, column);
    if (type != sqlite3_column_type(b, column))
        return false;
    if (type == SQLITE_INTEGER)
        return sqlite3_column_int64(a, column) == sqlite3_column_int64(b, column);
    if (type == SQLITE_FLOAT)
        return sqlite3_column_double(a, column) == sqlite3_column_double(b, column);
    if (type == SQLITE_NULL)
        return true;
    return strcmp((const char *)sqlite3_column_text(a, column), (const char *)sqlite3_column_text(b, column)) ==
           0;
}

static enum further compare(struct merging *m, const char *format, int64_t src, int64_t main_id)
{
    sqlite3_stmt *a = prepare(m, format, "main", main_id), *b = prepare(m, format, "src", src);
    enum further result = a && b ? FURTHER_NONE : FURTHER_ERROR;
    while (result == FURTHER_NONE) {
        int x = sqlite3_step(a), y = sqlite3_step(b);
        if ((x != SQLITE_ROW && x != SQLITE_DONE) || (y != SQLITE_ROW && y != SQLITE_DONE))
            result = FURTHER_ERROR;
        else if (x != y)
            result = x == SQLITE_ROW ? FURTHER_MAIN : FURTHER_SRC;
        else if (x == SQLITE_DONE)
            break;
        for (int i = 0; result == FURTHER_NONE && i < sqlite3_column_count(a); i++)
            if (!same_value(a, b, i))
                result = FURTHER_APART;
    }
    sqlite3_finalize(a);
    sqlite3_finalize(b);
    return result;
}

static bool judge(struct merging *m, int64_t src, int64_t main_id, struct merge_verdict *out)
{
    if (!merge_progress(m, src, main_id, out))
        return false;
    for (size_t i = 0; out->further != FURTHER_APART && i < sizeof logs / sizeof logs[0]; i++) {
        enum further here = compare(m, logs[i].sql, src, main_id);
        if (here == FURTHER_ERROR)
            return merge_fail_sqlite(m);
        if (here != FURTHER_NONE)
            snprintf(out->table, sizeof out->table, "%s", logs[i].name);
        out->further = merge_further(out->further, here);
    }
    return true;
}

// What refers to a row goes before it.
static bool drop_session(struct merging *m, int64_t session)
{
#define TRIALS "(SELECT id FROM main.trial WHERE session_id = %lld)"
    static const char *const steps[] = {
        "DELETE FROM main.exclusion WHERE session_id = %lld OR trial_id IN " TRIALS,
        "DELETE FROM main.rating WHERE session_id = %lld OR trial_id IN " TRIALS,
        "DELETE FROM main.choice WHERE trial_id IN " TRIALS,
        "DELETE FROM main.response WHERE trial_id IN " TRIALS,
        "DELETE FROM main.adjust_step WHERE trial_id IN " TRIALS,
        "DELETE FROM main.staircase_step WHERE trial_id IN " TRIALS,
        "DELETE FROM main.exposure WHERE trial_id IN " TRIALS,
        "DELETE FROM main.event WHERE session_id = %lld",
        "DELETE FROM main.frame WHERE session_id = %lld",
        "DELETE FROM main.gaze WHERE session_id = %lld",
        "DELETE FROM main.gaze_check WHERE session_id = %lld",
        "DELETE FROM main.trial WHERE session_id = %lld",
        "DELETE FROM main.segment WHERE session_id = %lld",
    };
#undef TRIALS
    bool ok = true;
    for (size_t i = 0; ok && i < sizeof steps / sizeof steps[0]; i++) {
        char *sql = sqlite3_mprintf(steps[i], (long long)session, (long long)session);
        ok = sql ? merge_run(m, sql) : merge_fail(m, "not enough memory");
        sqlite3_free(sql);
    }
    return ok;
}

static void say_once(struct merging *m, const struct merge_verdict *v, int64_t src, const char *code)
{
    char invalid[96] = "";
    if (v->invalid)
        snprintf(invalid, sizeof invalid, "; trial %lld of its order is invalid there and done in the other",
                 (long long)v->invalid);
    merge_say(m, "%s: session %lld of participant %s is in several files; counted once%s%s", m->input->path,
              (long long)src, code,
              v->further == FURTHER_SRC    ? ", as this file has it, which goes on further"
              : v->further == FURTHER_MAIN ? ", as the other file has it, which goes on further"
                                           : "",
              invalid);
}

static bool settle(struct merging *m, int64_t src, int64_t main_id, const char *code)
{
    struct merge_verdict verdict = {.further = FURTHER_NONE};
    if (!judge(m, src, main_id, &verdict))
        return false;
    enum further further = verdict.further;
    if (further == FURTHER_APART)
        return merge_fail(
            m,
            "%s: session %lld of participant %s is a copy of one in another file, but both went on "
            "differently (table %s); give the one that holds what happened",
            m->input->path, (long long)src, code, verdict.table);
    say_once(m, &verdict, src, code);
    m->twice++;
    char sql[64];
    if (further != FURTHER_SRC) {
        snprintf(sql, sizeof sql, "DELETE FROM temp.take WHERE id = %lld", (long long)src);
        return merge_run(m, sql);
    }
    snprintf(sql, sizeof sql, "INSERT INTO temp.replaced VALUES (%lld)", (long long)main_id);
    return merge_run(m, sql) && drop_session(m, main_id);
}

static bool refuse_forgotten(struct merging *m, sqlite3_stmt *row)
{
    return merge_fail(
        m,
        "%s: participant number %s was erased from one of two copies of a study and is still in the "
        "other; erase them there too (fovstudy forget), then merge",
        m->input->path, sqlite3_column_text(row, 0));
}

bool merge_choose(struct merging *m)
{
    // Only between copies: another laboratory's number is another person's.
    static const char forgotten[] =
        "SELECT a.number FROM src.participant AS a JOIN main.participant AS b USING (number) WHERE EXISTS "
        "(SELECT 1 "
        "FROM temp.twin) AND EXISTS (SELECT 1 FROM src.exclusion WHERE participant_id = a.id AND rule = "
        "'forgotten') "
        "<> EXISTS (SELECT 1 FROM main.exclusion WHERE participant_id = b.id AND rule = 'forgotten')";
    if (!merge_run(m, "DELETE FROM temp.take") || !merge_run(m, "DELETE FROM temp.twin") ||
        !merge_run(m, "DELETE FROM temp.replaced") ||
        !merge_run(m, "INSERT INTO temp.take SELECT id FROM src.session") || !merge_run(m, find_twins) ||
        !merge_none(m, forgotten, refuse_forgotten))
        return false;
    static const char sql[] =
        "SELECT twin.src, twin.main, p.code FROM temp.twin JOIN src.session AS s ON s.id = "
        "twin.src JOIN src.participant AS p ON p.id = s.participant_id ORDER BY twin.src";
    sqlite3_stmt *statement = NULL;
    bool ok = sqlite3_prepare_v2(m->db, sql, -1, &statement, NULL) == SQLITE_OK || merge_fail_sqlite(m);
    int code = SQLITE_DONE;
    while (ok && (code = sqlite3_step(statement)) == SQLITE_ROW)
        ok = settle(m, sqlite3_column_int64(statement, 0), sqlite3_column_int64(statement, 1),
                    (const char *)sqlite3_column_text(statement, 2));
    if (ok && code != SQLITE_DONE)
        ok = merge_fail_sqlite(m);
    sqlite3_finalize(statement);
    return ok;
}
