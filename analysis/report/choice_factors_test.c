// The tests of one set of cells.
//   Interval of a difference of independent proportions: Newcombe, R. G. (1998), Statistics in Medicine 17,
//   873-890, method 10: from Wilson's limits of either.
//   Within people the differences are -1, 0 and 1, and their mean has Student's t interval.
#include "analysis/report/choice_factors_private.h"
#include "analysis/stats/chi_squared.h"
#include "analysis/stats/cochran.h"
#include "analysis/stats/exchange.h"
#include "analysis/stats/fisher.h"
#include "analysis/stats/mcnemar.h"

#include <math.h>
#include <stdlib.h>

enum { SEED = 1 }; // of arrangements drawn at random, so that a report repeats exactly

const char *choice_factor_word(enum choice_factor_method method)
{
    static const char *const words[] = {[FACTOR_FISHER] = "Fisher",
                                        [FACTOR_EXCHANGE] = "exchange of people",
                                        [FACTOR_MCNEMAR] = "McNemar",
                                        [FACTOR_COCHRAN] = "Cochran's Q"};
    return words[method];
}

static struct stat_interval newcombe(const struct choice_cell *a, const struct choice_cell *b, double conf)
{
    struct stat_interval x = stat_wilson(a->chosen, a->n, conf, STAT_TWO_SIDED),
                         y = stat_wilson(b->chosen, b->n, conf, STAT_TWO_SIDED);
    double p = (double)a->chosen / (double)a->n, q = (double)b->chosen / (double)b->n;
    return (struct stat_interval){p - q - hypot(p - x.low, y.high - q), p - q + hypot(x.high - p, q - y.low)};
}

static bool exchange(struct choice_factor_test *test, const struct factor_set *set)
{
    int *group = malloc(set->most * sizeof *group);
    int64_t *counts = malloc(2 * set->most * sizeof *counts);
    size_t people = 0;
    for (size_t g = 0; group && counts && g < set->count; g++)
        for (size_t k = 0; k < set->cells[g]->people; k++) {
            const struct stat_person *person = &set->cells[g]->counts[k];
            if (person->n == 0)
                continue;
            group[people] = (int)g;
            counts[2 * people] = person->k;
            counts[2 * people++ + 1] = person->n - person->k;
        }
    bool ok = group && counts;
    if (ok) {
        const struct stat_groups_of_people of = {people, set->count, 2, group, counts};
        struct stat_permutation p = stat_exchange_test(&of, (struct stat_permuting){.seed = SEED});
        test->method = FACTOR_EXCHANGE;
        test->statistic = p.statistic;
        test->p_value = p.p_value;
        test->p_error = isnan(p.standard_error) ? 0 : p.standard_error;
    }
    free(group);
    free(counts);
    return ok;
}

static bool shares_of(const struct choice_cell *cell, double **out, size_t *count)
{
    *out = malloc((cell->people + 1) * sizeof **out);
    *count = 0;
    for (size_t i = 0; *out && i < cell->people; i++)
        if (cell->counts[i].n)
            (*out)[(*count)++] = (double)cell->counts[i].k / (double)cell->counts[i].n;
    return *out != NULL;
}

static bool welch(struct choice_factor_test *test, const struct factor_set *set, double conf)
{
    double *a = NULL, *b = NULL;
    size_t n_a, n_b;
    bool ok = shares_of(set->cells[0], &a, &n_a) && shares_of(set->cells[1], &b, &n_b);
    if (ok) {
        struct stat_ttest t = stat_ttest_welch(a, n_a, b, n_b, &(struct stat_ttest_options){.conf = conf});
        test->ci = (struct stat_interval){t.ci_low, t.ci_high};
    }
    free(a);
    free(b);
    return ok;
}

static void count_people(struct choice_factor_test *test, const struct factor_set *set)
{
    for (size_t i = 0; i < set->count; i++)
        test->people += stat_people_sum(set->cells[i]->counts, set->cells[i]->people).people;
}

