#include "analysis/report/thresholds.h"

#include "analysis/report/adjusted.h"
#include "analysis/tools/arguments.h"
#include "analysis/tools/study_arguments.h"
#include "analysis/tools/table.h"
#include "analysis/tools/thresholds_json.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

static const char help[] =
    "usage: fovstats thresholds DB... [--family F] [--log] [--larger W] [--bootstrap N] [--conf C]\n"
    "                           [--simulated] [--json]\n"
    "\n"
    "Thresholds of staircases and of constant levels, and adjusted values, person by person and over people.\n"
    "Staircases, per cell (block and factor levels): the staircase's own estimate (up-down: its reversals,\n"
    "QUEST+: posterior mean); a psychometric function fitted to all steps of a person by maximum likelihood,\n"
    "with profile-likelihood interval and goodness of fit; the same by Bayes' rule with overdispersion.\n"
    "The threshold is the level midway between the asymptotes (75 % right where lapses are 0), the slope that\n"
    "of the function between 0 and 1 there, per unit of the level (of its logarithm with --log and weibull).\n"
    "Constant levels, per cell: choices at 3 or more numbers of a factor (right answers) or 5 or more\n"
    "(preferences: the share for the test option, both asymptotes free) have the fits only.\n"
    "Guesses of right answers are fixed at one half. What cannot be estimated is not, and says why.\n"
    "  --family F     logistic (default), weibull, normal or gumbel\n"
    "  --log          on the logarithm of the level\n"
    "  --larger W     whether larger levels are easier or harder; else as the staircases moved\n"
    "  --bootstrap N  replicates for the goodness of fit and the bootstrap interval (199; 0 for none)\n"
    "  --conf C       confidence of the intervals (0.95)\n"
    "  --simulated    analyse simulated sessions, which are left out otherwise\n"
    "  --json         one object with everything\n"
    "Means are over the people who have an estimate; people, not answers, are what intervals count.\n";

enum { SEED = 5, REPLICATES = 199, REPLICATES_MOST = 100000 }; // the seed is one for all studies

// Takes the options that only this subcommand has out of argv. -1, or the exit code.
static int own_options(const struct command *command, int *argc, char **argv, struct threshold_options *out)
{
    int left = 1;
    *out = (struct threshold_options){.replicates = REPLICATES, .seed = SEED, .bayes = true};
    for (int i = 1; i < *argc; i++) {
        const char *value = i + 1 < *argc ? argv[i + 1] : "";
        int64_t number = 0;
        if (strcmp(argv[i], "--family") == 0) {
            if (!stat_family_find(value, &out->family))
                return command_fail(command, EXIT_USAGE,
                                    "--family is \"%s\" but is logistic, weibull, normal or gumbel", value);
            i++;
        } else if (strcmp(argv[i], "--larger") == 0) {
            out->larger = strcmp(value, "easier") == 0   ? THRESHOLD_EASIER
                          : strcmp(value, "harder") == 0 ? THRESHOLD_HARDER
                                                         : THRESHOLD_AS_SHOWN;
            if (out->larger == THRESHOLD_AS_SHOWN)
                return command_fail(command, EXIT_USAGE, "--larger is \"%s\" but is easier or harder", value);
            i++;
        } else if (strcmp(argv[i], "--bootstrap") == 0) {
            if (!arguments_integer(value, &number) || number < 0 || number > REPLICATES_MOST)
                return command_fail(command, EXIT_USAGE,
                                    "--bootstrap is \"%s\" but must be a whole number up to %d", value,
                                    REPLICATES_MOST);
            out->replicates = (size_t)number;
            i++;
        } else if (strcmp(argv[i], "--log") == 0) {
            out->logarithmic = true;
        } else {
            argv[left++] = argv[i];
        }
    }
    *argc = left;
    return -1;
}

