// `fovstats frames --audit`: every frame accounted for.
#include "analysis/report/audit.h"

#include "analysis/tools/arguments.h"
#include "analysis/tools/study_arguments.h"
#include "analysis/tools/table.h"

#include <inttypes.h>
#include <stdio.h>

static const char *code_of(const struct sample *sample, const struct audit *audit, size_t session)
{
    return sample->people[sample->sessions[audit->sessions[session].session].person].code;
}

static bool sessions_table(const struct sample *sample, const struct audit *audit)
{
    const char *const headings[] = {"<person", "session",  "frames", "submitted", "missing",
                                    "late",    "stale",    "fixed",  "lost",      "copied",
                                    "other",   "switches", "judged", "fades off", NULL};
    struct table t;
    table_init(&t, headings);
    for (size_t i = 0; i < audit->session_count; i++) {
        const struct audit_session *s = &audit->sessions[i];
        const int64_t *c = s->counts;
        table_cell(&t, "%s", code_of(sample, audit, i));
        table_cell(&t, "%" PRId64, sample->sessions[s->session].id);
        table_cell(&t, "%" PRId64, s->frames);
        if (s->uncounted)
            table_cell(&t, "?");
        else
            table_cell(&t, "%" PRId64, s->submitted);
        table_cell(&t, "%" PRId64, c[AUDIT_MISSING]);
        table_cell(&t, "%" PRId64, c[AUDIT_LATE_STIMULUS] + c[AUDIT_LATE_FADE] + c[AUDIT_LATE_OTHER]);
        table_cell(&t, "%" PRId64, c[AUDIT_STALE]);
        table_cell(&t, "%" PRId64, c[AUDIT_FIXED]);
        table_cell(&t, "%" PRId64, c[AUDIT_LOST]);
        table_cell(&t, "%" PRId64, c[AUDIT_COPIED]);
        table_cell(&t, "%" PRId64, c[AUDIT_WRONG] + c[AUDIT_DIFFERS] + c[AUDIT_REPEATED]);
        table_cell(&t, "%" PRId64, s->toggles);
        table_cell(&t, "%" PRId64, s->judged);
        table_cell(&t, "%" PRId64, c[AUDIT_FADES]);
    }
    bool ok = table_print(&t, stdout);
    table_finish(&t);
    return ok;
}

static void print_session_notes(const struct sample *sample, const struct audit *audit)
{
    for (size_t i = 0; i < audit->session_count; i++) {
        const struct audit_session *s = &audit->sessions[i];
        int64_t id = sample->sessions[s->session].id;
        if (s->uncounted)
            printf("Session %" PRId64 ": %" PRId64 " of %" PRId64
                   " runs of the program left no count of frames "
                   "(a crash, or it still runs); frames after its last row are not known.\n",
                   id, s->uncounted, s->segments);
        if (s->dropped)
            printf("Session %" PRId64 ": the store said itself that it dropped %" PRId64 " frame rows.\n", id,
                   s->dropped);
        if (s->late_unknown)
            printf("Session %" PRId64 ": of %" PRId64 " frames it is not known whether they were late.\n", id,
                   s->late_unknown);
    }
}

static void print_findings(const struct sample *sample, const struct audit *audit)
{
    if (audit->findings == 0) {
        puts("No finding.");
        return;
    }
    printf("%" PRId64 " findings:\n", audit->findings);
    for (size_t i = 0; i < audit->trial_count; i++) {
        const struct audit_trial *t = &audit->trials[i];
        const char *comma = "";
        if (t->trial_id)
            printf("  %s, trial %" PRId64 " (place %" PRId64 "): ", code_of(sample, audit, t->session),
                   t->trial_id, t->ordinal);
        else
            printf("  %s, between trials: ", code_of(sample, audit, t->session));
        for (int k = 0; k < AUDIT_COUNTS; k++)
            if (t->counts[k]) {
                printf("%s%" PRId64 " %s", comma, t->counts[k], audit_words((enum audit_count)k));
                comma = ", ";
            }
        putchar('\n');
    }
    for (size_t i = 0; i < audit->fade_count; i++) {
        const struct audit_fade *f = &audit->fades[i];
        printf("  %s, trial %" PRId64 ", switch %" PRId64 ": %s\n", code_of(sample, audit, f->session),
               f->trial_id, f->toggle, f->what);
    }
}

