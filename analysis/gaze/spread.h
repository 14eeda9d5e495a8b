// How far directions lie from each other: mean, SD, and the area of the bivariate contour ellipse, in one pass.
//
// Sums are kept about the mean (Welford; Chan, Golub & LeVeque 1983 for joining two), so that no digit of a
// small spread about a large angle is lost. A zeroed struct is empty.
//
// BCEA = 2 k pi s_h s_v sqrt(1 - r^2), k = -ln(1 - P): the ellipse that holds the share P of a bivariate normal
// distribution (Steinman, R. M. 1965, J. Opt. Soc. Am. 55, 1158-1165, in the form of Crossland, M. D. & Rubin,
// G. S. 2002, Optom. Vis. Sci. 79, 735-739). P = 0.682 by convention, the share within one SD of a normal
// distribution in one dimension.
#ifndef ANALYSIS_GAZE_SPREAD_H
#define ANALYSIS_GAZE_SPREAD_H

#include <stddef.h>
#include <stdint.h>

#define GAZE_BCEA_SHARE 0.682

struct gaze_spread {
    int64_t n;
    int64_t groups; // joined by gaze_spread_pool(); 0: one group
    double mean_x, mean_y;
    double xx, yy, xy; // sums of squares and products about the mean, or about each group's own
};

void gaze_spread_add(struct gaze_spread *spread, double x, double y);
// All values about one common mean.
void gaze_spread_join(struct gaze_spread *to, const struct gaze_spread *from);
// Values about the mean of their group: the spread within groups. `to` holds groups only; means are not kept.
void gaze_spread_pool(struct gaze_spread *to, const struct gaze_spread *from);

// NaN with fewer than one degree of freedom (n less the number of groups).
double gaze_spread_sd_x(const struct gaze_spread *spread);
double gaze_spread_sd_y(const struct gaze_spread *spread);
double gaze_spread_sd(const struct gaze_spread *spread); // sqrt(sd_x^2 + sd_y^2)
// In square units; share in (0, 1). NaN with fewer than two degrees of freedom, where an ellipse is a line.
double gaze_spread_bcea(const struct gaze_spread *spread, double share);

#endif
