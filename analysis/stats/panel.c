#include "analysis/stats/panel.h"

#include <stddef.h>

// Abramowitz & Stegun (1964), table 25.4, n = 16; the other half lies opposite.
static const double node[] = {0.095012509837637440185, 0.281603550779258913230, 0.458016777657227386342,
                              0.617876244402643748447, 0.755404408355003033895, 0.865631202387831743880,
                              0.944575023073232576078, 0.989400934991649932596};
static const double weight[] = {0.189450610455068496285, 0.182603415044923588867, 0.169156519395002538189,
                                0.149595988816576732081, 0.124628971255533872052, 0.095158511682492784810,
                                0.062253523938647892863, 0.027152459411754094852};

double stat_panel(stat_integrand_fn integrand, const void *user, double low, double high)
{
    double sum = 0, half = (high - low) / 2, centre = low + half;
    for (size_t i = 0; i < sizeof node / sizeof node[0]; i++)
        sum +=
            weight[i] * (integrand(centre - half * node[i], user) + integrand(centre + half * node[i], user));
    return sum * half;
}
