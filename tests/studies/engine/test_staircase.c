// Adaptive methods step by step against hand-worked tracks, contradictory descriptions, replay, and simulated
// observers.
#include "studies/engine/staircase.h"

#include "studies/engine/random.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static struct staircase_desc up_down(const char *method)
{
    return (struct staircase_desc){.method = staircase_find_method(method),
                                   .larger = STAIRCASE_LARGER_EASIER,
                                   .level = {.min = 0, .max = 20},
                                   .trials = 1000,
                                   .start = 10,
                                   .steps = {4, 2, 1},
                                   .step_count = 3,
                                   .target = strcmp(method, "weighted") == 0 ? 0.75 : 0};
}

static struct staircase_desc quest(uint32_t outcomes)
{
    return (struct staircase_desc){
        .method = staircase_find_method("quest_plus"),
        .larger = STAIRCASE_LARGER_EASIER,
        .level = {-3, 3, 31, QUEST_PLUS_LINEAR},
        .trials = 1000,
        .model = {.family = quest_plus_find_family("logistic"),
                  .outcomes = outcomes,
                  .threshold = {-2.5, 2.5, outcomes == 2 ? 41 : 11, QUEST_PLUS_LINEAR},
                  .slope = {0.7, 6, 5, QUEST_PLUS_LOG},
                  .guess = {outcomes == 2 ? 0.5 : 0, outcomes == 2 ? 0.5 : 0, outcomes == 2, QUEST_PLUS_LINEAR},
                  .lapse = {0, 0.06, 3, QUEST_PLUS_LINEAR}}};
}

static struct staircase *make(const struct staircase_desc *desc)
{
    char error[256] = "";
    staircase_check(desc, error, sizeof error);
    assert_string_equal(error, "");
    struct staircase *staircase = staircase_create(desc);
    assert_non_null(staircase);
    return staircase;
}

// Answers as "+" right and "-" wrong; the levels shown and the reversals ("R") must be as worked out by hand.
static void track(const struct staircase_desc *desc, const char *answers, const double *levels,
                  const char *reversals, double estimate)
{
    struct staircase *staircase = make(desc);
    struct staircase_step step = {0};
    for (size_t i = 0; answers[i]; i++) {
        double shown = staircase_level(staircase);
        assert_true(staircase_outcome(staircase, answers[i] == '+', &step));
        assert_true(step.level == shown); // of this trial, not of the next one (PsychoPy PR 413)
        assert_true(step.outcome == (answers[i] == '+'));
        if (fabs(shown - levels[i]) > 1e-12 || step.reversal != (reversals[i] == 'R'))
            fail_msg("trial %zu: level %g (%g), reversal %d", i + 1, shown, levels[i], step.reversal);
        assert_true(isnan(step.sd));
    }
    if (!(isnan(estimate) ? isnan(step.estimate) : fabs(step.estimate - estimate) < 1e-12))
        fail_msg("estimate %g, not %g", step.estimate, estimate);
    staircase_destroy(staircase);
}

static void test_one_up_two_down_by_hand(void **state)
{
    (void)state;
    struct staircase_desc desc = up_down("1up2down");
    // 10 twice right: 6, twice right: 2. Wrong: turn 1, step 2: 4. Twice right: turn 2, step 1: 3. Right,
    // wrong: turn 3 at 3. 4 twice right: turn 4. Wrong: turn 5 at 3, wrong again: 5. Twice right: turn 6.
    // Wrong: turn 7 at 4.
    const double levels[] = {10, 10, 6, 6, 2, 4, 4, 3, 3, 4, 4, 3, 4, 5, 5, 4};
    track(&desc, "++++-+++-", levels, "    R R R", (double)NAN); // one turn with the last step
    track(&desc, "++++-+++-++", levels, "    R R R R", 3.5);     // turns 3 and 4
    track(&desc, "++++-+++-++--++", levels, "    R R R RR  R", (3 + 4 + 3 + 5) / 4.0);
    track(&desc, "++++-+++-++--++-", levels, "    R R R RR  RR", (4 + 3 + 5 + 4) / 4.0); // turn 3 left out
    // Larger is harder: the same track mirrored.
    desc.larger = STAIRCASE_LARGER_HARDER;
    const double mirrored[] = {10, 10, 14, 14, 18, 16, 16, 17, 17, 16, 16};
    track(&desc, "++++-+++-++", mirrored, "    R R R R", 16.5);
}

