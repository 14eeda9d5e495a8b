#include "analysis/stats/binomial.h"
#include "analysis/tools/arguments.h"
#include "analysis/tools/binomial_json.h"

#include <inttypes.h>
#include <stdio.h>
#include <string.h>

static const char help[] =
    "usage: fovstats binom K N [--p P] [--alternative two-sided|less|greater] [--conf C] [--json]\n"
    "\n"
    "Exact binomial test of K successes in N independent answers.\n"
    "  --p P            probability under the null hypothesis (0.5)\n"
    "  --alternative A  two-sided (by small p-values, as R's binom.test), less or greater\n"
    "  --conf C         confidence of the Clopper-Pearson interval and the null region (0.95)\n"
    "  --json           one object: k n p0 p_value estimate ci_low ci_high null_low null_high\n"
    "The null region is the smallest and largest K with p > 1 - C. Answers of one person to several\n"
    "questions are not independent: use one answer per person.\n";

static const char *const alternatives[] = {"two-sided", "less", "greater"};

static int print_text(const struct command *command, const struct stat_binomial *t, double conf,
                      enum stat_alternative alternative)
{
    printf("Exact binomial test, %s, of %" PRId64 " in %" PRId64 " against p0 = %.10g\n",
           alternatives[alternative], t->k, t->n, t->p0);
    printf("  p            %.6g\n", t->p_value);
    printf("  estimate     %.6g\n", t->estimate);
    printf("  %g %% CI      %.6g to %.6g (Clopper-Pearson)\n", 100 * conf, t->ci.low, t->ci.high);
    printf("  null region  %" PRId64 " to %" PRId64 " (p > %.10g)\n", t->null_region.low, t->null_region.high,
           1 - conf);
    return command_finish(command);
}

static int check(const struct command *command, const char *k_text, const char *n_text, int64_t *k, int64_t *n)
{
    if (!arguments_integer(k_text, k) || *k < 0)
        return command_fail(command, EXIT_USAGE, "K is \"%s\" but must be a whole number from 0 to N", k_text);
    if (!arguments_integer(n_text, n) || *n < 1 || *n > STAT_BINOMIAL_MAX_N)
        return command_fail(command, EXIT_USAGE, "N is \"%s\" but must be a whole number from 1 to %" PRId64,
                            n_text, STAT_BINOMIAL_MAX_N);
    if (*k > *n)
        return command_fail(command, EXIT_USAGE, "K is %" PRId64 " but cannot exceed N, which is %" PRId64, *k,
                            *n);
    return -1;
}

static int run(const struct command *command, int argc, char **argv)
{
    double p0 = 0.5, conf = 0.95;
    const char *word = alternatives[0];
    bool json = false;
    const struct option options[] = {{"--p", OPTION_NUMBER, &p0},
                                     {"--alternative", OPTION_TEXT, &word},
                                     {"--conf", OPTION_NUMBER, &conf},
                                     {"--json", OPTION_FLAG, &json}};
    int count = 0,
        code = arguments_parse(command, argc, argv, options, sizeof options / sizeof options[0], &count);
    if (code >= 0)
        return code;
    if (count != 2)
        return command_fail(command, EXIT_USAGE, "needs K and N, and nothing else; see --help");
    int64_t k = 0, n = 0;
    code = check(command, argv[0], argv[1], &k, &n);
    if (code >= 0)
        return code;
    if (!(p0 >= 0 && p0 <= 1))
        return command_fail(command, EXIT_USAGE, "--p is %g but must be from 0 to 1", p0);
    if (!(conf > 0 && 1 - conf > 0 && 1 - conf < 1))
        return command_fail(command, EXIT_USAGE, "--conf is %g but must lie between 0 and 1, for example 0.95",
                            conf);
    int alternative = 0;
    while (alternative < 3 && strcmp(alternatives[alternative], word) != 0)
        alternative++;
    if (alternative == 3)
        return command_fail(command, EXIT_USAGE,
                            "--alternative is \"%s\" but must be two-sided, less or greater", word);
    struct stat_binomial test = stat_binomial_test(k, n, p0, conf, (enum stat_alternative)alternative);
    if (!json)
        return print_text(command, &test, conf, (enum stat_alternative)alternative);
    struct json out = {stdout, false};
    json_open(&out, NULL, '{');
    binomial_json(&out, &test);
    json_close(&out, '}');
    putchar('\n');
    return command_finish(command);
}

const struct command command_binom = {"binom", "exact binomial test of K successes in N", help, run};
