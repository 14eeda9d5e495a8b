#include "binomial_grid.h"

#include "analysis/stats/bayes_factor.h"
#include "analysis/stats/binomial.h"
#include "analysis/stats/equivalence.h"
#include "reference.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static const double shallow = -690.7; // ln 1e-300

struct row {
    int64_t k, n;
    double p0, conf, margin;
    double ln_p[3], ln_mid[3], ln_equal; // two-sided, less, greater
    double bound[2][3][2];               // two-sided or one-sided; Clopper-Pearson, Wilson, Jeffreys; low, high
    double ln_bf[3];
};

static void read_row(char *line, struct row *row)
{
    char *rest = line;
    row->k = strtoll(reference_field(&rest, ','), NULL, 10);
    row->n = strtoll(reference_field(&rest, ','), NULL, 10);
    double *numbers[] = {&row->p0,      &row->conf,      &row->margin,    &row->ln_p[0],   &row->ln_p[1],
                         &row->ln_p[2], &row->ln_mid[0], &row->ln_mid[1], &row->ln_mid[2], &row->ln_equal};
    for (size_t i = 0; i < sizeof numbers / sizeof numbers[0]; i++)
        *numbers[i] = reference_number(reference_field(&rest, ','));
    for (int i = 0; i < 12; i++)
        row->bound[i / 6][i / 2 % 3][i % 2] = reference_number(reference_field(&rest, ','));
    for (int i = 0; i < 3; i++)
        row->ln_bf[i] = reference_number(reference_field(&rest, ','));
    assert_null(rest);
}

// |a - b|; 0 for two that are equal, be it NaN or infinite.
static double apart(double a, double b)
{
    if (a == b || (isnan(a) && isnan(b)))
        return 0;
    double d = fabs(a - b);
    return isnan(d) ? (double)INFINITY : d;
}

static void worst(double *most, double error)
{
    *most = error > *most ? error : *most;
}

static void compare_p(const struct row *row, struct binomial_grid *grid)
{
    for (int i = 0; i < 3; i++) {
        enum stat_alternative alternative = (enum stat_alternative)i; // in the order of the columns
        double p = stat_binomial_p(row->k, row->n, row->p0, alternative),
               ln_p = stat_binomial_log_p(row->k, row->n, row->p0, alternative),
               mid = stat_binomial_mid_p(row->k, row->n, row->p0, alternative);
        if (row->ln_p[i] >= shallow || isinf(row->ln_p[i])) {
            worst(&grid->ln_p, apart(ln_p, row->ln_p[i]));
            worst(&grid->ln_p, apart(log(p), row->ln_p[i]));
        } else {
            worst(&grid->deep, reference_distance(ln_p, row->ln_p[i]));
        }
        if (row->ln_mid[i] >= shallow || isinf(row->ln_mid[i]))
            worst(&grid->mid_p, reference_distance(mid, exp(row->ln_mid[i])));
    }
}

static void compare_bounds(const struct row *row, struct binomial_grid *grid)
{
    struct stat_interval (*const intervals[])(int64_t, int64_t, double, enum stat_alternative) = {
        stat_clopper_pearson, stat_wilson, stat_jeffreys};
    double *errors[] = {&grid->clopper, &grid->wilson, &grid->jeffreys};
    for (int i = 0; i < 3; i++) {
        struct stat_interval both = intervals[i](row->k, row->n, row->conf, STAT_TWO_SIDED),
                             less = intervals[i](row->k, row->n, row->conf, STAT_LESS),
                             greater = intervals[i](row->k, row->n, row->conf, STAT_GREATER);
        assert_true(less.low == 0 && greater.high == 1);
        worst(errors[i], reference_distance(both.low, row->bound[0][i][0]));
        worst(errors[i], reference_distance(both.high, row->bound[0][i][1]));
        worst(errors[i], reference_distance(greater.low, row->bound[1][i][0]));
        worst(errors[i], reference_distance(less.high, row->bound[1][i][1]));
    }
}

static void compare_others(const struct row *row, struct binomial_grid *grid)
{
    const double priors[3][2] = {{1, 1}, {0.5, 0.5}, {2, 7}};
    for (int i = 0; i < 3; i++) {
        double ln_bf = stat_binomial_log_bf10(row->k, row->n, row->p0, priors[i][0], priors[i][1]);
        worst(&grid->bayes, apart(ln_bf, row->ln_bf[i]) / fmax(1, fabs(row->ln_bf[i])));
    }
    double p = stat_binomial_equivalence(row->k, row->n, row->p0, row->margin, 0.05).p_value;
    if (isnan(row->ln_equal) || row->ln_equal >= shallow)
        worst(&grid->equivalence, apart(log(p), row->ln_equal));
    else
        assert_true(p < 1e-299);
}

struct binomial_grid binomial_grid_errors(void)
{
    FILE *file = reference_open("binomial_exact.csv");
    char line[2048];
    struct binomial_grid grid = {0};
    assert_non_null(fgets(line, sizeof line, file));
    for (; fgets(line, sizeof line, file); grid.rows++) {
        struct row row;
        line[strcspn(line, "\n")] = '\0';
        read_row(line, &row);
        compare_p(&row, &grid);
        compare_bounds(&row, &grid);
        compare_others(&row, &grid);
    }
    fclose(file);
    return grid;
}