static void test_weighted_by_hand(void **state)
{
    (void)state;
    struct staircase_desc desc = up_down("weighted");
    // Target 0.75: wrong steps are three times right ones.
    desc.steps[0] = 2;
    desc.steps[1] = 1;
    desc.step_count = 2;
    const double levels[] = {10, 8, 6, 9, 8, 7, 10, 9};
    // Turn 1 at 6, step 1: 9; turn 2 at 9 -> 8, 7; turn 3 at 7 -> 10; turn 4 at 10 -> 9.
    track(&desc, "++-++-+", levels, "  RR RR", (7.0 + 10) / 2);
    track(&desc, "++-++-", levels, "  RR R", (9.0 + 7) / 2);
    // Logarithmic: factors, and the geometric mean.
    desc.level = (struct quest_plus_grid){.min = 0.01, .max = 100, .spacing = QUEST_PLUS_LOG};
    desc.start = 8;
    desc.steps[0] = 2;
    desc.step_count = 1;
    const double factors[] = {8, 4, 32, 16, 100};
    track(&desc, "+-+-", factors, " RRR", sqrt(32.0 * 16));
}

static void test_bounds(void **state)
{
    (void)state;
    struct staircase_desc desc = up_down("1up2down");
    // Steps are cut at 20; there, wrong answers move nothing, and the way back is a turn at 20.
    const double levels[] = {10, 14, 18, 20, 20, 20, 20, 18};
    track(&desc, "-----++", levels, "      R", (double)NAN);
    desc.start = 20; // no move before: no turn
    const double from_end[] = {20, 20, 20, 16};
    track(&desc, "-++", from_end, "   ", (double)NAN);
}

static void test_it_stops(void **state)
{
    (void)state;
    struct staircase_desc desc = up_down("1up2down");
    struct staircase_step step;
    desc.reversals = 6;
    desc.trials = 0;
    for (int all_right = 0; all_right <= 1; all_right++) { // never a reversal
        struct staircase *staircase = make(&desc);
        uint32_t trials = 0;
        while (!staircase_done(staircase)) {
            assert_true(staircase_outcome(staircase, (uint32_t)all_right, &step));
            assert_true(++trials <= STAIRCASE_TRIALS);
        }
        assert_true(trials == STAIRCASE_TRIALS && staircase_trials(staircase) == trials);
        assert_true(isnan(step.estimate) && staircase_level(staircase) == (all_right ? 0 : 20));
        step.outcome = 77;
        assert_false(staircase_outcome(staircase, 1, &step)); // done: nothing changes
        assert_true(step.outcome == 77 && staircase_trials(staircase) == trials);
        staircase_destroy(staircase);
    }
    struct staircase *staircase = make(&desc);
    assert_false(staircase_outcome(staircase, 2, &step)); // no such outcome
    assert_true(staircase_trials(staircase) == 0);
    uint32_t reversals = 0;
    for (uint32_t i = 0; !staircase_done(staircase); i++) {
        staircase_outcome(staircase, i % 3 != 2, &step); // right right wrong
        reversals += step.reversal;
    }
    assert_true(reversals == 6);
    staircase_destroy(staircase);
}

static void test_any_answers(void **state)
{
    (void)state;
    struct staircase_desc descs[] = {up_down("1up2down"), up_down("weighted"), quest(2), quest(4)};
    for (size_t d = 0; d < 4; d++)
        for (int larger = STAIRCASE_LARGER_EASIER; larger <= STAIRCASE_LARGER_HARDER; larger++)
            for (uint32_t pattern = 0; pattern < 3; pattern++) {
                descs[d].larger = (enum staircase_larger)larger;
                struct staircase *staircase = make(&descs[d]);
                struct staircase_step step;
                uint32_t top = staircase_outcomes(staircase) - 1;
                for (uint32_t i = 0; i < 1000; i++) {
                    assert_false(staircase_done(staircase));
                    staircase_outcome(staircase, pattern == 2 ? i % 2 * top : pattern * top, &step);
                    assert_true(step.level >= descs[d].level.min && step.level <= descs[d].level.max);
                    assert_true(!isnan(step.estimate) || d < 2);
                }
                assert_true(staircase_done(staircase));
                // Those who are always right are better than those who never are.
                bool towards_max = (pattern == 0) == (larger == STAIRCASE_LARGER_EASIER);
                double end = d < 2 ? staircase_level(staircase) : step.estimate;
                if (pattern < 2)
                    assert_true(towards_max ? end > (descs[d].level.min + descs[d].level.max) / 2
                                            : end < (descs[d].level.min + descs[d].level.max) / 2);
                staircase_destroy(staircase);
            }
}

