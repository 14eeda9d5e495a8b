// The tests of one set of cells, or of two of its levels.
//   Interval of a difference of independent proportions: Newcombe, R. G. (1998), Statistics in Medicine 17,
//   873-890, method 10: from Wilson's limits of either.
#include "analysis/report/choice_factors_private.h"
#include "analysis/stats/chi_squared.h"
#include "analysis/stats/cochran.h"
#include "analysis/stats/exchange.h"
#include "analysis/stats/fisher.h"
#include "analysis/stats/mcnemar.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { SEED = 1 }; // of arrangements drawn at random, so that a report repeats exactly

static void say(struct choice_factor_test *test, const char *why)
{
    snprintf(test->none, sizeof test->none, "%s", why);
}

static void set_shares(struct choice_factor_test *test, const struct factor_people *people)
{
    test->share_a = stat_people_share(factor_people_at(people, 0), people->people);
    test->share_b = stat_people_share(factor_people_at(people, 1), people->people);
    test->difference = test->share_a - test->share_b;
}

static struct stat_interval newcombe(const struct stat_people *a, const struct stat_people *b, double conf)
{
    struct stat_interval x = stat_wilson(a->k, a->n, conf, STAT_TWO_SIDED),
                         y = stat_wilson(b->k, b->n, conf, STAT_TWO_SIDED);
    double p = (double)a->k / (double)a->n, q = (double)b->k / (double)b->n;
    return (struct stat_interval){p - q - hypot(p - x.low, y.high - q), p - q + hypot(x.high - p, q - y.low)};
}

static bool exchange(struct choice_factor_test *test, const struct factor_people *of)
{
    int *group = malloc((of->people + 1) * sizeof *group);
    int64_t *counts = malloc((2 * of->people + 1) * sizeof *counts);
    bool ok = group && counts;
    for (size_t g = 0; ok && g < of->levels; g++)
        for (size_t p = 0; p < of->people; p++) {
            const struct stat_person *person = &factor_people_at(of, g)[p];
            if (person->n == 0)
                continue;
            group[p] = (int)g;
            counts[2 * p] = person->k;
            counts[2 * p + 1] = person->n - person->k;
        }
    if (ok) {
        const struct stat_groups_of_people people = {of->people, of->levels, 2, group, counts};
        struct stat_permutation p = stat_exchange_test(&people, (struct stat_permuting){.seed = SEED});
        test->method = FACTOR_EXCHANGE;
        test->statistic = p.statistic;
        test->p_value = p.p_value;
        test->p_error = isnan(p.standard_error) ? 0 : p.standard_error;
    }
    free(group);
    free(counts);
    return ok;
}

static size_t shares_of(const struct stat_person *counts, size_t people, double *out)
{
    size_t count = 0;
    for (size_t i = 0; i < people; i++)
        if (counts[i].n)
            out[count++] = (double)counts[i].k / (double)counts[i].n;
    return count;
}

static bool welch(struct choice_factor_test *test, const struct factor_people *of, double conf)
{
    double *a = malloc((2 * of->people + 1) * sizeof *a), *b = a + of->people;
    if (!a)
        return false;
    size_t n_a = shares_of(factor_people_at(of, 0), of->people, a);
    size_t n_b = shares_of(factor_people_at(of, 1), of->people, b);
    struct stat_ttest t = stat_ttest_welch(a, n_a, b, n_b, &(struct stat_ttest_options){.conf = conf});
    test->ci = (struct stat_interval){t.ci_low, t.ci_high};
    free(a);
    return true;
}

