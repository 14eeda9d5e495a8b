// JOD scales against R (tests/reference/thurstone.R, thurstone_bootstrap.R), and by law.
#include "analysis/stats/thurstone.h"
#include "reference.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

enum { MOST = 4000 };

// Each comparison by a person of its own.
static size_t answers_of(const double *wins, size_t options, struct stat_preference *out)
{
    size_t count = 0;
    for (size_t i = 0; i < options; i++)
        for (size_t j = 0; j < options; j++)
            for (int k = 0; k < (int)wins[i * options + j]; k++) {
                assert_true(count < MOST);
                out[count] = (struct stat_preference){.person = count, .winner = i, .loser = j};
                count++;
            }
    return count;
}

static void agrees_with_r(void **state)
{
    (void)state;
    static struct stat_preference answers[MOST];
    FILE *file = reference_open("thurstone.csv");
    char line[4096];
    double worst = 0, worst_likelihood = 0;
    size_t rows = 0, scaled = 0, not_estimable = 0;
    assert_non_null(fgets(line, sizeof line, file));
    for (; fgets(line, sizeof line, file); rows++) {
        line[strcspn(line, "\n")] = '\0';
        char *rest = line;
        const char *name = reference_field(&rest, ',');
        struct stat_jod_desc desc = {.options = strtoul(reference_field(&rest, ','), NULL, 10)};
        desc.reference = strtoul(reference_field(&rest, ','), NULL, 10);
        double wins[256], scores[16], likelihood;
        size_t options = desc.options;
        assert_int_equal(reference_numbers(reference_field(&rest, ','), wins, 256), options * options);
        assert_int_equal(reference_numbers(reference_field(&rest, ','), scores, 16), options);
        likelihood = reference_number(reference_field(&rest, ','));
        size_t count = answers_of(wins, options, answers);
        struct stat_jod out[16];
        assert_true(stat_jod_scale(answers, count, &desc, out));
        double mine[16];
        for (size_t i = 0; i < options; i++) {
            mine[i] = out[i].score;
            double off = isnan(scores[i]) && isnan(mine[i]) ? 0 : fabs(mine[i] - scores[i]);
            if (!(off <= 1e-6)) // R's iteration stops by the deviance
                fail_msg("%s, option %zu: %.12g, R %.12g", name, i, mine[i], scores[i]);
            worst = fmax(worst, off);
            assert_true((out[i].status > STAT_JOD_REFERENCE) == isnan(scores[i]));
            scaled += isnan(scores[i]) ? 0 : 1;
            not_estimable += isnan(scores[i]) ? 1 : 0;
        }
        if (!isnan(likelihood)) {
            double off = stat_jod_log_likelihood(answers, count, mine) - likelihood;
            assert_true(off > -1e-9); // never below R's maximum
            worst_likelihood = fmax(worst_likelihood, fabs(off));
        }
    }
    fclose(file);
    print_message("%zu sets, %zu scores within %.1e JOD, likelihoods within %.1e; %zu not estimable\n", rows,
                  scaled, worst, worst_likelihood, not_estimable);
    assert_true(rows >= 20 && not_estimable >= 8);
}

// One pair has a closed form.
static void a_pair_is_its_quantile(void **state)
{
    (void)state;
    static struct stat_preference answers[MOST];
    struct stat_jod out[2];
    const double wins[] = {0, 10, 30, 0};
    assert_true(
        stat_jod_scale(answers, answers_of(wins, 2, answers), &(struct stat_jod_desc){.options = 2}, out));
    assert_true(fabs(out[1].score - 1) < 1e-12); // 75 %
    assert_int_equal(out[1].won, 30);
    assert_int_equal(out[1].n, 40);
    const double unanimous[] = {0, 0, 30, 0};
    assert_true(
        stat_jod_scale(answers, answers_of(unanimous, 2, answers), &(struct stat_jod_desc){.options = 2}, out));
    assert_int_equal(out[1].status, STAT_JOD_ALWAYS);
    assert_true(isnan(out[1].score));
    assert_true(stat_jod_scale(answers, answers_of(unanimous, 2, answers),
                               &(struct stat_jod_desc){.options = 2, .reference = 1}, out));
    assert_int_equal(out[0].status, STAT_JOD_NEVER);
    assert_true(stat_jod_scale(answers, 0, &(struct stat_jod_desc){.options = 2, .replicates = 10}, out));
    assert_int_equal(out[1].status, STAT_JOD_ALONE);
}

