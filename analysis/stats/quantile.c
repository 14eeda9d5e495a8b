// Hyndman, R. J. & Fan, Y. (1996), "Sample quantiles in statistical packages", The American Statistician 50,
// 361-365, definition 7: the order statistics are at (i - 1) / (n - 1).
#include "analysis/stats/quantile.h"

#include <math.h>
#include <stdlib.h>

static int ascending(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

void stat_sort(double *values, size_t n)
{
    if (n > 1)
        qsort(values, n, sizeof values[0], ascending);
}

double stat_quantile(const double *sorted, size_t n, double p)
{
    if (n == 0 || !(p >= 0 && p <= 1))
        return (double)NAN;
    double place = (double)(n - 1) * p, below = floor(place), part = place - below;
    size_t i = (size_t)below;
    if (part == 0 || i + 1 >= n)
        return sorted[i];
    return (1 - part) * sorted[i] + part * sorted[i + 1];
}
