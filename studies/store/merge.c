// The merge's course: each input is checked, its sessions are chosen and copied, and the whole is checked
// before it gets its name.
#include "studies/store/merge.h"

#include "schema_sql.h"
#include "studies/protocol/sha256.h"
#include "studies/store/merge_private.h"
#include "studies/store/migrate.h"
#include "studies/store/read.h"

#include <errno.h>
#include <fcntl.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

bool merge_fail(struct merging *m, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(m->error, m->error_size, format, arguments);
    va_end(arguments);
    return false;
}

// What SQLite says as one line: of a broken CHECK it quotes the schema, over several.
static void one_line(char *text)
{
    char *to = text;
    for (const char *from = text; *from; to++) {
        *to = *from == '\n' ? ' ' : *from;
        from += *from == '\n' ? strspn(from, "\n ") : 1;
    }
    *to = '\0';
}

bool merge_fail_sqlite(struct merging *m)
{
    int code = sqlite3_extended_errcode(m->db);
    const char *path = m->input ? m->input->path : m->desc->output;
    if ((code & 0xff) == SQLITE_CORRUPT || (code & 0xff) == SQLITE_NOTADB)
        return merge_fail(m, "%s: the study file is damaged; use a backup, or leave it out", path);
    bool damaged = code == SQLITE_CONSTRAINT_CHECK || code == SQLITE_CONSTRAINT_NOTNULL ||
                   code == SQLITE_CONSTRAINT_DATATYPE;
    if (damaged)
        merge_fail(m, "%s: the study file is damaged (%s); use a backup, or leave it out", path,
                   sqlite3_errmsg(m->db));
    else
        merge_fail(m, "%s: cannot be merged: %s", path, sqlite3_errmsg(m->db));
    one_line(m->error);
    return false;
}

void merge_say(struct merging *m, const char *format, ...)
{
    char text[1024];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    if (m->desc->say)
        m->desc->say(m->desc->user, text);
}

static int step_to_end(struct merging *m, sqlite3_stmt *statement)
{
    if (sqlite3_bind_parameter_count(statement) > 0)
        sqlite3_bind_int64(statement, 1, m->offset);
    int code;
    while ((code = sqlite3_step(statement)) == SQLITE_ROW)
        continue;
    return code;
}

bool merge_run(struct merging *m, const char *sql)
{
    sqlite3_stmt *statement = NULL;
    int code = sqlite3_prepare_v2(m->db, sql, -1, &statement, NULL);
    if (code == SQLITE_OK)
        code = step_to_end(m, statement);
    bool ok = code == SQLITE_DONE || merge_fail_sqlite(m);
    sqlite3_finalize(statement);
    return ok;
}

bool merge_none(struct merging *m, const char *sql, bool (*refuse)(struct merging *m, sqlite3_stmt *row))
{
    sqlite3_stmt *statement = NULL;
    int code = sqlite3_prepare_v2(m->db, sql, -1, &statement, NULL);
    if (code == SQLITE_OK)
        code = sqlite3_step(statement);
    bool ok = code == SQLITE_DONE;
    if (!ok)
        code == SQLITE_ROW ? refuse(m, statement) : merge_fail_sqlite(m);
    sqlite3_finalize(statement);
    return ok;
}

// --- what may share a file ---

static bool refuse_kinds(struct merging *m, sqlite3_stmt *row)
{
    (void)row;
    return merge_fail(m, "%s: simulated observers and people never share a study file; merge them apart",
                      m->input->path);
}

static bool refuse_protocol(struct merging *m, sqlite3_stmt *row)
{
    return merge_fail(
        m,
        "%s: its sessions are of protocol %s (hash %.12s), which the files before it do not have; one "
        "file is one study, unless --new-protocol",
        m->input->path, (const char *)sqlite3_column_text(row, 0), (const char *)sqlite3_column_text(row, 1));
}

static bool refuse_seed(struct merging *m, sqlite3_stmt *row)
{
    (void)row;
    return merge_fail(m, "%s: was run with another seed than the files before it; a study has one seed",
                      m->input->path);
}

static bool refuse_damage(struct merging *m, sqlite3_stmt *row)
{
    return merge_fail(m, "%s: the study file is damaged (%s); use a backup, or leave it out", m->input->path,
                      (const char *)sqlite3_column_text(row, 0));
}

