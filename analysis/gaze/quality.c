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

double gaze_quality_interval(const struct gaze_quality *q)
{
    double median = gaze_bins_quantile(&q->interval, 0.5);
    return gaze_bins_mean(&q->interval, 0.5 * median, 1.5 * median);
}
