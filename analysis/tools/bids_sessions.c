// sub-LABEL_sessions.tsv: which session of the study file a folder holds, and what it ran on.
#include "analysis/tools/bids_private.h"

#include <inttypes.h>
#include <string.h>

static const char *const columns[] = {"session_status", "protocol", "protocol_sha256", "seed",
                                      "started_at",     "ended_at", "consent_version", "device",
                                      "driver",         "display",  "refresh_hz",      "width_px",
                                      "height_px",      "fov_deg",  "excluded",        "excluded_stricter",
                                      "excluded_rules"};
enum { COLUMNS = sizeof columns / sizeof columns[0] };

struct sessions {
    struct bids *bids;
    size_t person;
    FILE *out;
};

static void write_header(FILE *out)
{
    fputs("session_id\tstudy_session_id\tacq_time", out);
    for (size_t i = 0; i < COLUMNS; i++)
        fprintf(out, "\t%s", columns[i]);
    fputc('\n', out);
}

static bool write_session(void *user, bool header, const struct store_cell *cells, size_t count)
{
    struct sessions *s = user;
    if (header)
        return true;
    int64_t id = cell_integer(cells, count, "session_id", 0);
    const struct bids_session *session = bids_find_session(s->bids, id);
    if (!session || session->person != s->person)
        return true;
    s->bids->counts.sessions++;
    fprintf(s->out, "ses-%" PRId64 "\t%" PRId64 "\t", session->number, id);
    cell_write_tsv(s->out, cell_find(cells, count, "started_at"));
    for (size_t i = 0; i < COLUMNS; i++) {
        fputc('\t', s->out);
        cell_write_tsv(s->out, cell_find(cells, count, columns[i]));
    }
    fputc('\n', s->out);
    return true;
}

static bool describe(struct bids *b, const char *name)
{
    FILE *out = bids_open(b, name);
    if (!out)
        return false;
    struct json json = {out, false};
    json_open(&json, NULL, '{');
    json_open(&json, "study_session_id", '{');
    json_text(&json, "Description", "Number of the session in the study file and in its Psych-DS tables.");
    json_close(&json, '}');
    json_open(&json, "acq_time", '{');
    json_text(&json, "Description", "When the session began, ISO 8601, UTC.");
    json_close(&json, '}');
    bids_describe(b, &json, columns, COLUMNS);
    json_close(&json, '}');
    fputc('\n', out);
    return bids_close(b, out, name);
}

static bool write_of_person(struct bids *b, size_t person)
{
    char name[BIDS_PATH_SIZE];
    const char *label = b->people.items[person].label;
    snprintf(name, sizeof name, "sub-%s/sub-%s_sessions.tsv", label, label);
    struct sessions s = {b, person, bids_open(b, name)};
    if (!s.out)
        return false;
    write_header(s.out);
    bool ok = bids_read(b, "sessions", write_session, &s);
    ok = bids_close(b, s.out, name) && ok;
    snprintf(name, sizeof name, "sub-%s/sub-%s_sessions.json", label, label);
    return ok && describe(b, name);
}

bool bids_write_sessions(struct bids *b)
{
    for (size_t person = 0; person < b->people.count; person++) {
        bool any = false;
        for (size_t i = 0; i < b->session_count; i++)
            any = any || b->sessions[i].person == person;
        if (any && !write_of_person(b, person))
            return false;
    }
    return true;
}
