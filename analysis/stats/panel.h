// An integral over a stretch in which nothing is sharp.
#ifndef ANALYSIS_STATS_PANEL_H
#define ANALYSIS_STATS_PANEL_H

typedef double (*stat_integrand_fn)(double x, const void *user);

// Gauss and Legendre's 16 points between low and high: exact for polynomials of degree 31.
double stat_panel(stat_integrand_fn integrand, const void *user, double low, double high);

#endif
