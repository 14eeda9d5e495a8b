#include "analysis/report/ratings.h"

#include "analysis/tools/arguments.h"
#include "analysis/tools/study_arguments.h"
#include "analysis/tools/table.h"

#include <inttypes.h>
#include <stdio.h>

static const char help[] =
    "usage: fovstats ratings DB... [--conf C] [--simulated] [--json]\n"
    "\n"
    "Two ratings per session in two orders: first ratings between the order groups (Welch's t-test), and\n"
    "second minus first within each group (paired t-test). The groups are never pooled.\n"
    "  --conf C     confidence of the intervals (0.95)\n"
    "  --simulated  analyse simulated sessions, which are left out otherwise\n"
    "  --protocol N analyse the sessions of this protocol; else of the one with most sessions\n"
    "  --json       one object with the questions in an array\n";

static const char *label(const struct sample *sample, size_t condition)
{
    return sample->conditions[condition].label;
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
        table_cell(&t, "%.2f", g->first_of.mean);
        table_cell(&t, "%.2f", g->first_of.sd);
        table_cell(&t, "%.2f", g->second_of.mean);
        table_cell(&t, "%.2f", g->second_of.sd);
        table_cell(&t, "%.2f", g->change.estimate);
        table_cell(&t, "%.2f to %.2f", g->change.ci_low, g->change.ci_high);
        table_cell(&t, "%.3f", g->change.t);
        table_cell(&t, "%.0f", g->change.df);
        table_cell(&t, "%.4f", g->change.p_value);
    }
    printf("%s (%g to %g)\n", q->question, q->scale_min, q->scale_max);
    bool ok = table_print(&t, stdout);
    table_finish(&t);
    const struct stat_ttest *w = &q->first_between;
    if (q->compared)
        printf("First ratings, %s minus %s: %.2f, %g %% CI %.2f to %.2f, t(%.2f) = %.3f, p %.4f (Welch)\n",
               label(sample, q->groups[0].first_condition), label(sample, q->groups[1].first_condition),
               w->estimate, 100 * conf, w->ci_low, w->ci_high, w->df, w->t, w->p_value);
    else
        printf("First ratings are not compared: that needs two order groups, there %s %zu.\n",
               q->group_count == 1 ? "is" : "are", q->group_count);
    if (q->unpaired)
        printf("Left out, sessions without two ratings of different options: %" PRId64 ".\n", q->unpaired);
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
        printf("Left out, ratings of no before-and-after pair: %" PRId64 ".\n", r->more);
}

static void ttest_json(struct json *json, const char *key, const struct stat_ttest *t)
{
    json_open(json, key, '{');
    json_number(json, "estimate", t->estimate);
    json_number(json, "t", t->t);
    json_number(json, "df", t->df);
    json_number(json, "p_value", t->p_value);
    json_number(json, "ci_low", t->ci_low);
    json_number(json, "ci_high", t->ci_high);
    json_close(json, '}');
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
    ttest_json(json, "second_minus_first", &g->change);
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
        if (q->compared)
            ttest_json(&json, "first_between_groups", &q->first_between);
        json_integer(&json, "unpaired_sessions", q->unpaired);
        json_close(&json, '}');
    }
    json_close(&json, ']');
    json_open(&json, "left_out", '{');
    json_integer(&json, "excluded", r->excluded);
    json_integer(&json, "not_done", r->not_done);
    json_integer(&json, "no_option", r->no_condition);
    json_integer(&json, "unpaired_by_design", r->more);
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
    struct ratings r;
    if (!ratings_load(&r, &sample, arguments.conf, error, sizeof error)) {
        code = command_fail(command, EXIT_FAILED, "%s", error);
    } else if (r.question_count == 0) {
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
        print_notes(&sample, &r);
        code = ok ? command_finish(command) : command_fail(command, EXIT_FAILED, "not enough memory");
    }
    ratings_free(&r);
    sample_free(&sample);
    return code;
}

const struct command command_ratings = {"ratings", "ratings before and after, in two orders, by t-tests", help,
                                        run};
