// Data quality per session, what was left out and why, and what the words mean.
#include "analysis/report/html.h"
#include "analysis/report/sections.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

struct session_quality {
    int64_t planned, open, done, steps, invalid, samples, lost, frames, lost_frames;
};

struct filling {
    const struct report *report;
    size_t file;
    struct session_quality *sessions;
};

static bool add_trial(void *user, const struct store_trial_row *row)
{
    struct filling *f = user;
    size_t i = sample_find_session(f->report->sample, f->file, row->session_id);
    if (i == SAMPLE_NONE)
        return true;
    // A staircase ends when it is sure, before the most trials that it may take: those are no loss.
    bool fixed = strcmp(row->kind, "staircase") != 0;
    bool done = strcmp(row->status, "done") == 0;
    f->sessions[i].planned += fixed && row->repeat_of == 0;
    f->sessions[i].open += !fixed;
    f->sessions[i].done += fixed && done;
    f->sessions[i].steps += !fixed && done;
    f->sessions[i].invalid += strcmp(row->status, "invalid") == 0;
    return true;
}

static void add_gaze(const struct gaze_report *gaze, struct session_quality *sessions)
{
    for (size_t i = 0; i < gaze->record_count; i++) {
        sessions[gaze->records[i].session].samples += gaze->records[i].received;
        sessions[gaze->records[i].session].lost += gaze->records[i].received_invalid;
    }
    for (size_t i = 0; i < gaze->latency_count; i++) {
        const struct gaze_latency *l = &gaze->latencies[i];
        sessions[l->session].frames = l->frames + l->lost;
        sessions[l->session].lost_frames = l->lost;
    }
}

static void session_row(const struct report *r, size_t index, const struct session_quality *q)
{
    const struct sample_session *s = &r->sample->sessions[index];
    FILE *out = r->out;
    fputs("<tr>", out);
    html_cell(out, "th scope=\"row\" class=\"word\"", "%s", r->sample->people[s->person].code);
    html_cell(out, "td class=\"word\"", "%s", s->status);
    html_cell(out, "td class=\"word\"", "%s", s->started_at);
    html_cell(out, "td", "%" PRId64, s->segments);
    if (q->open && q->planned)
        html_cell(out, "td", "%" PRId64 " of %" PRId64 ", %" PRId64 " of staircases", q->done, q->planned,
                  q->steps);
    else if (q->open)
        html_cell(out, "td", "%" PRId64 " of staircases", q->steps);
    else
        html_cell(out, "td", "%" PRId64 " of %" PRId64, q->done, q->planned);
    html_cell(out, "td", "%" PRId64, q->invalid);
    if (q->samples)
        html_cell(out, "td", "%" PRId64 " (%.1f\u00a0%%)", q->samples,
                  100 * (double)q->lost / (double)q->samples);
    else
        html_cell(out, "td", "none");
    if (q->frames)
        html_cell(out, "td", "%" PRId64 " of %" PRId64, q->lost_frames, q->frames);
    else
        html_cell(out, "td", "\u2013");
    fputs("</tr>\n", out);
}

// A fovea without a gaze is not what the condition says: at first every pixel counts as foveal, later it stands
// still.
static void lost_note(const struct report *r, const struct session_quality *sessions)
{
    int64_t frames = 0, lost = 0;
    for (size_t i = 0; i < r->sample->session_count; i++) {
        if (!r->sample->sessions[i].excluded) {
            frames += sessions[i].frames;
            lost += sessions[i].lost_frames;
        }
    }
    if (lost)
        fprintf(r->out,
                "<p class=\"note\">In %" PRId64 " of %" PRId64
                " stimulus frames the gaze was lost for more than half a second or not known yet: there a "
                "foveated option "
                "was not what its condition says, and choices between them say less.</p>\n",
                lost, frames);
}

static void open_note(const struct report *r, const struct session_quality *sessions)
{
    bool open = false;
    for (size_t i = 0; i < r->sample->session_count; i++)
        open = open || (!r->sample->sessions[i].excluded && sessions[i].open);
    if (open)
        fputs("<p class=\"note\">How many trials a staircase takes is not fixed: it ends when its rule is met, "
              "so "
              "its trials are counted and not held against a number.</p>\n",
              r->out);
}