// With one answer per person the interval is near that of the delta method; with the answers of 40 in the hands
// of 8 who always say the same, it is about root 5 as wide.
static void people_are_the_unit(void **state)
{
    (void)state;
    static struct stat_preference answers[MOST];
    const double wins[] = {0, 80, 120, 0};
    struct stat_jod_desc desc = {.options = 2, .replicates = 2000, .seed = 3};
    struct stat_jod out[2], again[2];
    size_t count = answers_of(wins, 2, answers);
    assert_true(stat_jod_scale(answers, count, &desc, out));
    // d score / d p = sigma / phi(z), z = Phi^-1(0.6) = 0.2533, phi(z) = 0.3863
    double error = 1.4826 / 0.3863 * sqrt(0.6 * 0.4 / 200), width = out[1].interval.high - out[1].interval.low;
    assert_true(fabs(width / (2 * 1.96 * error) - 1) < 0.08);
    assert_false(out[1].unreliable);
    assert_true(stat_jod_scale(answers, count, &desc, again));
    assert_true(again[1].interval.low == out[1].interval.low && again[1].interval.high == out[1].interval.high);
    for (size_t i = 0; i < count; i++)
        answers[i].person = i / 5;
    assert_true(stat_jod_scale(answers, count, &desc, again));
    double clustered = again[1].interval.high - again[1].interval.low;
    assert_true(fabs(clustered / width / sqrt(5) - 1) < 0.15);
    for (size_t i = 0; i < count; i++)
        answers[i].person = 7;
    assert_true(stat_jod_scale(answers, count, &desc, again)); // one person: no interval
    assert_true(isnan(again[1].interval.low) && again[1].score == out[1].score);
}

// A replicate in which an option is never, or always, preferred puts it at infinity, and counts there: with
// 20000 replicates shares are off by at most 0.011 (three standard errors of one half), and percentiles are
// exact, as no step of the distribution is that near (tests/reference/thurstone_bootstrap.R).
static void infinite_replicates_open_the_interval(void **state)
{
    (void)state;
    static struct stat_preference answers[MOST];
    struct stat_jod_desc desc = {.options = 2, .replicates = 20000, .seed = 11};
    char line[512];
    size_t rows = 0, open = 0;
    FILE *file = reference_open("thurstone_bootstrap.csv");
    assert_non_null(fgets(line, sizeof line, file));
    for (; fgets(line, sizeof line, file); rows++) {
        double r[6];
        char *rest = line;
        for (size_t i = 0; i < 6; i++)
            r[i] = reference_number(reference_field(&rest, ','));
        const double wins[] = {0, r[1] - r[0], r[0], 0};
        struct stat_jod out[2];
        assert_true(stat_jod_scale(answers, answers_of(wins, 2, answers), &desc, out));
        assert_true(fabs((double)out[1].below / 20000 - r[2]) < 0.011);
        assert_true(fabs((double)out[1].above / 20000 - r[3]) < 0.011);
        assert_int_equal(out[1].failed, 0);
        assert_false(out[1].unreliable || out[1].alike);
        const double ends[2][2] = {{out[1].interval.low, r[4]}, {out[1].interval.high, r[5]}};
        for (int i = 0; i < 2; i++) {
            bool same = isinf(ends[i][1]) ? ends[i][0] == ends[i][1] : fabs(ends[i][0] - ends[i][1]) < 1e-9;
            if (!same)
                fail_msg("%g of %g: end %d is %g, R %g", r[0], r[1], i, ends[i][0], ends[i][1]);
            open += isinf(ends[i][1]) ? 1 : 0;
        }
    }
    fclose(file);
    assert_true(rows >= 8 && open >= 5);
}

// Who all give the same answers say nothing about how others would differ.
static void people_who_do_not_differ_have_no_interval(void **state)
{
    (void)state;
    static struct stat_preference answers[MOST];
    const struct stat_jod_desc desc = {.options = 2, .replicates = 500, .seed = 3};
    const double wins[] = {0, 8, 24, 0};
    struct stat_jod out[2];
    size_t count = answers_of(wins, 2, answers);
    for (size_t i = 0; i < count; i++) // the first 8 won by one, the others by the other: 3 of 4 for each of 8
        answers[i].person = i % 8;
    assert_true(stat_jod_scale(answers, count, &desc, out));
    assert_true(fabs(out[1].score - 1) < 1e-12 && out[1].alike);
    assert_true(isnan(out[1].interval.low) && isnan(out[1].interval.high));
    answers[0].person = 1; // now the first differs, and the second
    assert_true(stat_jod_scale(answers, count, &desc, out));
    assert_true(!out[1].alike && out[1].interval.low < 1 && out[1].interval.high > 1);
}

static void bad_input(void **state)
{
    (void)state;
    struct stat_jod out[2];
    const struct stat_preference self = {0, 1, 1}, beyond = {0, 1, 2}, fine = {0, 1, 0};
    assert_false(stat_jod_scale(&self, 1, &(struct stat_jod_desc){.options = 2}, out));
    assert_false(stat_jod_scale(&beyond, 1, &(struct stat_jod_desc){.options = 2}, out));
    assert_false(stat_jod_scale(&fine, 1, &(struct stat_jod_desc){.options = 2, .reference = 2}, out));
    assert_false(stat_jod_scale(&fine, 1, &(struct stat_jod_desc){.options = 65}, out));
    assert_false(stat_jod_scale(&fine, 1, &(struct stat_jod_desc){0}, out));
    assert_false(stat_jod_scale(&fine, 1, &(struct stat_jod_desc){.options = 2, .conf = 1}, out));
    assert_false(stat_jod_scale(&fine, 1, &(struct stat_jod_desc){.options = 2, .conf = (double)NAN}, out));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(agrees_with_r),
        cmocka_unit_test(a_pair_is_its_quantile),
        cmocka_unit_test(people_are_the_unit),
        cmocka_unit_test(infinite_replicates_open_the_interval),
        cmocka_unit_test(people_who_do_not_differ_have_no_interval),
        cmocka_unit_test(bad_input),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
