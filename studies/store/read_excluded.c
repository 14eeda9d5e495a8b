// What is out already and who lacks which rules: the short queries of facts.h.
#include "studies/store/facts.h"

#include "studies/store/read_private.h"

struct call {
    void *user;
    store_protocol_fn protocol;
    store_ruled_fn ruled;
    store_excluded_fn excluded;
};

static const char *text(sqlite3_stmt *statement, int column)
{
    const unsigned char *value = sqlite3_column_text(statement, column);
    return value ? (const char *)value : "";
}

static bool protocol_row(sqlite3_stmt *s, const struct call *call)
{
    struct store_protocol_row row = {
        .id = sqlite3_column_int64(s, 0),
        .name = text(s, 1),
        .sha256 = text(s, 2),
        .text = text(s, 3),
        .scenes = text(s, 4),
    };
    return call->protocol(call->user, &row);
}

static bool ruled_row(sqlite3_stmt *s, const struct call *call)
{
    struct store_ruled_row row = {
        .session_id = sqlite3_column_int64(s, 0),
        .segment_id = sqlite3_column_int64(s, 1),
        .participant_id = sqlite3_column_int64(s, 2),
        .protocol_id = sqlite3_column_int64(s, 3),
        .code = text(s, 4),
        .status = text(s, 5),
        .ruled = sqlite3_column_int(s, 6),
    };
    return call->ruled(call->user, &row);
}

static bool excluded_row(sqlite3_stmt *s, const struct call *call)
{
    struct store_excluded_row row = {
        .trial_id = sqlite3_column_int64(s, 0),
        .session_id = sqlite3_column_int64(s, 1),
        .participant_id = sqlite3_column_int64(s, 2),
        .ordinal = sqlite3_column_int64(s, 3),
        .code = text(s, 4),
        .rule = text(s, 5),
        .rule_set = text(s, 6),
        .reason = text(s, 7),
        .by = text(s, 8),
        .applied_at = text(s, 9),
    };
    return call->excluded(call->user, &row);
}

// `key` is bound as the only parameter: a text, or NULL.
static bool read_all(struct store_reader *reader, const char *sql, const char *key,
                     bool (*row)(sqlite3_stmt *, const struct call *), const struct call *call)
{
    sqlite3_stmt *statement = NULL;
    reader->error[0] = '\0';
    int code = sqlite3_prepare_v2(reader->db, sql, -1, &statement, NULL);
    bool going = code == SQLITE_OK;
    if (going && sqlite3_bind_parameter_count(statement) == 1)
        sqlite3_bind_text(statement, 1, key, -1, SQLITE_STATIC);
    while (going && (code = sqlite3_step(statement)) == SQLITE_ROW)
        going = row(statement, call);
    if (code != SQLITE_DONE && code != SQLITE_ROW) {
        store_reader_fail_sqlite(reader, code);
        going = false;
    }
    sqlite3_finalize(statement);
    return going && store_reader_unchanged(reader);
}

bool store_read_protocols(struct store_reader *reader, store_protocol_fn each, void *user)
{
    static const char sql[] =
        "SELECT p.id, p.name, p.sha256, p.text, (SELECT group_concat(DISTINCT j.key || char(10)) FROM session "
        "s,"
        " json_each(s.settings, '$.scenes') j WHERE s.protocol_id = p.id) FROM protocol p ORDER BY p.id";
    return read_all(reader, sql, NULL, protocol_row, &(struct call){.user = user, .protocol = each});
}

bool store_read_ruled(struct store_reader *reader, const char *sha256, store_ruled_fn each, void *user)
{
    static const char sql[] =
        "SELECT s.id, g.id, s.participant_id, s.protocol_id, p.code, s.status,"
        " EXISTS (SELECT 1 FROM event e WHERE e.session_id = s.id AND e.segment_id = g.id AND"
        "  e.kind = 'rules_applied' AND e.detail ->> '$.protocol' = coalesce(?1, o.sha256))"
        " FROM session s JOIN participant p ON p.id = s.participant_id JOIN protocol o ON o.id = s.protocol_id"
        " JOIN segment g ON g.id = (SELECT max(id) FROM segment WHERE session_id = s.id) ORDER BY s.id";
    return read_all(reader, sql, sha256, ruled_row, &(struct call){.user = user, .ruled = each});
}

bool store_read_excluded(struct store_reader *reader, store_excluded_fn each, void *user)
{
    static const char sql[] =
        "SELECT e.trial_id, e.session_id, e.participant_id, t.ordinal,"
        " (SELECT code FROM participant WHERE id = coalesce(e.participant_id, s.participant_id)),"
        " e.rule, e.rule_set, e.reason, e.\"by\", e.applied_at FROM exclusion e"
        " LEFT JOIN trial t ON t.id = e.trial_id"
        " LEFT JOIN session s ON s.id = coalesce(e.session_id, t.session_id) ORDER BY e.id";
    return read_all(reader, sql, NULL, excluded_row, &(struct call){.user = user, .excluded = each});
}

static int64_t find(struct store_reader *reader, const char *sql, const char *code, int64_t id)
{
    sqlite3_stmt *statement = NULL;
    int64_t found = 0;
    reader->error[0] = '\0';
    int result = sqlite3_prepare_v2(reader->db, sql, -1, &statement, NULL);
    if (result == SQLITE_OK && code)
        sqlite3_bind_text(statement, 1, code, -1, SQLITE_STATIC);
    else if (result == SQLITE_OK)
        sqlite3_bind_int64(statement, 1, id);
    if (result == SQLITE_OK)
        result = sqlite3_step(statement);
    if (result == SQLITE_ROW)
        found = sqlite3_column_int64(statement, 0);
    else if (result != SQLITE_DONE)
        store_reader_fail_sqlite(reader, result);
    sqlite3_finalize(statement);
    return found;
}

int64_t store_find_participant(struct store_reader *reader, const char *code)
{
    return find(reader, "SELECT id FROM participant WHERE code = ?1", code, 0);
}

int64_t store_find_trial(struct store_reader *reader, int64_t trial_id)
{
    return find(reader, "SELECT id FROM trial WHERE id = ?1", NULL, trial_id);
}
