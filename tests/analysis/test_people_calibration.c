// How often the tests of several answers per person are wrong, over simulated studies with one fixed seed:
// people with preferences of their own (normal on the logit scale), answers independent given them. What a test
// must keep is said of the mean preference over people, which is not the middle person's where people differ.
// 10,000 studies a cell where FOVSTUDY_SOAK is set, with the limits as they stand; 200 otherwise, with the
// limits four binomial standard errors wider.
#include "analysis/stats/binomial.h"
#include "analysis/stats/mixed_logit.h"
#include "analysis/stats/people.h"
#include "analysis/stats/signflip.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

#include <cmocka.h>

enum { MOST_PEOPLE = 24, FULL = 10000, QUICK = 200 };

struct design {
    int people, answers;
};

static const struct design designs[] = {{20, 20}, {24, 40}, {21, 9}, {22, 12}};
static const double sds[] = {0, 0.5, 1}, means[] = {0.5, 0.625, 0.75};

static int studies(void)
{
    return getenv("FOVSTUDY_SOAK") ? FULL : QUICK;
}

// Steele, G. L., Lea, D. & Flood, C. H. (2014), SplitMix64; 53 bits in (0, 1).
static double uniform(uint64_t *state)
{
    uint64_t z = (*state += UINT64_C(0x9e3779b97f4a7c15));
    z = (z ^ (z >> 30)) * UINT64_C(0xbf58476d1ce4e5b9);
    z = (z ^ (z >> 27)) * UINT64_C(0x94d049bb133111eb);
    return ((double)((z ^ (z >> 31)) >> 11) + 0.5) / 9007199254740992.0;
}

static double normal(uint64_t *state) // Box & Muller (1958)
{
    double radius = sqrt(-2 * log(uniform(state)));
    return radius * cos(6.283185307179586 * uniform(state));
}

static double mean_preference(double middle, double sd)
{
    double sum = 0, mass = 0;
    for (int i = -160; i <= 160; i++) {
        double b = i * 0.05, w = exp(-b * b / 2);
        sum += w / (1 + exp(-(middle + sd * b)));
        mass += w;
    }
    return sum / mass;
}

// The middle person's logit where people's preferences have this mean.
static double middle_for(double mean, double sd)
{
    double low = -20, high = 20;
    for (int i = 0; i < 100; i++) {
        double at = (low + high) / 2;
        if (mean_preference(at, sd) < mean)
            low = at;
        else
            high = at;
    }
    return (low + high) / 2;
}

static void draw(struct stat_person *people, struct design d, double middle, double sd, uint64_t *state)
{
    for (int i = 0; i < d.people; i++) {
        double preference = 1 / (1 + exp(-(middle + sd * normal(state))));
        people[i] = (struct stat_person){0, d.answers};
        for (int j = 0; j < d.answers; j++)
            people[i].k += uniform(state) < preference;
    }
}

// A share of the studies against its limits; a negative limit is none.
static void keeps(const char *what, int count, int of, double least, double most)
{
    double share = (double)count / of, wider = of < FULL ? 4 : 0;
    double low = least - wider * sqrt(least * (1 - least) / of),
           high = most + wider * sqrt(most * (1 - most) / of);
    if ((least >= 0 && share < low) || (most >= 0 && share > high))
        fail_msg("%s: %.2f %%, but must be %g to %g %%", what, 100 * share, 100 * least, 100 * most);
}

struct tally {
    int flip, t, missed, mixed, not_fitted, population_missed, pooled;
};