static bool print_text(const struct sample *sample, const struct audit *audit)
{
    study_title(sample, "Frames audit");
    if (!sessions_table(sample, audit))
        return false;
    putchar('\n');
    print_findings(sample, audit);
    print_session_notes(sample, audit);
    printf(
        "\nStale: drawn by a gaze sample older than %g ms, or in use for longer (%g ms through a blink). Fades "
        "may be "
        "off by\none refresh and a tenth; judged are those that no pause and no answer cut short. Fixed, lost: "
        "frames of an option that\nfollows a fovea, where the trial asks for another.\n",
        AUDIT_STALE_MS, AUDIT_BLINK_MS);
    study_notes(sample);
    return true;
}

static void counts_json(struct json *json, const int64_t *counts)
{
    for (int k = 0; k < AUDIT_COUNTS; k++)
        json_integer(json, audit_key((enum audit_count)k), counts[k]);
}

static void print_json(const struct sample *sample, const struct audit *audit)
{
    struct json json = {stdout, false};
    json_open(&json, NULL, '{');
    study_title_json(&json, sample);
    json_integer(&json, "findings", audit->findings);
    json_number(&json, "stale_ms", AUDIT_STALE_MS);
    json_number(&json, "blink_ms", AUDIT_BLINK_MS);
    json_open(&json, "sessions_audited", '[');
    for (size_t i = 0; i < audit->session_count; i++) {
        const struct audit_session *s = &audit->sessions[i];
        json_open(&json, NULL, '{');
        json_text(&json, "participant", code_of(sample, audit, i));
        json_integer(&json, "session", sample->sessions[s->session].id);
        json_integer(&json, "segments", s->segments);
        json_integer(&json, "segments_uncounted", s->uncounted);
        json_integer(&json, "frames", s->frames);
        json_integer(&json, "submitted", s->submitted);
        json_integer(&json, "dropped", s->dropped);
        json_integer(&json, "late_unknown", s->late_unknown);
        json_integer(&json, "switches", s->toggles);
        json_integer(&json, "fades_judged", s->judged);
        counts_json(&json, s->counts);
        json_close(&json, '}');
    }
    json_close(&json, ']');
    json_open(&json, "trials", '[');
    for (size_t i = 0; i < audit->trial_count; i++) {
        const struct audit_trial *t = &audit->trials[i];
        json_open(&json, NULL, '{');
        json_text(&json, "participant", code_of(sample, audit, t->session));
        json_integer(&json, "trial", t->trial_id);
        json_integer(&json, "ordinal", t->ordinal);
        counts_json(&json, t->counts);
        json_close(&json, '}');
    }
    json_close(&json, ']');
    json_open(&json, "fades", '[');
    for (size_t i = 0; i < audit->fade_count; i++) {
        const struct audit_fade *f = &audit->fades[i];
        json_open(&json, NULL, '{');
        json_integer(&json, "trial", f->trial_id);
        json_integer(&json, "switch", f->toggle);
        json_text(&json, "what", f->what);
        json_close(&json, '}');
    }
    json_close(&json, ']');
    json_close(&json, '}');
    putchar('\n');
}

int frames_audit(const struct command *command, struct sample *sample, bool json)
{
    char error[SAMPLE_ERROR_SIZE];
    struct audit audit;
    if (!audit_load(&audit, sample, error, sizeof error))
        return command_fail(command, EXIT_FAILED, "%s", error);
    int code = EXIT_DONE;
    if (audit.session_count == 0)
        code = command_fail(command, EXIT_FAILED, "%s: no session drew a frame",
                            store_reader_path(sample->files[0]));
    else if (json)
        print_json(sample, &audit);
    else if (!print_text(sample, &audit))
        code = command_fail(command, EXIT_FAILED, "not enough memory");
    audit_free(&audit);
    return code == EXIT_DONE ? command_finish(command) : code;
}
