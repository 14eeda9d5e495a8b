#include "analysis/gaze/spread.h"

#include <math.h>

void gaze_spread_add(struct gaze_spread *s, double x, double y)
{
    s->n++;
    double dx = x - s->mean_x, dy = y - s->mean_y;
    s->mean_x += dx / (double)s->n;
    s->mean_y += dy / (double)s->n;
    s->xx += dx * (x - s->mean_x);
    s->yy += dy * (y - s->mean_y);
    s->xy += dx * (y - s->mean_y);
}

void gaze_spread_join(struct gaze_spread *to, const struct gaze_spread *from)
{
    if (from->n == 0)
        return;
    double n = (double)(to->n + from->n), share = (double)from->n / n;
    double dx = from->mean_x - to->mean_x, dy = from->mean_y - to->mean_y, weight = (double)to->n * share;
    to->xx += from->xx + dx * dx * weight;
    to->yy += from->yy + dy * dy * weight;
    to->xy += from->xy + dx * dy * weight;
    to->mean_x += dx * share;
    to->mean_y += dy * share;
    to->n += from->n;
}

void gaze_spread_pool(struct gaze_spread *to, const struct gaze_spread *from)
{
    if (from->n == 0)
        return;
    to->n += from->n;
    to->groups += from->groups ? from->groups : 1;
    to->xx += from->xx;
    to->yy += from->yy;
    to->xy += from->xy;
}

static double freedom(const struct gaze_spread *s)
{
    return (double)(s->n - (s->groups ? s->groups : 1));
}

static double sd(const struct gaze_spread *s, double squares)
{
    return freedom(s) >= 1 ? sqrt(squares / freedom(s)) : (double)NAN;
}

double gaze_spread_sd_x(const struct gaze_spread *s)
{
    return sd(s, s->xx);
}

double gaze_spread_sd_y(const struct gaze_spread *s)
{
    return sd(s, s->yy);
}

double gaze_spread_sd(const struct gaze_spread *s)
{
    return sd(s, s->xx + s->yy);
}

double gaze_spread_bcea(const struct gaze_spread *s, double share)
{
    if (!(freedom(s) >= 2) || !(share > 0 && share < 1))
        return NAN;
    // s_h s_v sqrt(1 - r^2) is the root of the covariance's determinant; rounding may take it below 0
    double determinant = s->xx * s->yy - s->xy * s->xy;
    return 2 * -log1p(-share) * M_PI * sqrt(fmax(determinant, 0)) / freedom(s);
}
