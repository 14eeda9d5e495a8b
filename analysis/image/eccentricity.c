// Geisler, W. S. & Perry, J. S., "A real-time foveated multiresolution system for low-bandwidth video
// communication", SPIE 3299 (1998), 294-305: CT(f, e) = CT0 exp(alpha f (e + e2) / e2). The cut-off frequency
// is where the threshold reaches full contrast, CT = 1:  fc(e) = e2 ln(1 / CT0) / (alpha (e + e2)).
#include "analysis/image/eccentricity.h"

#include <math.h>

static const double ct0 = 1.0 / 64; // minimal contrast threshold, Geisler & Perry 1998
static const double alpha = 0.106;  // spatial frequency decay, same
static const double half_deg = 2.3; // e2, half-resolution eccentricity in degrees, same

double eccentricity_cutoff_cpd(double e_deg)
{
    if (!(e_deg >= 0))
        return (double)NAN;
    return half_deg * log(1 / ct0) / (alpha * (e_deg + half_deg));
}

double eccentricity_weight(double e_deg)
{
    if (!(e_deg >= 0))
        return (double)NAN;
    // The constants of fc cancel but for e2.
    double relative = half_deg / (e_deg + half_deg);
    return relative * relative;
}
