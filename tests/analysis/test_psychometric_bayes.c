// Psychometric functions by Bayes' rule against a finer grid and against draws, both made by R
// (tests/reference/psychometric_bayes.R, psychometric_bayes_sampled.R), and by law.
#include "analysis/stats/marginal.h"
#include "analysis/stats/psychometric_mass.h"
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

// Off by at most a share of the credible interval's width, and of the SD's own size.
static void compare(const char *name, const char *what, const struct stat_marginal *m, const double r[VALUES],
                    double allowed, double *worst)
{
    static const char *const names[VALUES] = {"mean", "SD", "median", "low", "high"};
    double mine[VALUES], width = r[4] - r[3];
    values_of(m, mine);
    for (size_t i = 0; i < VALUES; i++) {
        double off = fabs(mine[i] - r[i]) / (i == 1 ? r[1] : width);
        *worst = fmax(*worst, off);
        if (!(off <= allowed))
            fail_msg("%s, %s of %s: %.6g, R %.6g (%.2g of the interval)", name, names[i], what, mine[i], r[i],
                     off);
    }
}

struct row {
    char name[64];
    struct stat_fit_desc desc;
    struct stat_answers answers[MOST];
    size_t count;
    char *rest; // the reference values
};

// `guess` and `lapse` columns: the asymptote's value, or NA and the lapse's end where it is free.
static bool next_row(FILE *file, char *line, int size, struct row *row)
{
    double levels[MOST], k[MOST], n[MOST];
    if (!fgets(line, size, file))
        return false;
    line[strcspn(line, "\n")] = '\0';
    char *rest = line;
    snprintf(row->name, sizeof row->name, "%s", reference_field(&rest, ','));
    row->desc = (struct stat_fit_desc){0};
    assert_true(stat_family_find(reference_field(&rest, ','), &row->desc.family));
    row->desc.logarithmic = reference_number(reference_field(&rest, ',')) > 0;
    row->desc.falling = reference_number(reference_field(&rest, ',')) > 0;
    double guess = reference_number(reference_field(&rest, ','));
    row->desc.guess_low = isnan(guess) ? 0 : guess;
    row->desc.guess_high = isnan(guess) ? 0.5 : guess;
    row->desc.lapse_high = reference_number(reference_field(&rest, ',')) > 0 ? 0.5 : 0;
    row->count = reference_numbers(reference_field(&rest, ','), levels, MOST);
    assert_int_equal(reference_numbers(reference_field(&rest, ','), k, MOST), row->count);
    assert_int_equal(reference_numbers(reference_field(&rest, ','), n, MOST), row->count);
    for (size_t i = 0; i < row->count; i++)
        row->answers[i] = (struct stat_answers){levels[i], (int64_t)k[i], (int64_t)n[i]};
    row->rest = rest;
    return true;
}

// The marginals in the order of the files' columns; where an asymptote is fixed they have none.
static size_t agree(const char *file_name, size_t marginals, bool with_error)
{
    static char line[8192];
    static const char *const whats[] = {"the threshold", "the width", "the lapse", "eta", "the guess"};
    struct row row;
    double worst[5] = {0};
    size_t rows = 0;
    FILE *file = reference_open(file_name);
    assert_non_null(fgets(line, sizeof line, file));
    for (; next_row(file, line, sizeof line, &row); rows++) {
        struct stat_bayes b = stat_psychometric_bayes(row.answers, row.count, &row.desc);
        const struct stat_marginal *mine[] = {&b.threshold, &b.width, &b.lapse, &b.eta, &b.guess};
        assert_false(b.rough);
        double r[5][VALUES];
        for (size_t i = 0; i < marginals; i++)
            for (size_t j = 0; j < VALUES; j++)
                r[i][j] = reference_number(reference_field(&row.rest, ','));
        double error = with_error ? reference_number(reference_field(&row.rest, ',')) : 0;
        for (size_t i = 0; i < marginals; i++)
            if (!isnan(r[i][0]))
                compare(row.name, whats[i], mine[i], r[i], 0.005 + 3 * error, &worst[i]);
            else
                assert_true(mine[i]->sd == 0);
    }
    fclose(file);
    print_message("%zu sets: threshold within %.1e of the interval, width %.1e, lapse %.1e, eta %.1e, guess "
                  "%.1e\n",
                  rows, worst[0], worst[1], worst[2], worst[3], worst[4]);
    return rows;
}

