#include "analysis/report/choices.h"

#include "analysis/tools/alternatives.h"
#include "analysis/tools/arguments.h"
#include "analysis/tools/binomial_json.h"
#include "analysis/tools/choices_effects.h"
#include "analysis/tools/choices_equivalence.h"
#include "analysis/tools/choices_factors.h"
#include "analysis/tools/choices_people.h"
#include "analysis/tools/choices_three.h"
#include "analysis/tools/study_arguments.h"
#include "analysis/tools/table.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

static const char help[] =
    "usage: fovstats choices DB... [--p P] [--alternative two-sided|less|greater] [--conf C] [--margin M]\n"
    "                        [--simulated] [--json]\n"
    "\n"
    "How often the test option was chosen, per cell (block, factor levels and options), tested against one\n"
    "half, with toggles before answering and reaction time. Left and right are resolved by the stored test "
    "slot.\n"
    "  --p P            the preference under the null hypothesis (0.5)\n"
    "  --alternative A  two-sided, less or greater\n"
    "  --conf C         confidence of intervals and null regions (0.95)\n"
    "  --margin M       tests whether the preference lies within P - M to P + M, by two one-sided tests; by "
    "default\n"
    "                   the margin that the protocol planned, about one half; equality that was planned is "
    "claimed\n"
    "                   by the planned analyses' Holm's p, of other cells by that over the tests of a "
    "difference\n"
    "                   and of equality of all of them\n"
    "  --simulated      analyse simulated sessions, which are left out otherwise\n"
    "  --protocol N     analyse the sessions of this protocol; else of the one with most sessions\n"
    "  --json           one object with the cells in an array\n"
    "Where nobody answered more than once in a cell: the exact binomial test, Clopper-Pearson interval and "
    "the\n"
    "null region for the cell's own n. Where somebody did, people are tested, not answers: the exact "
    "sign-flip\n"
    "test of one half (the t-test of the people's shares against another P), the t interval of the shares, and "
    "a\n"
    "logistic mixed model; the binomial test of all answers stands below as the papers have it. Holm's p is\n"
    "adjusted for all cells with an answer.\n"
    "Levels of a factor, between or within people as their trials were planned: between people Fisher's\n"
    "exact test of one answer each, else people are exchanged; within people McNemar's test or Cochran's Q\n"
    "of one answer each, else the t-test of each person's difference. Who does not fit is left out and said.\n"
    "Last, effects on choices that are no preference: of side, order, place in the session, previous answer,\n"
    "switches and viewing time, by person, with Holm's p over these checks.\n";

// What stands below the cells.
struct parts {
    struct choice_factors factors;
    struct effects effects;
    struct choices_margin margin;
};

