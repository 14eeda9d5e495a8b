// Remarks on planned margins of equality that the planned participants seldom show.
#include "app/fovstudy/check_figures.h"

#include "analysis/stats/power_equivalence.h"

#include <math.h>

enum { MOST_PEOPLE = 5000 }; // beyond which nobody plans

// How many people one answer each needs for the planned margin.
static void remark_write(struct text *remarks, const char *path, uint32_t number, const struct check_part *part,
                         double margin)
{
    struct stat_sample_size size =
        stat_binomial_equivalence_size(margin, 0.5, CHECK_ALPHA, CHECK_POWER, MOST_PEOPLE);
    text_add(remarks,
             "%s: analysis %u plans equality within 50 +- %.4g %%, which %u people show in %.1f %% of studies "
             "where nobody prefers either; ",
             path, number, 100 * margin, part->people,
             floor(1000 * stat_binomial_equivalence_power(part->people, margin, 0.5, CHECK_ALPHA)) / 10);
    if (size.stays)
        text_add(remarks, "%.0f %% takes %d in each test, or a wider margin\n", 100 * CHECK_POWER,
                 (int)size.stays);
    else
        text_add(remarks, "%.0f %% takes more than %d in each test, or a wider margin\n", 100 * CHECK_POWER,
                 MOST_PEOPLE);
}

void check_figures_remarks(struct text *remarks, const char *path, const struct check_analyses *analyses)
{
    for (uint32_t i = 0; i < analyses->count; i++) {
        const struct check_analysis *analysis = &analyses->each[i];
        const struct check_part *least = NULL; // with the smallest power of those that have too little
        double least_power = CHECK_POWER;
        for (uint32_t p = 0; p < analysis->part_count; p++) {
            const struct check_part *part = &analysis->parts[p];
            double power =
                part->margin && part->answers == part->people
                    ? stat_binomial_equivalence_power(part->people, analysis->planned->margin, 0.5, CHECK_ALPHA)
                    : (double)NAN;
            least = power < least_power ? part : least;
            least_power = power < least_power ? power : least_power;
        }
        if (least)
            remark_write(remarks, path, i + 1, least, analysis->planned->margin);
    }
}
