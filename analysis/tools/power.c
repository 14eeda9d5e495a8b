#include "analysis/stats/power.h"
#include "analysis/report/choices.h"
#include "analysis/stats/binomial_sample_size.h"
#include "analysis/stats/power_simulation.h"
#include "analysis/tools/arguments.h"
#include "analysis/tools/json.h"
#include "analysis/tools/table.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char help[] =
    "usage: fovstats power --share P [--people N | --people FROM..TO] [--choices C] [--sd SD] [--alpha A]\n"
    "                      [--power W] [--studies S] [--seed N] [--json]\n"
    "       fovstats power REHEARSAL.db [--simulated] --share P --people FROM..TO [the same options]\n"
    "\n"
    "How often a study of so many people finds a preference of P for the option under test, with the test "
    "that\n"
    "fovstats choices would make: the exact binomial test where everybody chooses once in a cell, the "
    "sign-flip\n"
    "test of people where somebody chooses several times. One choice each is calculated exactly, several are\n"
    "simulated; the interval is the simulation's own error (95 %).\n"
    "  REHEARSAL.db  take each cell's choices per person from this study file, as the protocol's own plans "
    "made\n"
    "                them: rehearse with fovstudy run PROTOCOL --participants N --observer sim\n"
    "  --simulated   its simulated sessions, as of a rehearsal\n"
    "  --share P     the mean preference over people, above 0 and below 1\n"
    "  --people N    how many, or a range of up to 200 sizes (10..60)\n"
    "  --choices C   choices of each person in a cell (1)\n"
    "  --sd SD       how people differ: standard deviation of their preference in logits (0.5 where choices "
    "are\n"
    "                several; one choice each does not depend on it)\n"
    "  --alpha A     level of the test, two-sided (0.05)\n"
    "  --power W     also say how many people reach it (0.8)\n"
    "  --studies S   simulated ones per size (2000)\n"
    "  --seed N      of the simulation (1)\n"
    "  --json        one object with the sizes in an array\n";

enum { SIZES = 200 };

struct plan {
    double share, sd, alpha, power, studies, seed, choices;
    int64_t from, to;
    bool json, simulated;
    struct sample sample; // of a rehearsal
    struct choices cells;
};

static int check_range(const struct command *command, const char *name, double value, double low, double high,
                       bool whole)
{
    if (value >= low && value <= high && (!whole || value == floor(value)))
        return -1;
    return command_fail(command, EXIT_USAGE, "%s is %g but must be %sfrom %g to %g", name, value,
                        whole ? "a whole number " : "", low, high);
}

static int check_open(const struct command *command, const char *name, double value)
{
    if (value > 0 && value < 1)
        return -1;
    return command_fail(command, EXIT_USAGE, "%s is %g but must lie between 0 and 1", name, value);
}

static int check_people(const struct command *command, const char *text, struct plan *plan)
{
    char first[32] = "";
    const char *dots = strstr(text, "..");
    snprintf(first, sizeof first, "%.*s", (int)(dots ? (size_t)(dots - text) : strlen(text)), text);
    bool ok = arguments_integer(first, &plan->from);
    plan->to = plan->from;
    if (dots)
        ok = ok && arguments_integer(dots + 2, &plan->to);
    if (ok && plan->from >= 1 && plan->from <= plan->to && plan->to <= STAT_SIMULATED_PEOPLE &&
        plan->to - plan->from < SIZES)
        return -1;
    return command_fail(
        command, EXIT_USAGE,
        "--people is \"%s\" but must be a number from 1 to %d, or a range of up to %d of them such "
        "as 10..60",
        text, STAT_SIMULATED_PEOPLE, SIZES);
}

static int check(const struct command *command, const char *people, bool rehearsal, struct plan *plan)
{
    int code = -1;
    if (isnan(plan->share))
        return command_fail(command, EXIT_USAGE, "needs --share P, the preference to be found; see --help");
    if (!people && (rehearsal || plan->choices != 1))
        return command_fail(command, EXIT_USAGE, "needs --people N or FROM..TO where studies are simulated");
    if ((code = check_open(command, "--share", plan->share)) >= 0 ||
        (code = check_open(command, "--alpha", plan->alpha)) >= 0 ||
        (code = check_open(command, "--power", plan->power)) >= 0 ||
        (code = check_range(command, "--sd", plan->sd, 0, 10, false)) >= 0 ||
        (code = check_range(command, "--choices", plan->choices, 1, STAT_SIMULATED_CHOICES, true)) >= 0 ||
        (code = check_range(command, "--studies", plan->studies, 100, STAT_SIMULATED_STUDIES, true)) >= 0 ||
        (code = check_range(command, "--seed", plan->seed, 0, 9007199254740992.0, true)) >= 0)
        return code;
    return people ? check_people(command, people, plan) : -1;
}

