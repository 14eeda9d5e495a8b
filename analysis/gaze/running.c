#include "analysis/gaze/running.h"

#include <math.h>

void gaze_running_add(struct gaze_running *r, double value)
{
    double from_mean = value - r->mean;
    r->n++;
    r->mean += from_mean / (double)r->n;
    r->squares += from_mean * (value - r->mean);
}

void gaze_running_join(struct gaze_running *to, const struct gaze_running *from)
{
    if (from->n == 0)
        return;
    double apart = from->mean - to->mean, share = (double)from->n / (double)(to->n + from->n);
    to->squares += from->squares + apart * apart * (double)to->n * share;
    to->mean += apart * share;
    to->n += from->n;
}

double gaze_running_mean(const struct gaze_running *r)
{
    return r->n ? r->mean : (double)NAN;
}

double gaze_running_sd(const struct gaze_running *r)
{
    return r->n > 1 ? sqrt(r->squares / (double)(r->n - 1)) : (double)NAN;
}