static void test_replay(void **state)
{
    (void)state;
    struct staircase_desc descs[] = {up_down("1up2down"), up_down("weighted"), quest(2), quest(3)};
    for (size_t d = 0; d < 4; d++) {
        static struct staircase_step steps[300], again;
        struct random_stream stream = random_stream(5, 910, (uint32_t)d, 0);
        struct staircase *whole = make(&descs[d]);
        for (uint32_t i = 0; i < 300; i++)
            staircase_outcome(whole, random_below(&stream, staircase_outcomes(whole)), &steps[i]);
        for (uint32_t cut = 0; cut < 300; cut += 37) { // interrupted after `cut` answers, rebuilt, gone on with
            struct staircase *rebuilt = make(&descs[d]);
            for (uint32_t i = 0; i < 300; i++) {
                if (i == cut)
                    assert_true(staircase_level(rebuilt) == steps[i].level);
                staircase_outcome(rebuilt, steps[i].outcome, &again);
                assert_memory_equal(&again.level, &steps[i].level, sizeof again.level);
                assert_memory_equal(&again.estimate, &steps[i].estimate, sizeof again.estimate);
                assert_memory_equal(&again.sd, &steps[i].sd, sizeof again.sd);
                assert_true(again.reversal == steps[i].reversal);
            }
            assert_true(staircase_level(rebuilt) == staircase_level(whole));
            staircase_destroy(rebuilt);
        }
        staircase_destroy(whole);
    }
}

static void bad(const struct staircase_desc *desc, const char *sentence)
{
    char error[256] = "";
    assert_false(staircase_check(desc, error, sizeof error));
    assert_string_equal(error, sentence);
    assert_null(staircase_create(desc));
}

// One description changed in one place. The names are macros' so that each case is a line.
#define BAD(base, change, sentence)                                                                            \
    do {                                                                                                       \
        struct staircase_desc d = base;                                                                        \
        change;                                                                                                \
        bad(&d, sentence);                                                                                     \
    } while (0)

static void test_contradictions_of_up_down(void **state)
{
    (void)state;
    struct staircase_desc good = up_down("1up2down"), weighted = up_down("weighted");
    BAD(good, d.method = NULL, "no method is given; it is 1up2down, weighted or quest_plus");
    BAD(good, d.larger = STAIRCASE_LARGER_UNSAID, "say whether larger levels are easier or harder");
    BAD(good, d.level.max = 0, "levels go from 0 to 0; min must be below max, both finite");
    BAD(good, d.level.max = (double)NAN, "levels go from 0 to nan; min must be below max, both finite");
    BAD(good, d.level.spacing = QUEST_PLUS_LOG, "levels are logarithmic; min is 0 and must be above 0");
    BAD(good, d.start = 21, "start is 21; it must lie between min 0 and max 20");
    BAD(good, d.start = (double)NAN, "start is nan; it must lie between min 0 and max 20");
    BAD(good, d.step_count = 0, "0 step sizes are given; give 1 to 16");
    BAD(good, d.step_count = 17, "17 step sizes are given; give 1 to 16");
    BAD(good, d.steps[1] = 0, "step 2 is 0; a step is above 0");
    BAD(good, d.steps[1] = (double)NAN, "step 2 is nan; a step is above 0");
    BAD(good, d.steps[0] = 30, "step 1 is 30; from min to max it is only 20");
    BAD(good, (d.level.min = 1, d.level.spacing = QUEST_PLUS_LOG),
        "step 3 is 1; on logarithmic levels a step is a factor above 1");
    BAD(good, d.trials = 0, "nothing stops it; give reversals, trials or both");
    BAD(good, (d.trials = 8, d.reversals = 8), "8 reversals cannot come in 8 trials");
    BAD(good, d.trials = 200000, "200000 trials are more than 100000");
    BAD(good, d.reversals = 3,
        "3 reversals with 3 step sizes give no estimate; it takes 2 with the last size, so at least 4");
    BAD(good, d.target = 0.5, "target is 0.5; 1up2down always goes to 0.707, weighted has a target");
    BAD(good, d.level.count = 5,
        "1up2down has no psychometric function; family, outcomes and grids are for quest_plus");
    BAD(weighted, d.target = 0, "target is 0; it is a share of right answers above 0 and below 1");
    BAD(weighted, d.target = 1, "target is 1; it is a share of right answers above 0 and below 1");
}