struct row {
    int64_t people;
    struct stat_simulated_power power; // exact: ci is NaN
};

// The power for every size; exact where everybody chooses once.
static bool fill(const struct plan *plan, const int64_t *choices, size_t count, bool exact, struct row *rows)
{
    for (int64_t n = plan->from; n <= plan->to; n++) {
        struct row *row = &rows[n - plan->from];
        *row = (struct row){n, {(double)NAN, {(double)NAN, (double)NAN}, 0, (double)NAN}};
        if (exact) {
            row->power.power = stat_binomial_power(n, 0.5, plan->share, plan->alpha);
            continue;
        }
        const struct stat_simulation simulation = {choices,
                                                   count,
                                                   (size_t)n,
                                                   plan->share,
                                                   plan->sd,
                                                   plan->alpha,
                                                   (int64_t)plan->studies,
                                                   (uint64_t)plan->seed};
        row->power = stat_simulate_power(&simulation);
        if (isnan(row->power.power))
            return false;
    }
    return true;
}

// The smallest size of the range from which on all have the power; 0: none.
static int64_t enough(const struct plan *plan, const struct row *rows)
{
    int64_t found = 0;
    for (int64_t n = plan->to; n >= plan->from && rows[n - plan->from].power.power >= plan->power; n--)
        found = n;
    return found;
}

static void print_json(struct json *json, const struct plan *plan, const char *cell, bool exact,
                       const struct row *rows)
{
    json_open(json, NULL, '{');
    json_text(json, "cell", cell);
    json_text(json, "method", exact ? "exact binomial" : "simulated sign-flip");
    json_open(json, "sizes", '[');
    for (int64_t n = plan->from; n <= plan->to && plan->from; n++) {
        const struct row *row = &rows[n - plan->from];
        json_open(json, NULL, '{');
        json_integer(json, "people", row->people);
        json_number(json, "power", row->power.power);
        json_number(json, "ci_low", row->power.ci.low);
        json_number(json, "ci_high", row->power.ci.high);
        json_close(json, '}');
    }
    json_close(json, ']');
    if (exact) {
        struct stat_sample_size size = stat_binomial_sample_size(0.5, plan->share, plan->alpha, plan->power);
        json_integer(json, "people_first", size.first);
        json_integer(json, "people_stays", size.stays);
    } else {
        json_integer(json, "people_in_range", enough(plan, rows));
    }
    json_close(json, '}');
}

static bool print_text(const struct plan *plan, const char *cell, bool exact, const struct row *rows)
{
    static const char *const headings[] = {"people", "power", "95 % of simulation", NULL};
    struct table t;
    table_init(&t, headings);
    if (cell[0])
        printf("%s\n", cell);
    for (int64_t n = plan->from; n <= plan->to && plan->from; n++) {
        const struct row *row = &rows[n - plan->from];
        table_cell(&t, "%" PRId64, n);
        table_cell(&t, "%.4f", row->power.power);
        if (exact)
            table_cell(&t, "exact");
        else
            table_cell(&t, "%.4f to %.4f", row->power.ci.low, row->power.ci.high);
    }
    bool ok = !plan->from || table_print(&t, stdout);
    table_finish(&t);
    struct stat_sample_size size = stat_binomial_sample_size(0.5, plan->share, plan->alpha, plan->power);
    int64_t in_range = exact ? 0 : enough(plan, rows);
    if (exact && size.first)
        printf("A power of %g needs %" PRId64 " people; from %" PRId64 " on every larger number has it.\n",
               plan->power, size.first, size.stays);
    else if (exact)
        printf("A power of %g is not reached by any number of people that was looked at.\n", plan->power);
    else if (in_range)
        printf("A power of %g is reached from %" PRId64 " people on, within the sizes above.\n", plan->power,
               in_range);
    else
        printf("A power of %g is not reached within the sizes above.\n", plan->power);
    putchar('\n');
    return ok;
}

