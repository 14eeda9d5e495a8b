// What was planned before the first participant, each with the section that answers it. What no section answers
// is said, so that a planned test is never silently missing.
#include "analysis/report/html.h"
#include "analysis/report/sections.h"

#include <string.h>

static const struct {
    const char *plan, *section; // as store_session_row has plans
} answers[] = {
    {"binomial choice cell", "Choices"},
    {"mean toggles study", "Toggles before answering"},
    {"unpaired_t rating order", "Ratings"},
    {"paired_t rating order", "Ratings"},
    {"paired_t rating cell", "Ratings"},
    {"anova rating factor", "Ratings"},
    {"paired_t rating factor", "Ratings"},
    {"mean rating factor", "Ratings"},
    {"mean adjusted cell", "Adjusted values"},
    {"mean threshold cell", "Thresholds"},
    {"binomial choice -", "Choices"},
    {"mean choice cell", "Choices"},
    {"mean toggles cell", "Toggles before answering"},
};

// Planned, and answered otherwise or not at all: why.
static const struct {
    const char *plan, *why;
} reasons[] = {
    {"anova rating cell",
     "an analysis of variance compares levels of factors; it stands in section \u201cRatings\u201d"},
    {"binomial choice study",
     "a person\u2019s cells are never joined; each cell is tested in section \u201cChoices\u201d"},
    {"binomial choice scene",
     "a person\u2019s cells are never joined; each cell is tested in section \u201cChoices\u201d"},
};

// Answered by the comparison of levels, if there is one: which needs cells that differ in one factor alone.
static const char *levels_answer(const struct report *r, const char *plan)
{
    if (strcmp(plan, "binomial choice factor") != 0 && strcmp(plan, "paired_t choice factor") != 0)
        return NULL;
    return r->factors.count + r->choices.contrast_count
               ? "levels of factors are compared in section \u201cChoices\u201d, by the test that the data "
                 "permit"
               : "no two cells differ in one factor alone, so no levels are compared; each cell is tested in "
                 "section "
                 "\u201cChoices\u201d";
}

static const char *reason_of(const struct report *r, const char *plan)
{
    for (size_t i = 0; i < sizeof reasons / sizeof reasons[0]; i++)
        if (strcmp(reasons[i].plan, plan) == 0)
            return reasons[i].why;
    return levels_answer(r, plan);
}

static const char *answer_of(const char *plan)
{
    for (size_t i = 0; i < sizeof answers / sizeof answers[0]; i++)
        if (strcmp(answers[i].plan, plan) == 0)
            return answers[i].section;
    return NULL;
}

// "paired_t rating order" as "paired t of rating, per order".
static void write_plan(FILE *out, const char *plan)
{
    int word = 0;
    for (const char *c = plan; *c; c++) {
        if (*c == ' ' && strcmp(c, " -") == 0)
            return;
        if (*c == ' ')
            fputs(word++ == 0 ? " of " : ", per ", out);
        else
            html_printf(out, "%c", *c == '_' ? ' ' : *c);
    }
}

// Whether a session before this one has the line.
static bool known_before(const struct sample *sample, size_t session, const char *line)
{
    for (size_t i = 0; i < session; i++) {
        char lines[2048];
        snprintf(lines, sizeof lines, "%s", sample->sessions[i].planned);
        for (char *rest = lines, *one; !sample->sessions[i].excluded && (one = strsep(&rest, "\n"));)
            if (strcmp(one, line) == 0)
                return true;
    }
    return false;
}

static size_t write_session(const struct report *r, size_t session, size_t count)
{
    char lines[2048]; // 16 plans of three words
    snprintf(lines, sizeof lines, "%s", r->sample->sessions[session].planned);
    for (char *rest = lines, *line; (line = strsep(&rest, "\n"));) {
        if (!*line || known_before(r->sample, session, line))
            continue;
        const char *section = answer_of(line);
        fputs(count++ ? "" : "<ul>\n", r->out);
        fputs("<li>", r->out);
        write_plan(r->out, line);
        if (section)
            fprintf(r->out, ": section \u201c%s\u201d</li>\n", section);
        else if (reason_of(r, line))
            fprintf(r->out, ": %s</li>\n", reason_of(r, line));
        else
            fputs(": <strong>not computed by this version</strong></li>\n", r->out);
    }
    return count;
}

void report_planned(const struct report *r)
{
    size_t count = 0;
    report_heading(r, "Planned analyses");
    for (size_t i = 0; i < r->sample->session_count; i++)
        if (!r->sample->sessions[i].excluded)
            count = write_session(r, i, count);
    fputs(count ? "</ul>\n<p>They stand in the sections named; everything else in this report was not "
                  "planned.</p>\n"
                : "<p>The protocol planned none, or an earlier version recorded the sessions.</p>\n",
          r->out);
}
