// The analysis of variance of ratings over crossed factors alone; fovstats ratings prints it beside the rest.
#include "analysis/tools/arguments.h"
#include "analysis/tools/ratings_parts.h"
#include "analysis/tools/study_arguments.h"

#include <stdio.h>
#include <string.h>

static const char help[] =
    "usage: fovstats anova DB... [--conf C] [--simulated] [--protocol N] [--json]\n"
    "\n"
    "Ratings over crossed factors: analysis of variance within participants with all interactions, per "
    "question\n"
    "and block. Greenhouse-Geisser's and Huynh-Feldt's corrections, partial and generalised eta squared, "
    "means\n"
    "of levels, and paired tests of levels after Holm where a factor's corrected p is small. People who lack "
    "a\n"
    "cell are named and left out, nothing is filled; factors between people are said and not analysed. Where "
    "no\n"
    "analysis is possible there is one sentence that says why, and exit 1; fovstats ratings has means then.\n"
    "  --conf C     confidence of the intervals (0.95)\n"
    "  --simulated  analyse simulated sessions, which are left out otherwise\n"
    "  --protocol N analyse the sessions of this protocol; else of the one with most sessions\n"
    "  --json       one object with the analyses in an array\n";

static void print_json(const struct sample *sample, const struct ratings *r)
{
    struct json json = {stdout, false};
    json_open(&json, NULL, '{');
    study_title_json(&json, sample);
    json_number(&json, "conf", r->conf);
    json_open(&json, "factorial", '[');
    for (size_t i = 0; i < r->factorials.count; i++)
        ratings_factorial_json(&json, sample, &r->factorials.items[i]);
    json_close(&json, ']');
    json_close(&json, '}');
    putchar('\n');
}

static bool print_text(const struct sample *sample, const struct ratings *r)
{
    bool ok = true;
    study_title(sample, "Analysis of variance");
    for (size_t i = 0; i < r->factorials.count; i++)
        ok = ratings_print_factorial(sample, &r->factorials.items[i], r->conf) && ok;
    study_notes(sample);
    return ok;
}

static size_t analysed(const struct ratings *r)
{
    size_t count = 0;
    for (size_t i = 0; i < r->factorials.count; i++)
        count += r->factorials.items[i].refusal[0] == '\0';
    return count;
}

// One sentence: why there is not a single analysis.
static int refuse(const struct command *command, const struct sample *sample, const struct ratings *r)
{
    const char *path = store_reader_path(sample->files[0]);
    char why[512], more[64] = "";
    size_t count = r->factorials.count;
    if (count == 0)
        return command_fail(command, EXIT_FAILED,
                            "%s: no ratings over factors were recorded that count; see fovstats ratings", path);
    factorial_refusal(&r->factorials.items[0], why);
    why[0] = 'n';
    why[strlen(why) - 1] = '\0'; // no sentence of its own
    if (count > 1)
        snprintf(more, sizeof more, "; nor of %zu more, see fovstats ratings", count - 1);
    return command_fail(command, EXIT_FAILED, "%s: %s, block %s: %s%s", path, r->factorials.items[0].question,
                        r->factorials.items[0].block, why, more);
}

static int analyse(const struct command *command, const struct study_arguments *arguments,
                   struct sample *sample)
{
    int code;
    char error[SAMPLE_ERROR_SIZE];
    struct ratings r;
    if (!ratings_load(&r, sample, arguments->conf, false, error, sizeof error)) {
        code = command_fail(command, EXIT_FAILED, "%s", error);
    } else if (analysed(&r) == 0) {
        code = refuse(command, sample, &r);
    } else {
        bool ok = true;
        if (arguments->json)
            print_json(sample, &r);
        else
            ok = print_text(sample, &r);
        code = ok ? command_finish(command) : command_fail(command, EXIT_FAILED, "not enough memory");
    }
    ratings_free(&r);
    return code;
}

static int run(const struct command *command, int argc, char **argv)
{
    return study_arguments_run(command, argc, argv, analyse);
}

const struct command command_anova = {"anova", "analysis of variance of ratings over factors", help, run};
