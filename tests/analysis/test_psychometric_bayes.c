// Psychometric functions by Bayes' rule against a finer grid made by R (tests/reference/psychometric_bayes.R),
// and by law.
#include "analysis/stats/marginal.h"
#include "analysis/stats/psychometric_bayes.h"
#include "reference.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

enum { MOST = 64, VALUES = 5 };

static void values_of(const struct stat_marginal *m, double out[VALUES])
{
    const double values[VALUES] = {m->mean, m->sd, m->median, m->credible.low, m->credible.high};
    memcpy(out, values, sizeof values);
}

// Off by at most half a percent of the credible interval's width, and of the SD's own size.
static void compare(const char *name, const char *what, const struct stat_marginal *m, const double r[VALUES],
                    double *worst)
{
    static const char *const names[VALUES] = {"mean", "SD", "median", "low", "high"};
    double mine[VALUES], width = r[4] - r[3];
    values_of(m, mine);
    for (size_t i = 0; i < VALUES; i++) {
        double off = fabs(mine[i] - r[i]) / (i == 1 ? r[1] : width);
        *worst = fmax(*worst, off);
        if (!(off <= 0.005))
            fail_msg("%s, %s of %s: %.6g, R %.6g (%.2g of the interval)", name, names[i], what, mine[i], r[i],
                     off);
    }
}

static void agrees_with_a_finer_grid(void **state)
{
    (void)state;
    static char line[8192];
    double worst[4] = {0};
    size_t rows = 0;
    FILE *file = reference_open("psychometric_bayes.csv");
    assert_non_null(fgets(line, sizeof line, file));
    for (; fgets(line, sizeof line, file); rows++) {
        line[strcspn(line, "\n")] = '\0';
        char *rest = line;
        const char *name = reference_field(&rest, ',');
        struct stat_fit_desc desc = {0};
        assert_true(stat_family_find(reference_field(&rest, ','), &desc.family));
        desc.logarithmic = reference_number(reference_field(&rest, ',')) > 0;
        desc.falling = reference_number(reference_field(&rest, ',')) > 0;
        double guess = reference_number(reference_field(&rest, ','));
        desc.guess_low = isnan(guess) ? 0 : guess;
        desc.guess_high = isnan(guess) ? 0.5 : guess;
        desc.lapse_high = reference_number(reference_field(&rest, ',')) > 0 ? 0.5 : 0;
        double levels[MOST], k[MOST], n[MOST], r[4][VALUES];
        size_t count = reference_numbers(reference_field(&rest, ','), levels, MOST);
        reference_numbers(reference_field(&rest, ','), k, MOST);
        reference_numbers(reference_field(&rest, ','), n, MOST);
        struct stat_answers answers[MOST];
        for (size_t i = 0; i < count; i++)
            answers[i] = (struct stat_answers){levels[i], (int64_t)k[i], (int64_t)n[i]};
        for (size_t i = 0; i < 4; i++)
            for (size_t j = 0; j < VALUES; j++)
                r[i][j] = reference_number(reference_field(&rest, ','));
        struct stat_bayes b = stat_psychometric_bayes(answers, count, &desc);
        compare(name, "the threshold", &b.threshold, r[0], &worst[0]);
        compare(name, "the width", &b.width, r[1], &worst[1]);
        if (desc.lapse_high > 0)
            compare(name, "the lapse", &b.lapse, r[2], &worst[2]);
        compare(name, "eta", &b.eta, r[3], &worst[3]);
    }
    fclose(file);
    print_message("%zu sets: threshold within %.1e of the interval, width %.1e, lapse %.1e, eta %.1e\n", rows,
                  worst[0], worst[1], worst[2], worst[3]);
    assert_true(rows >= 8);
}

// Gauss and Legendre's n points are exact for polynomials up to degree 2 n - 1.
static void nodes_are_exact(void **state)
{
    (void)state;
    double x[16], w[16];
    for (size_t n = 1; n <= 16; n++) {
        stat_gauss_legendre(n, x, w);
        for (size_t degree = 0; degree < 2 * n; degree++) {
            double sum = 0;
            for (size_t i = 0; i < n; i++)
                sum += w[i] * pow(x[i], (double)degree);
            assert_true(fabs(sum * ((double)degree + 1) - 1) < 1e-13);
        }
    }
}

