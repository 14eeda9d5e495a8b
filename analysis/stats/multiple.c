// Holm, S. (1979), "A simple sequentially rejective multiple test procedure", Scandinavian Journal of
// Statistics 6, 65-70: the i-th smallest of m values times m + 1 - i, never less than the one before it, at
// most 1. No sorting: each round takes the smallest that is left, for a study has few tests.
#include "analysis/stats/multiple.h"

#include <math.h>
#include <stdbool.h>

static bool usable(double p)
{
    return p >= 0 && p <= 1;
}

// Whether test a comes after test b in rising order of p, equal ones in the order given.
static bool after(const double *p, size_t a, size_t b)
{
    return p[a] > p[b] || (p[a] == p[b] && a > b);
}

void stat_adjust_holm(const double *p, size_t n, double *out)
{
    size_t tests = 0, last = n;
    for (size_t i = 0; i < n; i++) {
        tests += usable(p[i]);
        out[i] = (double)NAN;
    }
    double reached = 0;
    for (size_t left = tests; left > 0; left--) {
        size_t next = n;
        for (size_t i = 0; i < n; i++)
            if (usable(p[i]) && (last == n || after(p, i, last)) && (next == n || after(p, next, i)))
                next = i;
        reached = fmax(reached, fmin(1, p[next] * (double)left));
        out[next] = reached;
        last = next;
    }
}
