// The maximum of a likelihood over threshold and slope, and its profile over one of them.
#include "analysis/stats/psychometric_problem.h"

#include <math.h>
#include <stdlib.h>

enum {
    CELLS = 40,               // most cells of the grid along one side
    LEVELS = 64,              // most levels by which thresholds are laid
    ATS = CELLS + 2 * LEVELS, // most thresholds of the grid
    STARTS = 12,              // most peaks of the grid that the simplex goes on from
    MOVES = 400,              // of the simplex
    PROFILE = 24,             // cells along the other parameter
    GOLDEN = 44               // sections: 0.618^44 is 6e-10
};

// Of a ridge: a likelihood ratio of 2.7.
static const double nearly_as_good = 1;

static double along(double low, double high, int i, int cells)
{
    return low + (high - low) * i / cells;
}

// --- the simplex ---

struct corner {
    double at, ln_slope; // each as a share of its search range
    struct stat_point point;
};

static void ask(struct stat_problem *p, struct corner *c)
{
    if (!(c->at >= 0 && c->at <= 1 && c->ln_slope >= 0 && c->ln_slope <= 1)) {
        c->point.log_likelihood = -(double)INFINITY;
        return;
    }
    c->point = stat_problem_point(p, p->at_low + c->at * (p->at_high - p->at_low),
                                  p->ln_slope_low + c->ln_slope * (p->ln_slope_high - p->ln_slope_low));
}

static void order(struct corner c[3])
{
    for (int i = 0; i < 2; i++)
        for (int j = 0; j < 2 - i; j++)
            if (c[j].point.log_likelihood < c[j + 1].point.log_likelihood) {
                struct corner kept = c[j];
                c[j] = c[j + 1];
                c[j + 1] = kept;
            }
}

// From the worst corner through the middle of the others.
static struct corner moved(struct stat_problem *p, const struct corner c[3], double by)
{
    struct corner m = {.at = c[2].at + by * ((c[0].at + c[1].at) / 2 - c[2].at),
                       .ln_slope = c[2].ln_slope + by * ((c[0].ln_slope + c[1].ln_slope) / 2 - c[2].ln_slope)};
    ask(p, &m);
    return m;
}

static void shrink(struct stat_problem *p, struct corner c[3])
{
    for (int i = 1; i < 3; i++) {
        c[i].at = (c[0].at + c[i].at) / 2;
        c[i].ln_slope = (c[0].ln_slope + c[i].ln_slope) / 2;
        ask(p, &c[i]);
    }
}

// `size`: of the first simplex along the threshold, `tall` along the slope, as shares of their ranges.
static struct stat_point climb(struct stat_problem *p, struct stat_point start, double size, double tall,
                               double enough)
{
    struct corner c[3];
    double at = (start.at - p->at_low) / (p->at_high - p->at_low),
           ln_slope = (start.ln_slope - p->ln_slope_low) / (p->ln_slope_high - p->ln_slope_low);
    for (int i = 0; i < 3; i++) {
        c[i].at = at + (i == 1 ? (at > 0.5 ? -size : size) : 0);
        c[i].ln_slope = ln_slope + (i == 2 ? (ln_slope > 0.5 ? -tall : tall) : 0);
        ask(p, &c[i]);
    }
    order(c);
    for (int i = 0; i < MOVES; i++) {
        double spread = fmax(fmax(fabs(c[1].at - c[0].at), fabs(c[2].at - c[0].at)),
                             fmax(fabs(c[1].ln_slope - c[0].ln_slope), fabs(c[2].ln_slope - c[0].ln_slope)));
        if (spread < enough)
            break;
        struct corner next = moved(p, c, 2);
        if (next.point.log_likelihood > c[0].point.log_likelihood) {
            struct corner further = moved(p, c, 3);
            c[2] = further.point.log_likelihood > next.point.log_likelihood ? further : next;
        } else if (next.point.log_likelihood > c[1].point.log_likelihood) {
            c[2] = next;
        } else {
            bool outside = next.point.log_likelihood > c[2].point.log_likelihood;
            struct corner nearer = moved(p, c, outside ? 1.5 : 0.5);
            if (nearer.point.log_likelihood > fmax(c[2].point.log_likelihood, next.point.log_likelihood))
                c[2] = nearer;
            else
                shrink(p, c);
        }
        order(c);
    }
    return c[0].point;
}

