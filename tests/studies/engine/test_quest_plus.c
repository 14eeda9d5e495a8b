// QUEST+ against a brute-force implementation in R (tests/reference/quest_plus.R), and by law: probabilities,
// posteriors without NaN whatever is answered, no underflow in 10,000 trials, the same from the same outcomes.
#include "studies/engine/quest_plus.h"

#include "studies/engine/random.h"
#include "tests/analysis/reference.h"

#include <float.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

enum { MOST = 8 };

static struct quest_plus_grid read_grid(const char *text)
{
    double n[4];
    assert_int_equal(reference_numbers(text, n, 4), 4);
    return (struct quest_plus_grid){n[0], n[1], (uint32_t)n[2], n[3] != 0 ? QUEST_PLUS_LOG : QUEST_PLUS_LINEAR};
}

static struct quest_plus *read_setting(char *rest, struct quest_plus_desc *out)
{
    char *name = reference_field(&rest, ','), error[256] = "";
    *out = (struct quest_plus_desc){.model.family = quest_plus_find_family(reference_field(&rest, ','))};
    out->model.outcomes = (uint32_t)reference_number(reference_field(&rest, ','));
    out->falling = reference_number(reference_field(&rest, ',')) != 0;
    struct quest_plus_grid *grids[] = {&out->level, &out->model.threshold, &out->model.slope, &out->model.guess,
                                       &out->model.lapse};
    for (int i = 0; i < 5; i++)
        *grids[i] = read_grid(reference_field(&rest, ','));
    quest_plus_check(out, error, sizeof error);
    assert_string_equal(error, "");
    struct quest_plus *quest = quest_plus_create(out);
    assert_non_null(quest);
    print_message("%s: %.0f parameter sets\n", name, quest_plus_sets(&out->model));
    return quest;
}

// Largest differences from R: relative for levels and means; SDs and entropies have no zero of their own in
// sight (a posterior may shrink to a point), so those are absolute.
struct worst {
    double level, mean, sd, entropy;
};

static void compare_trial(struct quest_plus *quest, uint32_t outcomes, char *rest, struct worst *worst)
{
    double means[MOST], sds[MOST], sd;
    double level = reference_number(reference_field(&rest, ','));
    double outcome = reference_number(reference_field(&rest, ','));
    double entropy = reference_number(reference_field(&rest, ','));
    double expected = reference_number(reference_field(&rest, ','));
    reference_numbers(reference_field(&rest, ','), means, MOST);
    assert_int_equal(reference_numbers(reference_field(&rest, ','), sds, MOST), outcomes + 2);
    // A level of 0 may be 1e-16 in the other program's sequence.
    double distance = fabs(quest_plus_level(quest) - level);
    worst->level = fmax(worst->level, distance / fmax(fabs(level), 1));
    assert_true(distance <= 1e-12 * fmax(fabs(level), 1));
    worst->entropy = fmax(worst->entropy, fabs(quest_plus_expected_entropy(quest) - expected));
    quest_plus_outcome(quest, (uint32_t)outcome);
    worst->entropy = fmax(worst->entropy, fabs(quest_plus_entropy(quest) - entropy));
    for (uint32_t i = 0; i < outcomes + 2; i++) {
        worst->mean = fmax(worst->mean, reference_distance(quest_plus_mean(quest, i, &sd), means[i]));
        worst->sd = fmax(worst->sd, fabs(sd - sds[i]));
    }
}

