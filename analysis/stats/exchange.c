// Permutation of people among groups of their own sizes: Good, P. (2005), Permutation, parametric and bootstrap
// tests of hypotheses, 3rd ed., chapters 3 and 7 (what is exchanged is what was assigned: the person, with all
// answers). All arrangements in the order of their labels where there are few, random ones else.
#include "analysis/stats/exchange.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

struct arrangement {
    const struct stat_groups_of_people *of;
    int *label; // owned; a group for each person
    double column[STAT_EXCHANGE_CATEGORIES], all;
};

static double chi_squared(const struct arrangement *a)
{
    double cell[STAT_EXCHANGE_GROUPS][STAT_EXCHANGE_CATEGORIES] = {{0}}, row[STAT_EXCHANGE_GROUPS] = {0},
           sum = 0;
    size_t categories = a->of->categories;
    for (size_t i = 0; i < a->of->people; i++)
        for (size_t j = 0; j < categories; j++) {
            double count = (double)a->of->counts[i * categories + j];
            cell[a->label[i]][j] += count;
            row[a->label[i]] += count;
        }
    for (size_t g = 0; g < a->of->groups; g++)
        for (size_t j = 0; j < categories && row[g] > 0; j++) {
            double expected = row[g] * a->column[j] / a->all, off = cell[g][j] - expected;
            sum += off * off / expected;
        }
    return sum;
}

static bool in_range(const struct stat_groups_of_people *p)
{
    return p->group && p->counts && p->people >= 2 && p->people <= STAT_EXCHANGE_MOST && p->groups >= 2 &&
           p->groups <= STAT_EXCHANGE_GROUPS && p->categories >= 2 && p->categories <= STAT_EXCHANGE_CATEGORIES;
}

// Column sums; false for bad groups or counts, an empty group or an empty category.
static bool add_up(const struct stat_groups_of_people *p, struct arrangement *a)
{
    double row[STAT_EXCHANGE_GROUPS] = {0};
    for (size_t i = 0; i < p->people; i++) {
        if (p->group[i] < 0 || (size_t)p->group[i] >= p->groups)
            return false;
        for (size_t j = 0; j < p->categories; j++) {
            int64_t count = p->counts[i * p->categories + j];
            if (count < 0 || count > 1000000)
                return false;
            row[p->group[i]] += (double)count;
            a->column[j] += (double)count;
            a->all += (double)count;
        }
    }
    for (size_t g = 0; g < p->groups; g++)
        if (row[g] == 0)
            return false;
    for (size_t j = 0; j < p->categories; j++)
        if (a->column[j] == 0)
            return false;
    return true;
}

// n! / (n1! n2! ...)
static double arrangements_of(const struct stat_groups_of_people *p)
{
    double count = 1, size[STAT_EXCHANGE_GROUPS] = {0};
    for (size_t i = 0; i < p->people && isfinite(count); i++) {
        size[p->group[i]]++;
        count *= (double)(i + 1) / size[p->group[i]];
    }
    return isfinite(count) ? round(count) : count;
}

static void swap(int *a, int *b)
{
    int kept = *a;
    *a = *b;
    *b = kept;
}

static int ascending(const void *a, const void *b)
{
    return *(const int *)a - *(const int *)b;
}

// The next order of the labels; false after the last. Knuth, D. E. (2011), The art of computer programming
// 4A, 7.2.1.2, algorithm L.
static bool next_order(int *label, size_t n)
{
    size_t j = n - 1;
    while (j > 0 && label[j - 1] >= label[j])
        j--;
    if (j == 0)
        return false;
    size_t l = n - 1;
    while (label[j - 1] >= label[l])
        l--;
    swap(&label[j - 1], &label[l]);
    for (size_t k = n - 1; j < k; j++, k--)
        swap(&label[j], &label[k]);
    return true;
}

static struct stat_permutation try_all(struct arrangement *a, double data)
{
    int64_t reached = 0, arrangements = 0;
    qsort(a->label, a->of->people, sizeof *a->label, ascending);
    do {
        reached += stat_permutation_reaches(chi_squared(a), data);
        arrangements++;
    } while (next_order(a->label, a->of->people));
    return stat_permutation_done(data, reached, arrangements, true);
}

static struct stat_permutation draw(struct arrangement *a, double data, struct stat_permuting how)
{
    int64_t reached = 0;
    uint64_t counter = 0;
    for (int64_t i = 0; i < how.draws; i++) {
        for (size_t j = a->of->people; j > 1; j--)
            swap(&a->label[j - 1], &a->label[stat_permutation_below(how.seed, counter++, (uint32_t)j)]);
        reached += stat_permutation_reaches(chi_squared(a), data);
    }
    return stat_permutation_done(data, reached, how.draws, false);
}

struct stat_permutation stat_exchange_test(const struct stat_groups_of_people *people,
                                           struct stat_permuting how)
{
    struct arrangement a = {.of = people};
    how = stat_permuting_defaults(how);
    if (!in_range(people) || how.draws < 1 || how.draws > 1000000000 || !add_up(people, &a))
        return stat_permutation_none();
    a.label = malloc(people->people * sizeof *a.label);
    if (!a.label)
        return stat_permutation_none();
    memcpy(a.label, people->group, people->people * sizeof *a.label);
    double data = chi_squared(&a);
    bool exact = arrangements_of(people) <= (double)how.exact_most;
    struct stat_permutation out = exact ? try_all(&a, data) : draw(&a, data, how);
    free(a.label);
    return out;
}
