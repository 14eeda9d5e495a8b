// Study and sample, and the methods paragraph.
#include "analysis/report/facts.h"
#include "analysis/report/html.h"
#include "analysis/report/sections.h"
#include "analysis/stats/moments.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

static size_t sessions_used(const struct sample *sample)
{
    size_t used = 0;
    for (size_t i = 0; i < sample->session_count; i++)
        used += !sample->sessions[i].excluded;
    return used;
}

// Every distinct value, with the number of sessions where there are several.
static void fact_row(const struct report *r, const char *name, fact_fn fact)
{
    const struct sample *sample = r->sample;
    char value[FACT], other[FACT];
    size_t distinct = 0;
    fprintf(r->out, "<tr><th scope=\"row\">%s</th><td>", name);
    for (size_t i = 0; i < sample->session_count; i++) {
        fact(&sample->sessions[i], value);
        size_t count = 0;
        bool first = true;
        for (size_t j = 0; j < sample->session_count; j++) {
            fact(&sample->sessions[j], other);
            bool same = !sample->sessions[j].excluded && strcmp(value, other) == 0;
            count += same;
            first = first && !(same && j < i);
        }
        if (sample->sessions[i].excluded || !first)
            continue;
        fputs(distinct++ ? "<br>" : "", r->out);
        html_text(r->out, value[0] ? value : "not recorded");
        if (count != sessions_used(sample))
            html_printf(r->out, " (%zu %s)", count, count == 1 ? "session" : "sessions");
    }
    fputs("</td></tr>\n", r->out);
}

static bool person_used(const struct sample *sample, size_t person)
{
    for (size_t i = 0; i < sample->session_count; i++)
        if (!sample->sessions[i].excluded && sample->sessions[i].person == person)
            return true;
    return false;
}

static size_t people_used(const struct sample *sample)
{
    size_t count = 0;
    for (size_t i = 0; i < sample->person_count; i++)
        count += person_used(sample, i);
    return count;
}

static void words_of_attribute(const struct report *r, const char *key)
{
    const struct sample *s = r->sample;
    size_t distinct = 0;
    for (size_t i = 0; i < s->attribute_count; i++) {
        size_t count = 0;
        bool first = true;
        if (strcmp(s->attributes[i].key, key) != 0 || !person_used(s, s->attributes[i].person))
            continue;
        for (size_t j = 0; j < s->attribute_count; j++) {
            bool same = strcmp(s->attributes[j].key, key) == 0 && person_used(s, s->attributes[j].person) &&
                        strcmp(s->attributes[j].value, s->attributes[i].value) == 0;
            count += same;
            first = first && !(same && j < i);
        }
        if (first)
            html_printf(r->out, "%s%s (%zu)", distinct++ ? ", " : "", s->attributes[i].value, count);
    }
}

// Numbers by mean, SD and range; words by how many have each.
static void attribute_row(const struct report *r, const char *key)
{
    const struct sample *s = r->sample;
    double *values = calloc(s->attribute_count, sizeof *values), low = INFINITY, high = -INFINITY;
    size_t count = 0, words = 0;
    for (size_t i = 0; values && i < s->attribute_count; i++) {
        const struct sample_attribute *a = &s->attributes[i];
        if (strcmp(a->key, key) != 0 || !person_used(s, a->person))
            continue;
        if (isnan(a->number)) {
            words++;
            continue;
        }
        values[count++] = a->number;
        low = fmin(low, a->number);
        high = fmax(high, a->number);
    }
    if (count + words) {
        fputs("<tr>", r->out);
        fputs("<th scope=\"row\">", r->out);
        for (const char *c = key; *c; c++) // JSON keys are words joined by '_'
            html_printf(r->out, "%c", *c == '_' ? ' ' : *c);
        fputs("</th>", r->out);
        fputs("<td>", r->out);
        if (words == 0 && count > 1) {
            struct stat_moments m = stat_moments(values, count);
            html_printf(r->out, "M %.2f, SD %.2f, %g to %g (%zu of %zu)", m.mean, m.sd, low, high, count,
                        people_used(s));
        } else {
            words_of_attribute(r, key);
        }
        fputs("</td></tr>\n", r->out);
    }
    free(values);
}