static void test_agrees_with_r(void **state)
{
    (void)state;
    FILE *file = reference_open("quest_plus.csv");
    struct quest_plus *quest = NULL;
    struct quest_plus_desc desc = {0};
    struct worst worst = {0};
    char line[1024];
    uint32_t trials = 0, settings = 0;
    while (fgets(line, sizeof line, file)) {
        line[strcspn(line, "\n")] = '\0';
        char *rest = line;
        if (strcmp(reference_field(&rest, ','), "setting") == 0) {
            quest_plus_destroy(quest);
            quest = read_setting(rest, &desc);
            settings++;
        } else {
            compare_trial(quest, desc.model.outcomes, rest, &worst);
            trials++;
        }
    }
    quest_plus_destroy(quest);
    fclose(file);
    print_message(
        "%u settings, %u trials; worst: level %.2g, mean %.2g (relative), sd %.2g, entropy %.2g nats\n",
        settings, trials, worst.level, worst.mean, worst.sd, worst.entropy);
    assert_true(settings >= 12 && trials >= 900);
    assert_true(worst.mean <= 1e-9 && worst.sd <= 1e-9 && worst.entropy <= 1e-9);
}

// Two outcomes with everything on a grid.
static struct quest_plus_desc two(const char *family)
{
    return (struct quest_plus_desc){.level = {0.1, 10, 21, QUEST_PLUS_LOG},
                                    .model = {.family = quest_plus_find_family(family),
                                              .outcomes = 2,
                                              .threshold = {0.2, 8, 15, QUEST_PLUS_LOG},
                                              .slope = {0.5, 8, 4, QUEST_PLUS_LOG},
                                              .guess = {0.4, 0.5, 2, QUEST_PLUS_LINEAR},
                                              .lapse = {0, 0.1, 3, QUEST_PLUS_LINEAR}}};
}

static struct quest_plus_desc many(const char *family, uint32_t outcomes)
{
    struct quest_plus_desc desc = two(family);
    desc.model.outcomes = outcomes;
    desc.model.threshold.count = outcomes + 4;
    desc.model.guess = (struct quest_plus_grid){0};
    return desc;
}

static void test_probabilities(void **state)
{
    (void)state;
    for (size_t f = 0; quest_plus_families[f]; f++)
        for (uint32_t outcomes = 2; outcomes <= 5; outcomes++)
            for (int falling = 0; falling <= 1; falling++) {
                const char *name = quest_plus_family_name(quest_plus_families[f]);
                struct quest_plus_desc desc = outcomes == 2 ? two(name) : many(name, outcomes);
                desc.falling = falling;
                const double rising_set[] = {3, 0.2, 0.04, 0.5, 0.9, 2, 6},
                             falling_set[] = {3, 0.2, 0.04, 6, 2, 0.9, 0.5};
                double p[5], before = falling ? 2 : -1;
                for (double x = 1e-3; x < 1e4; x *= 1.1) {
                    double sum = 0, score = 0;
                    quest_plus_probabilities(&desc, x, falling ? falling_set : rising_set, p);
                    for (uint32_t k = 0; k < outcomes; k++) {
                        assert_true(p[k] >= DBL_MIN && p[k] <= 1);
                        sum += p[k];
                        score += p[k] * k / (outcomes - 1);
                    }
                    assert_true(fabs(sum - 1) < 1e-14);
                    assert_true(falling ? score <= before + 1e-14 : score >= before - 1e-14);
                    before = score;
                }
            }
    // At the threshold: guess + (1 - guess - lapse) F(0).
    double p[2], set[] = {2.5, 0.5, 0.02, 1.7};
    struct quest_plus_desc desc = two("logistic");
    quest_plus_probabilities(&desc, 1.7, set, p);
    assert_true(fabs(p[1] - (0.5 + 0.48 * 0.5)) < 1e-15);
    desc = two("weibull");
    quest_plus_probabilities(&desc, 1.7, set, p);
    assert_true(fabs(p[1] - (0.5 + 0.48 * (1 - exp(-1)))) < 1e-15);
    // Each tail keeps its digits: Phi(-10) and its mirror (R: pnorm(-10) = 7.6198530241605269e-24).
    desc = two("normal");
    desc.level.spacing = QUEST_PLUS_LINEAR;
    set[0] = 1;
    set[1] = set[2] = 0;
    set[3] = 0;
    quest_plus_probabilities(&desc, -10, set, p);
    assert_true(reference_close(p[1], 7.6198530241605269e-24, 1e-13));
    quest_plus_probabilities(&desc, 10, set, p);
    assert_true(reference_close(p[0], 7.6198530241605269e-24, 1e-13));
}