// An infinite end is open.
static void interval_cell(struct table *t, double low, double high)
{
    if (isnan(low) || isnan(high))
        table_cell(t, "-");
    else if (isinf(low) && isinf(high))
        table_cell(t, "open at both ends");
    else if (isinf(low))
        table_cell(t, "below %.4g", high);
    else if (isinf(high))
        table_cell(t, "above %.4g", low);
    else
        table_cell(t, "%.4g to %.4g", low, high);
}

static void number_cell(struct table *t, double value)
{
    if (isnan(value))
        table_cell(t, "-");
    else
        table_cell(t, "%.4g", value);
}

static void note_cell(struct table *t, const struct threshold_cell *cell, const struct threshold_person *p)
{
    const struct stat_fit *fit = &p->fit;
    if (cell->graded)
        table_cell(t, "not fitted: answers on a scale");
    else if (fit->status == STAT_FIT_STEP)
        table_cell(t, "not estimable: a jump between %.4g and %.4g", fit->step.low, fit->step.high);
    else if (fit->status != STAT_FIT_OK)
        table_cell(t, "not estimable: %s", stat_fit_reason(fit->status));
    else if (p->bootstrap.replicates && p->bootstrap.unreliable)
        table_cell(t, "bootstrap unreliable (%zu of %zu without a threshold)", p->bootstrap.failed,
                   p->bootstrap.replicates);
    else
        table_cell(t, "%s", "");
}

static void person_row(struct table *t, const struct sample *sample, const struct threshold_cell *cell,
                       const struct threshold_person *p)
{
    bool ok = p->fit.status == STAT_FIT_OK;
    if (cell->pooled)
        table_cell(t, "%zu people", cell->pooled);
    else
        table_cell(t, "%s", sample->people[p->person].code);
    table_cell(t, "%zu", p->step_count);
    if (cell->source == THRESHOLD_STAIRCASES) {
        if (cell->quest)
            table_cell(t, "-");
        else
            table_cell(t, "%" PRId64, p->reversals);
        number_cell(t, p->estimate);
    }
    number_cell(t, ok ? p->fit.function.threshold : (double)NAN);
    interval_cell(t, ok ? p->fit.threshold.low : (double)NAN, p->fit.threshold.high);
    interval_cell(t, p->bootstrap.threshold.low, p->bootstrap.threshold.high);
    number_cell(t, ok ? p->fit.function.slope : (double)NAN);
    if (cell->source == THRESHOLD_LEVELS)
        number_cell(t, ok ? p->fit.function.guess : (double)NAN);
    number_cell(t, ok ? p->fit.function.lapse : (double)NAN);
    number_cell(t, p->bootstrap.deviance_p);
    number_cell(t, p->bayes.threshold.mean);
    interval_cell(t, p->bayes.threshold.credible.low, p->bayes.threshold.credible.high);
    note_cell(t, cell, p);
}

static void mean_row(struct table *t, const char *what, const struct threshold_mean *m, size_t people)
{
    table_cell(t, "%s", what);
    table_cell(t, "%zu of %zu", m->of.n, people);
    number_cell(t, m->of.mean);
    number_cell(t, m->of.sd);
    number_cell(t, m->median);
    interval_cell(t, m->t.ci_low, m->t.ci_high);
}

static bool print_means(const struct threshold_cell *cell, double conf)
{
    char ci[32];
    snprintf(ci, sizeof ci, "%g %% CI of M", 100 * conf);
    const char *const headings[] = {"<over people", "with one", "M", "SD", "median", ci, NULL};
    struct table t;
    table_init(&t, headings);
    if (cell->source == THRESHOLD_STAIRCASES)
        mean_row(&t, cell->quest ? "QUEST+" : "reversals", &cell->by_staircase, cell->person_count);
    if (!cell->graded) {
        mean_row(&t, "maximum likelihood", &cell->by_fit, cell->person_count);
        mean_row(&t, "Bayes", &cell->by_bayes, cell->person_count);
    }
    bool ok = table_print(&t, stdout);
    table_finish(&t);
    if (!cell->graded && cell->by_fit.of.n < cell->person_count)
        puts("People without a maximum-likelihood threshold are not in its mean, and not by chance.");
    if (cell->prior_bound)
        printf("Bayes: the interval of %zu of %zu reaches beyond the levels shown, where the prior decides.\n",
               cell->prior_bound, cell->by_bayes.of.n);
    putchar('\n');
    return ok;
}

