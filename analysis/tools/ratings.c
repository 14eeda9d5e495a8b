#include "analysis/report/ratings.h"
#include "analysis/report/html.h"

#include "analysis/tools/arguments.h"
#include "analysis/tools/ratings_parts.h"
#include "analysis/tools/study_arguments.h"
#include "analysis/tools/table.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

static const char help[] =
    "usage: fovstats ratings DB... [--conf C] [--pratt] [--simulated] [--json]\n"
    "\n"
    "Ratings before and after, in two orders: first ratings between the order groups (Welch's t-test), and\n"
    "second minus first within each group (paired t-test, Wilcoxon's signed ranks, d_z). The groups are never\n"
    "pooled. Both options rated in a trial: test minus reference per cell, with Holm's adjustment over cells.\n"
    "Ratings over crossed factors: analysis of variance within participants, with Greenhouse-Geisser's and\n"
    "Huynh-Feldt's corrections, means of levels, and paired tests of levels where a factor's corrected p is\n"
    "small, adjusted after Holm. People who lack a cell are named and left out.\n"
    "Hodges and Lehmann's estimate and its interval keep differences of 0, which the signed-rank test's p "
    "drops\n"
    "(or only ranks, with --pratt): where there are some, the interval may reach 0 though p is small.\n"
    "  --conf C     confidence of the intervals (0.95)\n"
    "  --pratt      signed-rank tests rank differences of 0 before they drop them (Pratt 1959), else drop them "
    "first\n"
    "  --simulated  analyse simulated sessions, which are left out otherwise\n"
    "  --protocol N analyse the sessions of this protocol; else of the one with most sessions\n"
    "  --json       one object with the questions in an array\n";

static const char *label(const struct sample *sample, size_t condition)
{
    return sample->conditions[condition].label;
}

// The same changes by ranks, and their size.
static bool print_ranks(const struct sample *sample, const struct rating_question *q, double conf)
{
    char ci[32], d_ci[32];
    snprintf(ci, sizeof ci, "%g %% CI", 100 * conf);
    snprintf(d_ci, sizeof d_ci, "%g %% CI d_z", 100 * conf);
    const char *const headings[] = {"<first", "V",   "not 0", "Wilcoxon p", "Hodges-Lehmann",
                                    ci,       "d_z", d_ci,    "Hedges' g",  NULL};
    struct table t;
    table_init(&t, headings);
    for (size_t i = 0; i < q->group_count; i++) {
        const struct rating_group *g = &q->groups[i];
        table_cell(&t, "%s", label(sample, g->first_condition));
        table_cell(&t, "%g", g->rank.statistic);
        table_cell(&t, "%zu", g->rank.n);
        ratings_p(&t, g->rank.p_value);
        ratings_number(&t, "%.2f", g->rank.estimate);
        if (isfinite(g->rank.ci_low) && isfinite(g->rank.ci_high))
            ratings_interval(&t, g->rank.ci_low, g->rank.ci_high);
        else
            table_cell(&t, "n too small");
        ratings_number(&t, "%.2f", g->effect.d);
        ratings_interval(&t, g->effect.ci_low, g->effect.ci_high);
        ratings_number(&t, "%.2f", g->effect.g);
    }
    bool ok = table_print(&t, stdout);
    table_finish(&t);
    for (size_t i = 0; i < q->group_count; i++)
        if (!q->groups[i].rank.exact)
            printf("Wilcoxon's p of %s first is by the normal approximation.\n",
                   label(sample, q->groups[i].first_condition));
    puts("Wilcoxon's p drops differences of 0; Hodges and Lehmann's estimate and interval keep them.");
    return ok;
}

