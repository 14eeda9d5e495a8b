// What `fovstats power` says of one planned test.
#include "analysis/stats/power_simulation.h"
#include "analysis/tools/arguments.h"
#include "analysis/tools/power_plan.h"
#include "analysis/tools/table.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>

static const double none = (double)NAN;

struct row {
    int64_t people;
    struct stat_simulated_power power; // exact: ci is NaN
};

static struct stat_simulated_power simulate(const struct power_plan *plan, const struct power_case *c,
                                            int64_t n)
{
    const struct stat_simulation simulation = {.choices = c->choices,
                                               .choices_count = c->count,
                                               .people = (size_t)power_case_people(c, n),
                                               .share = plan->share,
                                               .sd = plan->sd,
                                               .alpha = plan->alpha,
                                               .studies = (int64_t)plan->studies,
                                               .seed = (uint64_t)plan->seed,
                                               .margin = isnan(plan->margin) ? 0 : plan->margin};
    return stat_simulate_power(&simulation);
}

static bool fill(const struct power_plan *plan, const struct power_case *c, struct row *rows)
{
    const struct power_test *test = power_plan_test(plan, c);
    for (int64_t n = plan->from; n <= plan->to && plan->from; n++) {
        struct row *row = &rows[n - plan->from];
        *row = (struct row){n, {none, {none, none}, 0, none}};
        if (test->at)
            row->power.power = test->at(plan, c, n);
        else if (power_case_choices(c, n) == 0) // nobody of so few has a choice to make
            row->power = (struct stat_simulated_power){0, {0, 0}, 0, none};
        else
            row->power = simulate(plan, c, n);
        if (isnan(row->power.power))
            return false;
    }
    return true;
}

// The smallest size of the range from which on all have the power; 0: none.
static int64_t enough(const struct power_plan *plan, const struct row *rows)
{
    int64_t found = 0;
    for (int64_t n = plan->to; n >= plan->from && rows[n - plan->from].power.power >= plan->power; n--)
        found = n;
    return found;
}

static void print_json(struct json *json, const struct power_plan *plan, const struct power_case *c,
                       const struct row *rows)
{
    const struct power_test *test = power_plan_test(plan, c);
    json_open(json, NULL, '{');
    json_text(json, "cell", c->name);
    json_text(json, "method", test->method);
    json_open(json, "sizes", '[');
    for (int64_t n = plan->from; n <= plan->to && plan->from; n++) {
        const struct row *row = &rows[n - plan->from];
        json_open(json, NULL, '{');
        json_integer(json, "people", row->people);
        json_integer(json, "in_cell", power_case_people(c, row->people));
        json_number(json, "power", row->power.power);
        json_number(json, "ci_low", row->power.ci.low);
        json_number(json, "ci_high", row->power.ci.high);
        json_close(json, '}');
    }
    json_close(json, ']');
    if (test->needed) {
        struct stat_sample_size size = test->needed(plan, c);
        json_number(json, "people_first", size.first ? (double)size.first : none);
        json_number(json, "people_stays", size.stays ? (double)size.stays : none);
    } else {
        int64_t in_range = enough(plan, rows);
        json_number(json, "people_in_range", in_range ? (double)in_range : none);
    }
    json_close(json, '}');
}

// "49 people", or "98 participants of the whole study, 49 of them in this cell"
static void size_words(const struct power_case *c, int64_t people, char out[128])
{
    if (c->of)
        snprintf(out, 128, "%" PRId64 " participants of the whole study, %" PRId64 " of them in this cell",
                 people, power_case_people(c, people));
    else
        snprintf(out, 128, "%" PRId64 " people", people);
}

static void print_needed(const struct power_plan *plan, const struct power_case *c, const struct row *rows)
{
    const struct power_test *test = power_plan_test(plan, c);
    struct stat_sample_size size = test->needed ? test->needed(plan, c) : (struct stat_sample_size){0, 0};
    int64_t in_range = test->needed ? 0 : enough(plan, rows);
    char words[128];
    size_words(c, test->needed ? size.first : in_range, words);
    if (test->needed && size.first == size.stays && size.first)
        printf("A power of %g needs %s; every larger number has it.\n", plan->power, words);
    else if (test->needed && size.first)
        printf("A power of %g needs %s; from %" PRId64 " on every larger number has it.\n", plan->power, words,
               size.stays);
    else if (test->needed)
        printf("A power of %g is not reached by any number of people that was looked at.\n", plan->power);
    else if (in_range)
        printf("A power of %g is reached from %s on, within the sizes above.\n", plan->power, words);
    else
        printf("A power of %g is not reached within the sizes above.\n", plan->power);
    putchar('\n');
}

static void heads(struct table *t, const struct power_test *test, bool part)
{
    static const char *const exact[] = {"people", "power", NULL},
                             *const simulated[] = {"people", "power", "95 % of simulation", NULL},
                             *const part_exact[] = {"participants", "in this cell", "power", NULL},
                             *const part_simulated[] = {"participants", "in this cell", "power",
                                                        "95 % of simulation", NULL};
    if (part)
        table_init(t, test->at ? part_exact : part_simulated);
    else
        table_init(t, test->at ? exact : simulated);
}

static bool print_text(const struct power_plan *plan, const struct power_case *c, const struct row *rows)
{
    const struct power_test *test = power_plan_test(plan, c);
    struct table t;
    heads(&t, test, c->of > 0);
    printf("%s%s%s\n", c->name, c->name[0] ? "; " : "", test->method);
    for (int64_t n = plan->from; n <= plan->to && plan->from; n++) {
        const struct row *row = &rows[n - plan->from];
        table_cell(&t, "%" PRId64, n);
        if (c->of)
            table_cell(&t, "%" PRId64, power_case_people(c, n));
        table_cell(&t, "%.4f", row->power.power);
        if (!test->at)
            table_cell(&t, "%.4f to %.4f", row->power.ci.low, row->power.ci.high);
    }
    bool ok = !plan->from || table_print(&t, stdout);
    table_finish(&t);
    print_needed(plan, c, rows);
    return ok;
}

int power_show(const struct command *command, const struct power_plan *plan, const struct power_case *c,
               struct json *json)
{
    struct row *rows = calloc((size_t)(plan->to - plan->from + 1), sizeof *rows);
    bool ok = rows && fill(plan, c, rows);
    if (ok && plan->json)
        print_json(json, plan, c, rows);
    else if (ok)
        ok = print_text(plan, c, rows);
    free(rows);
    return ok ? -1
              : command_fail(command, EXIT_FAILED,
                             "%s%sthe power of this design cannot be calculated: not enough memory", c->name,
                             c->name[0] ? ": " : "");
}
