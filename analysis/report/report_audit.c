// Every frame accounted for: the audit as a part of the report's quality section.
#include "analysis/report/html.h"
#include "analysis/report/sections.h"

#include <inttypes.h>
#include <string.h>

enum { TRIALS_SHOWN = 200 }; // named in the page; `fovstats frames --audit` names all

static const char *code_of(const struct report *r, size_t session)
{
    const struct sample *s = r->sample;
    return s->people[s->sessions[r->audit.sessions[session].session].person].code;
}

static void session_row(const struct report *r, size_t index)
{
    const struct audit_session *s = &r->audit.sessions[index];
    const int64_t *c = s->counts;
    const int64_t cells[] = {
        c[AUDIT_MISSING],    c[AUDIT_LATE_STIMULUS], c[AUDIT_LATE_FADE],
        c[AUDIT_LATE_OTHER], c[AUDIT_STALE],         c[AUDIT_FIXED],
        c[AUDIT_LOST],       c[AUDIT_COPIED],        c[AUDIT_WRONG] + c[AUDIT_DIFFERS] + c[AUDIT_REPEATED]};
    FILE *out = r->out;
    fputs("<tr>", out);
    html_cell(out, "th scope=\"row\" class=\"word\"", "%s", code_of(r, index));
    if (s->uncounted)
        html_cell(out, "td", "%" PRId64 " of ?", s->frames);
    else
        html_cell(out, "td", "%" PRId64 " of %" PRId64, s->frames, s->submitted);
    for (size_t i = 0; i < sizeof cells / sizeof cells[0]; i++)
        html_cell(out, "td", "%" PRId64, cells[i]);
    html_cell(out, "td", "%" PRId64 " of %" PRId64, c[AUDIT_FADES], s->judged);
    fputs("</tr>\n", out);
}

static void findings_list(const struct report *r)
{
    const struct audit *a = &r->audit;
    FILE *out = r->out;
    if (a->findings == 0) {
        fputs("<p>No finding.</p>\n", out);
        return;
    }
    fputs("<ul>\n", out);
    for (size_t i = 0; i < a->trial_count && i < TRIALS_SHOWN; i++) {
        const struct audit_trial *t = &a->trials[i];
        const char *comma = "";
        fputs("<li>", out);
        if (t->trial_id)
            html_printf(out, "%s, trial %" PRId64 " (place %" PRId64 "): ", code_of(r, t->session), t->trial_id,
                        t->ordinal);
        else
            html_printf(out, "%s, between trials: ", code_of(r, t->session));
        for (int k = 0; k < AUDIT_COUNTS; k++)
            if (t->counts[k]) {
                html_printf(out, "%s%" PRId64 " %s", comma, t->counts[k], audit_words((enum audit_count)k));
                comma = ", ";
            }
        fputs("</li>\n", out);
    }
    for (size_t i = 0; i < a->fade_count && i < TRIALS_SHOWN; i++) {
        const struct audit_fade *f = &a->fades[i];
        fputs("<li>", out);
        html_printf(out, "%s, trial %" PRId64 ", switch %" PRId64 ": %s", code_of(r, f->session), f->trial_id,
                    f->toggle, f->what);
        fputs("</li>\n", out);
    }
    fputs("</ul>\n", out);
    if (a->trial_count > TRIALS_SHOWN || a->fade_count > TRIALS_SHOWN)
        fprintf(out, "<p class=\"note\">The first %d are named here; fovstats frames --audit names all.</p>\n",
                TRIALS_SHOWN);
}

void report_audit(const struct report *r)
{
    const struct audit *a = &r->audit;
    FILE *out = r->out;
    int64_t uncounted = 0;
    if (a->session_count == 0)
        return;
    fputs("<h3>Every frame</h3>\n<p>", out);
    html_printf(
        out,
        "Rows against the frames that the program submitted. Stale: drawn by a gaze sample older than %g ms, "
        "or "
        "in use for longer (%g ms through a blink). Fixed, lost, other: frames of a foveated option whose "
        "fovea "
        "was not what the trial asks for. Fades: switches whose fade began, was gray, or ended more than one "
        "refresh and a tenth off the protocol, of those that no pause and no answer cut short.",
        AUDIT_STALE_MS, AUDIT_BLINK_MS);
    fputs("</p>\n<div class=\"table\" tabindex=\"0\" role=\"region\" aria-label=\"Every "
          "frame\"><table>\n<caption>Frames "
          "accounted for</caption>\n<thead><tr><th scope=\"col\" class=\"word\">participant</th><th "
          "scope=\"col\">rows</th><th scope=\"col\">missing</th><th scope=\"col\">late, stimulus</th><th "
          "scope=\"col\">fade</th><th scope=\"col\">rest</th><th scope=\"col\">stale gaze</th><th "
          "scope=\"col\">fixed</th><th scope=\"col\">lost</th><th scope=\"col\">one eye copied</th><th "
          "scope=\"col\">other</th><th scope=\"col\">fades off</th></tr></thead>\n<tbody>\n",
          out);
    for (size_t i = 0; i < a->session_count; i++) {
        session_row(r, i);
        uncounted += a->sessions[i].uncounted;
    }
    fputs("</tbody></table></div>\n", out);
    if (uncounted)
        fprintf(out,
                "<p class=\"note\">%" PRId64
                " %s of the program left no count of frames (a crash, or it still runs). "
                "What was shown after the last row is not known.</p>\n",
                uncounted, uncounted == 1 ? "run" : "runs");
    findings_list(r);
}