static bool print_question(const struct sample *sample, const struct rating_question *q, double conf)
{
    char ci[32];
    snprintf(ci, sizeof ci, "%g %% CI", 100 * conf);
    const char *const headings[] = {"<first",       "<second", "n", "M first", "SD", "M second", "SD",
                                    "second-first", ci,        "t", "df",      "p",  NULL};
    struct table t;
    table_init(&t, headings);
    for (size_t i = 0; i < q->group_count; i++) {
        const struct rating_group *g = &q->groups[i];
        table_cell(&t, "%s", label(sample, g->first_condition));
        table_cell(&t, "%s", label(sample, g->second_condition));
        table_cell(&t, "%zu", g->n);
        ratings_number(&t, "%.2f", g->first_of.mean);
        ratings_number(&t, "%.2f", g->first_of.sd);
        ratings_number(&t, "%.2f", g->second_of.mean);
        ratings_number(&t, "%.2f", g->second_of.sd);
        ratings_number(&t, "%.2f", g->change.estimate);
        ratings_interval(&t, g->change.ci_low, g->change.ci_high);
        ratings_number(&t, "%.3f", g->change.t);
        ratings_number(&t, "%.0f", g->change.df);
        ratings_p(&t, g->change.p_value);
    }
    printf("%s (%g to %g)\n", q->question, q->scale_min, q->scale_max);
    bool ok = table_print(&t, stdout);
    table_finish(&t);
    ok = print_ranks(sample, q, conf) && ok;
    const struct stat_ttest *w = &q->first_between;
    const struct stat_effect *d = &q->between_effect;
    char p[24];
    html_p_value(p, w->p_value);
    if (q->overlap)
        puts("First ratings are not compared: somebody rated in both orders.");
    else if (q->compared && isnan(w->p_value))
        printf("First ratings differ by %.2f; there are too few, or all are equal, so that no t-test is "
               "possible.\n",
               w->estimate);
    else if (q->compared)
        printf("First ratings, %s minus %s: %.2f, %g %% CI %.2f to %.2f, t(%.2f) = %.3f, p %s (Welch), d %.2f, "
               "%g %% CI %.2f to %.2f\n",
               label(sample, q->groups[0].first_condition), label(sample, q->groups[1].first_condition),
               w->estimate, 100 * conf, w->ci_low, w->ci_high, w->df, w->t, p, d->d, 100 * conf, d->ci_low,
               d->ci_high);
    else
        printf("First ratings are not compared: that needs two order groups, there %s %zu.\n",
               q->group_count == 1 ? "is" : "are", q->group_count);
    if (q->unpaired)
        printf("Left out, sessions without two ratings of different options: %" PRId64 ".\n", q->unpaired);
    if (q->late_first)
        printf("Left out, sessions whose rating planned as the first was given when both options had been "
               "seen: %" PRId64 ".\n",
               q->late_first);
    putchar('\n');
    return ok;
}

static void print_notes(const struct sample *sample, const struct ratings *r)
{
    study_notes(sample);
    if (r->excluded)
        printf("Left out, ratings in excluded trials: %" PRId64 ".\n", r->excluded);
    if (r->not_done)
        printf("Left out, ratings in trials that are not done: %" PRId64 ".\n", r->not_done);
    if (r->no_condition)
        printf("Left out, ratings that belong to no option: %" PRId64 ".\n", r->no_condition);
    if (r->more)
        printf("Left out, ratings of nothing they could be compared with: %" PRId64 ".\n", r->more);
    if (r->options.unpaired)
        printf("Left out, ratings of one option of a trial only: %" PRId64 ".\n", r->options.unpaired);
    if (r->not_finite)
        printf("Left out, ratings that are not finite numbers: %" PRId64 "; no program of ours writes them.\n",
               r->not_finite);
}

static void group_json(struct json *json, const struct sample *sample, const struct rating_group *g)
{
    json_open(json, NULL, '{');
    json_text(json, "first", label(sample, g->first_condition));
    json_text(json, "second", label(sample, g->second_condition));
    json_integer(json, "n", (int64_t)g->n);
    json_number(json, "first_mean", g->first_of.mean);
    json_number(json, "first_sd", g->first_of.sd);
    json_number(json, "second_mean", g->second_of.mean);
    json_number(json, "second_sd", g->second_of.sd);
    ratings_ttest_json(json, "second_minus_first", &g->change);
    ratings_rank_json(json, "wilcoxon", &g->rank);
    ratings_effect_json(json, "d_z", &g->effect);
    ratings_effect_json(json, "d_av", &g->average);
    json_close(json, '}');
}

