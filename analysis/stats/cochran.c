// Cochran, W. G. (1950), The comparison of percentages in matched samples, Biometrika 37, 256-266. With column
// sums C, row sums R, k conditions: Q = (k - 1) (k sum C^2 - (sum C)^2) / (k sum R - sum R^2), chi-squared with
// k - 1 degrees of freedom for many people. Under the null hypothesis each person's yeses may stand anywhere in
// their row; only sum C^2 changes with it, so permutations compare whole numbers. For two conditions Q is
// McNemar's without correction.
#include "analysis/stats/cochran.h"

#include <Rmath.h>
#include <math.h>
#include <string.h>

struct sums {
    size_t conditions;
    int64_t column[STAT_COCHRAN_CONDITIONS];
    double all, row_squares;
    double arrangements; // the product of C(k, R), 1 for people of one answer
};

static bool add_up(const unsigned char *answers, size_t people, size_t conditions, struct sums *s)
{
    *s = (struct sums){.conditions = conditions, .arrangements = 1};
    if (!answers || people < 1 || people > STAT_COCHRAN_PEOPLE || conditions < 2 ||
        conditions > STAT_COCHRAN_CONDITIONS)
        return false;
    for (size_t i = 0; i < people; i++) {
        double row = 0;
        for (size_t j = 0; j < conditions; j++) {
            unsigned char answer = answers[i * conditions + j];
            if (answer > 1)
                return false;
            s->column[j] += answer;
            row += answer;
        }
        s->all += row;
        s->row_squares += row * row;
        s->arrangements *= choose((double)conditions, row);
    }
    return (double)conditions * s->all > s->row_squares; // else nobody's answers differ
}

static int64_t column_squares(const struct sums *s)
{
    int64_t squares = 0;
    for (size_t j = 0; j < s->conditions; j++)
        squares += s->column[j] * s->column[j];
    return squares;
}

static double q_of(const struct sums *s)
{
    double k = (double)s->conditions;
    return (k - 1) * (k * (double)column_squares(s) - s->all * s->all) / (k * s->all - s->row_squares);
}

// A person of one answer to all conditions can be arranged in one way only and takes no part in the search.
// Every other one has two ways at least, so that fewer than 2^63 arrangements have at most 62 such people.
enum { MIXED_MOST = 62 };

struct search {
    const unsigned char *answers;
    size_t people;
    struct sums sums; // columns of the arrangement at hand
    int64_t always;   // people of yes to all conditions: in every column of every arrangement
    size_t mixed[MIXED_MOST], mixed_count;
    int64_t data, reached, arrangements;
};

static size_t yeses(const struct search *s, size_t person)
{
    size_t row = 0;
    for (size_t j = 0; j < s->sums.conditions; j++)
        row += s->answers[person * s->sums.conditions + j];
    return row;
}

static bool is_mixed(const struct search *s, size_t person)
{
    size_t row = yeses(s, person);
    return row > 0 && row < s->sums.conditions;
}

static void start_columns(struct search *s)
{
    for (size_t j = 0; j < s->sums.conditions; j++)
        s->sums.column[j] = s->always;
}

// Places the yeses that the i-th mixed person has left in the conditions from `from` on, then those of the
// next. As deep as they have yeses together, at most MIXED_MOST times the conditions.
static void place(struct search *s, size_t i, size_t from, size_t left)
{
    if (left == 0 && i + 1 == s->mixed_count) {
        s->arrangements++;
        s->reached += column_squares(&s->sums) >= s->data;
        return;
    }
    if (left == 0) {
        place(s, i + 1, 0, yeses(s, s->mixed[i + 1]));
        return;
    }
    for (size_t j = from; j + left <= s->sums.conditions; j++) {
        s->sums.column[j]++;
        place(s, i, j + 1, left - 1);
        s->sums.column[j]--;
    }
}

static void try_all(struct search *s)
{
    for (size_t i = 0; i < s->people && s->mixed_count < MIXED_MOST; i++)
        if (is_mixed(s, i))
            s->mixed[s->mixed_count++] = i;
    start_columns(s);
    place(s, 0, 0, yeses(s, s->mixed[0]));
}

// A person's answers in a random order: Fisher and Yates' shuffle.
static void shuffle_person(struct search *s, size_t i, uint64_t seed, uint64_t counter)
{
    unsigned char row[STAT_COCHRAN_CONDITIONS];
    size_t k = s->sums.conditions;
    memcpy(row, s->answers + i * k, k);
    for (size_t j = k; j > 1; j--) {
        size_t other = stat_permutation_below(seed, counter + j, (uint32_t)j);
        unsigned char kept = row[j - 1];
        row[j - 1] = row[other];
        row[other] = kept;
    }
    for (size_t j = 0; j < k; j++)
        s->sums.column[j] += row[j];
}

static void draw(struct search *s, struct stat_permuting how)
{
    uint64_t counter = 0;
    for (s->arrangements = 0; s->arrangements < how.draws; s->arrangements++) {
        start_columns(s);
        for (size_t i = 0; i < s->people; i++, counter += STAT_COCHRAN_CONDITIONS + 1)
            if (is_mixed(s, i))
                shuffle_person(s, i, how.seed, counter);
        s->reached += column_squares(&s->sums) >= s->data;
    }
}

struct stat_cochran stat_cochran_q(const unsigned char *answers, size_t people, size_t conditions,
                                   struct stat_permuting how)
{
    const double nan = (double)NAN;
    struct stat_cochran out = {nan, nan, nan, stat_permutation_none()};
    struct search s = {.answers = answers, .people = people};
    how = stat_permuting_defaults(how);
    if (!add_up(answers, people, conditions, &s.sums) || how.draws < 1 || how.draws > 1000000000)
        return out;
    out.statistic = q_of(&s.sums);
    out.df = (double)conditions - 1;
    out.p_value = pchisq(out.statistic, out.df, false, false);
    s.data = column_squares(&s.sums);
    for (size_t i = 0; i < people; i++)
        s.always += yeses(&s, i) == conditions;
    bool exact = s.sums.arrangements <= (double)how.exact_most;
    if (exact)
        try_all(&s);
    else
        draw(&s, how);
    out.permutation = stat_permutation_done(out.statistic, s.reached, s.arrangements, exact);
    return out;
}