static bool check_input(struct merging *m)
{
    static const char kinds[] =
        "SELECT 1 FROM src.participant AS a JOIN main.participant AS b ON a.kind <> b.kind LIMIT 1";
    static const char protocols[] = "SELECT o.name, o.sha256 FROM src.session AS s JOIN src.protocol AS o ON "
                                    "o.id = s.protocol_id WHERE o.sha256 "
                                    "NOT IN (SELECT sha256 FROM main.protocol JOIN main.session ON protocol_id "
                                    "= protocol.id) AND EXISTS (SELECT "
                                    "1 FROM main.session) LIMIT 1";
    static const char seeds[] =
        "SELECT 1 FROM src.session AS s JOIN src.protocol AS o ON o.id = s.protocol_id JOIN main.protocol AS q "
        "USING "
        "(sha256) JOIN main.session AS m ON m.protocol_id = q.id AND m.seed <> s.seed LIMIT 1";
    // As arguments: where they stand in a WHERE clause, SQLite checks main alone and finds no row of src.
    return merge_none(
               m,
               "SELECT trim(replace(replace(integrity_check, '*** in database src ***', ''), char(10), ' ')) "
               "FROM pragma_integrity_check(NULL, 'src') WHERE integrity_check <> 'ok'",
               refuse_damage) &&
           merge_none(m,
                      "SELECT 'table ' || \"table\" || ' refers to rows that are not there' FROM "
                      "pragma_foreign_key_check(NULL, 'src')",
                      refuse_damage) &&
           merge_none(m, kinds, refuse_kinds) &&
           (m->desc->new_protocol || merge_none(m, protocols, refuse_protocol)) &&
           merge_none(m, seeds, refuse_seed);
}

// --- one input ---

static bool hash_file(struct merging *m, char out[SHA256_HEX])
{
    int file = open(m->input->path, O_RDONLY | O_CLOEXEC);
    struct stat info;
    void *bytes = MAP_FAILED;
    if (file >= 0 && fstat(file, &info) == 0 && info.st_size > 0)
        bytes = mmap(NULL, (size_t)info.st_size, PROT_READ, MAP_PRIVATE, file, 0);
    if (file >= 0)
        close(file);
    if (bytes == MAP_FAILED)
        return merge_fail(m, "%s: cannot be read: %s", m->input->path, strerror(errno));
    uint8_t digest[SHA256_BYTES];
    sha256(bytes, (size_t)info.st_size, digest);
    sha256_hex(digest, out);
    munmap(bytes, (size_t)info.st_size);
    return true;
}

// Its time is 0 of the session's first segment: a merge has no place on that clock.
static bool note_source(struct merging *m)
{
    static const char sql[] = "INSERT INTO main.event (session_id, segment_id, at_ns, kind, detail) SELECT "
                              "s.id + ?1, (SELECT min(id) FROM "
                              "src.segment WHERE session_id = s.id) + ?1, 0, 'merged', json_object('file', ?2, "
                              "'sha256', ?3, 'session', "
                              "s.id, 'code', p.code, 'lab', ?4, 'program', 'fovstats " FOVSTUDY_VERSION
                              "') FROM src.session AS s JOIN "
                              "src.participant AS p ON p.id = s.participant_id WHERE s.id IN (SELECT id FROM "
                              "temp.take) ORDER BY s.id";
    char hash[SHA256_HEX];
    if (!hash_file(m, hash))
        return false;
    const char *slash = strrchr(m->input->path, '/');
    sqlite3_stmt *statement = NULL;
    bool ok = sqlite3_prepare_v2(m->db, sql, -1, &statement, NULL) == SQLITE_OK;
    if (ok) {
        sqlite3_bind_text(statement, 2, slash ? slash + 1 : m->input->path, -1, SQLITE_STATIC);
        sqlite3_bind_text(statement, 3, hash, -1, SQLITE_STATIC);
        sqlite3_bind_text(statement, 4, m->input->lab, -1, SQLITE_STATIC);
        ok = step_to_end(m, statement) == SQLITE_DONE;
    }
    if (!ok)
        merge_fail_sqlite(m);
    sqlite3_finalize(statement);
    return ok;
}

