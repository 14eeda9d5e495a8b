// Intervals within people: each person's values less that person's mean, Cousineau, D. (2005), Tutorials in
// Quantitative Methods for Psychology 1, 42-45, with the variance made up for by columns / (columns - 1),
// Morey, R. D. (2008), same journal 4, 61-64.
#include "analysis/stats/anova.h"

#include "analysis/stats/moments.h"

#include <Rmath.h>
#include <math.h>
#include <stdlib.h>

bool stat_within_intervals(const double *values, size_t people, size_t columns, double conf, double *mean,
                           double *half_width)
{
    double *column = people ? malloc(2 * people * sizeof *column) : NULL,
           *level = column ? column + people : NULL;
    for (size_t i = 0; column && i < people; i++)
        level[i] = stat_moments_about(values + i * columns, columns, values[0]).mean;
    for (size_t c = 0; c < columns; c++) {
        mean[c] = half_width[c] = (double)NAN;
        for (size_t i = 0; column && i < people; i++)
            column[i] = values[i * columns + c];
        if (!column)
            continue;
        mean[c] = stat_moments(column, people).mean;
        if (people < 2 || columns < 2 || !(conf > 0 && conf < 1))
            continue;
        for (size_t i = 0; i < people; i++)
            column[i] = (column[i] - values[0]) - level[i];
        half_width[c] = stat_moments(column, people).std_error * sqrt((double)columns / ((double)columns - 1)) *
                        qt((1 - conf) / 2, (double)people - 1, false, false);
    }
    free(column);
    return column != NULL;
}