static int show(const struct command *command, const struct plan *plan, const char *cell,
                const int64_t *choices, size_t count, struct json *json)
{
    bool exact = true;
    for (size_t i = 0; i < count; i++)
        exact = exact && choices[i] == 1;
    struct row *rows = calloc((size_t)(plan->to - plan->from + 1), sizeof *rows);
    bool ok = rows && (!plan->from || fill(plan, choices, count, exact, rows));
    if (ok && plan->json)
        print_json(json, plan, cell, exact, rows);
    else if (ok)
        ok = print_text(plan, cell, exact, rows);
    free(rows);
    return ok ? -1
              : command_fail(
                    command, EXIT_FAILED,
                    "%s%sthe power of this design cannot be calculated: nobody chooses, or not enough memory",
                    cell, cell[0] ? ": " : "");
}

static int show_cells(const struct command *command, struct plan *plan, struct json *json)
{
    int code = -1;
    for (size_t i = 0; i < plan->cells.cell_count && code < 0; i++) {
        const struct choice_cell *cell = &plan->cells.cells[i];
        int64_t *choices = calloc(cell->people + 1, sizeof *choices);
        char name[256];
        snprintf(name, sizeof name, "%s: %s", cell->block, cell->label);
        for (size_t j = 0; choices && j < cell->people; j++)
            choices[j] = cell->counts[j].n;
        code = choices ? show(command, plan, name, choices, cell->people, json)
                       : command_fail(command, EXIT_FAILED, "not enough memory");
        free(choices);
    }
    return code;
}

static void begin(const struct plan *plan, struct json *json)
{
    if (!plan->json) {
        printf("Power against one half, two-sided at %g, where the mean preference is %g", plan->alpha,
               plan->share);
        if (plan->choices > 1 || plan->sample.file_count)
            printf(" and people differ by %g logits; %g simulated studies a size, seed %.0f", plan->sd,
                   plan->studies, plan->seed);
        puts("");
        if (plan->sample.file_count)
            printf("Choices per person as in the data with SHA-256 %s\n", plan->sample.data_hash);
        puts("");
        return;
    }
    json_open(json, NULL, '{');
    json_text(json, "program", "fovstats " FOVSTUDY_VERSION);
    if (plan->sample.file_count)
        json_text(json, "data_sha256", plan->sample.data_hash);
    json_number(json, "share", plan->share);
    json_number(json, "sd", plan->sd);
    json_number(json, "alpha", plan->alpha);
    json_number(json, "wanted_power", plan->power);
    json_number(json, "studies", plan->studies);
    json_number(json, "seed", plan->seed);
    json_open(json, "cells", '[');
}

static int run(const struct command *command, int argc, char **argv)
{
    struct plan plan = {
        .share = (double)NAN, .sd = 0.5, .alpha = 0.05, .power = 0.8, .studies = 2000, .seed = 1, .choices = 1};
    const char *people = NULL;
    const struct option options[] = {
        {"--share", OPTION_NUMBER, &plan.share},       {"--sd", OPTION_NUMBER, &plan.sd},
        {"--alpha", OPTION_NUMBER, &plan.alpha},       {"--power", OPTION_NUMBER, &plan.power},
        {"--studies", OPTION_NUMBER, &plan.studies},   {"--seed", OPTION_NUMBER, &plan.seed},
        {"--choices", OPTION_NUMBER, &plan.choices},   {"--people", OPTION_TEXT, &people},
        {"--simulated", OPTION_FLAG, &plan.simulated}, {"--json", OPTION_FLAG, &plan.json}};
    int count = 0,
        code = arguments_parse(command, argc, argv, options, sizeof options / sizeof options[0], &count);
    if (code >= 0 || (code = check(command, people, count > 0, &plan)) >= 0)
        return code;
    char error[SAMPLE_ERROR_SIZE];
    struct json json = {stdout, false};
    if (count && (!sample_load(&plan.sample, (const char *const *)argv, (size_t)count, plan.simulated, NULL,
                               error, sizeof error) ||
                  !choices_load(&plan.cells, &plan.sample, 0.95, error, sizeof error)))
        code = command_fail(command, EXIT_FAILED, "%s", error);
    else if (count && !plan.cells.cell_count)
        code =
            command_fail(command, EXIT_FAILED, "%s: no choice was recorded, so no cell has a design", argv[0]);
    if (code < 0) {
        int64_t choices = (int64_t)plan.choices;
        begin(&plan, &json);
        code = count ? show_cells(command, &plan, &json) : show(command, &plan, "", &choices, 1, &json);
    }
    if (code < 0 && plan.json) {
        json_close(&json, ']');
        json_close(&json, '}');
        putchar('\n');
    }
    choices_free(&plan.cells);
    sample_free(&plan.sample);
    return code < 0 ? command_finish(command) : code;
}

const struct command command_power = {"power", "how many people a study needs", help, run};