static bool one_each(struct choice_factor_test *test, const struct factor_people *of,
                     const struct stat_people *sums, double conf)
{
    int64_t counts[2 * CHOICE_FACTOR_LEVELS];
    for (size_t i = 0; i < of->levels; i++) {
        counts[2 * i] = sums[i].k;
        counts[2 * i + 1] = sums[i].n - sums[i].k;
    }
    const struct stat_counts table = {counts, (int)of->levels, 2};
    struct stat_chi_squared chi = stat_chi_squared_test(table);
    if (of->levels == 2) {
        struct stat_fisher f = stat_fisher_2x2(counts, conf, STAT_TWO_SIDED);
        test->p_value = f.p_value;
        test->odds_ratio = f.odds_ratio;
        test->odds_ci = f.ci;
        test->ci = newcombe(&sums[0], &sums[1], conf);
    } else {
        test->p_value = stat_fisher_p(table);
        if (isnan(test->p_value)) // too many tables to count
            return exchange(test, of);
    }
    test->statistic = chi.statistic;
    test->df = chi.df;
    test->p_asymptotic = chi.p_value;
    return true;
}

bool factor_test_between(struct choice_factor_test *test, const struct factor_people *of, double conf)
{
    struct stat_people sums[CHOICE_FACTOR_LEVELS];
    int64_t k = 0, n = 0;
    test->method = of->several ? FACTOR_EXCHANGE : FACTOR_FISHER;
    for (size_t i = 0; i < of->levels; i++) {
        sums[i] = stat_people_sum(factor_people_at(of, i), of->people);
        k += sums[i].k;
        n += sums[i].n;
        if (sums[i].people == 0) {
            snprintf(test->none, sizeof test->none,
                     "everybody who answered at %.60s answered at other levels too and is left out",
                     test->level[i]);
            return true;
        }
    }
    if (of->levels == 2)
        set_shares(test, of);
    bool ok = of->several ? exchange(test, of) && (of->levels > 2 || welch(test, of, conf))
                          : one_each(test, of, sums, conf);
    if (ok && isnan(test->p_value))
        say(test,
            k == 0 || k == n ? "all answers are the same" : "there are too many people or answers for it");
    return ok;
}

// --- the same people ---

static void mcnemar(struct choice_factor_test *test, const struct factor_people *of, double conf)
{
    int64_t b = 0, c = 0;
    const struct stat_person *x = factor_people_at(of, 0), *y = factor_people_at(of, 1);
    for (size_t i = 0; i < of->people; i++) {
        b += x[i].k > y[i].k;
        c += x[i].k < y[i].k;
    }
    struct stat_mcnemar m = stat_mcnemar_test(b, c, conf);
    test->p_value = m.p_exact;
    test->statistic = m.chi_squared;
    test->df = isnan(m.chi_squared) ? (double)NAN : 1;
    test->p_asymptotic = m.p_value;
    test->odds_ratio = m.odds_ratio;
    test->odds_ci = m.ci;
    test->ci = stat_mcnemar_difference(b, c, (int64_t)of->people, conf);
    set_shares(test, of);
}

static bool cochran(struct choice_factor_test *test, const struct factor_people *of)
{
    unsigned char *rows = calloc(of->people * of->levels, 1);
    if (!rows)
        return false;
    bool differ = false;
    for (size_t i = 0; i < of->people; i++)
        for (size_t j = 0; j < of->levels; j++) {
            rows[i * of->levels + j] = factor_people_at(of, j)[i].k > 0;
            differ = differ || rows[i * of->levels + j] != rows[i * of->levels];
        }
    struct stat_cochran q = stat_cochran_q(rows, of->people, of->levels, (struct stat_permuting){.seed = SEED});
    test->p_value = q.permutation.p_value;
    test->p_error = isnan(q.permutation.standard_error) ? 0 : q.permutation.standard_error;
    test->statistic = q.statistic;
    test->df = q.df;
    test->p_asymptotic = q.p_value;
    if (isnan(test->p_value))
        say(test, differ ? "there are too many people for it" : "nobody's answers differ between levels");
    free(rows);
    return true;
}

bool factor_test_within(struct choice_factor_test *test, const struct factor_people *of, double conf)
{
    test->method = of->levels == 2 ? FACTOR_MCNEMAR : FACTOR_COCHRAN;
    if (of->people == 0) {
        say(test, of->levels == 2 ? "nobody answered at both levels" : "nobody answered at every level");
        return true;
    }
    if (of->levels > 2)
        return cochran(test, of);
    mcnemar(test, of, conf);
    return true;
}