static bool sessions_table(const struct report *r, char *error, size_t error_size)
{
    struct sample *s = r->sample;
    struct filling f = {r, 0, calloc(s->session_count, sizeof *f.sessions)};
    bool ok = f.sessions != NULL;
    if (!ok)
        snprintf(error, error_size, "not enough memory");
    for (; ok && f.file < s->file_count; f.file++) {
        ok = store_read_trials(s->files[f.file], add_trial, &f);
        if (!ok)
            snprintf(error, error_size, "%s", store_reader_error(s->files[f.file]));
    }
    if (ok) {
        add_gaze(&r->gaze, f.sessions);
        fputs("<div class=\"table\" tabindex=\"0\" role=\"region\" "
              "aria-label=\"Sessions\"><table>\n<caption>Sessions"
              "</caption>\n<thead><tr><th scope=\"col\" class=\"word\">participant</th><th scope=\"col\" "
              "class=\"word\">"
              "status</th><th scope=\"col\" class=\"word\">started</th><th scope=\"col\">program runs</th>"
              "<th scope=\"col\">trials done</th><th scope=\"col\">invalid</th><th scope=\"col\">gaze samples "
              "(not valid)"
              "</th><th scope=\"col\">stimulus frames without gaze</th></tr></thead>\n<tbody>\n",
              r->out);
        for (size_t i = 0; i < s->session_count; i++)
            if (!s->sessions[i].excluded)
                session_row(r, i, &f.sessions[i]);
        fputs("</tbody></table></div>\n", r->out);
        open_note(r, f.sessions);
        lost_note(r, f.sessions);
    }
    free(f.sessions);
    return ok;
}

static void count_item(const struct report *r, int64_t count, const char *what)
{
    if (count)
        fprintf(r->out, "<li>%s: %" PRId64 "</li>\n", what, count);
}

static void left_out(const struct report *r)
{
    const struct choices *c = &r->choices;
    const struct ratings *t = &r->ratings;
    int64_t sessions = 0, incomplete = 0;
    for (size_t i = 0; i < r->sample->session_count; i++) {
        sessions += r->sample->sessions[i].excluded;
        incomplete +=
            !r->sample->sessions[i].excluded && strcmp(r->sample->sessions[i].status, "complete") != 0;
    }
    if (incomplete)
        fprintf(r->out,
                "<p class=\"note\">%" PRId64
                " %s not complete; the answers given are part of every number here.</p>\n",
                incomplete, incomplete == 1 ? "session is" : "sessions are");
    int64_t all = sessions + c->excluded + c->not_done + c->other_kinds + c->no_test_slot + t->excluded +
                  t->other_kinds + t->not_done + t->no_condition + t->more + t->options.unpaired +
                  t->not_finite + (int64_t)(r->sample->left_out_simulated + r->sample->left_out_protocol);
    fputs(all ? "<p>Left out of the numbers above:</p>\n<ul>\n" : "<p>Nothing was left out.</p>\n", r->out);
    count_item(r, (int64_t)r->sample->left_out_simulated, "simulated sessions");
    count_item(r, (int64_t)r->sample->left_out_protocol, "sessions of other protocols");
    count_item(r, sessions, "excluded sessions");
    count_item(r, c->excluded, "answers to excluded trials");
    count_item(r, c->not_done, "answers to trials that are not done");
    count_item(r, c->other_kinds,
               "answers to practice, catch and null trials, and those of staircases, which have a section of "
               "their own");
    count_item(r, c->no_test_slot, "answers to trials without a test option");
    count_item(r, t->other_kinds, "ratings in practice, catch and null trials");
    count_item(r, t->excluded, "ratings in excluded trials");
    count_item(r, t->not_done, "ratings in trials that are not done");
    count_item(r, t->no_condition, "ratings that belong to no option");
    count_item(r, t->more, "ratings of nothing they could be compared with");
    count_item(r, t->options.unpaired, "ratings of one option of a trial only");
    count_item(r, t->not_finite, "ratings that are not finite numbers, which no program of ours writes");
    fputs(all ? "</ul>\n" : "", r->out);
}