static void more_doubt_where_answers_vary_more(void **state)
{
    (void)state;
    const struct stat_answers smooth[] = {{1, 1, 20}, {2, 4, 20}, {3, 10, 20}, {4, 16, 20}, {5, 19, 20}};
    const struct stat_answers rough[] = {{1, 5, 20}, {2, 0, 20}, {3, 14, 20}, {4, 11, 20}, {5, 20, 20}};
    const struct stat_fit_desc desc = {.lapse_high = 0.5};
    struct stat_bayes a = stat_psychometric_bayes(smooth, 5, &desc),
                      b = stat_psychometric_bayes(rough, 5, &desc);
    assert_true(a.eta.mean < 0.12 && b.eta.mean > 0.2);
    assert_true(b.threshold.sd > 1.3 * a.threshold.sd);
    assert_true(fabs(a.threshold.mean - 3) < 0.2 && !a.prior_bound);
    assert_true(a.guess.sd == 0 && a.guess.mean == 0);
}

// The likelihood of a large eta is next to nothing here, beyond what a cubic through its logarithm can follow:
// a swing of it once put the median at 0.95.
static void median_lies_where_the_mean_is(void **state)
{
    (void)state;
    const struct stat_answers answers[] = {{1, 6, 12}, {2, 4, 12}, {3, 7, 12}, {4, 6, 12},  {5, 8, 12},
                                           {6, 9, 12}, {7, 9, 12}, {8, 9, 12}, {9, 12, 12}, {10, 11, 12}};
    const struct stat_fit_desc desc = {.guess_low = 0.5, .guess_high = 0.5};
    struct stat_bayes b = stat_psychometric_bayes(answers, 10, &desc);
    assert_true(fabs(b.eta.median - b.eta.mean) < b.eta.sd);
    assert_true(b.eta.credible.low < b.eta.mean && b.eta.mean < b.eta.credible.high);
    const struct stat_answers many[] = {{1, 300, 3000}, {2, 1500, 3000}, {3, 2700, 3000}};
    b = stat_psychometric_bayes(many, 3, &(struct stat_fit_desc){0});
    assert_true(b.eta.credible.high < 0.3 && fabs(b.eta.median - b.eta.mean) < 2 * b.eta.sd);
}

static void nothing_known_is_the_prior(void **state)
{
    (void)state;
    const struct stat_answers same[] = {{1, 1, 2}, {2, 1, 2}, {3, 1, 2}};
    struct stat_bayes b = stat_psychometric_bayes(same, 3, &(struct stat_fit_desc){0});
    assert_true(b.threshold.credible.low > 0 && b.threshold.credible.high < 4); // half the range beyond
    assert_true(fabs(b.threshold.mean - 2) < 1e-3);
    assert_true(b.prior_bound);
}

static void bad_input(void **state)
{
    (void)state;
    const struct stat_answers one[] = {{1, 1, 2}}, wrong[] = {{1, 3, 2}, {2, 1, 2}},
                              many[] = {{1, 1, STAT_BAYES_MOST}, {2, 1, 1}}, zero[] = {{0, 1, 2}, {1, 1, 2}};
    const struct stat_fit_desc desc = {0}, weibull = {.family = STAT_WEIBULL};
    assert_true(isnan(stat_psychometric_bayes(one, 1, &desc).threshold.mean));
    assert_true(isnan(stat_psychometric_bayes(wrong, 2, &desc).threshold.mean));
    assert_true(isnan(stat_psychometric_bayes(many, 2, &desc).eta.sd));
    assert_true(isnan(stat_psychometric_bayes(zero, 2, &weibull).width.median));
    assert_true(isnan(stat_psychometric_bayes(NULL, 0, &desc).threshold.credible.low));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(agrees_with_a_finer_grid),           cmocka_unit_test(nodes_are_exact),
        cmocka_unit_test(more_doubt_where_answers_vary_more), cmocka_unit_test(median_lies_where_the_mean_is),
        cmocka_unit_test(nothing_known_is_the_prior),         cmocka_unit_test(bad_input),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