static bool move_offset(struct merging *m)
{
    static const char sql[] =
        "SELECT max(coalesce((SELECT max(id) FROM main.protocol), 0), coalesce((SELECT max(id) FROM "
        "main.participant),"
        " 0), coalesce((SELECT max(id) FROM main.session), 0), coalesce((SELECT max(id) FROM main.segment), 0),"
        " coalesce((SELECT max(id) FROM main.condition), 0), coalesce((SELECT max(id) FROM main.trial), 0),"
        " coalesce((SELECT max(id) FROM main.choice), 0), coalesce((SELECT max(id) FROM main.rating), 0),"
        " coalesce((SELECT max(id) FROM main.response), 0), coalesce((SELECT max(id) FROM main.adjust_step), "
        "0),"
        " coalesce((SELECT max(id) FROM main.staircase_step), 0), coalesce((SELECT max(id) FROM "
        "main.exposure), 0),"
        " coalesce((SELECT max(id) FROM main.gaze), 0), coalesce((SELECT max(id) FROM main.gaze_check), 0),"
        " coalesce((SELECT max(id) FROM main.frame), 0), coalesce((SELECT max(id) FROM main.event), 0),"
        " coalesce((SELECT max(id) FROM main.exclusion), 0))";
    sqlite3_stmt *statement = NULL;
    bool ok = sqlite3_prepare_v2(m->db, sql, -1, &statement, NULL) == SQLITE_OK &&
              sqlite3_step(statement) == SQLITE_ROW;
    m->offset = ok ? sqlite3_column_int64(statement, 0) : 0;
    sqlite3_finalize(statement);
    return ok || merge_fail_sqlite(m);
}

static bool attach(struct merging *m)
{
    sqlite3_stmt *statement = NULL;
    bool ok = merge_run(m, "DELETE FROM temp.lab");
    // A file's path in a URI: everything that means something there is spelt out.
    sqlite3_str *uri = sqlite3_str_new(NULL);
    sqlite3_str_appendall(uri, "file:");
    for (const char *c = m->input->path; *c; c++)
        if (strchr("?#%", *c))
            sqlite3_str_appendf(uri, "%%%02X", (unsigned)(unsigned char)*c);
        else
            sqlite3_str_appendchar(uri, 1, *c);
    sqlite3_str_appendall(uri, "?mode=ro");
    char *name = sqlite3_str_finish(uri);
    ok = ok && sqlite3_prepare_v2(m->db, "ATTACH ?1 AS src", -1, &statement, NULL) == SQLITE_OK;
    if (ok) {
        sqlite3_bind_text(statement, 1, name, -1, SQLITE_STATIC);
        ok = sqlite3_step(statement) == SQLITE_DONE;
    }
    sqlite3_finalize(statement);
    sqlite3_free(name);
    if (ok && m->input->lab) {
        char *sql = sqlite3_mprintf("INSERT INTO temp.lab VALUES (%Q)", m->input->lab);
        ok = sql && merge_run(m, sql);
        sqlite3_free(sql);
    }
    return ok || merge_fail_sqlite(m);
}

static bool add_input(struct merging *m)
{
    // The reader knows what a study file is and says it in words.
    struct store_reader *reader = store_reader_open(m->input->path, m->error, m->error_size);
    if (!reader)
        return false;
    m->version = store_reader_version(reader);
    store_reader_close(reader);
    return attach(m) && merge_run(m, "BEGIN") && check_input(m) && move_offset(m) && merge_choose(m) &&
           merge_copy(m) && note_source(m) && merge_run(m, "COMMIT") && merge_run(m, "DETACH src");
}

// --- the output ---