void report_sample(const struct report *r)
{
    const struct sample *s = r->sample;
    size_t used = sessions_used(s);
    report_heading(r, "Study and sample");
    fputs("<div class=\"table\"><table class=\"facts\"><tbody>\n", r->out);
    fact_row(r, "Protocol", fact_protocol);
    fprintf(r->out, "<tr><th scope=\"row\">%s</th><td>%zu (%zu %s)</td></tr>\n",
            s->simulated ? "Simulated observers" : "Participants", people_used(s), used,
            used == 1 ? "session" : "sessions");
    for (size_t i = 0; i < s->attribute_count; i++) {
        bool first = true;
        for (size_t j = 0; j < i && first; j++)
            first = strcmp(s->attributes[i].key, s->attributes[j].key) != 0;
        if (first)
            attribute_row(r, s->attributes[i].key);
    }
    fact_row(r, "Status", fact_status);
    fact_row(r, "Device", fact_device);
    fact_row(r, "Driver", fact_driver);
    fact_row(r, "Display", fact_display);
    fact_row(r, "Rate", fact_rate);
    fact_row(r, "Size", fact_size);
    fact_row(r, "Field of view", fact_fov);
    fact_row(r, "Seed", fact_seed);
    fact_row(r, "Scenes", fact_scenes);
    if (r->sample->simulated)
        fact_row(r, "Observer", fact_observer);
    fact_row(r, "Program", fact_version);
    fputs("</tbody></table></div>\n", r->out);
    if (s->left_out_protocol)
        fprintf(r->out,
                "<p class=\"note\">%zu %s of other protocols in these files %s no part of this report; "
                "--protocol NAME "
                "reports them.</p>\n",
                s->left_out_protocol, s->left_out_protocol == 1 ? "session" : "sessions",
                s->left_out_protocol == 1 ? "is" : "are");
    if (sample_shared_codes(s))
        fprintf(r->out,
                "<p class=\"note\">%zu participant %s in several files; each file\u2019s is taken for another "
                "person.</p>\n",
                sample_shared_codes(s), sample_shared_codes(s) == 1 ? "code stands" : "codes stand");
    char differing[256];
    if (facts_differing(s, differing, sizeof differing))
        fprintf(r->out, "<p class=\"note\">The sessions differ in: %s. The numbers below pool them.</p>\n",
                differing);
}

void report_methods(const struct report *r)
{
    report_heading(r, "Methods");
    fputs("<p>", r->out);
    if (r->choices.cell_count)
        report_choices_methods(r);
    if (r->factors.count)
        fputs("Levels of a factor were compared in cells that are otherwise the same, between or within "
              "people as their trials were planned: between people by Fisher\u2019s exact test of one "
              "answer each, else by exchanging whole people; within people by McNemar\u2019s exact test "
              "or Cochran\u2019s Q of one answer each, else by the t-test of each person\u2019s "
              "difference. The interval of a difference within people of one answer each is Fay and "
              "Lumbard\u2019s (2021), which agrees with McNemar\u2019s exact test. ",
              r->out);
    if (r->ratings.question_count)
        fputs(
            "First ratings were compared between the two order groups by Welch\u2019s t-test, and the second "
            "with the "
            "first rating within each group by a paired t-test and by Wilcoxon\u2019s signed-rank test (exact "
            "with ties, zeros dropped). ",
            r->out);
    if (r->ratings.options.count)
        fputs(
            "Ratings of both options of a trial were compared within people by paired t-tests with Holm\u2019s "
            "adjustment over cells, and by Wilcoxon\u2019s signed-rank test. ",
            r->out);
    if (r->ratings.factorials.count)
        fputs(
            "Ratings over crossed factors were averaged per person and cell and analysed by a full factorial "
            "analysis of variance within participants; sphericity is not tested but always corrected for, and "
            "Greenhouse\u2013Geisser\u2019s p decides. Levels of factors with an effect were compared by "
            "paired "
            "t-tests with Holm\u2019s adjustment. People without a rating in every cell are left out. ",
            r->out);
    if (ratings_any(&r->ratings))
        fputs("d is Cohen\u2019s (d<sub>z</sub>: in the SD of the differences), with exact intervals by the "
              "noncentral t distribution. ",
              r->out);
    report_planned_methods(r);
    report_equivalence_methods(r);
    html_printf(r->out,
                "Intervals cover %g\u00a0%%. Where Holm is not named, p-values are not corrected for "
                "the number of tests. ",
                100 * r->conf);
    if (r->sample->simulated)
        fputs("<strong>All sessions are simulated:</strong> the answers come from a model that reads image "
              "errors, and say "
              "nothing about people.",
              r->out);
    fputs("</p>\n", r->out);
}
