#include "analysis/report/jod.h"

#include "analysis/tools/arguments.h"
#include "analysis/tools/study_arguments.h"
#include "analysis/tools/table.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>

static const char help[] =
    "usage: fovstats jod DB... [--conf C] [--simulated] [--protocol N] [--json]\n"
    "\n"
    "Preferences on one scale per block: just-objectionable differences (JOD) from the reference, by "
    "Thurstone's\n"
    "case V and maximum likelihood. One JOD apart is 75 % preference; negative is worse than the reference.\n"
    "The reference is the option that most trials of the block had for theirs, excluded trials too.\n"
    "Intervals by a bootstrap over people (1000 replicates, one seed). Where no chain of answers prefers the\n"
    "reference to an option, or none prefers it to the reference, the likelihood has no maximum: the\n"
    "option is not estimable without a prior, and none is put on it. Where that is so in more replicates\n"
    "than an end of the interval leaves out, that end is open: \"below\" or \"above\". People who all\n"
    "answered alike have no interval.\n"
    "  --conf C     confidence of the intervals (0.95)\n"
    "  --simulated  analyse simulated sessions, which are left out otherwise\n"
    "  --protocol N analyse the sessions of this protocol; else of the one with most sessions\n"
    "  --json       one object with the blocks in an array\n"
    "\"Equal\" and answers to questions with a right answer are not part of it.\n";

static void note_cell(struct table *t, const struct stat_jod *s, size_t replicates)
{
    const struct {
        const char *what;
        size_t count;
    } parts[] = {{"at minus infinity", s->below}, {"at infinity", s->above}, {"not compared", s->failed}};
    char note[256];
    size_t used = (size_t)snprintf(note, sizeof note, "%s", jod_reason(s));
    for (size_t i = 0; s->status == STAT_JOD_OK && i < sizeof parts / sizeof parts[0]; i++)
        if (parts[i].count)
            used += (size_t)snprintf(note + used, sizeof note - used, "%s%s in %zu of %zu %s", used ? ", " : "",
                                     parts[i].what, parts[i].count, replicates,
                                     replicates == 1 ? "replicate" : "replicates");
    table_cell(t, "%s", note);
}

static bool print_block(const struct sample *sample, const struct jod *j, const struct jod_block *b)
{
    char ci[32], interval[64];
    snprintf(ci, sizeof ci, "%g %% CI", 100 * j->conf);
    const char *const headings[] = {"<option", "preferred", "of", "JOD", ci, "<note", NULL};
    struct table t;
    table_init(&t, headings);
    for (size_t place = 0; place < b->option_count; place++) {
        size_t i = b->order[place];
        const struct stat_jod *s = &b->scores[i];
        table_cell(&t, "%s", sample->conditions[b->options[i]].label);
        table_cell(&t, "%" PRId64, s->won);
        table_cell(&t, "%" PRId64, s->n);
        if (isnan(s->score))
            table_cell(&t, "-");
        else
            table_cell(&t, "%.3f", s->score);
        jod_interval_text(s, 3, interval);
        table_cell(&t, "%s", interval[0] ? interval : "-");
        note_cell(&t, s, j->replicates);
    }
    printf("%s: %zu %s by %" PRId64 " %s%s\n", b->block, b->answer_count,
           b->answer_count == 1 ? "comparison" : "comparisons", b->persons,
           b->persons == 1 ? "person" : "people", b->persons < 2 ? ", too few for intervals" : "");
    bool ok = table_print(&t, stdout);
    table_finish(&t);
    if (b->equal)
        printf("Answers \"equal\" and choices between equal options, left out: %" PRId64 ".\n", b->equal);
    putchar('\n');
    return ok;
}

static void print_notes(const struct sample *sample, const struct jod *j)
{
    study_notes(sample);
    const struct {
        const char *what;
        int64_t count;
    } left[] = {{"excluded trials", j->excluded},
                {"trials that are not done", j->not_done},
                {"trials without a test option", j->no_test_slot},
                {"questions with a right answer", j->correct},
                {"options beyond 64 in a block", j->too_many}};
    for (size_t i = 0; i < sizeof left / sizeof left[0]; i++)
        if (left[i].count)
            printf("Left out, answers to %s: %" PRId64 ".\n", left[i].what, left[i].count);
}

static void block_json(struct json *json, const struct sample *sample, const struct jod_block *b)
{
    json_open(json, NULL, '{');
    json_text(json, "block", b->block);
    json_integer(json, "comparisons", (int64_t)b->answer_count);
    json_integer(json, "participants", b->persons);
    json_integer(json, "equal", b->equal);
    json_open(json, "options", '[');
    for (size_t place = 0; place < b->option_count; place++) {
        size_t i = b->order[place];
        const struct stat_jod *s = &b->scores[i];
        json_open(json, NULL, '{');
        json_text(json, "option", sample->conditions[b->options[i]].label);
        json_integer(json, "preferred", s->won);
        json_integer(json, "n", s->n);
        json_number(json, "jod", s->score);
        json_number(json, "ci_low", s->interval.low);
        json_number(json, "ci_high", s->interval.high);
        json_bool(json, "ci_low_open", isinf(s->interval.low));
        json_bool(json, "ci_high_open", isinf(s->interval.high));
        json_integer(json, "replicates_at_minus_infinity", (int64_t)s->below);
        json_integer(json, "replicates_at_infinity", (int64_t)s->above);
        json_integer(json, "replicates_without", (int64_t)s->failed);
        json_bool(json, "people_alike", s->alike);
        json_text(json, "note", jod_reason(s));
        json_close(json, '}');
    }
    json_close(json, ']');
    json_close(json, '}');
}

static void print_json(const struct sample *sample, const struct jod *j)
{
    struct json json = {stdout, false};
    json_open(&json, NULL, '{');
    study_title_json(&json, sample);
    json_number(&json, "conf", j->conf);
    json_open(&json, "blocks", '[');
    for (size_t i = 0; i < j->block_count; i++)
        block_json(&json, sample, &j->blocks[i]);
    json_close(&json, ']');
    json_close(&json, '}');
    putchar('\n');
}

static int analyse(const struct command *command, const struct study_arguments *arguments,
                   struct sample *sample)
{
    int code;
    char error[SAMPLE_ERROR_SIZE];
    struct jod j = {0};
    bool ok = true;
    if (!jod_load(&j, sample, arguments->conf, JOD_REPLICATES, JOD_SEED, error, sizeof error)) {
        code = command_fail(command, EXIT_FAILED, "%s", error);
    } else if (j.block_count == 0) {
        code =
            command_fail(command, EXIT_FAILED, "%s: no preference between two options was recorded that counts",
                         store_reader_path(sample->files[0]));
    } else if (arguments->json) {
        print_json(sample, &j);
        code = command_finish(command);
    } else {
        study_title(sample, "Just-objectionable differences");
        for (size_t i = 0; ok && i < j.block_count; i++)
            ok = print_block(sample, &j, &j.blocks[i]);
        print_notes(sample, &j);
        code = ok ? command_finish(command) : command_fail(command, EXIT_FAILED, "not enough memory");
    }
    jod_free(&j);
    return code;
}

static int run(const struct command *command, int argc, char **argv)
{
    return study_arguments_run(command, argc, argv, analyse);
}

const struct command command_jod = {"jod", "preferences on a scale of just-objectionable differences", help,
                                    run};