static void test_contradictions_of_quest_plus(void **state)
{
    (void)state;
    struct staircase_desc good = quest(2), four = quest(4);
    BAD(good, d.trials = 0, "nothing stops it; give trials");
    BAD(good, d.reversals = 8, "quest_plus has no reversals; stop it by trials");
    BAD(good, d.start = 1,
        "quest_plus chooses every level itself; start, steps and target are for up-down methods");
    BAD(good, d.model.family = NULL, "QUEST+ has no family; it is logistic, weibull, normal or gumbel");
    BAD(good, d.model.outcomes = 1, "QUEST+ has 1 outcomes; it needs at least 2");
    BAD(good, d.model.slope.count = 0, "the grid of slope is empty; give min, max and count");
    BAD(good, d.model.slope.min = -1, "the grid of slope is logarithmic; min is -1 and must be above 0");
    BAD(good, (d.model.slope.min = 0, d.model.slope.spacing = QUEST_PLUS_LINEAR),
        "the grid of slope begins at 0; slopes are above 0, whether larger is harder or easier");
    BAD(good, d.model.threshold.max = -3, "the grid of threshold has 41 values; min -2.5 must be below max -3");
    BAD(good, d.model.threshold.max = (double)INFINITY,
        "the grid of threshold goes from -2.5 to inf; both must be finite");
    BAD(good, d.model.threshold.count = 1,
        "the grid of threshold has one value but goes from -2.5 to 2.5; give it a 'count' of 2 or more");
    BAD(good, d.model.guess.min = -0.1, "the grid of guess goes from -0.1 to 0.5; it must lie between 0 and 1");
    BAD(good, d.model.lapse.max = 1.5, "the grid of lapse goes from 0 to 1.5; it must lie between 0 and 1");
    BAD(good, d.model.lapse.max = 0.5,
        "guess up to 0.5 and lapse up to 0.5 leave nothing to the level; their sum must be below 1");
    BAD(good, d.level.count = 1,
        "the grid of level has one value but goes from -3 to 3; give it a 'count' of 2 or more");
    BAD(good, d.model.family = quest_plus_find_family("weibull"),
        "levels begin at -3 and thresholds at -2.5; on a logarithmic axis (weibull) both are above 0");
    BAD(good, d.threshold = 2, "threshold 2 is not there; 2 outcomes have 1");
    BAD(good, d.model.threshold.count = 100000,
        "the grids make 1500000 parameter sets and tables of 1133 MiB; at most 64 MiB, so make them coarser");
    BAD(four, d.model.threshold.count = 2,
        "4 outcomes need 3 thresholds in order; the grid of threshold has 2 values");
    BAD(four, d.model.guess = good.model.guess, "guess is for two outcomes; leave it out with 4");
    BAD(four, (d.model.threshold.count = UINT32_MAX, d.model.outcomes = 1u << 31),
        "the grids make more parameter sets than can be counted; at most 64 MiB of tables, so make them "
        "coarser");
}

static void test_names(void **state)
{
    (void)state;
    for (size_t i = 0; staircase_methods[i]; i++)
        assert_ptr_equal(staircase_find_method(staircase_method_name(staircase_methods[i])),
                         staircase_methods[i]);
    for (size_t i = 0; quest_plus_families[i]; i++)
        assert_ptr_equal(quest_plus_find_family(quest_plus_family_name(quest_plus_families[i])),
                         quest_plus_families[i]);
    assert_null(staircase_find_method("2up1down"));
    assert_null(quest_plus_find_family(""));
    staircase_destroy(NULL);
    quest_plus_destroy(NULL);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_one_up_two_down_by_hand),
        cmocka_unit_test(test_weighted_by_hand),
        cmocka_unit_test(test_bounds),
        cmocka_unit_test(test_it_stops),
        cmocka_unit_test(test_any_answers),
        cmocka_unit_test(test_replay),
        cmocka_unit_test(test_contradictions_of_up_down),
        cmocka_unit_test(test_contradictions_of_quest_plus),
        cmocka_unit_test(test_names),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
