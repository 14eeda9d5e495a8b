#include "app/fovstudy/check_report.h"

#include "app/fovstudy/check_figures.h"

#include <stdlib.h>
#include <string.h>

static void add_whole(struct text *text, char *part)
{
    if (part)
        text_add(text, "%s", part);
    else
        text->failed = true;
    free(part);
}

static bool follows(const struct check_report *report, uint32_t block)
{
    return report->carry[block].pairs > 0 && report->protocol->blocks[block].kind != PROTOCOL_STAIRCASE;
}

static void carry_text(struct text *text, const struct check_report *report)
{
    bool first = true;
    for (uint32_t b = 0; b < report->protocol->block_count; b++) {
        const struct plan_carry *carry = &report->carry[b];
        if (!follows(report, b))
            continue;
        text_add(text, first ? "\ncarry-over: how often a cell came right after another one\n" : "");
        first = false;
        bool balanced = carry->least == carry->most;
        text_add(text, "  %s: %u pairs, each %u", report->protocol->blocks[b].name, carry->pairs, carry->least);
        if (!balanced)
            text_add(text, " to %u", carry->most);
        text_add(text, " time%s; even would be %.3g%s\n", carry->most == 1 ? "" : "s", carry->even,
                 balanced ? ": balanced" : "");
    }
}

static void clock_write(struct text *text, double seconds)
{
    long whole = (long)(seconds + 0.5);
    if (whole >= 3600)
        text_add(text, "%ld:%02ld:%02ld", whole / 3600, whole / 60 % 60, whole % 60);
    else
        text_add(text, "%ld:%02ld", whole / 60, whole % 60);
}

static void duration_text(struct text *text, const struct check_report *report)
{
    const struct duration *d = &report->duration;
    const struct {
        const char *name;
        double seconds;
    } parts[] = {{"looking", d->looking},
                 {"fades", d->fading},
                 {"later answers", d->answers},
                 {"other screens", d->screens},
                 {"rests and breaks", d->resting}};
    text_add(text, "\nexpected duration: ");
    clock_write(text, d->total);
    text_add(text, " (");
    for (size_t i = 0; i < sizeof parts / sizeof parts[0]; i++) {
        text_add(text, "%s%s ", i ? ", " : "", parts[i].name);
        clock_write(text, parts[i].seconds);
    }
    text_add(
        text,
        ")\n  assumed, as the simulated observer has it: %g switches a trial, %g s at each image between them, "
        "%g s\n  where one looks at one option as long as one likes, %g s for an answer and to go on from a "
        "screen;\n  nothing for reading, loading and putting the headset on\n",
        report->pace.toggles_mean, report->pace.dwell_s, report->pace.view_s, report->pace.answer_s);
}

char *check_report_text(const struct check_report *report)
{
    struct text text = {0};
    add_whole(&text, plan_table_text(report->plan));
    text_add(&text, "\n");
    add_whole(&text, plan_counts_text(report->protocol, report->seed, 0, report->people));
    carry_text(&text, report);
    duration_text(&text, report);
    check_figures_text(&text, &report->analyses, report->people, report->people_assumed);
    if (*report->remarks)
        text_add(&text, "\nremarks\n%s", report->remarks);
    return text_take(&text);
}

static void number_json(struct text *text, const char *name, double value, bool first)
{
    text_add(text, "%s\"%s\":", first ? "" : ",", name);
    text_number(text, value);
}

static void duration_json(struct text *text, const struct check_report *report)
{
    const struct duration *d = &report->duration;
    text_add(text, ",\n\"duration_s\":{");
    number_json(text, "total", d->total, true);
    number_json(text, "looking", d->looking, false);
    number_json(text, "fading", d->fading, false);
    number_json(text, "answers", d->answers, false);
    number_json(text, "screens", d->screens, false);
    number_json(text, "resting", d->resting, false);
    text_add(text, "},\n\"assumed\":{");
    number_json(text, "toggles", report->pace.toggles_mean, true);
    number_json(text, "dwell_s", report->pace.dwell_s, false);
    number_json(text, "view_s", report->pace.view_s, false);
    number_json(text, "answer_s", report->pace.answer_s, false);
    text_add(text, "}");
}

static void carry_json(struct text *text, const struct check_report *report)
{
    bool first = true;
    text_add(text, ",\n\"carry_over\":[");
    for (uint32_t b = 0; b < report->protocol->block_count; b++) {
        const struct plan_carry *carry = &report->carry[b];
        if (!follows(report, b))
            continue;
        text_add(text, "%s{\"block\":\"%s\",\"pairs\":%u,\"least\":%u,\"most\":%u", first ? "" : ",",
                 report->protocol->blocks[b].name, carry->pairs, carry->least, carry->most);
        number_json(text, "even", carry->even, false);
        text_add(text, "}");
        first = false;
    }
    text_add(text, "]");
}

static void remarks_json(struct text *text, const char *remarks)
{
    text_add(text, ",\n\"remarks\":[");
    for (const char *line = remarks; *line;) {
        size_t length = strcspn(line, "\n");
        char *one = strndup(line, length);
        text->failed = text->failed || !one;
        text_add(text, line == remarks ? "" : ",");
        text_json_string(text, one ? one : "");
        free(one);
        line += length + (line[length] != '\0');
    }
    text_add(text, "]");
}

// The plan's own object with more members.
char *check_report_json(const struct check_report *report)
{
    struct text text = {0};
    char *table = plan_table_json(report->plan), *end = table ? strrchr(table, '}') : NULL;
    if (end)
        *end = '\0';
    add_whole(&text, table);
    text_add(&text, ",\n\"group\":%u,\"groups\":%u,\"participants\":%u,\n\"counts\":", report->plan->group + 1,
             protocol_groups(report->protocol), report->people);
    add_whole(&text, plan_counts_json(report->protocol, report->seed, 0, report->people));
    carry_json(&text, report);
    duration_json(&text, report);
    check_figures_json(&text, &report->analyses);
    remarks_json(&text, report->remarks);
    text_add(&text, "}\n");
    return text_take(&text);
}
