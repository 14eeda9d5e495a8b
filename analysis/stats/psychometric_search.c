// The maximum of a likelihood over threshold and slope, and its profile over one of them.
#include "analysis/stats/psychometric_problem.h"

#include <math.h>

enum {
    CELLS = 40,   // most cells of the grid along one side
    STARTS = 4,   // cells that the simplex goes on from
    MOVES = 400,  // of the simplex
    PROFILE = 24, // cells along the other parameter
    GOLDEN = 44   // sections: 0.618^44 is 6e-10
};

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

static struct stat_point climb(struct stat_problem *p, struct stat_point start, double size)
{
    struct corner c[3];
    double at = (start.at - p->at_low) / (p->at_high - p->at_low),
           ln_slope = (start.ln_slope - p->ln_slope_low) / (p->ln_slope_high - p->ln_slope_low);
    for (int i = 0; i < 3; i++) {
        c[i].at = at + (i == 1 ? (at > 0.5 ? -size : size) : 0);
        c[i].ln_slope = ln_slope + (i == 2 ? (ln_slope > 0.5 ? -size : size) : 0);
        ask(p, &c[i]);
    }
    order(c);
    for (int i = 0; i < MOVES; i++) {
        double spread = fmax(fmax(fabs(c[1].at - c[0].at), fabs(c[2].at - c[0].at)),
                             fmax(fabs(c[1].ln_slope - c[0].ln_slope), fabs(c[2].ln_slope - c[0].ln_slope)));
        if (spread < 1e-9)
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

static void keep_best(struct stat_point best[STARTS], struct stat_point point)
{
    for (int i = 0; i < STARTS; i++)
        if (point.log_likelihood > best[i].log_likelihood) {
            struct stat_point next = best[i];
            best[i] = point;
            point = next;
        }
}

// The best cell of each column of thresholds, the best columns of all: starts that are apart.
static int grid(struct stat_problem *p, int fine, struct stat_point best[STARTS])
{
    struct stat_point column[CELLS + 1];
    for (int i = 0; i < STARTS; i++)
        best[i] = (struct stat_point){.log_likelihood = -(double)INFINITY};
    for (int i = 0; i <= fine; i++) {
        column[i].log_likelihood = -(double)INFINITY;
        for (int j = 0; j <= fine; j++) {
            struct stat_point point = stat_problem_point(p, along(p->at_low, p->at_high, i, fine),
                                                         along(p->ln_slope_low, p->ln_slope_high, j, fine));
            if (point.log_likelihood > column[i].log_likelihood)
                column[i] = point;
        }
    }
    for (int i = 0; i <= fine; i++) {
        double here = column[i].log_likelihood;
        bool peak = (i == 0 || here >= column[i - 1].log_likelihood) &&
                    (i == fine || here >= column[i + 1].log_likelihood);
        if (peak && isfinite(here))
            keep_best(best, column[i]);
    }
    int count = 0;
    while (count < STARTS && isfinite(best[count].log_likelihood))
        count++;
    return count;
}

struct stat_point stat_problem_maximum(struct stat_problem *p, int fine, const struct stat_point *start)
{
    struct stat_point starts[STARTS + 1];
    fine = fine > CELLS ? CELLS : fine;
    int count = grid(p, fine, starts);
    if (start)
        starts[count++] = *start;
    struct stat_point best = {.log_likelihood = -(double)INFINITY};
    for (int i = 0; i < count; i++) {
        struct stat_point top = climb(p, starts[i], 0.5 / fine);
        if (top.log_likelihood > best.log_likelihood)
            best = top;
    }
    return best.log_likelihood > -(double)INFINITY ? climb(p, best, 0.02) : best; // the simplex may have stuck
}

// --- profile ---

static double at_profile(struct stat_problem *p, bool slope, double value, double other)
{
    return (slope ? stat_problem_point(p, other, value) : stat_problem_point(p, value, other)).log_likelihood;
}

double stat_problem_profile(struct stat_problem *p, bool slope, double value)
{
    const double golden = 0.61803398874989484820;
    double low = slope ? p->at_low : p->ln_slope_low, high = slope ? p->at_high : p->ln_slope_high;
    int cells = slope ? 2 * PROFILE : PROFILE, top = 0;
    double best = -(double)INFINITY;
    for (int i = 0; i <= cells; i++) {
        double at = at_profile(p, slope, value, along(low, high, i, cells));
        if (at > best) {
            best = at;
            top = i;
        }
    }
    double a = along(low, high, top > 0 ? top - 1 : 0, cells),
           b = along(low, high, top < cells ? top + 1 : cells, cells);
    double x = b - golden * (b - a), y = a + golden * (b - a);
    double at_x = at_profile(p, slope, value, x), at_y = at_profile(p, slope, value, y);
    for (int i = 0; i < GOLDEN && fabs(at_x - at_y) + (b - a) * 1e3 / (high - low) > 1e-7; i++) {
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
    return fmax(best, fmax(at_x, at_y));
}