static void print_notes(const struct sample *sample, const struct choices *c)
{
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

static void number_cell(struct table *t, double value)
{
    if (isnan(value))
        table_cell(t, "-");
    else
        table_cell(t, "%.2f", value);
}

static void cell_row(struct table *t, const struct choice_cell *cell)
{
    const struct stat_region *region = &cell->binomial.null_region;
    table_cell(t, "%s", cell->block);
    table_cell(t, "%s", cell->label);
    table_cell(t, "%" PRId64, cell->chosen);
    table_cell(t, "%" PRId64, cell->n);
    table_cell(t, "%zu", stat_people_sum(cell->counts, cell->people).people);
    table_cell(t, "%.1f", 100 * cell->estimate);
    table_cell(t, "%s", choice_method_word(cell->method));
    choices_p_cell(t, cell->p_value);
    choices_p_cell(t, cell->holm);
    choices_range_cell(t, cell->ci);
    if (cell->method == CHOICE_BINOMIAL)
        table_cell(t, "%" PRId64 " to %" PRId64, region->low, region->high);
    else
        table_cell(t, "-");
    number_cell(t, cell->toggles.mean);
    number_cell(t, cell->toggles.sd);
    number_cell(t, cell->reaction_median_s);
}

static bool print_text(const struct sample *sample, const struct choices *c, const struct parts *parts)
{
    char ci[32];
    snprintf(ci, sizeof ci, "%g %% CI", 100 * c->conf);
    const char *const headings[] = {"<block",      "<cell",   "chosen", "n",          "people",
                                    "%",           "<test",   "p",      "Holm p",     ci,
                                    "null region", "toggles", "SD",     "reaction s", NULL};
    struct table t;
    table_init(&t, headings);
    bool equal = false;
    for (size_t i = 0; i < c->cell_count; i++) {
        cell_row(&t, &c->cells[i]);
        equal = equal || c->cells[i].equal;
    }
    bool ok = table_print(&t, stdout);
    table_finish(&t);
    printf(
        "\nchosen: answers for the test option, tested against %g, %s; Holm p: adjusted for %zu %s; reaction: "
        "median.\n",
        c->p0, alternative_words[c->alternative], c->tested, c->tested == 1 ? "cell" : "cells");
    if (c->several)
        puts("%: where somebody answered several times, the mean of the people's shares, each counting the "
             "same; "
             "chosen and n are of all\nanswers together.");
    if (c->toggles.n > 1)
        printf("Toggles over all answers: M %.2f, SD %.2f.\n", c->toggles.mean, c->toggles.sd);
    for (size_t i = 0; equal && i < c->cell_count; i++)
        if (c->cells[i].equal)
            printf("%s: %" PRId64 " answers \"equal\" are not part of n.\n", c->cells[i].label,
                   c->cells[i].equal);
    ok = ok && (!c->several || choices_people_print(c)) && choices_factors_print(&parts->factors) &&
         choices_three_print(c) && choices_equivalence_print(c, &parts->margin) &&
         choices_effects_print(&parts->effects);
    print_notes(sample, c);
    return ok;
}

static void cell_json(struct json *json, const struct sample *sample, const struct choice_cell *cell,
                      double conf)
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
    struct stat_binomial shown = cell->binomial; // the members of a binomial test, with the test that was made
    shown.p_value = cell->p_value;
    shown.estimate = cell->estimate;
    shown.ci = cell->ci;
    if (cell->method != CHOICE_BINOMIAL)
        shown.null_region = (struct stat_region){1, 0};
    binomial_json(json, &shown);
    json_text(json, "method", choice_method_word(cell->method));
    json_number(json, "p_holm", cell->holm);
    json_integer(json, "equal", cell->equal);
    json_integer(json, "participants", (int64_t)stat_people_sum(cell->counts, cell->people).people);
    json_bool(json, "several_answers", cell->several);
    json_number(json, "overdispersion", cell->overdispersion);
    if (cell->several)
        choices_people_json(json, cell, conf);
    json_bool(json, "right_answers", cell->right);
    json_number(json, "toggles_mean", cell->toggles.mean);
    json_number(json, "toggles_sd", cell->toggles.sd);
    json_number(json, "reaction_s_median", cell->reaction_median_s);
    json_close(json, '}');
}

static bool print_json(const struct sample *sample, const struct choices *c, const struct parts *parts)
{
    struct json json = {stdout, false};
    json_open(&json, NULL, '{');
    study_title_json(&json, sample);
    json_number(&json, "conf", c->conf);
    json_text(&json, "alternative", alternative_words[c->alternative]);
    json_integer(&json, "cells_tested", (int64_t)c->tested);
    json_open(&json, "cells", '[');
    for (size_t i = 0; i < c->cell_count; i++)
        cell_json(&json, sample, &c->cells[i], c->conf);
    json_close(&json, ']');
    choices_contrasts_json(&json, c);
    choices_factors_json(&json, &parts->factors);
    bool ok = choices_three_json(&json, c);
    ok = choices_equivalence_json(&json, c, &parts->margin) && ok;
    choices_effects_json(&json, &parts->effects);
    json_integer(&json, "answers", c->answers);
    json_number(&json, "toggles_mean", c->toggles.mean);
    json_number(&json, "toggles_sd", c->toggles.sd);
    json_integer(&json, "chosen_first_shown", c->chosen_first);
    json_integer(&json, "first_shown_known", c->first_known);
    json_integer(&json, "chosen_slot_a", c->chosen_a);
    json_open(&json, "left_out", '{');
    json_integer(&json, "excluded", c->excluded);
    json_integer(&json, "not_done", c->not_done);
    json_integer(&json, "other_kinds", c->other_kinds);
    json_integer(&json, "no_test_option", c->no_test_slot);
    json_close(&json, '}');
    json_close(&json, '}');
    putchar('\n');
    return ok;
}

