// The tests that `fovstats power` plans, and how many people each needs.
#include "analysis/stats/power.h"
#include "analysis/stats/power_anova.h"
#include "analysis/stats/power_equivalence.h"
#include "analysis/stats/power_simulation.h"
#include "analysis/tools/power_plan.h"

#include <math.h>

static double binomial(const struct power_plan *plan, const struct power_case *c, int64_t people)
{
    (void)c;
    return stat_binomial_power(people, 0.5, plan->share, plan->alpha);
}

static struct stat_sample_size binomial_size(const struct power_plan *plan, const struct power_case *c)
{
    (void)c;
    return stat_binomial_sample_size(0.5, plan->share, plan->alpha, plan->power);
}

static double equivalence(const struct power_plan *plan, const struct power_case *c, int64_t people)
{
    (void)c;
    return stat_binomial_equivalence_power(people, plan->margin, plan->share, plan->alpha);
}

static struct stat_sample_size equivalence_size(const struct power_plan *plan, const struct power_case *c)
{
    (void)c;
    return stat_binomial_equivalence_size(plan->margin, plan->share, plan->alpha, plan->power,
                                          STAT_SIMULATED_PEOPLE);
}

static double paired(const struct power_plan *plan, const struct power_case *c, int64_t people)
{
    (void)c;
    return stat_paired_t_power(people, plan->d, plan->alpha);
}

// Everybody counts; of an odd number one group has one more.
static double unpaired(const struct power_plan *plan, const struct power_case *c, int64_t people)
{
    (void)c;
    return stat_two_sample_t_power((people + 1) / 2, people / 2, plan->d, plan->alpha);
}

static double anova(const struct power_plan *plan, const struct power_case *c, int64_t people)
{
    return stat_anova_within_power(people, plan->cells, c->df, plan->f, plan->alpha);
}

// These rise with the number of people. NaN, of too few people, has not the power.
static struct stat_sample_size rising(const struct power_plan *plan, const struct power_case *c)
{
    const struct power_test *test = power_plan_test(plan, c);
    int64_t low = 1, high = STAT_SIMULATED_PEOPLE; // low has not the power
    if (!(test->at(plan, c, high) >= plan->power))
        return (struct stat_sample_size){0, 0};
    while (high - low > 1) {
        int64_t middle = low + (high - low) / 2;
        if (test->at(plan, c, middle) >= plan->power)
            high = middle;
        else
            low = middle;
    }
    return (struct stat_sample_size){high, high};
}

bool power_plan_ratings(const struct power_plan *plan)
{
    return !isnan(plan->d) || plan->factors > 0;
}

const struct power_test *power_plan_test(const struct power_plan *plan, const struct power_case *c)
{
    static const struct power_test exact = {"exact binomial", binomial, binomial_size},
                                   flips = {"simulated sign-flip", NULL, NULL},
                                   within = {"two exact one-sided binomials", equivalence, equivalence_size},
                                   people = {"simulated t-tests of people's shares", NULL, NULL},
                                   differences = {"paired t", paired, rising},
                                   groups = {"t of two groups", unpaired, rising},
                                   effect = {"noncentral F", anova, rising};
    if (plan->factors)
        return &effect;
    if (!isnan(plan->d))
        return plan->unpaired ? &groups : &differences;
    bool once = true;
    for (size_t i = 0; i < c->count; i++)
        once = once && c->choices[i] == 1;
    if (isnan(plan->margin))
        return once ? &exact : &flips;
    return once ? &within : &people;
}
