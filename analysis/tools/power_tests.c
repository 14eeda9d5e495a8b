// The tests that `fovstats power` plans, and how many people each needs. Of choices it is the test that the
// data ask for (choices.h): exact where nobody has more than one.
#include "analysis/stats/power.h"
#include "analysis/stats/power_anova.h"
#include "analysis/stats/power_equivalence.h"
#include "analysis/stats/power_simulation.h"
#include "analysis/tools/power_plan.h"

#include <math.h>

int64_t power_case_people(const struct power_case *c, int64_t participants)
{
    return c->of ? (2 * participants * c->in + c->of - 1) / (2 * c->of) : participants;
}

int64_t power_case_participants(const struct power_case *c, int64_t people)
{
    if (people < 1 || (c->of && !c->in))
        return 0;
    return c->of ? c->of * (2 * people - 1) / (2 * c->in) + 1 : people;
}

static int64_t choices_of(const struct power_case *c, int64_t people)
{
    int64_t all = 0, part = 0;
    for (size_t i = 0; i < c->count; i++) {
        all += c->choices[i];
        part += (int64_t)i < people % (int64_t)c->count ? c->choices[i] : 0;
    }
    return people / (int64_t)c->count * all + part;
}

int64_t power_case_choices(const struct power_case *c, int64_t participants)
{
    return choices_of(c, power_case_people(c, participants));
}

// The fewest participants who make so many choices, of one each at most; 0 for 0.
static int64_t participants_of(const struct power_case *c, int64_t choices)
{
    int64_t all = choices_of(c, (int64_t)c->count);
    if (choices < 1 || all < 1)
        return 0;
    int64_t rounds = (choices - 1) / all, left = choices - rounds * all;
    size_t last = 0;
    for (; left > 0; last++)
        left -= c->choices[last];
    return power_case_participants(c, rounds * (int64_t)c->count + (int64_t)last);
}

static struct stat_sample_size sizes_of(const struct power_case *c, struct stat_sample_size choices)
{
    return (struct stat_sample_size){participants_of(c, choices.first), participants_of(c, choices.stays)};
}

// People without a choice find nothing.
static double binomial(const struct power_plan *plan, const struct power_case *c, int64_t people)
{
    int64_t n = power_case_choices(c, people);
    return n ? stat_binomial_power(n, 0.5, plan->share, plan->alpha) : 0;
}

static struct stat_sample_size binomial_size(const struct power_plan *plan, const struct power_case *c)
{
    return sizes_of(c, stat_binomial_sample_size(0.5, plan->share, plan->alpha, plan->power));
}

static double equivalence(const struct power_plan *plan, const struct power_case *c, int64_t people)
{
    int64_t n = power_case_choices(c, people);
    return n ? stat_binomial_equivalence_power(n, plan->margin, plan->share, plan->alpha) : 0;
}

static struct stat_sample_size equivalence_size(const struct power_plan *plan, const struct power_case *c)
{
    return sizes_of(c, stat_binomial_equivalence_size(plan->margin, plan->share, plan->alpha, plan->power,
                                                      STAT_SIMULATED_PEOPLE));
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
    return stat_anova_within_power(people, plan->design.cells, c->df, plan->f, plan->alpha);
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
    return !isnan(plan->d) || !isnan(plan->f);
}

// Beyond, the noncentral F leaves its range (power_anova.h) for the largest number of people.
bool power_design_fits(const struct power_plan *plan, const struct power_design *design)
{
    return plan->f * plan->f * (double)design->cells <= 100;
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
    if (!isnan(plan->f))
        return &effect;
    if (!isnan(plan->d))
        return plan->unpaired ? &groups : &differences;
    bool once = true;
    for (size_t i = 0; i < c->count; i++)
        once = once && c->choices[i] <= 1;
    if (isnan(plan->margin))
        return once ? &exact : &flips;
    return once ? &within : &people;
}
