// Holm, S. (1979), Scandinavian Journal of Statistics 6, 65-70; Hochberg, Y. (1988), Biometrika 75, 800-802;
// Benjamini, Y. & Hochberg, Y. (1995), J. Royal Statistical Society B 57, 289-300; Shaffer, J. P. (1986), J.
// American Statistical Association 81, 826-831: Holm's steps, each with the largest number of hypotheses that
// can still be true given those rejected so far, instead of all that are left.
#include "analysis/stats/multiple.h"

#include <math.h>
#include <stdlib.h>

struct test {
    double p;
    size_t index;
};

static int ascending(const void *x, const void *y)
{
    const struct test *a = x, *b = y;
    if (a->p != b->p)
        return a->p < b->p ? -1 : 1;
    return (a->index > b->index) - (a->index < b->index);
}

// The tests that count, ascending; their number in *count, and `out` all NaN. NULL: none, or no memory.
static struct test *sorted(const double *p, size_t n, double *out, size_t *count)
{
    struct test *tests = n ? malloc(n * sizeof *tests) : NULL;
    *count = 0;
    for (size_t i = 0; i < n; i++) {
        if (tests && p[i] >= 0 && p[i] <= 1)
            tests[(*count)++] = (struct test){p[i], i};
        out[i] = (double)NAN;
    }
    if (tests)
        qsort(tests, *count, sizeof *tests, ascending);
    return tests;
}

// From the smallest up: none may be smaller than one before it.
void stat_adjust_holm(const double *p, size_t n, double *out)
{
    size_t count;
    struct test *tests = sorted(p, n, out, &count);
    double most = 0;
    for (size_t i = 0; i < count; i++) {
        most = fmax(most, (double)(count - i) * tests[i].p);
        out[tests[i].index] = fmin(1, most);
    }
    free(tests);
}

void stat_adjust_exclusive(const double *p, const size_t *set, size_t n, double *out)
{
    size_t count, sets = 0;
    struct test *tests = sorted(p, n, out, &count);
    size_t *left = calloc(n + 1, sizeof *left);
    double most = 0;
    for (size_t i = 0; left && i < count; i++)
        sets += left[set[tests[i].index]]++ == 0;
    for (size_t i = 0; left && i < count; i++) {
        most = fmax(most, (double)sets * tests[i].p);
        out[tests[i].index] = fmin(1, most);
        sets -= --left[set[tests[i].index]] == 0;
    }
    free(left);
    free(tests);
}

// From the largest down: none may be larger than one after it.
void stat_adjust_hochberg(const double *p, size_t n, double *out)
{
    size_t count;
    struct test *tests = sorted(p, n, out, &count);
    double least = 1;
    for (size_t i = count; i-- > 0;) {
        least = fmin(least, (double)(count - i) * tests[i].p);
        out[tests[i].index] = least;
    }
    free(tests);
}

void stat_adjust_bh(const double *p, size_t n, double *out)
{
    size_t count;
    struct test *tests = sorted(p, n, out, &count);
    double least = 1;
    for (size_t i = count; i-- > 0;) {
        least = fmin(least, (double)count / (double)(i + 1) * tests[i].p);
        out[tests[i].index] = least;
    }
    free(tests);
}
