// Fisher, R. A. (1935), The Design of Experiments, section 21. All signs without listing them: the sums of one
// half of the values, sorted, meet those of the other half (Horowitz, E. & Sahni, S. (1974), J. ACM 21,
// 277-292, section 4), 2^(n/2) of each; so 36 values take a quarter of a million sums instead of 7e10.
#include "analysis/stats/signflip_values.h"

#include "analysis/stats/quantile.h"

#include <math.h>
#include <stdlib.h>

#define TIE                                                                                                    \
    1e-10 // of the sum of all sizes: far above the rounding of 36 additions, far below what data resolve

// All sums of signed values, rising. `out` has room for 2^n.
static size_t all_sums(const double *values, size_t n, double *out)
{
    size_t count = 1;
    out[0] = 0;
    for (size_t i = 0; i < n; i++) {
        for (size_t k = 0; k < count; k++) {
            out[count + k] = out[k] - values[i];
            out[k] += values[i];
        }
        count *= 2;
    }
    stat_sort(out, count);
    return count;
}

// How many pairs of sums reach `least` together.
static double pairs_from(const double *a, size_t a_count, const double *b, size_t b_count, double least)
{
    double pairs = 0; // up to 2^36: exact
    size_t from = b_count;
    for (size_t i = 0; i < a_count; i++) {
        while (from > 0 && a[i] + b[from - 1] >= least)
            from--;
        pairs += (double)(b_count - from);
    }
    return pairs;
}

struct stat_flip_values stat_signflip_values(const double *values, size_t n)
{
    struct stat_flip_values test = {.n = n, .p_value = (double)NAN, .least_p = (double)NAN};
    double sum = 0, size = 0;
    for (size_t i = 0; i < n; i++) {
        sum += values[i];
        size += fabs(values[i]);
        test.uneven += values[i] != 0;
    }
    if (n == 0 || !isfinite(size))
        return test;
    test.least_p = fmin(1, 2 * ldexp(1, -(int)fmin((double)test.uneven, 1000)));
    if (n > STAT_FLIP_VALUES)
        return test;
    size_t half = n / 2;
    double *sums = malloc((((size_t)1 << half) + ((size_t)1 << (n - half))) * sizeof *sums);
    if (!sums)
        return test;
    size_t a = all_sums(values, half, sums), b = all_sums(values + half, n - half, sums + a);
    // By symmetry the lower tail is as large as the upper one.
    test.p_value = fmin(1, 2 * ldexp(pairs_from(sums, a, sums + a, b, fabs(sum) - TIE * size), -(int)n));
    free(sums);
    return test;
}
