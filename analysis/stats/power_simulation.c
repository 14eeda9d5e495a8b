#include "analysis/stats/power_simulation.h"

#include "analysis/stats/draw.h"
#include "analysis/stats/equivalence.h"
#include "analysis/stats/people_equivalence.h"
#include "analysis/stats/signflip.h"

#include <Rmath.h>
#include <math.h>
#include <stdlib.h>

enum { STEPS = 272 }; // of 1/16 SD, from -8.5

static double logistic(double x)
{
    return 1 / (1 + exp(-x));
}

static double mean_preference(double b, double sd)
{
    double sum = 0, mass = 0;
    for (int i = 0; i <= STEPS; i++) {
        double z = -8.5 + i / 16.0, weight = exp(-z * z / 2);
        sum += weight * logistic(b + sd * z);
        mass += weight;
    }
    return sum / mass;
}

double stat_logit_of_mean(double share, double sd)
{
    if (!(share > 0 && share < 1 && sd >= 0 && sd <= 10))
        return (double)NAN;
    double plain = log(share / (1 - share));
    if (sd == 0)
        return plain;
    // A spread draws the mean towards one half by less than the factor sqrt(1 + sd^2).
    double reach = (fabs(plain) + 1) * sqrt(1 + sd * sd), low = -reach, high = reach;
    for (int i = 0; i < 200 && high - low > 1e-14 * reach; i++) {
        double middle = (low + high) / 2;
        if (mean_preference(middle, sd) < share)
            low = middle;
        else
            high = middle;
    }
    return (low + high) / 2;
}

static bool valid(const struct stat_simulation *s, int64_t *most)
{
    *most = 0;
    if (!s->choices_count || !s->people || s->people > STAT_SIMULATED_PEOPLE ||
        !(s->alpha > 0 && s->alpha < (s->margin != 0 ? 0.5 : 1)) || !(s->margin >= 0 && s->margin <= 0.5) ||
        s->studies < 1 || s->studies > STAT_SIMULATED_STUDIES)
        return false;
    for (size_t i = 0; i < s->people; i++) {
        int64_t n = s->choices[i % s->choices_count];
        if (n < 0 || n > STAT_SIMULATED_CHOICES)
            return false;
        *most = n > *most ? n : *most;
    }
    return *most > 0;
}

// One study's answers. Draw 0 of a person is the person, the next ones are the choices.
static void answer(const struct stat_simulation *s, double b, int64_t most, uint64_t study,
                   struct stat_person *people)
{
    for (size_t i = 0; i < s->people; i++) {
        uint64_t first = (uint64_t)i * ((uint64_t)most + 1);
        double p = logistic(b);
        if (s->sd > 0)
            p = logistic(b + s->sd * qnorm(stat_draw(s->seed, study, first), 0, 1, 1, 0));
        people[i] = (struct stat_person){0, s->choices[i % s->choices_count]};
        for (int64_t j = 0; j < people[i].n; j++)
            people[i].k += stat_draw(s->seed, study, first + 1 + (uint64_t)j) < p;
    }
}

static double p_value(const struct stat_simulation *s, int64_t most, const struct stat_person *people)
{
    if (most > 1 && s->margin > 0) {
        // People who all have the same share have no t, and show nothing.
        double p = stat_people_equivalence(people, s->people, 0.5, s->margin, s->alpha).p_value;
        return isnan(p) ? 1 : p;
    }
    if (most > 1)
        return stat_signflip(people, s->people, STAT_TWO_SIDED).p_value;
    struct stat_people sum = stat_people_sum(people, s->people);
    if (s->margin > 0)
        return stat_binomial_equivalence(sum.k, sum.n, 0.5, s->margin, s->alpha).p_value;
    return stat_binomial_p(sum.k, sum.n, 0.5, STAT_TWO_SIDED);
}

struct stat_simulated_power stat_simulate_power(const struct stat_simulation *s)
{
    const double none = (double)NAN;
    struct stat_simulated_power power = {none, {none, none}, 0, none};
    int64_t most;
    double b = stat_logit_of_mean(s->share, s->sd);
    struct stat_person *people = !isnan(b) && valid(s, &most) ? malloc(s->people * sizeof *people) : NULL;
    if (!people)
        return power;
    bool defined = true;
    for (int64_t i = 0; i < s->studies && defined; i++) {
        answer(s, b, most, (uint64_t)i, people);
        double p = p_value(s, most, people);
        defined = !isnan(p);
        power.rejected += p <= s->alpha;
    }
    free(people);
    if (!defined)
        return (struct stat_simulated_power){none, {none, none}, 0, none};
    power.intercept = b;
    power.power = (double)power.rejected / (double)s->studies;
    power.ci = stat_clopper_pearson(power.rejected, s->studies, 0.95, STAT_TWO_SIDED);
    return power;
}
