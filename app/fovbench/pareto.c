#include "app/fovbench/pareto.h"

#include <math.h>
#include <stdlib.h>

struct point {
    double first, second;
    size_t index;
};

static int by_costs(const void *a, const void *b)
{
    const struct point *p = a, *q = b;
    if (p->first != q->first)
        return p->first < q->first ? -1 : 1;
    return (p->second > q->second) - (p->second < q->second);
}

// By ascending first cost, a point is beaten where an earlier one has a second cost as small; of those with the
// same first cost only the smallest second cost counts.
bool pareto_front(const double *first, const double *second, size_t count, bool *out_on_front)
{
    struct point *points = malloc((count + 1) * sizeof *points);
    size_t used = 0;
    if (!points)
        return false;
    for (size_t i = 0; i < count; i++) {
        out_on_front[i] = false;
        if (!isnan(first[i]) && !isnan(second[i]))
            points[used++] = (struct point){first[i], second[i], i};
    }
    qsort(points, used, sizeof *points, by_costs);
    double best = (double)INFINITY;
    bool any = false;
    for (size_t i = 0; i < used;) {
        const struct point lead = points[i];
        const bool on = !any || lead.second < best;
        for (; i < used && points[i].first == lead.first; i++)
            out_on_front[points[i].index] = on && points[i].second == lead.second;
        best = on ? lead.second : best;
        any = true;
    }
    free(points);
    return true;
}
