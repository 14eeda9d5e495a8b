#include "analysis/gaze/bins.h"

#include <math.h>
#include <stdlib.h>

bool gaze_bins_init(struct gaze_bins *bins, double width, size_t count)
{
    *bins = (struct gaze_bins){.width = width, .count = count};
    bins->values = calloc(count + 1, sizeof bins->values[0]);
    bins->sums = calloc(count + 1, sizeof bins->sums[0]);
    if (bins->values && bins->sums)
        return true;
    gaze_bins_finish(bins);
    return false;
}

void gaze_bins_finish(struct gaze_bins *bins)
{
    free(bins->values);
    free(bins->sums);
    *bins = (struct gaze_bins){.width = 0};
}

void gaze_bins_add(struct gaze_bins *bins, double value)
{
    if (isnan(value))
        return;
    double place = value / bins->width;
    size_t i = place >= (double)bins->count ? bins->count : place > 0 ? (size_t)place : 0;
    bins->values[i]++;
    bins->sums[i] += value;
    bins->n++;
}

void gaze_bins_join(struct gaze_bins *to, const struct gaze_bins *from)
{
    for (size_t i = 0; i <= to->count && from->n; i++) {
        to->values[i] += from->values[i];
        to->sums[i] += from->sums[i];
    }
    to->n += from->n;
}

double gaze_bins_quantile(const struct gaze_bins *bins, double p)
{
    double below = p * (double)bins->n, passed = 0;
    if (bins->n == 0 || !(p >= 0 && p <= 1))
        return NAN;
    for (size_t i = 0; i < bins->count; i++) {
        double here = (double)bins->values[i];
        if (here > 0 && passed + here >= below)
            return bins->sums[i] / here;
        passed += here;
    }
    return INFINITY;
}

double gaze_bins_mean(const struct gaze_bins *bins, double low, double high, double *out_count)
{
    double n = 0, sum = 0;
    for (size_t i = 0; i < bins->count; i++)
        if (bins->width * (double)i >= low && bins->width * (double)(i + 1) <= high) {
            n += (double)bins->values[i];
            sum += bins->sums[i];
        }
    *out_count = n;
    return n > 0 ? sum / n : (double)NAN;
}

double gaze_bins_unit(const struct gaze_bins *bins, double unit, double most)
{
    double multiples = 0, sum = 0;
    for (size_t i = 0; i < bins->count; i++) {
        double here = (double)bins->values[i], times = bins->sums[i] / (here * unit);
        if (here > 0 && times >= 0.5 && times <= most) {
            multiples += here * round(times);
            sum += bins->sums[i];
        }
    }
    return multiples > 0 ? sum / multiples : (double)NAN;
}

double gaze_bins_fit(const struct gaze_bins *bins, double unit, double most, double *out_count)
{
    double n = 0, sum = 0;
    for (size_t i = 0; i < bins->count; i++) {
        double here = (double)bins->values[i], times = bins->sums[i] / (here * unit);
        if (here > 0 && times <= most) {
            n += here;
            sum += here * cos(2 * M_PI * times);
        }
    }
    *out_count = n;
    return n > 0 ? sum / n : (double)NAN;
}

double gaze_bins_missing(const struct gaze_bins *bins, double interval)
{
    double missing = 0;
    for (size_t i = 0; i < bins->count; i++)
        if (bins->values[i]) {
            double mean = bins->sums[i] / (double)bins->values[i];
            if (mean > 1.5 * interval)
                missing += (double)bins->values[i] * (round(mean / interval) - 1);
        }
    double open = round(bins->sums[bins->count] / interval) - (double)bins->values[bins->count];
    return missing + (bins->values[bins->count] ? fmax(open, 0) : 0);
}