static void print_json(const struct sample *sample, const struct ratings *r)
{
    struct json json = {stdout, false};
    json_open(&json, NULL, '{');
    study_title_json(&json, sample);
    json_number(&json, "conf", r->conf);
    json_open(&json, "questions", '[');
    for (size_t i = 0; i < r->question_count; i++) {
        const struct rating_question *q = &r->questions[i];
        json_open(&json, NULL, '{');
        json_text(&json, "question", q->question);
        json_number(&json, "scale_min", q->scale_min);
        json_number(&json, "scale_max", q->scale_max);
        json_open(&json, "groups", '[');
        for (size_t j = 0; j < q->group_count; j++)
            group_json(&json, sample, &q->groups[j]);
        json_close(&json, ']');
        if (q->compared) {
            char which[600];
            snprintf(which, sizeof which, "%s minus %s", label(sample, q->groups[0].first_condition),
                     label(sample, q->groups[1].first_condition));
            json_text(&json, "first_between_groups_is", which);
            ratings_ttest_json(&json, "first_between_groups", &q->first_between);
            ratings_effect_json(&json, "first_between_groups_d", &q->between_effect);
        }
        json_integer(&json, "unpaired_sessions", q->unpaired);
        json_integer(&json, "first_rated_last_sessions", q->late_first);
        json_close(&json, '}');
    }
    json_close(&json, ']');
    json_open(&json, "options", '[');
    for (size_t i = 0; i < r->options.count; i++)
        ratings_options_json(&json, sample, &r->options.items[i]);
    json_close(&json, ']');
    json_open(&json, "factorial", '[');
    for (size_t i = 0; i < r->factorials.count; i++)
        ratings_factorial_json(&json, sample, &r->factorials.items[i]);
    json_close(&json, ']');
    json_open(&json, "left_out", '{');
    json_integer(&json, "excluded", r->excluded);
    json_integer(&json, "not_done", r->not_done);
    json_integer(&json, "no_option", r->no_condition);
    json_integer(&json, "unpaired_by_design", r->more);
    json_integer(&json, "one_option_only", r->options.unpaired);
    json_integer(&json, "not_finite", r->not_finite);
    json_close(&json, '}');
    json_close(&json, '}');
    putchar('\n');
}

// Takes an option of this subcommand alone out of its arguments.
static bool take_flag(int *argc, char **argv, const char *name)
{
    int left = 0;
    bool given = false, options = true;
    for (int i = 0; i < *argc; i++) {
        bool flag = options && strcmp(argv[i], name) == 0;
        options = options && strcmp(argv[i], "--") != 0;
        given = given || flag;
        if (!flag)
            argv[left++] = argv[i];
    }
    *argc = left;
    return given;
}

static int run(const struct command *command, int argc, char **argv)
{
    struct study_arguments arguments;
    struct sample sample;
    bool pratt = take_flag(&argc, argv, "--pratt");
    int code = study_arguments_load(command, argc, argv, false, &arguments, &sample);
    if (code >= 0)
        return code;
    char error[SAMPLE_ERROR_SIZE];
    struct ratings r;
    if (!ratings_load(&r, &sample, arguments.conf, pratt, error, sizeof error)) {
        code = command_fail(command, EXIT_FAILED, "%s", error);
    } else if (!ratings_any(&r)) {
        code = command_fail(command, EXIT_FAILED, "%s: no rating of an option was recorded that counts",
                            store_reader_path(sample.files[0]));
    } else if (arguments.json) {
        print_json(&sample, &r);
        code = command_finish(command);
    } else {
        study_title(&sample, "Ratings");
        bool ok = true;
        for (size_t i = 0; i < r.question_count; i++)
            ok = print_question(&sample, &r.questions[i], r.conf) && ok;
        for (size_t i = 0; i < r.options.count; i++)
            ok = ratings_print_options(&sample, &r.options.items[i], r.conf) && ok;
        for (size_t i = 0; i < r.factorials.count; i++)
            ok = ratings_print_factorial(&sample, &r.factorials.items[i], r.conf) && ok;
        print_notes(&sample, &r);
        code = ok ? command_finish(command) : command_fail(command, EXIT_FAILED, "not enough memory");
    }
    ratings_free(&r);
    sample_free(&sample);
    return code;
}

const struct command command_ratings = {"ratings", "ratings: before and after, of both options, over factors",
                                        help, run};