static bool make_output(struct merging *m, const char *path)
{
    char schema[sizeof schema_sql + 1];
    memcpy(schema, schema_sql, sizeof schema_sql);
    schema[sizeof schema_sql] = '\0';
    if (sqlite3_open_v2(path, &m->db, SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE | SQLITE_OPEN_URI, NULL) !=
            SQLITE_OK ||
        sqlite3_exec(m->db, "PRAGMA journal_mode = OFF; PRAGMA synchronous = OFF; PRAGMA foreign_keys = OFF",
                     NULL, NULL, NULL) != SQLITE_OK ||
        sqlite3_exec(m->db, schema, NULL, NULL, NULL) != SQLITE_OK)
        return merge_fail_sqlite(m);
    // Two laboratories' first participants both have number 1; the rule is back before the file has its name.
    return merge_run(m, "CREATE TEMP TABLE rule AS SELECT sql FROM main.sqlite_schema WHERE name = "
                        "'participant_one_number'") &&
           merge_run(m, "DROP TRIGGER main.participant_one_number") &&
           merge_run(m, "CREATE TEMP TABLE take (id INTEGER PRIMARY KEY)") &&
           merge_run(m, "CREATE TEMP TABLE twin (src INTEGER, main INTEGER)") &&
           merge_run(m, "CREATE TEMP TABLE replaced (main INTEGER)") &&
           merge_run(m, "CREATE TEMP TABLE lab (name)") &&
           merge_run(m, "CREATE TEMP TABLE protocols (old INTEGER PRIMARY KEY, new INTEGER)") &&
           merge_run(m, "CREATE TEMP TABLE conditions (old INTEGER PRIMARY KEY, new INTEGER)") &&
           merge_run(m, "CREATE TEMP TABLE people (old INTEGER PRIMARY KEY, new INTEGER)");
}

static bool finish_output(struct merging *m, struct store_merge_counts *out)
{
    m->input = NULL;
    sqlite3_stmt *statement = NULL;
    bool ok = sqlite3_prepare_v2(m->db, "SELECT sql FROM temp.rule", -1, &statement, NULL) == SQLITE_OK &&
              sqlite3_step(statement) == SQLITE_ROW &&
              merge_run(m, (const char *)sqlite3_column_text(statement, 0));
    sqlite3_finalize(statement);
    statement = NULL;
    static const char sums[] =
        "SELECT (SELECT count(*) FROM session), (SELECT count(*) FROM participant), (SELECT count(*) FROM "
        "pragma_integrity_check WHERE integrity_check <> 'ok') + (SELECT count(*) FROM "
        "pragma_foreign_key_check)";
    ok = ok && sqlite3_prepare_v2(m->db, sums, -1, &statement, NULL) == SQLITE_OK &&
         sqlite3_step(statement) == SQLITE_ROW;
    if (!ok)
        merge_fail_sqlite(m);
    else if (sqlite3_column_int64(statement, 2) != 0)
        ok = merge_fail(m, "%s: the merged file would not be whole; nothing was written", m->desc->output);
    if (ok)
        *out = (struct store_merge_counts){sqlite3_column_int64(statement, 0),
                                           sqlite3_column_int64(statement, 1), m->twice};
    sqlite3_finalize(statement);
    return ok;
}

static bool name_output(struct merging *m, const char *part)
{
    int file = open(part, O_RDONLY | O_CLOEXEC);
    bool ok = file >= 0 && fsync(file) == 0;
    if (file >= 0)
        close(file);
    if (ok && access(m->desc->output, F_OK) == 0) {
        errno = EEXIST;
        ok = false;
    }
    if (ok && rename(part, m->desc->output) == 0)
        return true;
    return merge_fail(m, "%s: cannot be written: %s", m->desc->output, strerror(errno));
}

bool store_merge(const struct store_merge_desc *desc, struct store_merge_counts *out, char *error,
                 size_t error_size)
{
    struct merging m = {.desc = desc, .error = error, .error_size = error_size};
    if (access(desc->output, F_OK) == 0)
        return merge_fail(&m, "%s: exists already; give a new name", desc->output);
    char *part = sqlite3_mprintf("%s.part", desc->output);
    if (!part)
        return merge_fail(&m, "not enough memory");
    unlink(part); // of a merge that was interrupted
    bool ok = make_output(&m, part);
    for (size_t i = 0; ok && i < desc->input_count; i++) {
        m.input = &desc->inputs[i];
        ok = add_input(&m);
    }
    ok = ok && finish_output(&m, out);
    sqlite3_close(m.db);
    ok = ok && name_output(&m, part);
    if (!ok)
        unlink(part);
    sqlite3_free(part);
    return ok;
}
