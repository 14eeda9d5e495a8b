// The numbers of a track: see track.h.
#include "analysis/gaze/track.h"

#include <math.h>

// Up to 100 ms, which is below the slowest tracker's interval; 0.05 ms is a hundredth of that of 200 Hz.
#define INTERVAL_MS 0.05
enum { INTERVAL_BINS = 2000 };

bool gaze_quality_init(struct gaze_quality *quality)
{
    *quality = (struct gaze_quality){.samples = 0};
    return gaze_bins_init(&quality->interval, INTERVAL_MS, INTERVAL_BINS);
}

void gaze_quality_finish(struct gaze_quality *quality)
{
    gaze_bins_finish(&quality->interval);
}

void gaze_quality_join(struct gaze_quality *to, const struct gaze_quality *from)
{
    to->samples += from->samples;
    to->invalid += from->invalid;
    to->disordered += from->disordered;
    gaze_bins_join(&to->interval, &from->interval);
    to->step_xx += from->step_xx;
    to->step_yy += from->step_yy;
    to->steps += from->steps;
    gaze_spread_pool(&to->within, &from->within);
    to->fixations_cut += from->fixations_cut;
    to->saccades_cut += from->saccades_cut;
    gaze_running_join(&to->fixation_ms, &from->fixation_ms);
    gaze_running_join(&to->saccade_ms, &from->saccade_ms);
    gaze_running_join(&to->amplitude_deg, &from->amplitude_deg);
    gaze_running_join(&to->peak_deg_s, &from->peak_deg_s);
}

static double root_mean(const struct gaze_quality *q, double squares)
{
    return q->steps ? sqrt(squares / (double)q->steps) : (double)NAN;
}

double gaze_quality_rms_x(const struct gaze_quality *q)
{
    return root_mean(q, q->step_xx);
}

double gaze_quality_rms_y(const struct gaze_quality *q)
{
    return root_mean(q, q->step_yy);
}

double gaze_quality_rms(const struct gaze_quality *q)
{
    return root_mean(q, q->step_xx + q->step_yy);
}

// Where samples are lost at random, a share s of them, the share 1 - s of the times between those that came is
// one interval long, the next longer ones two, and so on. Up to s = 0.8 the tenth shortest of a hundred is thus
// one of single intervals. The mean of those around it, again about that mean until it stays, is about theirs;
// longer and longer times, by the number of intervals they hold, give it to more digits.
#define SHORT_SHARE 0.1
enum { MEANS = 50 };
// Times that are not multiples of what was found show that it is no interval. Errors of each sample's own time
// with an SD of 10 % of the interval give a fit of 0.67, times without any rhythm 0, and single intervals too
// few to be found (s = 0.95, say) less than that. Some fit by chance: where most times are longer than what is
// looked at, and of fewer than 50 times where fewer than half are single.
#define LEAST_FIT 0.5
enum { FEW = 50, TOO_FEW = 10 };

double gaze_quality_interval(const struct gaze_quality *q)
{
    static const double most[] = {2.5, 4.5, 8.5, 8.5};
    const struct gaze_bins *times = &q->interval;
    double interval = gaze_bins_quantile(times, SHORT_SHARE), before = NAN, single = 0, fitted = 0;
    for (int i = 0; i < MEANS && interval != before; i++) {
        before = interval;
        interval = gaze_bins_mean(times, 0.5 * before, 1.5 * before, &single);
    }
    for (size_t i = 0; i < sizeof most / sizeof most[0]; i++)
        interval = gaze_bins_unit(times, interval, most[i]);
    double fit = gaze_bins_fit(times, interval, 8.5, &fitted), n = (double)times->n;
    bool enough = times->n >= FEW || (times->n >= TOO_FEW && single >= 0.5 * n);
    return enough && fitted >= 0.5 * n && fit >= LEAST_FIT ? interval : (double)NAN;
}