static struct tally simulate(struct design d, double mean, double sd, uint64_t *state)
{
    struct tally tally = {0};
    struct stat_person people[MOST_PEOPLE];
    double middle = middle_for(mean, sd);
    for (int i = 0; i < studies(); i++) {
        draw(people, d, middle, sd, state);
        size_t count = (size_t)d.people;
        struct stat_ttest t = stat_people_t(people, count, &(struct stat_ttest_options){.mean = mean});
        tally.missed += !(t.ci_low <= mean && mean <= t.ci_high);
        tally.t += t.p_value <= 0.05;
        struct stat_people sum = stat_people_sum(people, count);
        struct stat_mixed_logit fit = stat_mixed_logit(people, count, NULL);
        tally.not_fitted += isnan(fit.p_value);
        tally.population_missed += !(fit.population_ci.low <= mean && mean <= fit.population_ci.high);
        if (mean != 0.5)
            continue;
        tally.flip += stat_signflip(people, count, STAT_TWO_SIDED).p_value <= 0.05;
        tally.mixed += fit.p_value <= 0.05;
        tally.pooled += stat_binomial_p(sum.k, sum.n, 0.5, STAT_TWO_SIDED) <= 0.05;
    }
    return tally;
}

static double percent(int count)
{
    return 100.0 * count / studies();
}

static void several_answers_keep_their_level(void **state)
{
    (void)state;
    uint64_t random = 20261125;
    print_message(
        "%d studies a cell; false positives at 0.05 and coverage at 95 %%, in percent\n"
        "people x answers   SD   mean  sign-flip     t  t covers  mixed  its mean covers  pooled binomial\n",
        studies());
    for (size_t i = 0; i < sizeof designs / sizeof designs[0]; i++)
        for (size_t j = 0; j < sizeof sds / sizeof sds[0]; j++)
            for (size_t k = 0; k < sizeof means / sizeof means[0]; k++) {
                struct tally y = simulate(designs[i], means[k], sds[j], &random);
                int of = studies();
                print_message("%6d x %-7d %5.1f  %.3f  ", designs[i].people, designs[i].answers, sds[j],
                              means[k]);
                if (means[k] == 0.5)
                    print_message("%9.2f %5.2f  %8.2f  %5.2f  %15.2f  %15.2f\n", percent(y.flip), percent(y.t),
                                  percent(of - y.missed), percent(y.mixed), percent(of - y.population_missed),
                                  percent(y.pooled));
                else
                    print_message("%9s %5.2f  %8.2f  %5s  %15.2f\n", "", percent(y.t), percent(of - y.missed),
                                  "", percent(of - y.population_missed));
                keeps("t", y.t, of, 0.04, 0.065);
                keeps("t covers", of - y.missed, of, 0.935, 0.965);
                assert_int_equal(y.not_fitted, 0);
                if (means[k] == 0.5) {
                    keeps("sign-flip", y.flip, of, -1, 0.055);
                    keeps("mixed model", y.mixed, of, -1, 0.065);
                }
            }
}

static void one_answer_keeps_its_level(void **state)
{
    (void)state;
    uint64_t random = 20261126;
    const struct design d = {22, 1};
    for (size_t j = 0; j < sizeof sds / sizeof sds[0]; j++)
        for (size_t k = 0; k < sizeof means / sizeof means[0]; k++) {
            struct stat_person people[MOST_PEOPLE];
            int rejected = 0, covered = 0, of = studies();
            double middle = middle_for(means[k], sds[j]);
            for (int i = 0; i < of; i++) {
                draw(people, d, middle, sds[j], &random);
                struct stat_people sum = stat_people_sum(people, (size_t)d.people);
                struct stat_interval ci = stat_clopper_pearson(sum.k, sum.n, 0.95, STAT_TWO_SIDED);
                rejected += stat_binomial_p(sum.k, sum.n, means[k], STAT_TWO_SIDED) <= 0.05;
                covered += ci.low <= means[k] && means[k] <= ci.high;
            }
            print_message("22 x 1, SD %.1f, mean %.3f: binomial %.2f, Clopper-Pearson covers %.2f\n", sds[j],
                          means[k], percent(rejected), percent(covered));
            keeps("binomial", rejected, of, -1, 0.05);
            keeps("Clopper-Pearson", covered, of, 0.95, -1);
        }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(several_answers_keep_their_level),
        cmocka_unit_test(one_answer_keeps_its_level),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
