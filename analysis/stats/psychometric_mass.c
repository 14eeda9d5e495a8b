// First the mode, by Hooke and Jeeves' pattern search (1961, Journal of the ACM 8, 212-229); from how the
// density falls along each axis there, first ends; then coarse sums, after each of which an end that still
// holds mass goes out and one that holds none comes in. Starting at the mode and not at the priors' ends, no
// posterior is so narrow that it falls between the points.
#include "analysis/stats/psychometric_mass.h"

#include <math.h>
#include <string.h>

enum {
    SWEEPS = 300,
    DOUBLINGS = 24,
    ROUNDS = 10,
    LOOK = 13,
    LOOK_ROOT = 8,
    FEWEST = 21,
    FEWEST_ROOT = 12,
    FEWEST_ETA = 16
};

// How far below its maximum a marginal's density still counts as mass: e^-10 is 5e-5, and the ends are laid
// where the density is lower.
static const double mass_ln = 10;
// First ends, in standard deviations along the axis; spacing of the final points, in the same.
static const double first_ends = 4, spacing = 1.25;

// --- the mode ---

struct search {
    struct stat_problem *problem;
    const struct stat_axis *axes; // as wide as the priors
    double point[STAT_GRID_AXES], step[STAT_GRID_AXES], ln_density;
};

static bool try_point(struct search *s, const double point[STAT_GRID_AXES])
{
    double there = stat_posterior_ln_density(s->problem, s->axes, point);
    if (!(there > s->ln_density))
        return false;
    memcpy(s->point, point, sizeof s->point);
    s->ln_density = there;
    return true;
}

// One step along each axis; shortens the steps that lead nowhere. False where all are short.
static bool explore(struct search *s)
{
    bool far = false;
    for (int i = 0; i < STAT_GRID_AXES; i++) {
        double point[STAT_GRID_AXES], whole = s->axes[i].high - s->axes[i].low;
        if (s->axes[i].points == 1)
            continue;
        memcpy(point, s->point, sizeof point);
        point[i] += s->step[i];
        bool better = try_point(s, point);
        if (!better) {
            point[i] = s->point[i] - s->step[i];
            better = try_point(s, point);
            s->step[i] = better ? -s->step[i] : s->step[i] / 2;
        }
        far = far || fabs(s->step[i]) > 1e-5 * whole;
    }
    return far;
}

static void climb(struct search *s)
{
    for (int i = 0; i < STAT_GRID_AXES; i++)
        s->step[i] = (s->axes[i].high - s->axes[i].low) / 16;
    for (int sweep = 0; sweep < SWEEPS; sweep++) {
        double before[STAT_GRID_AXES], onward[STAT_GRID_AXES];
        memcpy(before, s->point, sizeof before);
        if (!explore(s))
            return;
        for (int times = 1; times <= 8; times *= 2) { // on in the same direction while that is better
            for (int i = 0; i < STAT_GRID_AXES; i++)
                onward[i] = s->point[i] + times * (s->point[i] - before[i]);
            memcpy(before, s->point, sizeof before);
            if (!try_point(s, onward))
                break;
        }
    }
}

static void start_at(struct search *s, const double start[STAT_GRID_AXES])
{
    for (int i = 0; i < STAT_GRID_AXES; i++) {
        double low = s->axes[i].low, high = s->axes[i].high, margin = (high - low) / 50;
        s->point[i] = s->axes[i].points == 1 ? low : fmin(fmax(start[i], low + margin), high - margin);
    }
    s->ln_density = stat_posterior_ln_density(s->problem, s->axes, s->point);
    climb(s);
}

// From the likelihood's maximum, and from widths and overdispersions that it may not see.
static void find_mode(struct search *s)
{
    struct stat_problem *p = s->problem;
    struct stat_point best = stat_problem_maximum(p, &(struct stat_search){.fine = 16, .starts = 4});
    double span = stat_family_quantile(p->desc.family, 0.95) - stat_family_quantile(p->desc.family, 0.05);
    const double starts[][STAT_GRID_AXES] = {
        {best.at, log(span) - best.ln_slope, cbrt(2 * best.guess), cbrt(2 * best.lapse), 0.3},
        {best.at, log(p->range), 0.4, 0.4, 0.6},
        {p->u[0] + p->range / 2, log(p->range / 2), 0.5, 0.5, 0.4}};
    struct search top = {.ln_density = -(double)INFINITY};
    for (size_t i = 0; i < sizeof starts / sizeof starts[0]; i++) {
        start_at(s, starts[i]);
        if (s->ln_density > top.ln_density)
            top = *s;
    }
    *s = top;
}