static void print_heading(const struct threshold_cell *cell)
{
    printf("%s, %s: %s", cell->block, cell->label, cell->parameter);
    if (cell->undirected && !cell->graded)
        printf(", nothing tells whether larger is harder: no Bayes without --larger");
    else if (cell->preference)
        printf(", the test option is chosen %s at larger levels; asymptotes guess and 1 - lapse",
               cell->falling ? "less" : "more");
    else if (!cell->graded)
        printf(", larger is %s", cell->falling ? "harder" : "easier");
    putchar('\n');
}

static bool print_cell(const struct sample *sample, const struct threshold_cell *cell,
                       const struct threshold_options *o)
{
    char profile[48], boot[48], credible[48];
    snprintf(profile, sizeof profile, "%g %% profile", 100 * o->conf);
    snprintf(boot, sizeof boot, "%g %% bootstrap", 100 * o->conf);
    snprintf(credible, sizeof credible, "%g %% credible", 100 * o->conf);
    const char *const headings[] = {
        "<participant", "steps", "reversals", cell->quest ? "QUEST+" : "by reversals",
        "ML",           profile, boot,        "slope",
        "lapse",        "fit p", "Bayes",     credible,
        "<note",        NULL};
    const char *const of_levels[] = {"<participant", "answers", "ML",    profile,  boot,    "slope", "guess",
                                     "lapse",        "fit p",   "Bayes", credible, "<note", NULL};
    print_heading(cell);
    struct table t;
    table_init(&t, cell->source == THRESHOLD_STAIRCASES ? headings : of_levels);
    for (size_t i = 0; i < cell->person_count; i++)
        person_row(&t, sample, cell, &cell->people[i]);
    bool ok = table_print(&t, stdout);
    table_finish(&t);
    for (size_t i = 0; i < cell->person_count; i++)
        if (cell->people[i].bayes.rough)
            printf("%s: the sum over the posterior did not settle; Bayes may be off by more than 0.5 %% of its "
                   "interval.\n",
                   cell->pooled ? "All people" : sample->people[cell->people[i].person].code);
    if (cell->pooled)
        puts("Nobody answered twice at a level, so people share one function, without intervals: a person's "
             "answers are not\nindependent.");
    putchar('\n');
    return ok && (cell->pooled || print_means(cell, o->conf));
}

static bool print_adjusted(const struct sample *sample, const struct adjusted *a)
{
    char ci[32];
    snprintf(ci, sizeof ci, "%g %% CI of M", 100 * a->conf);
    const char *const headings[] = {"<block", "<cell", "<parameter", "people", "M", "SD", "median", ci, NULL};
    const char *const people[] = {"<block", "<cell", "<parameter", "<participant", "values", "M",
                                  "least",  "most",  NULL};
    struct table over, each;
    table_init(&over, headings);
    table_init(&each, people);
    for (size_t i = 0; i < a->cell_count; i++) {
        const struct adjusted_cell *cell = &a->cells[i];
        const struct threshold_mean *m = &cell->over_people;
        table_cell(&over, "%s", cell->block);
        table_cell(&over, "%s", cell->label);
        table_cell(&over, "%s", cell->parameter);
        table_cell(&over, "%zu", cell->person_count);
        number_cell(&over, m->of.mean);
        number_cell(&over, m->of.sd);
        number_cell(&over, m->median);
        interval_cell(&over, m->t.ci_low, m->t.ci_high);
        for (size_t j = 0; j < cell->person_count; j++) {
            const struct adjusted_person *p = &cell->people[j];
            table_cell(&each, "%s", cell->block);
            table_cell(&each, "%s", cell->label);
            table_cell(&each, "%s", cell->parameter);
            table_cell(&each, "%s", sample->people[p->person].code);
            table_cell(&each, "%zu", p->count);
            number_cell(&each, p->mean);
            number_cell(&each, p->low);
            number_cell(&each, p->high);
        }
    }
    puts("Adjusted values: each person's repeats averaged, then over people");
    bool ok = table_print(&over, stdout);
    putchar('\n');
    ok = ok && table_print(&each, stdout);
    table_finish(&over);
    table_finish(&each);
    return ok;
}

