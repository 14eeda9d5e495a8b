#include "analysis/stats/psychometric.h"

#include <Rmath.h>
#include <math.h>
#include <string.h>

static const double ln2 = 0.69314718055994530942, root_2pi = 2.50662827463100050242;

static const char *const names[STAT_FAMILIES] = {"logistic", "weibull", "normal", "gumbel"};

const char *stat_family_name(enum stat_family family)
{
    return names[family];
}

bool stat_family_find(const char *name, enum stat_family *out)
{
    for (int i = 0; i < STAT_FAMILIES; i++)
        if (strcmp(names[i], name) == 0) {
            *out = (enum stat_family)i;
            return true;
        }
    return false;
}

bool stat_family_logarithmic(enum stat_family family)
{
    return family == STAT_WEIBULL;
}

struct stat_tails stat_family_tails(enum stat_family family, double z)
{
    if (family == STAT_LOGISTIC) {
        double e = exp(-fabs(4 * z)), large = 1 / (1 + e), small = e / (1 + e);
        return z >= 0 ? (struct stat_tails){large, small} : (struct stat_tails){small, large};
    }
    if (family == STAT_NORMAL) {
        double x = z * root_2pi / sqrt(2);
        return (struct stat_tails){0.5 * erfc(-x), 0.5 * erfc(x)};
    }
    double t = ln2 * exp(2 * z / ln2);
    return (struct stat_tails){-expm1(-t), exp(-t)};
}

double stat_family_quantile(enum stat_family family, double p)
{
    if (!(p > 0 && p < 1))
        return (double)NAN;
    if (family == STAT_LOGISTIC)
        return (log(p) - log1p(-p)) / 4;
    if (family == STAT_NORMAL)
        return qnorm(p, 0, 1, true, false) / root_2pi;
    return log(-log1p(-p) / ln2) * ln2 / 2;
}

static bool valid(const struct stat_psychometric *f)
{
    bool logarithmic = f->logarithmic || stat_family_logarithmic(f->family);
    return isfinite(f->threshold) && (!logarithmic || f->threshold > 0) && f->slope > 0 && isfinite(f->slope) &&
           f->guess >= 0 && f->lapse >= 0 && f->guess + f->lapse < 1;
}

double stat_psychometric(const struct stat_psychometric *f, double x)
{
    bool logarithmic = f->logarithmic || stat_family_logarithmic(f->family);
    if (!valid(f) || !isfinite(x) || (logarithmic && !(x > 0)))
        return (double)NAN;
    double distance = logarithmic ? log(x) - log(f->threshold) : x - f->threshold;
    struct stat_tails t = stat_family_tails(f->family, (f->falling ? -f->slope : f->slope) * distance);
    return f->guess * t.upper + (1 - f->lapse) * t.lower;
}

double stat_psychometric_level(const struct stat_psychometric *f, double p)
{
    bool logarithmic = f->logarithmic || stat_family_logarithmic(f->family);
    if (!valid(f))
        return (double)NAN;
    double z = stat_family_quantile(f->family, (p - f->guess) / (1 - f->guess - f->lapse));
    double distance = (f->falling ? -z : z) / f->slope;
    return logarithmic ? f->threshold * exp(distance) : f->threshold + distance;
}
