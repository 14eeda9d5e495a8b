// What the protocol planned, each with its result: the report's table of planned analyses as text or JSON.
#include "analysis/tools/arguments.h"
#include "analysis/tools/planned_results.h"
#include "analysis/tools/study_arguments.h"
#include "analysis/tools/table.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static const char help[] =
    "usage: fovstats planned DB... [--conf C] [--simulated] [--protocol N] [--json]\n"
    "\n"
    "What the protocol planned under 'analysis', a row for each cell, level, scene or pair of levels: people,\n"
    "estimate, interval and p, with Holm's p over all planned tests. Rows of differences say what is\n"
    "subtracted from what. A margin of equivalence is a test of its own, and equality counts as shown by "
    "Holm's\n"
    "p alone; it and the test of a difference in the same row count once, for one of their hypotheses at most\n"
    "is true. What cannot be computed says why: paired tests and analyses of variance need a\n"
    "factor within people, unpaired ones a factor between them. It lies within where at least half of the\n"
    "people were to see several of its levels. Who does not fit is left out and said.\n"
    "  --conf C     confidence of the intervals (0.95); 1 - C is the level of verdicts\n"
    "  --simulated  analyse simulated sessions, which are left out otherwise\n"
    "  --protocol N analyse the sessions of this protocol; else of the one with most sessions\n"
    "  --json       one object with the plans in an array; shares are from 0 to 1, verdicts are empty but for\n"
    "               tests of equality\n";

static void number_cells(struct table *t, const struct planned_row *row)
{
    double factor = row->share ? 100 : 1;
    const char *unit = row->effect_size  ? " eta2p"
                       : !row->share     ? row->unit
                       : row->difference ? " points"
                                         : " %";
    if (isnan(row->estimate))
        table_cell(t, "-");
    else
        table_cell(t, "%.4g%s%s", factor * row->estimate, strcmp(unit, "s") == 0 ? " " : "", unit);
    if (isnan(row->low))
        table_cell(t, "-");
    else
        table_cell(t, "%.4g to %.4g (%.4g %%)", factor * row->low, factor * row->high, 100 * row->conf);
}

static void p_cell(struct table *t, double p)
{
    if (isnan(p))
        table_cell(t, "-");
    else
        table_cell(t, "%.4g", p);
}

static bool print_plan(const struct planned_results *l, size_t index)
{
    static const char *const headings[] = {"<row", "people", "estimate", "interval",
                                           "p",    "Holm p", "<test",    NULL};
    const struct plan *plan = &l->plans.items[index];
    struct table t;
    table_init(&t, headings);
    for (size_t i = 0; i < l->planned.row_count; i++) {
        const struct planned_row *row = &l->planned.rows[i];
        if (row->plan != index)
            continue;
        table_cell(&t, "%s", row->words[0] ? row->words : "all");
        table_cell(&t, "%zu", row->people);
        number_cells(&t, row);
        p_cell(&t, row->p_value);
        p_cell(&t, row->holm);
        table_cell(&t, "%s%s%s", row->test, row->test[0] && row->note[0] ? "; " : "", row->note);
    }
    bool whole = strcmp(plan->per, "-") == 0;
    printf("%s of %s%s%s", plan->method, plan->of, whole ? "" : " per ", whole ? "" : plan->per);
    if (!isnan(plan->margin))
        printf(", margin %.4g %%", 100 * plan->margin);
    putchar('\n');
    bool ok = table_print(&t, stdout);
    table_finish(&t);
    putchar('\n');
    return ok;
}

static bool print_text(const struct sample *sample, const struct planned_results *l)
{
    bool ok = true;
    study_title(sample, "Planned analyses");
    for (size_t i = 0; i < l->plans.count; i++)
        ok = print_plan(l, i) && ok;
    printf("Holm p: adjusted for the %zu %s above, the planned family. A large p does not show equality.\n",
           l->planned.tested, l->planned.tested == 1 ? "test" : "tests");
    if (planned_equality(&l->planned))
        puts("The test of equality and that of a difference before it count once (Shaffer 1986); both verdicts "
             "are by "
             "Holm's p.");
    study_notes(sample);
    return ok;
}

static void row_json(struct json *json, const struct planned_row *row)
{
    static const char *const verdicts[] = {[STAT_UNDECIDED] = "undecided",
                                           [STAT_DIFFERENT] = "different",
                                           [STAT_WITHIN] = "equal",
                                           [STAT_DIFFERENT_WITHIN] = "different, within the margin"};
    json_open(json, NULL, '{');
    json_text(json, "row", row->words[0] ? row->words : "all");
    json_integer(json, "people", (int64_t)row->people);
    json_integer(json, "people_without_some_cells", (int64_t)row->partial);
    json_integer(json, "people_left_out", (int64_t)row->left_out);
    json_text(json, "estimate_is", row->effect_size ? "partial eta squared" : row->share ? "share" : "mean");
    json_bool(json, "difference", row->difference);
    json_text(json, "unit", row->unit);
    json_number(json, "estimate", row->estimate);
    json_number(json, "ci_low", row->low);
    json_number(json, "ci_high", row->high);
    json_number(json, "ci_conf", isnan(row->low) ? (double)NAN : row->conf);
    json_text(json, "test", row->test);
    json_number(json, "p_value", row->p_value);
    json_number(json, "p_holm", row->holm);
    json_number(json, "equality_margin", row->margin);
    json_text(json, "verdict", isnan(row->margin) || isnan(row->holm) ? "" : verdicts[row->verdict]);
    json_text(json, "note", row->note);
    json_close(json, '}');
}

static void print_json(const struct sample *sample, const struct planned_results *l)
{
    struct json json = {stdout, false};
    json_open(&json, NULL, '{');
    study_title_json(&json, sample);
    json_number(&json, "conf", l->planned.conf);
    json_integer(&json, "tests", (int64_t)l->planned.tested);
    json_open(&json, "plans", '[');
    for (size_t i = 0; i < l->plans.count; i++) {
        const struct plan *plan = &l->plans.items[i];
        json_open(&json, NULL, '{');
        json_text(&json, "method", plan->method);
        json_text(&json, "of", plan->of);
        json_text(&json, "per", plan->per);
        json_number(&json, "margin", plan->margin);
        json_open(&json, "rows", '[');
        for (size_t k = 0; k < l->planned.row_count; k++)
            if (l->planned.rows[k].plan == i)
                row_json(&json, &l->planned.rows[k]);
        json_close(&json, ']');
        json_close(&json, '}');
    }
    json_close(&json, ']');
    json_close(&json, '}');
    putchar('\n');
}

static int analyse(const struct command *command, const struct study_arguments *arguments,
                   struct sample *sample)
{
    int code;
    struct planned_results l;
    char error[SAMPLE_ERROR_SIZE];
    bool ok = true;
    if (!planned_results_load(&l, sample, arguments->conf, error, sizeof error)) {
        code = command_fail(command, EXIT_FAILED, "%s", error);
    } else if (l.plans.count == 0) {
        code = command_fail(command, EXIT_FAILED, "%s: %s", store_reader_path(sample->files[0]),
                            plans_none(sample));
    } else {
        if (arguments->json)
            print_json(sample, &l);
        else
            ok = print_text(sample, &l);
        code = ok ? command_finish(command) : command_fail(command, EXIT_FAILED, "not enough memory");
    }
    planned_results_free(&l);
    return code;
}

static int run(const struct command *command, int argc, char **argv)
{
    return study_arguments_run(command, argc, argv, analyse);
}

const struct command command_planned = {"planned", "what the protocol planned, with results", help, run};