// The standard deviation along one axis of a bell that falls off as the density does around the mode.
static double deviation(const struct search *s, int axis)
{
    double whole = s->axes[axis].high - s->axes[axis].low, step = whole * ldexp(1, -DOUBLINGS);
    for (int i = 0; i < DOUBLINGS; i++, step *= 2) {
        double point[STAT_GRID_AXES], up, down;
        memcpy(point, s->point, sizeof point);
        point[axis] = s->point[axis] + step;
        up = s->ln_density - stat_posterior_ln_density(s->problem, s->axes, point);
        point[axis] = s->point[axis] - step;
        down = s->ln_density - stat_posterior_ln_density(s->problem, s->axes, point);
        if (fmax(up, down) > 0.5) // half a unit is one standard deviation
            return step / sqrt(fmin(2 * fmax(up, down), 4));
    }
    return whole / 4;
}

// --- ends ---

size_t stat_mass_points(const struct stat_axis *axis, int which, double step)
{
    double steps = ceil((axis->high - axis->low) / step);
    size_t fewest = which < STAT_GRID_GUESS ? FEWEST : which < STAT_GRID_ETA ? FEWEST_ROOT : FEWEST_ETA;
    size_t points = steps < STAT_GRID_MOST ? (size_t)steps + 1 : STAT_GRID_MOST;
    points = points < fewest ? fewest : points;
    if (which < STAT_GRID_GUESS) // 4 m + 1
        return points + 2 >= STAT_GRID_MOST ? STAT_GRID_MOST - 3 : (points + 2) / 4 * 4 + 1;
    return which == STAT_GRID_ETA ? (points + 3) / 4 * 4 : points;
}

// Moves one axis' ends to where its marginal has its mass; true where an end went out, or far in.
static bool move_ends(struct stat_grid *g, int which, const struct stat_axis *widest)
{
    struct stat_axis *a = &g->axis[which];
    const double *m = g->marginal[which];
    double most = 0, low = a->low, high = a->high, whole = high - low;
    size_t first = a->points, last = 0;
    for (size_t i = 0; i < a->points; i++)
        most = fmax(most, m[i]);
    for (size_t i = 0; i < a->points; i++)
        if (m[i] > most * exp(-mass_ln)) {
            first = first == a->points ? i : first;
            last = i;
        }
    if (first == a->points)
        return false;
    double from = first == 0 ? low - 0.4 * whole : stat_axis_at(a, first - 1),
           to = last + 1 == a->points ? high + 0.4 * whole : stat_axis_at(a, last + 1);
    a->low = fmax(from, widest->low);
    a->high = fmin(to, widest->high);
    return a->low < low || a->high > high || a->high - a->low < 0.7 * whole;
}

bool stat_mass_find(struct stat_problem *p, struct stat_grid *g, double *out_top)
{
    struct stat_axis widest[STAT_GRID_AXES];
    double sd[STAT_GRID_AXES];
    stat_posterior_axes(p, widest);
    struct search s = {.problem = p, .axes = widest};
    find_mode(&s);
    *out_top = s.ln_density;
    if (!isfinite(s.ln_density))
        return false;
    for (int i = 0; i < STAT_GRID_AXES; i++) {
        g->axis[i] = widest[i];
        if (widest[i].points == 1)
            continue;
        sd[i] = deviation(&s, i);
        g->axis[i].low = fmax(widest[i].low, s.point[i] - first_ends * sd[i]);
        g->axis[i].high = fmin(widest[i].high, s.point[i] + first_ends * sd[i]);
        g->axis[i].points = i < STAT_GRID_GUESS ? LOOK : LOOK_ROOT;
    }
    bool moved = true;
    for (int round = 0; moved && round < ROUNDS; round++) {
        if (!stat_grid_sum(p, g, *out_top))
            return false;
        moved = false;
        for (int i = 0; i < STAT_GRID_AXES; i++)
            if (g->axis[i].points > 1)
                moved |= move_ends(g, i, &widest[i]);
    }
    for (int i = 0; i < STAT_GRID_AXES; i++)
        if (g->axis[i].points > 1)
            g->axis[i].points = stat_mass_points(&g->axis[i], i, spacing * sd[i]);
    return true;
}