static bool one_each(struct choice_factor_test *test, const struct factor_set *set, double conf)
{
    int64_t counts[2 * FACTOR_LEVELS];
    for (size_t i = 0; i < set->count; i++) {
        counts[2 * i] = set->cells[i]->chosen;
        counts[2 * i + 1] = set->cells[i]->n - set->cells[i]->chosen;
    }
    const struct stat_counts table = {counts, (int)set->count, 2};
    struct stat_chi_squared chi = stat_chi_squared_test(table);
    test->method = FACTOR_FISHER;
    if (set->count == 2) {
        struct stat_fisher f = stat_fisher_2x2(counts, conf, STAT_TWO_SIDED);
        test->p_value = f.p_value;
        test->odds_ratio = f.odds_ratio;
        test->odds_ci = f.ci;
        test->ci = newcombe(set->cells[0], set->cells[1], conf);
    } else {
        test->p_value = stat_fisher_p(table);
        if (isnan(test->p_value)) // too many tables to count
            return exchange(test, set);
    }
    test->statistic = chi.statistic;
    test->df = chi.df;
    test->p_asymptotic = chi.p_value;
    return true;
}

bool factor_test_between(struct choice_factor_test *test, const struct factor_set *set, double conf)
{
    count_people(test, set);
    if (set->count == 2) {
        test->share_a = stat_people_share(set->cells[0]->counts, set->cells[0]->people);
        test->share_b = stat_people_share(set->cells[1]->counts, set->cells[1]->people);
        test->difference = test->share_a - test->share_b;
    }
    if (!set->several)
        return one_each(test, set, conf);
    return exchange(test, set) && (set->count > 2 || welch(test, set, conf));
}

// --- the same people ---

// Whether a person of the set's cell `from` has answered in no cell before it.
static bool is_new(const struct factor_set *set, size_t from, size_t person)
{
    for (size_t i = 0; i < from; i++)
        if (factor_counts(set->cells[i], person))
            return false;
    return true;
}

// Rows of the people with an answer at every level; counts the others.
static void fill_rows(struct choice_factor_test *test, const struct factor_set *set, unsigned char *rows)
{
    for (size_t i = 0; i < set->count; i++)
        for (size_t k = 0; k < set->cells[i]->people; k++) {
            size_t person = set->cells[i]->person[k], levels = 0;
            if (set->cells[i]->counts[k].n == 0 || !is_new(set, i, person))
                continue;
            for (size_t j = 0; j < set->count; j++) {
                const struct stat_person *counts = factor_counts(set->cells[j], person);
                rows[test->people * set->count + j] = counts && counts->k > 0;
                levels += counts != NULL;
            }
            if (levels == set->count)
                test->people++;
            else
                test->left_out++;
        }
}

static bool mcnemar(struct choice_factor_test *test, const unsigned char *rows, double conf)
{
    int64_t b = 0, c = 0;
    double *difference = malloc((test->people + 1) * sizeof *difference), a_sum = 0, b_sum = 0;
    for (size_t i = 0; difference && i < test->people; i++) {
        b += rows[2 * i] && !rows[2 * i + 1];
        c += !rows[2 * i] && rows[2 * i + 1];
        a_sum += rows[2 * i];
        b_sum += rows[2 * i + 1];
        difference[i] = (double)rows[2 * i] - (double)rows[2 * i + 1];
    }
    if (!difference)
        return false;
    struct stat_mcnemar m = stat_mcnemar_test(b, c, conf);
    struct stat_ttest t =
        stat_ttest_one_sample(difference, test->people, &(struct stat_ttest_options){.conf = conf});
    double n = (double)test->people;
    test->p_value = m.p_exact;
    test->statistic = m.chi_squared;
    test->df = 1;
    test->p_asymptotic = m.p_value;
    test->odds_ratio = m.odds_ratio;
    test->odds_ci = m.ci;
    test->share_a = a_sum / n;
    test->share_b = b_sum / n;
    test->difference = (a_sum - b_sum) / n;
    test->ci = (struct stat_interval){t.ci_low, t.ci_high};
    free(difference);
    return true;
}

bool factor_test_within(struct choice_factor_test *test, const struct factor_set *set, double conf)
{
    unsigned char *rows = calloc((set->most + 1) * set->count, 1);
    bool ok = rows != NULL;
    test->method = set->count == 2 ? FACTOR_MCNEMAR : FACTOR_COCHRAN;
    if (ok)
        fill_rows(test, set, rows);
    if (ok && test->people > 0 && set->count == 2) {
        ok = mcnemar(test, rows, conf);
    } else if (ok && test->people > 0) {
        struct stat_cochran q =
            stat_cochran_q(rows, test->people, set->count, (struct stat_permuting){.seed = SEED});
        test->p_value = q.permutation.p_value;
        test->p_error = isnan(q.permutation.standard_error) ? 0 : q.permutation.standard_error;
        test->statistic = q.statistic;
        test->df = q.df;
        test->p_asymptotic = q.p_value;
    }
    free(rows);
    return ok;
}
