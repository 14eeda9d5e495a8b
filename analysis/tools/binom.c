#include "analysis/stats/binomial.h"
#include "analysis/tools/alternatives.h"
#include "analysis/tools/arguments.h"
#include "analysis/tools/binom_print.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

static const char help[] =
    "usage: fovstats binom K N [--p P] [--alternative two-sided|less|greater] [--conf C] [--mid-p] [--margin "
    "M]\n"
    "                      [--prior A,B] [--share S [--power W]] [--json]\n"
    "\n"
    "Exact binomial test of K successes in N independent answers.\n"
    "  --p P, --p0 P    probability under the null hypothesis (0.5)\n"
    "  --alternative A  two-sided (by small p-values, as R's binom.test), less or greater\n"
    "  --conf C         confidence of the intervals and the null region (0.95); alpha is 1 - C\n"
    "  --mid-p          the mid-p value too: half of what is as probable as K, and all that is less\n"
    "  --margin M       tests whether the probability lies within P - M to P + M, by two one-sided exact "
    "tests;\n"
    "                   a test of P that finds nothing does not show that\n"
    "  --prior A,B      Beta prior of the Bayes factor BF10 (1,1)\n"
    "  --share S        power of the two-sided test where S is true, and the N that it needs; not beside "
    "another\n"
    "                   --alternative\n"
    "  --power W        the power that N is wanted for (0.8), beside --share\n"
    "  --json           one object: k n p0 p_value estimate ci_low ci_high null_low null_high ln_p mid_p "
    "wilson_low\n"
    "                   wilson_high jeffreys_low jeffreys_high prior_a prior_b ln_bf10 and, where asked, "
    "equivalence\n"
    "                   {margin p_low p_high p_value ci_low ci_high shown} and power {share power wanted "
    "n_first\n"
    "                   n_stays}\n"
    "The null region is the smallest and largest K with p > 1 - C. Answers of one person to several\n"
    "questions are not independent: use one answer per person.\n";

static int check_counts(const struct command *command, const char *k_text, const char *n_text,
                        struct binom_request *r)
{
    if (!arguments_integer(k_text, &r->k) || r->k < 0)
        return command_fail(command, EXIT_USAGE, "K is \"%s\" but must be a whole number from 0 to N", k_text);
    if (!arguments_integer(n_text, &r->n) || r->n < 1 || r->n > STAT_BINOMIAL_MAX_N)
        return command_fail(command, EXIT_USAGE, "N is \"%s\" but must be a whole number from 1 to %" PRId64,
                            n_text, STAT_BINOMIAL_MAX_N);
    if (r->k > r->n)
        return command_fail(command, EXIT_USAGE, "K is %" PRId64 " but cannot exceed N, which is %" PRId64,
                            r->k, r->n);
    return -1;
}

static int check_prior(const struct command *command, const char *text, struct binom_request *r)
{
    char first[64];
    const char *comma = strchr(text, ',');
    size_t length = comma ? (size_t)(comma - text) : sizeof first;
    if (length < sizeof first) {
        memcpy(first, text, length);
        first[length] = '\0';
        if (arguments_number(first, &r->prior[0]) && arguments_number(comma + 1, &r->prior[1]) &&
            r->prior[0] > 0 && r->prior[1] > 0 && r->prior[0] <= 1e9 && r->prior[1] <= 1e9)
            return -1;
    }
    return command_fail(command, EXIT_USAGE,
                        "--prior is \"%s\" but must be two numbers above 0, for example 1,1", text);
}

static int check_numbers(const struct command *command, const struct binom_request *r)
{
    if (!(r->p0 >= 0 && r->p0 <= 1))
        return command_fail(command, EXIT_USAGE, "--p is %g but must be from 0 to 1", r->p0);
    if (!(r->conf > 0 && 1 - r->conf > 0 && 1 - r->conf < 1))
        return command_fail(command, EXIT_USAGE, "--conf is %g but must lie between 0 and 1, for example 0.95",
                            r->conf);
    if (!isnan(r->margin) && !(r->margin > 0 && r->p0 - r->margin >= 0 && r->p0 + r->margin <= 1))
        return command_fail(command, EXIT_USAGE,
                            "--margin is %g but must be above 0, and %g less or plus it must be from 0 to 1",
                            r->margin, r->p0);
    if (!isnan(r->margin) && !(r->conf > 0.5))
        return command_fail(command, EXIT_USAGE, "--conf is %g but --margin needs more than 0.5", r->conf);
    if (!isnan(r->share) && !(r->share >= 0 && r->share <= 1))
        return command_fail(command, EXIT_USAGE, "--share is %g but must be from 0 to 1", r->share);
    if (isnan(r->share) && !isnan(r->power))
        return command_fail(command, EXIT_USAGE,
                            "--power is %g but needs --share S beside it, the probability that is to be found",
                            r->power);
    if (!isnan(r->power) && !(r->power > 0 && r->power < 1))
        return command_fail(command, EXIT_USAGE, "--power is %g but must lie between 0 and 1, for example 0.8",
                            r->power);
    return -1;
}

// The power of another test than the one that is made would be taken for its own.
static int check_power(const struct command *command, const struct binom_request *r)
{
    if (isnan(r->share) || r->alternative == STAT_TWO_SIDED)
        return -1;
    return command_fail(
        command, EXIT_USAGE,
        "--share gives the power of the two-sided test, and --alternative is %s; ask for one of "
        "them at a time",
        alternative_words[r->alternative]);
}

static int run(const struct command *command, int argc, char **argv)
{
    struct binom_request r = {.p0 = 0.5,
                              .conf = 0.95,
                              .margin = (double)NAN,
                              .prior = {1, 1},
                              .share = (double)NAN,
                              .power = (double)NAN};
    const char *word = alternative_words[STAT_TWO_SIDED], *prior = "1,1";
    bool json = false;
    const struct option options[] = {
        {"--p", OPTION_NUMBER, &r.p0},         {"--p0", OPTION_NUMBER, &r.p0},
        {"--alternative", OPTION_TEXT, &word}, {"--conf", OPTION_NUMBER, &r.conf},
        {"--mid-p", OPTION_FLAG, &r.mid_p},    {"--margin", OPTION_NUMBER, &r.margin},
        {"--prior", OPTION_TEXT, &prior},      {"--share", OPTION_NUMBER, &r.share},
        {"--power", OPTION_NUMBER, &r.power},  {"--json", OPTION_FLAG, &json}};
    int count = 0,
        code = arguments_parse(command, argc, argv, options, sizeof options / sizeof options[0], &count);
    if (code >= 0)
        return code;
    if (count != 2)
        return command_fail(command, EXIT_USAGE, "needs K and N, and nothing else; see --help");
    if ((code = check_counts(command, argv[0], argv[1], &r)) >= 0 || (code = check_numbers(command, &r)) >= 0 ||
        (code = alternative_parse(command, word, &r.alternative)) >= 0 ||
        (code = check_power(command, &r)) >= 0 || (code = check_prior(command, prior, &r)) >= 0)
        return code;
    r.power = isnan(r.power) ? 0.8 : r.power;
    if (json)
        binom_print_json(&r);
    else
        binom_print_text(&r);
    return command_finish(command);
}

const struct command command_binom = {"binom", "exact binomial test of K successes in N", help, run};