static void agrees_with_a_finer_grid(void **state)
{
    (void)state;
    assert_true(agree("psychometric_bayes.csv", 4, false) >= 9);
}

// Many answers, both asymptotes free: posteriors so narrow that a grid laid over the priors has no point in
// them. The reference is sampled, and its own standard error stands in its last column.
static void agrees_with_independent_draws(void **state)
{
    (void)state;
    assert_true(agree("psychometric_bayes_sampled.csv", 5, true) >= 12);
}

// A grid laid over the priors has no point in so narrow a posterior, and says so; the one that is laid is fine.
static void a_coarse_grid_says_so(void **state)
{
    (void)state;
    const struct stat_answers answers[] = {{0, 22, 200},  {1, 13, 200},  {2, 31, 200},
                                           {3, 65, 200},  {4, 102, 200}, {5, 167, 200},
                                           {6, 189, 200}, {7, 196, 200}, {8, 191, 200}};
    const struct stat_fit_desc desc = {.guess_high = 0.5};
    struct stat_problem problem;
    struct stat_grid *grid = calloc(1, sizeof *grid);
    double top;
    assert_non_null(grid);
    assert_true(stat_problem_init(&problem, answers, 9, &desc));
    assert_true(stat_mass_find(&problem, grid, &top) && stat_grid_sum(&problem, grid, top));
    assert_true(grid->rough <= stat_grid_enough);
    size_t points[STAT_GRID_AXES];
    for (int i = 0; i < STAT_GRID_AXES; i++)
        points[i] = grid->axis[i].points;
    assert_int_equal(points[STAT_GRID_LAPSE], 1); // fixed
    grid->axis[STAT_GRID_GUESS].points = 4;
    assert_true(stat_grid_sum(&problem, grid, top));
    assert_true(grid->rough > stat_grid_enough && grid->rough_along[STAT_GRID_GUESS]);
    stat_posterior_axes(&problem, grid->axis);
    for (int i = 0; i < STAT_GRID_AXES; i++)
        grid->axis[i].points = points[i];
    assert_true(stat_grid_sum(&problem, grid, top));
    assert_true(grid->rough > stat_grid_enough);
    stat_problem_finish(&problem);
    free(grid);
}

// The normal density at 13 points a standard deviation apart, and its own quantiles (R: qnorm).
static double flat(const void *user, double x)
{
    (void)user;
    (void)x;
    return 1;
}

static void a_bell_is_read_exactly(void **state)
{
    (void)state;
    double mass[13];
    for (int i = 0; i < 13; i++)
        mass[i] = exp(-0.5 * (i - 6) * (i - 6)) / (i == 0 || i == 12 ? 2 : 1);
    const struct stat_even even = {.mass = mass, .low = -6, .high = 6, .points = 13, .prior = flat};
    struct stat_marginal m = stat_even_marginal(&even, 0.95);
    assert_true(fabs(m.mean) < 1e-12 && fabs(m.median) < 1e-6 && fabs(m.sd - 1) < 1e-6);
    assert_true(fabs(m.credible.low + 1.9599639845400538) < 1e-3 &&
                fabs(m.credible.high - 1.9599639845400538) < 1e-3);
    assert_true(
        isnan(stat_even_marginal(&(struct stat_even){.mass = mass, .points = 3, .prior = flat}, 0.95).mean));
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
        cmocka_unit_test(agrees_with_a_finer_grid),
        cmocka_unit_test(agrees_with_independent_draws),
        cmocka_unit_test(a_coarse_grid_says_so),
        cmocka_unit_test(a_bell_is_read_exactly),
        cmocka_unit_test(more_doubt_where_answers_vary_more),
        cmocka_unit_test(median_lies_where_the_mean_is),
        cmocka_unit_test(nothing_known_is_the_prior),
        cmocka_unit_test(bad_input),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
