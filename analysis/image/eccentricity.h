// How much detail an eye can use away from its gaze: the contrast-threshold model of Geisler & Perry 1998.
#ifndef ANALYSIS_IMAGE_ECCENTRICITY_H
#define ANALYSIS_IMAGE_ECCENTRICITY_H

// Highest visible frequency in cycles per degree at an eccentricity of e >= 0 degrees: 39.23 at 0, 7.34 at 10.
// NaN for a negative or missing e.
double eccentricity_cutoff_cpd(double e_deg);

// (fc(e) / fc(0))^2, in (0, 1]: how much a squared error at e counts in the weighted measures of error.h.
double eccentricity_weight(double e_deg);

#endif