// --- the grid ---

struct grid {
    double at[ATS + 1]; // thresholds, ascending
    int ats, slopes;    // cells, one less than points
    double log_likelihood[ATS + 1][CELLS + 1];
};

static int ascending(const void *x, const void *y)
{
    double a = *(const double *)x, b = *(const double *)y;
    return (a > b) - (a < b);
}

// Even ones over the search; where levels are asked for also these and what lies midway between neighbours,
// since a steep function has a maximum of its own between any two levels.
// Returns the number of cells.
static int set_thresholds(const struct stat_problem *p, int cells, bool levels, double at[ATS + 1])
{
    int count = 0, shown = (int)p->count < LEVELS ? (int)p->count : LEVELS;
    for (int i = 0; i <= cells; i++)
        at[count++] = along(p->at_low, p->at_high, i, cells);
    for (int i = 0; levels && i < shown; i++) { // of more levels every so many
        size_t level = (size_t)i * p->count / (size_t)shown, next = level + 1;
        at[count++] = p->u[level];
        if (next < p->count && i + 1 < shown)
            at[count++] = (p->u[level] + p->u[next]) / 2;
    }
    qsort(at, (size_t)count, sizeof at[0], ascending);
    return count - 1;
}

// Diagonal neighbours may be higher: a ridge that runs between the points has its top anywhere. Of equal ones,
// as steep functions have, the first along each dimension is the peak.
static bool is_peak(const struct grid *g, int i, int j)
{
    double here = g->log_likelihood[i][j];
    return isfinite(here) && (i == 0 || g->log_likelihood[i - 1][j] < here) &&
           (i == g->ats || g->log_likelihood[i + 1][j] <= here) &&
           (j == 0 || g->log_likelihood[i][j - 1] < here) &&
           (j == g->slopes || g->log_likelihood[i][j + 1] <= here);
}

struct start {
    struct stat_point point;
    double size; // of its cell along the threshold, as a share of the search
};

static struct start start_at(const struct stat_problem *p, const struct grid *g, int i, int j)
{
    double whole = p->at_high - p->at_low, left = i > 0 ? g->at[i] - g->at[i - 1] : whole,
           right = i < g->ats ? g->at[i + 1] - g->at[i] : whole;
    return (struct start){{.at = g->at[i],
                           .ln_slope = along(p->ln_slope_low, p->ln_slope_high, j, g->slopes),
                           .log_likelihood = g->log_likelihood[i][j]},
                          fmax(fmin(left, right), 1e-3 * whole) / whole};
}

static void keep_best(struct start *best, int most, struct start start)
{
    for (int i = 0; i < most; i++)
        if (start.point.log_likelihood > best[i].point.log_likelihood) {
            struct start next = best[i];
            best[i] = start;
            start = next;
        }
}

// The best peaks of both dimensions together; with ridges, also each slope's best threshold where it is nearly
// as good as the best of all, for a long ridge may have two tops that the grid does not tell apart. Returns how
// many.
static int find_starts(struct stat_problem *p, struct grid *g, struct start *best, int most, bool ridges)
{
    int top[CELLS + 1] = {0}, count = 0;
    for (int i = 0; i < most; i++)
        best[i].point.log_likelihood = -(double)INFINITY;
    for (int i = 0; i <= g->ats; i++)
        for (int j = 0; j <= g->slopes; j++) {
            double slope = along(p->ln_slope_low, p->ln_slope_high, j, g->slopes);
            g->log_likelihood[i][j] = stat_problem_point(p, g->at[i], slope).log_likelihood;
            top[j] = g->log_likelihood[i][j] > g->log_likelihood[top[j]][j] ? i : top[j];
        }
    for (int i = 0; i <= g->ats; i++)
        for (int j = 0; j <= g->slopes; j++)
            if (is_peak(g, i, j))
                keep_best(best, most, start_at(p, g, i, j));
    while (count < most && isfinite(best[count].point.log_likelihood))
        count++;
    for (int j = 0; ridges && count > 0 && j <= g->slopes; j++)
        if (!is_peak(g, top[j], j) &&
            g->log_likelihood[top[j]][j] > best[0].point.log_likelihood - nearly_as_good)
            best[count++] = start_at(p, g, top[j], j);
    return count;
}