// Every number a caller can see is finite and in its place.
static void sane(const struct quest_plus *quest, const struct quest_plus_desc *desc)
{
    double most = log(quest_plus_sets(&desc->model)) + 1e-9, level = quest_plus_level(quest), sd;
    assert_true(level >= desc->level.min && level <= desc->level.max);
    assert_true(quest_plus_entropy(quest) >= -1e-12 && quest_plus_entropy(quest) <= most);
    assert_true(quest_plus_expected_entropy(quest) <= quest_plus_entropy(quest) + 1e-12);
    for (uint32_t k = 0; k + 1 < desc->model.outcomes; k++) {
        double mean = quest_plus_mean(quest, QUEST_PLUS_THRESHOLD + k, &sd);
        assert_true(mean >= desc->model.threshold.min * (1 - 1e-12));
        assert_true(mean <= desc->model.threshold.max * (1 + 1e-12));
        assert_true(sd >= 0 && isfinite(sd));
    }
}

enum pattern { ALL_WRONG, ALL_RIGHT, ALTERNATING, RANDOM, CONTRARY };

// CONTRARY: the less likely answer by the level, so that no function on the grid fits.
static uint32_t answer(enum pattern pattern, uint32_t trial, uint32_t outcomes, double level, bool falling,
                       struct random_stream *stream)
{
    bool strong = (level > 1) != falling;
    switch (pattern) {
    case ALL_WRONG:
        return 0;
    case ALL_RIGHT:
        return outcomes - 1;
    case ALTERNATING:
        return trial % 2 ? outcomes - 1 : 0;
    case RANDOM:
        return random_below(stream, outcomes);
    case CONTRARY:
        return strong ? 0 : outcomes - 1;
    }
    return 0;
}

static void test_any_answers_leave_a_posterior(void **state)
{
    (void)state;
    struct random_stream stream = random_stream(1, 900, 0, 0);
    for (size_t f = 0; quest_plus_families[f]; f++)
        for (enum pattern pattern = ALL_WRONG; pattern <= CONTRARY; pattern++)
            for (int variant = 0; variant < 4; variant++) {
                const char *name = quest_plus_family_name(quest_plus_families[f]);
                struct quest_plus_desc desc = variant < 2 ? two(name) : many(name, 4);
                desc.falling = variant % 2;
                if (variant % 2) { // steep, without guesses or lapses: contradictions have probability 0
                    desc.model.slope = (struct quest_plus_grid){50, 5000, 2, QUEST_PLUS_LOG};
                    desc.model.guess.min = desc.model.guess.max = 0;
                    desc.model.guess.count = variant < 2;
                    desc.model.lapse = (struct quest_plus_grid){0, 0, 1, QUEST_PLUS_LINEAR};
                }
                struct quest_plus *quest = quest_plus_create(&desc);
                assert_non_null(quest);
                for (uint32_t i = 0; i < 1000; i++) {
                    sane(quest, &desc);
                    quest_plus_outcome(quest, answer(pattern, i, desc.model.outcomes, quest_plus_level(quest),
                                                     desc.falling, &stream));
                }
                sane(quest, &desc);
                quest_plus_destroy(quest);
            }
}

static void test_ten_thousand_trials(void **state)
{
    (void)state;
    // The observer sits on the grid, so the posterior must gather at its values.
    struct quest_plus_desc desc = two("logistic");
    struct random_stream stream = random_stream(2, 901, 0, 0);
    double set[] = {quest_plus_grid_value(&desc.model.slope, 2), 0.5, 0.05,
                    quest_plus_grid_value(&desc.model.threshold, 6)},
           p[2], sd;
    struct quest_plus *quest = quest_plus_create(&desc);
    for (uint32_t i = 0; i < 10000; i++) {
        quest_plus_probabilities(&desc, quest_plus_level(quest), set, p);
        quest_plus_outcome(quest, random_unit(&stream) < p[1]);
        sane(quest, &desc);
    }
    for (uint32_t i = 0; i < 4; i++) {
        double mean = quest_plus_mean(quest, i, &sd);
        print_message("parameter %u: true %.4f, mean %.4f, sd %.2g\n", i, set[i], mean, sd);
        assert_true(fabs(mean - set[i]) <= 4 * sd + 1e-6 * set[i]);
    }
    quest_plus_mean(quest, QUEST_PLUS_THRESHOLD, &sd);
    assert_true(sd < 0.01 * set[3]);
    quest_plus_destroy(quest);
}

