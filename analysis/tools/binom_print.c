#include "analysis/tools/binom_print.h"

#include "analysis/stats/bayes_factor.h"
#include "analysis/stats/binomial.h"
#include "analysis/stats/binomial_sample_size.h"
#include "analysis/stats/equivalence.h"
#include "analysis/stats/power.h"
#include "analysis/tools/alternatives.h"
#include "analysis/tools/binomial_json.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>

static struct stat_equivalence equivalence_of(const struct binom_request *r)
{
    return stat_binomial_equivalence(r->k, r->n, r->p0, r->margin, 1 - r->conf);
}

static double bayes_factor_of(const struct binom_request *r)
{
    return stat_binomial_log_bf10(r->k, r->n, r->p0, r->prior[0], r->prior[1]);
}

// A number by its logarithm, also where no double holds it: 3.2e-4012.
static void print_by_log(double ln)
{
    double ten = ln / log(10), exponent = floor(ten);
    if (!isfinite(ln) || fabs(ln) < 690)
        printf("%.6g", exp(ln));
    else
        printf("%.3fe%+.0f", pow(10, ten - exponent), exponent);
}

static void print_interval(double conf, struct stat_interval ci, const char *whose)
{
    char percent[32];
    snprintf(percent, sizeof percent, "%g %% CI", 100 * conf);
    printf("  %-12s %.6g to %.6g (%s)\n", percent, ci.low, ci.high, whose);
}

// A test that finds nothing has not found equality; so there is no case in which this line says less.
static void print_equality(const struct binom_request *r, const struct stat_binomial *t)
{
    double alpha = 1 - r->conf;
    bool edge = !(r->p0 > 0 && r->p0 < 1); // where a margin would leave 0 to 1
    if (isnan(r->margin)) {
        if (t->p_value > alpha && edge)
            printf("  equality     not shown: a test that finds no difference shows none, and no margin fits "
                   "around a p0 of %g\n",
                   r->p0);
        else if (t->p_value > alpha)
            printf("  equality     not shown: a test that finds no difference shows none; --margin M tests for "
                   "it\n");
        return;
    }
    struct stat_equivalence e = equivalence_of(r);
    static const char *const words[] = {
        [STAT_UNDECIDED] = "neither a difference nor equality within the margin is shown",
        [STAT_DIFFERENT] = "a difference is shown, and not that it is within the margin",
        [STAT_WITHIN] = "equality within the margin is shown",
        [STAT_DIFFERENT_WITHIN] = "a difference is shown, and that it is within the margin",
    };
    printf("  equivalence  p = %.6g within %.10g to %.10g (two one-sided exact tests)\n", e.p_value,
           r->p0 - r->margin, r->p0 + r->margin);
    print_interval(1 - 2 * alpha, e.ci, "Clopper-Pearson, of the equivalence test");
    printf("  so           %s\n", words[stat_verdict(t->p_value, e.p_value, alpha)]);
}

static void print_bayes_factor(const struct binom_request *r)
{
    double ln = bayes_factor_of(r);
    printf("  BF10         ");
    print_by_log(ln);
    printf(" (Beta(%g, %g) against p0: the data is %s)\n", r->prior[0], r->prior[1],
           ln > 0   ? "more probable under the prior"
           : ln < 0 ? "more probable under p0"
                    : "as probable under either");
}

static void print_power(const struct binom_request *r)
{
    double alpha = 1 - r->conf;
    if (isnan(r->share))
        return;
    if (r->n <= STAT_POWER_MAX_N)
        printf("  power        %.6g where %.10g is true (two-sided, alpha %.10g)\n",
               stat_binomial_power(r->n, r->p0, r->share, alpha), r->share, alpha);
    struct stat_sample_size size = stat_binomial_sample_size(r->p0, r->share, alpha, r->power);
    if (size.first == 0)
        printf("  n            a power of %g may need more than can be looked at\n", r->power);
    else
        printf("  n            %" PRId64 " first reach a power of %g, %" PRId64 " and all more have it\n",
               size.first, r->power, size.stays);
}

