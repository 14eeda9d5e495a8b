// Mean and standard deviation in two passes over the values less their first one, with the correction for the
// rounding of the mean: Chan, T. F., Golub, G. H. & LeVeque, R. J. (1983), The American Statistician 37,
// 242-247, eq. 1.7. A sum of squares would lose all digits of values such as 1e9 + 0.001.
#include "analysis/stats/moments.h"

#include <float.h>
#include <math.h>

// Values reached by adding steps, and means, are apart by what their sums were rounded by: 0.1 + 0.2 is not
// 0.3. Values no farther apart than ten rounding errors have no spread, as t.test of R takes data for constant.
static const double rounding = 10 * DBL_EPSILON;

// How far any value lies from the first one.
static double apart(const double *values, size_t n)
{
    double most = 0;
    for (size_t i = 0; i < n; i++)
        most = fmax(most, fabs(values[i] - values[0]));
    return most;
}

struct stat_moments stat_moments(const double *values, size_t n)
{
    return stat_moments_about(values, n, 0);
}

struct stat_moments stat_moments_about(const double *values, size_t n, double origin)
{
    struct stat_moments m = {n, (double)NAN, (double)NAN, (double)NAN};
    if (n == 0)
        return m;
    double count = (double)n, sum = 0, square = 0, rest = 0;
    for (size_t i = 0; i < n; i++)
        sum += values[i] - values[0];
    double shift = sum / count;
    if (!isfinite(shift)) // also where a value is not finite
        return m;
    m.mean = (values[0] - origin) + shift;
    if (n < 2)
        return m;
    for (size_t i = 0; i < n; i++) {
        double d = (values[i] - values[0]) - shift;
        square += d * d;
        rest += d;
    }
    if (apart(values, n) <= rounding * fabs(values[0]))
        square = rest = 0;
    double variance = (square - rest * rest / count) / (count - 1);
    m.sd = sqrt(variance > 0 ? variance : 0);
    m.std_error = m.sd / sqrt(count);
    return m;
}