static void test_many_outcomes(void **state)
{
    (void)state;
    // A ten-point rating: nine thresholds out of ten values.
    struct quest_plus_desc desc = many("logistic", 10);
    desc.model.threshold.count = 10;
    assert_true(quest_plus_sets(&desc.model) == 10 * 4 * 3);
    struct quest_plus *quest = quest_plus_create(&desc);
    assert_non_null(quest);
    for (uint32_t i = 0; i < 200; i++) {
        double before = 0, sd;
        quest_plus_outcome(quest, i * 7 % 10);
        sane(quest, &desc);
        for (uint32_t k = 0; k < 9; k++) { // thresholds stay in order
            double mean = quest_plus_mean(quest, QUEST_PLUS_THRESHOLD + k, &sd);
            assert_true(mean > before);
            before = mean;
        }
    }
    quest_plus_destroy(quest);
}

static void test_mirror(void **state)
{
    (void)state;
    // On a grid symmetric about 0 a falling function seen at -x is a rising one seen at x.
    struct quest_plus_desc up = two("normal");
    up.level = (struct quest_plus_grid){-3, 3, 20, QUEST_PLUS_LINEAR};
    up.model.threshold = (struct quest_plus_grid){-2, 2, 14, QUEST_PLUS_LINEAR};
    struct quest_plus_desc down = up;
    down.falling = true;
    struct quest_plus *a = quest_plus_create(&up), *b = quest_plus_create(&down);
    struct random_stream stream = random_stream(3, 902, 0, 0);
    double sd;
    for (uint32_t i = 0; i < 100; i++) {
        assert_true(fabs(quest_plus_level(a) + quest_plus_level(b)) < 1e-12);
        uint32_t outcome = random_below(&stream, 4) > 0;
        quest_plus_outcome(a, outcome);
        quest_plus_outcome(b, outcome);
        assert_true(fabs(quest_plus_mean(a, QUEST_PLUS_THRESHOLD, &sd) +
                         quest_plus_mean(b, QUEST_PLUS_THRESHOLD, &sd)) < 1e-10);
    }
    quest_plus_destroy(a);
    quest_plus_destroy(b);
}

static void test_ties_go_to_the_first(void **state)
{
    (void)state;
    // Two levels mirrored about the only threshold tell the same about the lapse-free slope.
    struct quest_plus_desc desc = two("logistic");
    desc.level = (struct quest_plus_grid){-1, 1, 2, QUEST_PLUS_LINEAR};
    desc.model.threshold = (struct quest_plus_grid){0, 0, 1, QUEST_PLUS_LINEAR};
    desc.model.guess = desc.model.lapse = (struct quest_plus_grid){0, 0, 1, QUEST_PLUS_LINEAR};
    struct quest_plus *quest = quest_plus_create(&desc);
    for (uint32_t i = 0; i < 50; i++) {
        assert_true(quest_plus_level(quest) == -1);
        quest_plus_outcome(quest, i % 5 == 0);
    }
    quest_plus_destroy(quest);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_agrees_with_r),
        cmocka_unit_test(test_probabilities),
        cmocka_unit_test(test_any_answers_leave_a_posterior),
        cmocka_unit_test(test_ten_thousand_trials),
        cmocka_unit_test(test_many_outcomes),
        cmocka_unit_test(test_mirror),
        cmocka_unit_test(test_ties_go_to_the_first),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
