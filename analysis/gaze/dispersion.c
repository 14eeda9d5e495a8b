// I-DT: see events.h.
#include "analysis/gaze/events_private.h"

#include <math.h>

struct box {
    double low[2], high[2];
};

static struct box widened(struct box box, const struct gaze_point *p)
{
    const double at[2] = {p->x_deg, p->y_deg};
    for (int i = 0; i < 2; i++) {
        box.low[i] = fmin(box.low[i], at[i]);
        box.high[i] = fmax(box.high[i], at[i]);
    }
    return box;
}

static double dispersion(const struct box *box)
{
    return box->high[0] - box->low[0] + box->high[1] - box->low[1];
}

static bool long_enough(const struct gaze_search *s, size_t first, size_t last)
{
    return (double)(s->points[last].time_ns - s->points[first].time_ns) >= s->rules->min_fixation_ms * 1e6;
}

void gaze_search_dispersion(const struct gaze_search *s)
{
    const struct box nothing = {{INFINITY, INFINITY}, {-INFINITY, -INFINITY}};
    for (size_t first = 0; first < s->count;) {
        struct box box = widened(nothing, &s->points[first]);
        size_t last = first;
        while (last + 1 < s->count) {
            struct box wider = widened(box, &s->points[last + 1]);
            if (dispersion(&wider) > s->rules->dispersion_deg)
                break;
            box = wider;
            last++;
        }
        if (last > first && long_enough(s, first, last)) {
            gaze_found(s, GAZE_FIXATION, first, last);
            first = last + 1;
        } else {
            first++;
        }
    }
}
