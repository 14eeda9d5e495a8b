#include "analysis/report/choices.h"

#include <math.h>

// Each person counts, not each answer.
static void test_people(struct choice_cell *cell, double p0, double conf, enum stat_alternative alternative)
{
    cell->flip = stat_signflip(cell->counts, cell->people, alternative);
    cell->t = stat_people_t(cell->counts, cell->people, &(struct stat_ttest_options){p0, conf, alternative});
    cell->overdispersion = stat_overdispersion(cell->counts, cell->people);
    cell->mixed =
        stat_mixed_logit(cell->counts, cell->people, &(struct stat_mixed_options){p0, conf, alternative});
    // The signs may be flipped under one half only, and not listed for a million people.
    cell->method = p0 == 0.5 && !isnan(cell->flip.p_value) ? CHOICE_SIGN_FLIP : CHOICE_T;
    cell->p_value = cell->method == CHOICE_T ? cell->t.p_value : cell->flip.p_value;
    cell->estimate = stat_people_share(cell->counts, cell->people);
    cell->ci = (struct stat_interval){cell->t.ci_low, cell->t.ci_high};
}

void choice_cell_test(struct choice_cell *cell, const struct choices_desc *desc)
{
    double conf = desc->conf == 0 ? 0.95 : desc->conf, p0 = desc->p0 == 0 ? 0.5 : desc->p0;
    const double none = (double)NAN;
    struct stat_people people = stat_people_sum(cell->counts, cell->people);
    cell->several = people.most_n > 1;
    cell->binomial = stat_binomial_test(cell->chosen, cell->n, p0, conf, desc->alternative);
    cell->method = cell->n ? CHOICE_BINOMIAL : CHOICE_NONE;
    cell->p_value = cell->binomial.p_value;
    cell->estimate = cell->binomial.estimate;
    cell->ci = cell->binomial.ci;
    cell->overdispersion = none;
    if (cell->several) {
        test_people(cell, p0, conf, desc->alternative);
    } else {
        cell->flip = (struct stat_signflip){.statistic = none, .p_value = none, .least_p = none};
        cell->t = stat_people_t(NULL, 0, NULL);
        cell->mixed = stat_mixed_logit(NULL, 0, NULL);
    }
    cell->clear = cell->p_value <= 1 - conf;
}

const char *choice_method_word(enum choice_method method)
{
    static const char *const words[] = {
        [CHOICE_NONE] = "", [CHOICE_BINOMIAL] = "binomial", [CHOICE_SIGN_FLIP] = "sign-flip", [CHOICE_T] = "t"};
    return words[method];
}