// Checks what was typed. Returns -1 to go on, else the exit code after a sentence.
static int check(const struct command *command, const char *word, struct choices_desc *desc)
{
    if (!(desc->p0 > 0 && desc->p0 < 1))
        return command_fail(command, EXIT_USAGE, "--p is %g but must lie between 0 and 1", desc->p0);
    return alternative_parse(command, word, &desc->alternative);
}

static int check_margin(const struct command *command, double margin, double p0, double conf)
{
    if (isnan(margin))
        return -1;
    if (!(margin > 0 && p0 - margin >= 0 && p0 + margin <= 1))
        return command_fail(command, EXIT_USAGE,
                            "--margin is %g but must be above 0, and %g less or plus it must be from 0 to 1",
                            margin, p0);
    if (!(conf > 0.5))
        return command_fail(command, EXIT_USAGE, "--conf is %g but --margin needs more than 0.5", conf);
    return -1;
}

static int run(const struct command *command, int argc, char **argv)
{
    struct study_arguments arguments;
    struct sample sample;
    struct choices_desc desc = {.p0 = 0.5};
    const char *word = alternative_words[STAT_TWO_SIDED];
    double margin = (double)NAN;
    const struct option own[] = {{"--p", OPTION_NUMBER, &desc.p0},
                                 {"--alternative", OPTION_TEXT, &word},
                                 {"--margin", OPTION_NUMBER, &margin}};
    int code = study_arguments_load_with(command, argc, argv, false, own, sizeof own / sizeof own[0],
                                         &arguments, &sample);
    if (code >= 0)
        return code;
    code = check(command, word, &desc);
    if (code < 0)
        code = check_margin(command, margin, desc.p0, arguments.conf);
    if (code >= 0) {
        sample_free(&sample);
        return code;
    }
    desc.conf = arguments.conf;
    char error[SAMPLE_ERROR_SIZE];
    struct choices c;
    struct parts parts = {0};
    if (!choices_load_for(&c, &sample, &desc, error, sizeof error)) {
        code = command_fail(command, EXIT_FAILED, "%s", error);
    } else if (c.cell_count == 0) {
        code = command_fail(command, EXIT_FAILED, "%s: no choice was recorded that counts",
                            store_reader_path(sample.files[0]));
    } else if (!choice_factors_load(&parts.factors, &c)) {
        code = command_fail(command, EXIT_FAILED, "not enough memory");
    } else if (!choices_margin_load(&parts.margin, margin, &sample, &c, error, sizeof error) ||
               !effects_load(&parts.effects, &sample, desc.conf, error, sizeof error)) {
        code = command_fail(command, EXIT_FAILED, "%s", error);
    } else if (arguments.json) {
        code = print_json(&sample, &c, &parts) ? command_finish(command)
                                               : command_fail(command, EXIT_FAILED, "not enough memory");
    } else {
        study_title(&sample, "Choices");
        code = print_text(&sample, &c, &parts) ? command_finish(command)
                                               : command_fail(command, EXIT_FAILED, "not enough memory");
    }
    choices_margin_free(&parts.margin);
    choice_factors_free(&parts.factors);
    choices_free(&c);
    sample_free(&sample);
    return code;
}

const struct command command_choices = {"choices", "percent of choices per cell with exact tests", help, run};