static void exclusions_table(const struct report *r)
{
    FILE *out = r->out;
    const struct sample *s = r->sample;
    if (s->exclusion_count == 0)
        return;
    fputs("<p>Rules of the set \u201cstricter\u201d are listed and not applied; \u201clate\u201d ones were "
          "made after the data "
          "was seen.</p>\n<div class=\"table\" tabindex=\"0\" role=\"region\" aria-label=\"Exclusions\"><table "
          "class=\"wrap\">\n"
          "<caption>Exclusions</caption>\n<thead><tr><th scope=\"col\" class=\"word\">participant</th><th "
          "scope=\"col\" "
          "class=\"word\">what</th>"
          "<th scope=\"col\" class=\"word\">rule</th><th scope=\"col\" class=\"word\">set</th><th "
          "scope=\"col\" class=\"word\">"
          "reason</th><th scope=\"col\" class=\"word\">by</th></tr></thead>\n<tbody>\n",
          out);
    for (size_t i = 0; i < s->exclusion_count; i++) {
        const struct sample_exclusion *e = &s->exclusions[i];
        fputs("<tr>", out);
        html_cell(out, "th scope=\"row\" class=\"word\"", "%s", e->code);
        if (e->trial_id)
            html_cell(out, "td class=\"word\"", "trial %" PRId64, e->trial_id);
        else
            html_cell(out, "td class=\"word\"", "%s", e->session_id ? "session" : "participant");
        html_cell(out, "td class=\"word\"", "%s", e->rule);
        html_cell(out, "td class=\"word\"", "%s%s", e->rule_set, e->applied ? "" : " (not applied)");
        html_cell(out, "td class=\"word\"", "%s", e->reason);
        html_cell(out, "td class=\"word\"", "%s", e->by);
        fputs("</tr>\n", out);
    }
    fputs("</tbody></table></div>\n", out);
}

bool report_quality(const struct report *r, char *error, size_t error_size)
{
    report_heading(r, "Quality and exclusions");
    left_out(r);
    exclusions_table(r);
    report_what_if(r);
    if (!sessions_table(r, error, error_size))
        return false;
    report_audit(r);
    return true;
}

void report_definitions(const struct report *r)
{
    static const char *const words[][2] = {
        {"Cell", "One combination of block, factor levels and the two options compared."},
        {"Test option, reference",
         "The protocol\u2019s first option and the one it is compared with, whichever side they were "
         "on."},
        {"Share", "Answers for the test option, in percent of n. Answers \u201cequal\u201d are not part of n."},
        {"Null region",
         "The smallest and largest count whose two-sided p exceeds 1 minus the confidence, for the cell\u2019s "
         "own n (6 to 16 for n = 22 at 95 %)."},
        {"Interval",
         "Clopper\u2013Pearson for shares of one answer per person, by Student\u2019s t for means, for "
         "means of people\u2019s shares and for differences."},
        {"p", "Two-sided binomial p: the probability of all counts no more probable than the one seen, if both "
              "options were "
              "chosen equally often. Two-sided sign-flip p: the share of all ways to flip the people\u2019s "
              "signs that lean "
              "at least as far. A large p is no evidence that options look the same."},
        {"p (Holm)",
         "Adjusted for the number of cells: under it, the chance of any false finding among them is kept."},
        {"Toggles", "Switches between the two options before the answer."},
        {"Reaction time", "From the moment an answer was allowed to the answer; the median per cell."},
        {"\u03b5, fovea",
         "Confidence threshold of the time-warped mode, and the eccentricity in degrees (a radius) up to which "
         "it redraws every pixel."},
        {"Late frame", "A frame shown at least one refresh after its turn."},
        {"GPU and CPU time, interval",
         "Time spent on a frame by each, and between the starts of successive frames."},
    };
    report_heading(r, "Definitions");
    fputs("<dl>\n", r->out);
    for (size_t i = 0; i < sizeof words / sizeof words[0]; i++)
        fprintf(r->out, "<dt>%s</dt><dd>%s</dd>\n", words[i][0], words[i][1]);
    fputs("</dl>\n", r->out);
}
