// Pearson, K. (1900), Philosophical Magazine 50, 157-175; Yates, F. (1934), Journal of the Royal Statistical
// Society, Supplement 1, 217-235, as chisq.test of R has it: the correction is 1/2, or |observed - expected|
// where that is less.
#include "analysis/stats/chi_squared.h"

#include <Rmath.h>
#include <math.h>
#include <stdbool.h>

struct margins {
    double row[STAT_COUNTS_MOST], column[STAT_COUNTS_MOST], all;
};

// False for what has no test.
static bool sum_up(struct stat_counts table, struct margins *m)
{
    *m = (struct margins){.all = 0};
    if (!table.counts || table.rows < 2 || table.columns < 2 || table.rows > STAT_COUNTS_MOST ||
        table.columns > STAT_COUNTS_MOST)
        return false;
    for (int i = 0; i < table.rows; i++)
        for (int j = 0; j < table.columns; j++) {
            int64_t count = table.counts[i * table.columns + j];
            if (count < 0 || count > STAT_COUNTS_MAX_N)
                return false;
            m->row[i] += (double)count;
            m->column[j] += (double)count;
            m->all += (double)count;
        }
    for (int i = 0; i < table.rows; i++)
        if (m->row[i] == 0)
            return false;
    for (int j = 0; j < table.columns; j++)
        if (m->column[j] == 0)
            return false;
    return m->all <= (double)STAT_COUNTS_MAX_N;
}

static double square_off(double count, double expected, double correction)
{
    double off = fabs(count - expected) - correction;
    return off * off / expected;
}

struct stat_chi_squared stat_chi_squared_test(struct stat_counts table)
{
    const double nan = (double)NAN;
    struct stat_chi_squared out = {nan, nan, nan, nan, nan, nan};
    struct margins m;
    if (!sum_up(table, &m))
        return out;
    // In a 2 x 2 table all four are equally far from their expectation.
    bool two_by_two = table.rows == 2 && table.columns == 2;
    double off = fabs((double)table.counts[0] - m.row[0] * m.column[0] / m.all),
           correction = off < 0.5 ? off : 0.5;
    out.statistic = 0;
    out.least_expected = (double)INFINITY;
    double corrected = 0;
    for (int i = 0; i < table.rows; i++)
        for (int j = 0; j < table.columns; j++) {
            double count = (double)table.counts[i * table.columns + j],
                   expected = m.row[i] * m.column[j] / m.all;
            out.statistic += square_off(count, expected, 0);
            corrected += square_off(count, expected, correction);
            out.least_expected = expected < out.least_expected ? expected : out.least_expected;
        }
    out.df = (double)((table.rows - 1) * (table.columns - 1));
    out.p_value = pchisq(out.statistic, out.df, false, false);
    if (two_by_two) {
        out.corrected = corrected;
        out.p_corrected = pchisq(corrected, 1, false, false);
    }
    return out;
}