void binom_print_text(const struct binom_request *r)
{
    struct stat_binomial t = stat_binomial_test(r->k, r->n, r->p0, r->conf, r->alternative);
    printf("Exact binomial test, %s, of %" PRId64 " in %" PRId64 " against p0 = %.10g\n",
           alternative_words[r->alternative], t.k, t.n, t.p0);
    printf("  p            ");
    print_by_log(t.log_p);
    putchar('\n');
    if (r->mid_p)
        printf("  mid-p        %.6g (what is as probable as K counts half)\n",
               stat_binomial_mid_p(r->k, r->n, r->p0, r->alternative));
    printf("  estimate     %.6g\n", t.estimate);
    print_interval(r->conf, t.ci, "Clopper-Pearson");
    print_interval(r->conf, stat_wilson(r->k, r->n, r->conf, r->alternative), "Wilson");
    print_interval(r->conf, stat_jeffreys(r->k, r->n, r->conf, r->alternative), "Jeffreys");
    printf("  null region  %" PRId64 " to %" PRId64 " (p > %.10g)\n", t.null_region.low, t.null_region.high,
           1 - r->conf);
    print_bayes_factor(r);
    print_equality(r, &t);
    print_power(r);
}

static void interval_json(struct json *out, const char *low, const char *high, struct stat_interval ci)
{
    json_number(out, low, ci.low);
    json_number(out, high, ci.high);
}

static void equivalence_json(struct json *out, const struct binom_request *r, double p_difference)
{
    static const char *const words[] = {[STAT_UNDECIDED] = "undecided",
                                        [STAT_DIFFERENT] = "different",
                                        [STAT_WITHIN] = "within",
                                        [STAT_DIFFERENT_WITHIN] = "different_within"};
    struct stat_equivalence e = equivalence_of(r);
    json_open(out, "equivalence", '{');
    json_number(out, "margin", r->margin);
    json_number(out, "p_low", e.p_low);
    json_number(out, "p_high", e.p_high);
    json_number(out, "p_value", e.p_value);
    interval_json(out, "ci_low", "ci_high", e.ci);
    json_text(out, "shown", words[stat_verdict(p_difference, e.p_value, 1 - r->conf)]);
    json_close(out, '}');
}

static void power_json(struct json *out, const struct binom_request *r)
{
    double alpha = 1 - r->conf;
    struct stat_sample_size size = stat_binomial_sample_size(r->p0, r->share, alpha, r->power);
    json_open(out, "power", '{');
    json_number(out, "share", r->share);
    json_number(out, "power", stat_binomial_power(r->n, r->p0, r->share, alpha));
    json_number(out, "wanted", r->power);
    json_number(out, "n_first", size.first > 0 ? (double)size.first : (double)NAN);
    json_number(out, "n_stays", size.stays > 0 ? (double)size.stays : (double)NAN);
    json_close(out, '}');
}

void binom_print_json(const struct binom_request *r)
{
    struct stat_binomial t = stat_binomial_test(r->k, r->n, r->p0, r->conf, r->alternative);
    struct json out = {stdout, false};
    json_open(&out, NULL, '{');
    binomial_json(&out, &t);
    json_number(&out, "ln_p", t.log_p);
    json_number(&out, "mid_p", stat_binomial_mid_p(r->k, r->n, r->p0, r->alternative));
    interval_json(&out, "wilson_low", "wilson_high", stat_wilson(r->k, r->n, r->conf, r->alternative));
    interval_json(&out, "jeffreys_low", "jeffreys_high", stat_jeffreys(r->k, r->n, r->conf, r->alternative));
    json_number(&out, "prior_a", r->prior[0]);
    json_number(&out, "prior_b", r->prior[1]);
    json_number(&out, "ln_bf10", bayes_factor_of(r));
    if (!isnan(r->margin))
        equivalence_json(&out, r, t.p_value);
    if (!isnan(r->share))
        power_json(&out, r);
    json_close(&out, '}');
    putchar('\n');
}
