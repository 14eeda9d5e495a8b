// What of a session changes in place while it goes on: its status and its trials', which of two copies is
// further on, and what they contradict each other in.
#include "studies/store/merge_private.h"

#include <stdio.h>

// How far a trial is: an attempt may follow one that did not end; done becomes invalid where it is flagged
// after its answer.
#define TRIALS(schema, session)                                                                                \
    "SELECT t.ordinal, t.attempt, t.status, CASE t.status WHEN 'planned' THEN 0 WHEN 'running' THEN 1 WHEN "   \
    "'invalid' THEN 3 ELSE 2 END AS stage, json_array(t.status, t.started_ns, t.ended_ns, (SELECT count(*) "   \
    "FROM " schema                                                                                             \
    ".segment AS g WHERE g.session_id = t.session_id AND g.id <= t.segment_id), a.mode, a.parameters, "        \
    "b.mode, b.parameters) AS told FROM " schema ".trial AS t LEFT JOIN " schema                               \
    ".condition AS a ON a.id = t.option_a LEFT JOIN " schema                                                   \
    ".condition AS b ON b.id = t.option_b WHERE t.session_id = " session
#define SESSION(schema, session)                                                                               \
    "SELECT s.*, s.status <> 'running' AS ended, json_array(s.device, s.driver, s.display, s.refresh_hz, "     \
    "s.width_px, s.height_px, s.fov_deg, s.settings) AS fixed FROM " schema                                    \
    ".session AS s WHERE s.id = " session

// x, p: the output's trials and session, ?2; y, q: the input's, ?1.
#define COPIES                                                                                                 \
    "WITH x AS (" TRIALS("main", "?2") "), y AS (" TRIALS("src", "?1") "), p AS (" SESSION(                    \
        "main", "?2") "), q AS (" SESSION("src", "?1") ") "

// `further`: 1 the output's copy, -1 the input's, 0 neither, NULL both went on differently.
static const char sql[] = COPIES
    "SELECT CASE WHEN p.fixed <> q.fixed THEN NULL"
    " WHEN p.ended <> q.ended THEN p.ended - q.ended"
    " WHEN p.status = q.status AND p.ended_at IS q.ended_at THEN 0 END AS further,"
    " 'session' AS what, 0 AS invalid FROM p, q "
    "UNION ALL SELECT CASE WHEN p.consent_at IS q.consent_at AND p.consent_version IS q.consent_version THEN 0"
    " WHEN q.consent_at IS NULL THEN 1 WHEN p.consent_at IS NULL THEN -1 END, 'session', 0 FROM p, q "
    "UNION ALL SELECT CASE WHEN x.attempt > y.attempt THEN iif(y.stage < 2, 1, NULL)"
    " WHEN x.attempt < y.attempt THEN iif(x.stage < 2, -1, NULL)"
    " WHEN x.stage <> y.stage THEN iif(x.stage > y.stage, 1, -1)"
    " WHEN x.stage = 0 OR x.told = y.told THEN 0 END, 'trial',"
    " iif(x.status <> y.status AND 'done' IN (x.status, y.status) AND 'invalid' IN (x.status, y.status),"
    " x.ordinal, 0) FROM x JOIN y USING (ordinal)";

enum further merge_further(enum further a, enum further b)
{
    if (a == FURTHER_NONE || a == b)
        return b;
    return b == FURTHER_NONE ? a : FURTHER_APART;
}

static enum further further_of(sqlite3_stmt *row)
{
    if (sqlite3_column_type(row, 0) == SQLITE_NULL)
        return FURTHER_APART;
    int further = sqlite3_column_int(row, 0);
    return further > 0 ? FURTHER_MAIN : further < 0 ? FURTHER_SRC : FURTHER_NONE;
}

bool merge_progress(struct merging *m, int64_t src, int64_t main_id, struct merge_verdict *out)
{
    sqlite3_stmt *row = NULL;
    int code = sqlite3_prepare_v2(m->db, sql, -1, &row, NULL);
    if (code == SQLITE_OK) {
        sqlite3_bind_int64(row, 1, src);
        sqlite3_bind_int64(row, 2, main_id);
    }
    while ((code == SQLITE_OK || code == SQLITE_ROW) && out->further != FURTHER_APART &&
           (code = sqlite3_step(row)) == SQLITE_ROW) {
        enum further here = further_of(row);
        out->further = merge_further(out->further, here);
        if (here != FURTHER_NONE)
            snprintf(out->table, sizeof out->table, "%s", (const char *)sqlite3_column_text(row, 1));
        if (sqlite3_column_int64(row, 2))
            out->invalid = sqlite3_column_int64(row, 2);
    }
    bool ok = code == SQLITE_DONE || code == SQLITE_ROW || merge_fail_sqlite(m);
    sqlite3_finalize(row);
    return ok;
}
