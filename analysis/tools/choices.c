#include "analysis/report/choices.h"

#include "analysis/tools/arguments.h"
#include "analysis/tools/binomial_json.h"
#include "analysis/tools/study_arguments.h"
#include "analysis/tools/table.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>

static const char help[] =
    "usage: fovstats choices DB... [--conf C] [--simulated] [--json]\n"
    "\n"
    "How often the test option was chosen, per cell (block, factor levels and options): percent, exact\n"
    "two-sided binomial p against 0.5, Clopper-Pearson interval, the null region for the cell's own n,\n"
    "toggles before answering and reaction time. Left and right are resolved by the stored test slot.\n"
    "  --conf C     confidence of interval and null region (0.95)\n"
    "  --simulated  analyse simulated sessions, which are left out otherwise\n"
    "  --protocol N analyse the sessions of this protocol; else of the one with most sessions\n"
    "  --json       one object with the cells in an array\n"
    "The test takes a cell's answers as independent. A cell with several answers of one person is\n"
    "marked \"pooled\": its p and interval are then too optimistic.\n";

static void print_notes(const struct sample *sample, const struct choices *c)
{
    if (c->pooled)
        puts("* pooled: the cell holds several answers of one person; p and interval take them as independent "
             "and are "
             "too optimistic.");
    study_notes(sample);
    if (c->excluded)
        printf("Left out, answers to excluded trials: %" PRId64 ".\n", c->excluded);
    if (c->not_done)
        printf("Left out, answers to trials that are not done: %" PRId64 ".\n", c->not_done);
    if (c->other_kinds)
        printf("Left out, answers to practice, catch, null and staircase trials: %" PRId64 ".\n",
               c->other_kinds);
    if (c->no_test_slot)
        printf("Left out, answers to trials without a test option: %" PRId64 ".\n", c->no_test_slot);
}

static bool print_text(const struct sample *sample, const struct choices *c)
{
    char ci[32];
    snprintf(ci, sizeof ci, "%g %% CI", 100 * c->conf);
    const char *const headings[] = {"<block", "<cell",       "chosen",  "n",  "%",          "p",
                                    ci,       "null region", "toggles", "SD", "reaction s", NULL};
    struct table t;
    table_init(&t, headings);
    bool equal = false;
    for (size_t i = 0; i < c->cell_count; i++) {
        const struct choice_cell *cell = &c->cells[i];
        const struct stat_binomial *b = &cell->test_of;
        table_cell(&t, "%s", cell->block);
        table_cell(&t, "%s%s", cell->label, cell->pooled ? " *" : "");
        table_cell(&t, "%" PRId64, cell->chosen);
        table_cell(&t, "%" PRId64, cell->n);
        table_cell(&t, "%.1f", 100 * b->estimate);
        table_cell(&t, "%.4f", b->p_value);
        table_cell(&t, "%.1f to %.1f", 100 * b->ci.low, 100 * b->ci.high);
        if (cell->n)
            table_cell(&t, "%" PRId64 " to %" PRId64, b->null_region.low, b->null_region.high);
        else
            table_cell(&t, "none");
        table_cell(&t, "%.2f", cell->toggles.mean);
        table_cell(&t, "%.2f", cell->toggles.sd);
        table_cell(&t, "%.2f", cell->reaction_median_s);
        equal = equal || cell->equal;
    }
    bool ok = table_print(&t, stdout);
    table_finish(&t);
    printf(
        "\nchosen: answers for the test option; reaction: median. Toggles over all answers: M %.2f, SD %.2f.\n",
        c->toggles.mean, c->toggles.sd);
    for (size_t i = 0; equal && i < c->cell_count; i++)
        if (c->cells[i].equal)
            printf("%s: %" PRId64 " answers \"equal\" are not part of n.\n", c->cells[i].label,
                   c->cells[i].equal);
    print_notes(sample, c);
    return ok;
}

static void cell_json(struct json *json, const struct sample *sample, const struct choice_cell *cell)
{
    json_open(json, NULL, '{');
    json_text(json, "block", cell->block);
    json_text(json, "cell", cell->label);
    json_open(json, "factors", '{');
    for (size_t i = 0; i < cell->level_count; i++) {
        if (isnan(cell->levels[i].number))
            json_text(json, cell->levels[i].factor, cell->levels[i].value);
        else
            json_number(json, cell->levels[i].factor, cell->levels[i].number);
    }
    json_close(json, '}');
    json_text(json, "test", cell->test == SAMPLE_NONE ? "" : sample->conditions[cell->test].label);
    json_text(json, "reference",
              cell->reference == SAMPLE_NONE ? "" : sample->conditions[cell->reference].label);
    binomial_json(json, &cell->test_of);
    json_integer(json, "equal", cell->equal);
    json_integer(json, "participants", cell->persons);
    json_bool(json, "pooled", cell->pooled);
    json_number(json, "toggles_mean", cell->toggles.mean);
    json_number(json, "toggles_sd", cell->toggles.sd);
    json_number(json, "reaction_s_median", cell->reaction_median_s);
    json_close(json, '}');
}

static void print_json(const struct sample *sample, const struct choices *c)
{
    struct json json = {stdout, false};
    json_open(&json, NULL, '{');
    study_title_json(&json, sample);
    json_number(&json, "conf", c->conf);
    json_open(&json, "cells", '[');
    for (size_t i = 0; i < c->cell_count; i++)
        cell_json(&json, sample, &c->cells[i]);
    json_close(&json, ']');
    json_integer(&json, "answers", c->answers);
    json_number(&json, "toggles_mean", c->toggles.mean);
    json_number(&json, "toggles_sd", c->toggles.sd);
    json_integer(&json, "chosen_first_shown", c->chosen_first);
    json_integer(&json, "chosen_slot_a", c->chosen_a);
    json_open(&json, "left_out", '{');
    json_integer(&json, "excluded", c->excluded);
    json_integer(&json, "not_done", c->not_done);
    json_integer(&json, "other_kinds", c->other_kinds);
    json_integer(&json, "no_test_option", c->no_test_slot);
    json_close(&json, '}');
    json_close(&json, '}');
    putchar('\n');
}

static int run(const struct command *command, int argc, char **argv)
{
    struct study_arguments arguments;
    struct sample sample;
    int code = study_arguments_load(command, argc, argv, false, &arguments, &sample);
    if (code >= 0)
        return code;
    char error[SAMPLE_ERROR_SIZE];
    struct choices c;
    if (!choices_load(&c, &sample, arguments.conf, error, sizeof error)) {
        code = command_fail(command, EXIT_FAILED, "%s", error);
    } else if (c.cell_count == 0) {
        code = command_fail(command, EXIT_FAILED, "%s: no choice was recorded that counts",
                            store_reader_path(sample.files[0]));
    } else if (arguments.json) {
        print_json(&sample, &c);
        code = command_finish(command);
    } else {
        study_title(&sample, "Choices");
        code = print_text(&sample, &c) ? command_finish(command)
                                       : command_fail(command, EXIT_FAILED, "not enough memory");
    }
    choices_free(&c);
    sample_free(&sample);
    return code;
}

const struct command command_choices = {"choices", "percent of choices per cell with exact tests", help, run};