struct stat_point stat_problem_maximum(struct stat_problem *p, const struct stat_search *search)
{
    struct start starts[STARTS + CELLS + 2];
    struct stat_point best = {.log_likelihood = -(double)INFINITY};
    struct grid *g = malloc(sizeof *g);
    if (!g)
        return best;
    g->slopes = search->fine > CELLS ? CELLS : search->fine;
    g->ats = set_thresholds(p, g->slopes, search->thorough, g->at);
    int most = search->starts < STARTS ? search->starts : STARTS;
    int count = find_starts(p, g, starts, most, search->thorough);
    if (search->start)
        starts[count++] = (struct start){*search->start, 1.0 / g->slopes};
    for (int i = 0; i < count; i++) {
        struct stat_point top = climb(p, starts[i].point, starts[i].size / 2, 0.5 / g->slopes, 1e-5);
        if (top.log_likelihood > best.log_likelihood)
            best = top;
    }
    free(g);
    for (int i = 0; i < 2 && isfinite(best.log_likelihood); i++) // the simplex may have stuck
        best = climb(p, best, i ? 0.001 : 0.02, i ? 0.001 : 0.02, 1e-9);
    return best;
}

// --- profile ---

static double at_profile(struct stat_problem *p, bool slope, double value, double other)
{
    return (slope ? stat_problem_point(p, other, value) : stat_problem_point(p, value, other)).log_likelihood;
}

// The most between a and b by golden sections.
static double section(struct stat_problem *p, bool slope, double value, double a, double b, double whole)
{
    const double golden = 0.61803398874989484820;
    double x = b - golden * (b - a), y = a + golden * (b - a);
    double at_x = at_profile(p, slope, value, x), at_y = at_profile(p, slope, value, y);
    for (int i = 0; i < GOLDEN && fabs(at_x - at_y) + (b - a) * 1e3 / whole > 1e-7; i++) {
        if (at_x > at_y) {
            b = y;
            y = x;
            at_y = at_x;
            at_x = at_profile(p, slope, value, x = b - golden * (b - a));
        } else {
            a = x;
            x = y;
            at_x = at_y;
            at_y = at_profile(p, slope, value, y = a + golden * (b - a));
        }
    }
    return fmax(at_x, at_y);
}

// Every peak of the other parameter that is nearly as good as the best one is followed.
double stat_problem_profile(struct stat_problem *p, bool slope, double value)
{
    double low = slope ? p->at_low : p->ln_slope_low, high = slope ? p->at_high : p->ln_slope_high;
    double best = -(double)INFINITY, other[ATS + 1], at[ATS + 1];
    int cells = slope ? set_thresholds(p, CELLS, true, other) : PROFILE;
    for (int i = 0; i <= cells; i++) {
        other[i] = slope ? other[i] : along(low, high, i, cells);
        at[i] = at_profile(p, slope, value, other[i]);
        best = fmax(best, at[i]);
    }
    double least = best - nearly_as_good;
    for (int i = 0; i <= cells; i++) {
        int before = i > 0 ? i - 1 : 0, after = i < cells ? i + 1 : cells;
        if (at[i] >= least && at[i] >= at[before] && at[i] >= at[after])
            best = fmax(best, section(p, slope, value, other[before], other[after], high - low));
    }
    return best;
}