static void print_notes(const struct sample *sample, const struct thresholds *t, const struct adjusted *a)
{
    bool right = false, preference = false;
    for (size_t i = 0; i < t->cell_count; i++) {
        right = right || (!t->cells[i].preference && !t->cells[i].graded);
        preference = preference || t->cells[i].preference;
    }
    if (right || preference)
        printf("%s%s; ML%s%s%s.\n", stat_family_name(t->options.family),
               t->options.logarithmic ? " on logarithmic levels" : "",
               right ? ": guess 0.5, lapse between 0 and 0.06" : "",
               right && preference ? "; of preferences" : "",
               preference ? ": guess and lapse between 0 and 0.5" : "");
    if (t->cell_count && t->options.replicates)
        printf("fit p: share of %zu simulated studies that deviate no less from their fit.\n",
               t->options.replicates);
    study_notes(sample);
    if (t->excluded + a->excluded)
        printf("Left out, excluded trials: %" PRId64 ".\n", t->excluded + a->excluded);
    if (t->not_finite)
        printf("Left out, levels that are not finite: %" PRId64 ".\n", t->not_finite);
    if (t->not_done + a->not_done)
        printf("Left out, trials that are not done: %" PRId64 ".\n", t->not_done + a->not_done);
}

static int print_text(const struct command *command, const struct sample *sample, const struct thresholds *t,
                      const struct adjusted *a)
{
    study_title(sample, "Thresholds");
    bool ok = true;
    for (size_t i = 0; ok && i < t->cell_count; i++)
        ok = print_cell(sample, &t->cells[i], &t->options);
    if (ok && a->cell_count)
        ok = print_adjusted(sample, a);
    print_notes(sample, t, a);
    return ok ? command_finish(command) : command_fail(command, EXIT_FAILED, "not enough memory");
}

static int run(const struct command *command, int argc, char **argv)
{
    struct study_arguments arguments;
    struct threshold_options options;
    struct sample sample;
    int code = own_options(command, &argc, argv, &options);
    if (code < 0)
        code = study_arguments_load(command, argc, argv, false, &arguments, &sample);
    if (code >= 0)
        return code;
    options.conf = arguments.conf;
    char error[SAMPLE_ERROR_SIZE];
    struct thresholds t = {0};
    struct adjusted a = {0};
    if (!thresholds_load(&t, &sample, &options, error, sizeof error) ||
        !adjusted_load(&a, &sample, options.conf, error, sizeof error)) {
        code = command_fail(command, EXIT_FAILED, "%s", error);
    } else if (t.cell_count + a.cell_count == 0) {
        code =
            command_fail(command, EXIT_FAILED,
                         "%s: no staircase, no constant levels and no adjusted value were recorded that count",
                         store_reader_path(sample.files[0]));
    } else if (arguments.json) {
        thresholds_json(stdout, &sample, &t, &a);
        code = command_finish(command);
    } else {
        code = print_text(command, &sample, &t, &a);
    }
    thresholds_free(&t);
    adjusted_free(&a);
    sample_free(&sample);
    return code;
}

const struct command command_thresholds = {
    "thresholds", "thresholds of staircases and constant levels, adjusted values", help, run};
