// Overdispersion: McCullagh, P. & Nelder, J. A. (1989), Generalized Linear Models, 2nd ed., section 4.5.2: X^2
// over N - p, here with one parameter, the common share; R's quasibinomial has the same. With one answer each,
// X^2 is N whatever the answers are, so it says nothing.
#include "analysis/stats/people.h"

#include <math.h>
#include <stdlib.h>

struct stat_people stat_people_sum(const struct stat_person *people, size_t count)
{
    struct stat_people sum = {.ok = true};
    for (size_t i = 0; i < count; i++) {
        const struct stat_person *p = &people[i];
        if (p->n < 0 || p->n > STAT_PEOPLE_MAX_N || p->k < 0 || p->k > p->n)
            return (struct stat_people){.ok = false};
        if (p->n == 0)
            continue;
        sum.least_n = sum.people == 0 || p->n < sum.least_n ? p->n : sum.least_n;
        sum.most_n = p->n > sum.most_n ? p->n : sum.most_n;
        sum.people++;
        sum.k += p->k;
        sum.n += p->n;
    }
    return sum;
}

struct stat_ttest stat_people_t(const struct stat_person *people, size_t count,
                                const struct stat_ttest_options *options)
{
    struct stat_people sum = stat_people_sum(people, count);
    double *shares = sum.ok && sum.people ? malloc(sum.people * sizeof *shares) : NULL;
    if (!shares)
        return stat_ttest_one_sample(NULL, 0, options);
    size_t used = 0;
    for (size_t i = 0; i < count; i++)
        if (people[i].n)
            shares[used++] = (double)people[i].k / (double)people[i].n;
    struct stat_ttest test = stat_ttest_one_sample(shares, used, options);
    free(shares);
    return test;
}

double stat_people_share(const struct stat_person *people, size_t count)
{
    struct stat_people sum = stat_people_sum(people, count);
    if (!sum.ok || sum.people == 0)
        return (double)NAN;
    double shares = 0;
    for (size_t i = 0; i < count; i++)
        if (people[i].n)
            shares += (double)people[i].k / (double)people[i].n;
    return shares / (double)sum.people;
}

double stat_overdispersion(const struct stat_person *people, size_t count)
{
    struct stat_people sum = stat_people_sum(people, count);
    if (!sum.ok || sum.people < 2 || sum.most_n < 2 || sum.k == 0 || sum.k == sum.n)
        return (double)NAN;
    double share = (double)sum.k / (double)sum.n, squares = 0;
    for (size_t i = 0; i < count; i++) {
        double n = (double)people[i].n, off = (double)people[i].k - n * share;
        if (people[i].n)
            squares += off * off / (n * share * (1 - share));
    }
    return squares / ((double)sum.people - 1);
}
