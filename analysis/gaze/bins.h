// A histogram of values from 0 up, for quantiles of more values than memory should hold.
//
// Values fall into bins of equal width; those at or above the last bin's end are kept together. Each bin keeps
// how many values fell into it and their sum, so that a mean over a range of bins is exact. A quantile is off
// by at most one bin's width. `init` allocates, `finish` frees.
#ifndef ANALYSIS_GAZE_BINS_H
#define ANALYSIS_GAZE_BINS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

struct gaze_bins {
    double width;
    size_t count;    // of bins below the last one, which is open
    int64_t *values; // owned; count + 1
    double *sums;    // owned; count + 1
    int64_t n;
};

bool gaze_bins_init(struct gaze_bins *bins, double width, size_t count); // false where memory ran out
void gaze_bins_finish(struct gaze_bins *bins);                           // a zeroed struct is fine
void gaze_bins_add(struct gaze_bins *bins, double value); // negative counts as 0; NaN is passed over
void gaze_bins_join(struct gaze_bins *to, const struct gaze_bins *from); // of the same width and count

// The mean of the bin in which the share p of all values is reached; NaN for no values, infinity in the open
// bin. p in [0, 1].
double gaze_bins_quantile(const struct gaze_bins *bins, double p);
// Mean of the values in bins that lie wholly in [low, high], and how many they are; NaN where there is none.
double gaze_bins_mean(const struct gaze_bins *bins, double low, double high, double *out_count);
// Of values that are about whole multiples of `unit`, those in bins whose mean is at most `most` times it:
// their sum by the sum of the multiples, which is the unit anew; NaN where there is none.
double gaze_bins_unit(const struct gaze_bins *bins, double unit, double most);
// How well they are multiples: the mean of cos(2 pi value / unit), 1 where each is one, about 0 where they have
// nothing to do with it; NaN where there is none. How many they are.
double gaze_bins_fit(const struct gaze_bins *bins, double unit, double most, double *out_count);
// With values that are times between samples: how many samples are missing in them if one was due every
// `interval`. An interval up to one and a half counts as none.
double gaze_bins_missing(const struct gaze_bins *bins, double interval);

#endif
