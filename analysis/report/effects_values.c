// One value a person for each check of effects.h. Repetition: the number expected of neighbours that are alike
// when k answers of one kind and n - k of the other come in random order is Wald, A. & Wolfowitz, J. (1940),
// Ann. Math. Stat. 11, 147-162 (their runs, counted by neighbours): (k (k - 1) + (n - k)(n - k - 1)) / (n (n -
// 1)) of each pair, whichever pairs are looked at.
#include "analysis/report/effects_private.h"

#include <math.h>

// Whether the thing that is chosen in excess (a slot, a turn) was the test option; -1: not known.
static int held(enum effect_check check, const struct effect_answer *answer)
{
    return check == EFFECT_SIDE ? answer->test_a : check == EFFECT_FIRST ? answer->first : answer->last;
}

static double stratified(enum effect_check check, const struct effect_answer *answers, size_t count)
{
    double n[2] = {0, 0}, k[2] = {0, 0};
    for (size_t i = 0; i < count; i++) {
        int test = held(check, &answers[i]);
        if (test < 0)
            continue;
        n[test]++;
        k[test] += answers[i].test == (test == 1);
    }
    // Far from evenly often the value is skewed where there is a preference, and flipping signs rejects too
    // often: 8 to 18 % at 0.05 for 2 of 12 and 1 of 12 trials and a preference of 0.9, at most 5.3 % from half
    // as often on.
    bool even = 2 * fmin(n[0], n[1]) >= fmax(n[0], n[1]) && n[0] > 0;
    return even ? (k[0] / n[0] + k[1] / n[1]) / 2 - 0.5 : (double)NAN;
}

// How many of the answers from `from` on are of one sitting.
static size_t sitting(const struct effect_answer *answers, size_t count, size_t from)
{
    size_t to = from + 1;
    while (to < count && answers[to].session == answers[from].session)
        to++;
    return to - from;
}

// Within sittings; of an odd number the one in the middle is in neither half.
static double later_less_earlier(const struct effect_answer *answers, size_t count)
{
    double pairs = 0, difference = 0;
    for (size_t from = 0, n; from < count; from += n) {
        n = sitting(answers, count, from);
        for (size_t i = 0; i < n / 2; i++)
            difference += (double)answers[from + n - 1 - i].test - (double)answers[from + i].test;
        pairs += (double)(n / 2);
    }
    return pairs > 0 ? difference / pairs : (double)NAN;
}

// A sitting of one answer only says nothing: its order cannot differ.
static double repeated(const struct effect_answer *answers, size_t count)
{
    double all = 0, excess = 0;
    for (size_t from = 0, size; from < count; from += size) {
        size = sitting(answers, count, from);
        double n = (double)size, k = 0, pairs = 0, same = 0;
        for (size_t i = from; i < from + size; i++) {
            k += answers[i].a;
            if (i == from || answers[i].after_equal)
                continue;
            pairs++;
            same += answers[i].a == answers[i - 1].a;
        }
        if (k == 0 || k == n)
            continue;
        excess += same - pairs * (k * (k - 1) + (n - k) * (n - k - 1)) / (n * (n - 1));
        all += pairs;
    }
    return all > 0 ? excess / all : (double)NAN;
}

static double by_choice(enum effect_check check, const struct effect_answer *answers, size_t count)
{
    double n[2] = {0, 0}, sum[2] = {0, 0};
    for (size_t i = 0; i < count; i++) {
        double value = check == EFFECT_TOGGLES ? answers[i].toggles : answers[i].test_view;
        if (isnan(value))
            continue;
        n[answers[i].test]++;
        sum[answers[i].test] += value;
    }
    return n[0] > 0 && n[1] > 0 ? sum[1] / n[1] - sum[0] / n[0] : (double)NAN;
}

double effect_value(enum effect_check check, const struct effect_answer *answers, size_t count)
{
    if (check == EFFECT_PLACE)
        return later_less_earlier(answers, count);
    if (check == EFFECT_REPETITION)
        return repeated(answers, count);
    if (check == EFFECT_TOGGLES || check == EFFECT_VIEWING)
        return by_choice(check, answers, count);
    return stratified(check, answers, count);
}
