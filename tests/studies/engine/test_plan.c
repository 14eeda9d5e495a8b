// Every balance that DESIGN section 4 promises, over many seeds, numbers and designs; the generator against the
// published vectors; and that a plan depends on nothing else than its three keys.
#include "studies/engine/plan.h"

#include "studies/engine/random.h"
#include "tests/studies/engine/sample_design.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>

#include <cmocka.h>

// Random123's kat_vectors (Salmon et al.), philox4x32 with ten rounds.
static void test_philox_known_answers(void **state)
{
    (void)state;
    const uint32_t vectors[3][10] = {
        {0, 0, 0, 0, 0, 0, 0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8},
        {0xffffffff, 0xffffffff, 0xffffffff, 0xffffffff, 0xffffffff, 0xffffffff, 0x408f276d, 0x41c83b0e,
         0xa20bc7c6, 0x6d5451fd},
        {0x243f6a88, 0x85a308d3, 0x13198a2e, 0x03707344, 0xa4093822, 0x299f31d0, 0xd16cfe09, 0x94fdcceb,
         0x5001e420, 0x24126ea1},
    };
    for (int i = 0; i < 3; i++) {
        uint32_t out[4];
        random_philox(vectors[i], vectors[i] + 4, out);
        assert_memory_equal(out, vectors[i] + 6, sizeof out);
    }
}

static void test_below_is_even(void **state)
{
    (void)state;
    struct random_stream stream = random_stream(1, 2, 3, 4);
    uint32_t counts[7] = {0};
    for (int i = 0; i < 70000; i++)
        counts[random_below(&stream, 7)]++;
    double chi = 0;
    for (int i = 0; i < 7; i++)
        chi += pow(counts[i] - 10000.0, 2) / 10000;
    assert_true(chi < 22.46); // 0.999 quantile of chi-square with 6 degrees of freedom
}

static bool within_one(uint32_t a, uint32_t b)
{
    return a <= b + 1 && b <= a + 1;
}

static uint32_t level_of(const struct protocol_block *block, uint32_t cell, uint32_t factor)
{
    uint32_t below = 1;
    for (uint32_t f = factor + 1; f < block->factor_count; f++)
        below *= block->factors[f].level_count;
    return cell / below % block->factors[factor].level_count;
}

// Sides and first-shown options of the block's trials for which `factor` has `level` (factor -1: all) are
// within one.
static void check_group(const struct plan *plan, const struct protocol_block *block, int factor, uint32_t level)
{
    uint32_t sides[2] = {0}, first[2] = {0}, scenes[PROTOCOL_SCENES] = {0}, total = 0;
    for (uint32_t i = 0; i < plan->trial_count; i++) {
        const struct plan_trial *trial = &plan->trials[i];
        if (trial->block != 1 || (factor >= 0 && level_of(block, trial->cell, (uint32_t)factor) != level))
            continue;
        total++;
        sides[trial->test_slot]++;
        first[trial->first_shown == trial->test_slot]++;
        for (uint32_t s = 0; s < plan->protocol->scene_count; s++)
            scenes[s] += strcmp(plan->protocol->scenes[s], trial->scene) == 0;
    }
    assert_true(total > 0);
    assert_true(within_one(sides[0], sides[1]));
    assert_true(within_one(first[0], first[1]));
    for (uint32_t s = 1; s < plan->protocol->scene_count; s++)
        assert_true(within_one(scenes[0], scenes[s]));
}

static void check_participant(const struct plan *plan)
{
    const struct protocol_block *block = &plan->protocol->blocks[1];
    uint32_t pairs[4] = {0}, cells[PROTOCOL_TRIALS] = {0}, count = protocol_block_trials(block);
    assert_int_equal(plan->imbalance, 0);
    assert_int_equal(plan->trial_count, count + 2);
    check_group(plan, block, -1, 0);
    for (uint32_t f = 0; f < block->factor_count; f++)
        for (uint32_t level = 0; level < block->factors[f].level_count; level++)
            check_group(plan, block, (int)f, level);
    for (uint32_t i = 0; i < plan->trial_count; i++) {
        const struct plan_trial *trial = &plan->trials[i];
        assert_int_equal(trial->ordinal, i + 1);
        assert_true(trial->seed >> 63 == 0);
        if (trial->block != 1)
            continue;
        pairs[trial->test_slot * 2 + (trial->first_shown == trial->test_slot)]++;
        cells[trial->cell]++;
        const struct plan_condition *test = &plan->conditions[trial->option[trial->test_slot]];
        const struct plan_condition *other = &plan->conditions[trial->option[1 - (int)trial->test_slot]];
        assert_string_equal(test->mode, "time_warped");
        assert_string_equal(other->mode, "regular");
        static const char *const parameters[] = {"epsilon", "fovea_deg", "periphery_deg", "hole_decay", NULL};
        for (uint32_t f = 0; f < block->factor_count; f++)
            for (uint32_t p = 0; parameters[p]; p++)
                if (strcmp(block->factors[f].name, parameters[p]) == 0)
                    assert_true(test->values[p] ==
                                atof(block->factors[f].level[level_of(block, trial->cell, f)]));
    }
    for (uint32_t i = 0; i < 4; i++)
        for (uint32_t k = 0; k < 4; k++)
            assert_true(within_one(pairs[i], pairs[k]));
    for (uint32_t i = 0; i < count / block->repetitions; i++)
        assert_int_equal(cells[i], block->repetitions);
}

static const struct plan_trial *find(const struct plan *plan, uint32_t cell, uint32_t repetition)
{
    for (uint32_t i = 0; i < plan->trial_count; i++)
        if (plan->trials[i].block == 1 && plan->trials[i].cell == cell &&
            plan->trials[i].repetition == repetition)
            return &plan->trials[i];
    fail();
    return NULL;
}

// Over a whole group of four: every trial has each side x first-shown pair once, and with two scenes each scene
// meets both sides and both first-shown options.
static void check_group_of_four(struct plan *const plans[4])
{
    const struct protocol *protocol = plans[0]->protocol;
    const struct protocol_block *block = &protocol->blocks[1];
    for (uint32_t i = 0; i < protocol_block_trials(block); i++) {
        uint32_t seen = 0, sides[PROTOCOL_SCENES] = {0}, first[PROTOCOL_SCENES] = {0},
                 shown[PROTOCOL_SCENES] = {0};
        for (uint32_t p = 0; p < 4; p++) {
            const struct plan_trial *trial = find(plans[p], i / block->repetitions, i % block->repetitions);
            bool test_first = trial->first_shown == trial->test_slot;
            seen |= 1u << (trial->test_slot * 2 + test_first);
            for (uint32_t s = 0; s < protocol->scene_count; s++) {
                if (strcmp(protocol->scenes[s], trial->scene) != 0)
                    continue;
                shown[s]++;
                sides[s] += trial->test_slot == PLAN_SLOT_A;
                first[s] += test_first;
            }
            if (p > 0 && protocol->scene_count == 2) // each cell's scene alternates over participants
                assert_string_not_equal(
                    trial->scene, find(plans[p - 1], i / block->repetitions, i % block->repetitions)->scene);
        }
        assert_int_equal(seen, 15);
        for (uint32_t s = 0; s < 2 && protocol->scene_count == 2; s++)
            assert_true(shown[s] == 2 && sides[s] == 1 && first[s] == 1);
    }
}

// The two ratings: same scene, the one option and the other; over four participants each scene x first option
// once.
static void check_ratings(struct plan *const plans[4])
{
    uint32_t seen = 0;
    for (uint32_t p = 0; p < 4; p++) {
        const struct plan_trial *before = &plans[p]->trials[0],
                                *after = &plans[p]->trials[plans[p]->trial_count - 1];
        assert_int_equal(before->kind, PROTOCOL_RATE);
        assert_int_equal(after->kind, PROTOCOL_RATE);
        assert_string_equal(before->scene, after->scene);
        assert_true((before->test_slot == PLAN_SLOT_A) != (after->test_slot == PLAN_SLOT_A));
        assert_true(before->option[1] == -1 && after->option[1] == -1);
        const struct plan_trial *foveated = before->test_slot == PLAN_SLOT_A ? before : after;
        const struct plan_condition *condition = &plans[p]->conditions[foveated->option[0]];
        assert_string_equal(condition->mode, "time_warped");
        assert_true(condition->values[0] == 0.1 && condition->values[1] == 10);
        uint32_t scene = strcmp(before->scene, plans[p]->protocol->scenes[0]) == 0 ? 0 : 1;
        seen |= 1u << (scene * 2 + (before->test_slot == PLAN_SLOT_A));
    }
    if (plans[0]->protocol->scene_count == 2)
        assert_int_equal(seen, 15);
}

static void check_design(const char *scenes, const char *design, uint32_t seeds, uint32_t groups)
{
    char error[PROTOCOL_ERROR] = "";
    struct protocol *protocol = sample_design(scenes, design, error, sizeof error);
    assert_string_equal(error, "");
    for (uint32_t seed = 0; seed < seeds; seed++) {
        for (uint32_t group = 0; group < groups; group++) {
            struct plan *plans[4];
            for (uint32_t p = 0; p < 4; p++) {
                plans[p] = plan_create(protocol, seed * 7919u, 4 * group + p);
                assert_non_null(plans[p]);
                check_participant(plans[p]);
            }
            check_group_of_four(plans);
            check_ratings(plans);
            for (uint32_t p = 0; p < 4; p++)
                plan_destroy(plans[p]);
        }
    }
    protocol_destroy(protocol);
}

static void test_nine_decisions(void **state)
{
    (void)state;
    check_design("[atrium, town]", SAMPLE_NINE, 600, 5); // 12,000 participants
}

static void test_other_designs(void **state)
{
    (void)state;
    check_design("[atrium, town]", "  factors: {epsilon: [0.2, 0.1]}\n", 50, 2);
    check_design("[atrium]", "  factors: {epsilon: [0.2, 0.1], fovea_deg: [5, 6, 7]}\n", 50, 2);
    check_design("[atrium, town]",
                 "  factors: {epsilon: [0.2, 0.1], fovea_deg: [5, 6, 7, 8], splat: [atomic, points]}\n", 20, 2);
    check_design("[atrium, town]", "  factors: {epsilon: [0.1, 0.2, 0.3, 0.4, 0.5]}\n  repetitions: 2\n", 20,
                 2);
    check_design("[atrium]",
                 "  factors: {epsilon: [0.1, 0.2, 0.3], fovea_deg: [1, 2, 3], hole_decay: [0.1, 0.2, 0.3]}\n"
                 "  repetitions: 2\n",
                 5, 2);
}

// Order: over many participants each cell comes equally often at each place.
static void test_order_is_even(void **state)
{
    (void)state;
    char error[PROTOCOL_ERROR] = "";
    struct protocol *protocol = sample_design("[atrium, town]", SAMPLE_NINE, error, sizeof error);
    uint32_t at[9][9] = {{0}};
    for (uint32_t number = 0; number < 3600; number++) {
        struct plan *plan = plan_create(protocol, 5, number);
        for (uint32_t i = 1; i < 10; i++)
            at[plan->trials[i].cell][i - 1]++;
        plan_destroy(plan);
    }
    double chi = 0;
    for (int i = 0; i < 9; i++)
        for (int k = 0; k < 9; k++)
            chi += pow(at[i][k] - 400.0, 2) / 400;
    assert_true(chi < 104.72); // 0.999 quantile of chi-square with (9 - 1)^2 = 64 degrees of freedom
    protocol_destroy(protocol);
}

static void test_fixed_order_and_listed_trials(void **state)
{
    (void)state;
    char error[PROTOCOL_ERROR] = "";
    struct protocol *protocol = sample_design("[atrium, town]",
                                              "  order: fixed\n  repetitions: 2\n  trials:\n"
                                              "  - {name: x, scene: town, parameters: {f: {epsilon: 0.5}}}\n"
                                              "  - {settings: {camera: still}}\n",
                                              error, sizeof error);
    assert_string_equal(error, "");
    for (uint32_t number = 0; number < 100; number++) {
        struct plan *plan = plan_create(protocol, 1, number);
        assert_int_equal(plan->trial_count, 6);
        for (uint32_t i = 0; i < 4; i++)
            assert_true(plan->trials[1 + i].cell == i % 2 && plan->trials[1 + i].repetition == i / 2);
        assert_string_equal(plan->trials[1].factors, "{\"trial\":\"x\"}");
        assert_string_equal(plan->trials[2].factors, "{\"trial\":2}");
        assert_string_equal(plan->trials[1].scene, "town");
        assert_non_null(strstr(plan->trials[2].settings, "\"still\""));
        assert_true(plan->conditions[plan->trials[1].option[plan->trials[1].test_slot]].values[0] == 0.5);
        plan_destroy(plan);
    }
    protocol_destroy(protocol);
}

static void test_a_plan_depends_on_its_keys_only(void **state)
{
    (void)state;
    char error[PROTOCOL_ERROR] = "", first[SHA256_HEX], again[SHA256_HEX], other[SHA256_HEX];
    struct protocol *protocol = sample_design("[atrium, town]", SAMPLE_NINE, error, sizeof error);
    struct plan *a = plan_create(protocol, 3, 8), *b = plan_create(protocol, 4, 8),
                *c = plan_create(protocol, 3, 9);
    plan_hash(a, first);
    plan_hash(b, other);
    assert_string_not_equal(first, other);
    plan_hash(c, other);
    assert_string_not_equal(first, other);
    plan_destroy(a);
    plan_destroy(b);
    plan_destroy(c);
    a = plan_create(protocol, 3, 8);
    plan_hash(a, again);
    assert_string_equal(first, again);
    plan_destroy(a);
    protocol_destroy(protocol);
}

static void test_tables_and_counts(void **state)
{
    (void)state;
    char error[PROTOCOL_ERROR] = "";
    struct protocol *protocol = sample_design("[atrium, town]", SAMPLE_NINE, error, sizeof error);
    struct plan *plan = plan_create(protocol, 3, 8);
    char *text = plan_table_text(plan), *json = plan_table_json(plan),
         *counts = plan_counts_json(protocol, 3, 0, 8), *counts_text = plan_counts_text(protocol, 3, 0, 8);
    assert_non_null(strstr(text, "participant number 9, seed 3"));
    uint32_t lines = 0, cells = 0;
    for (const char *at = text; (at = strstr(at, "main ")); at++)
        lines++;
    assert_int_equal(lines, 9);
    assert_non_null(strstr(json, "\"ordinal\":11,\"block\":\"after\",\"kind\":\"rate\""));
    for (const char *at = counts; (at = strstr(at, "\"trials\":8,\"test_a\":4,\"test_b\":4,\"test_first\":4,"
                                                   "\"scenes\":{\"atrium\":4,\"town\":4}"));
         at++)
        cells++;
    assert_int_equal(cells, 9);
    assert_non_null(strstr(counts_text, "8 participants from number 1"));
    free(text);
    free(json);
    free(counts);
    free(counts_text);
    plan_destroy(plan);
    protocol_destroy(protocol);
}

// Without its texts a plan is the same plan.
static void test_bare(void **state)
{
    (void)state;
    char error[PROTOCOL_ERROR] = "";
    struct protocol *protocol = sample_design("[atrium, town]", SAMPLE_NINE, error, sizeof error);
    for (uint32_t number = 0; number < 40; number++) {
        struct plan *whole = plan_create(protocol, 3, number), *bare = plan_create_bare(protocol, 3, number);
        assert_int_equal(whole->trial_count, bare->trial_count);
        assert_int_equal(whole->condition_count, bare->condition_count);
        for (uint32_t i = 0; i < whole->trial_count; i++) {
            const struct plan_trial *a = &whole->trials[i], *b = &bare->trials[i];
            assert_true(a->settings[0] && !b->settings[0]);
            assert_string_equal(a->factors, b->factors);
            assert_string_equal(a->scene, b->scene);
            assert_memory_equal(a->option, b->option, sizeof a->option);
            assert_true(a->block == b->block && a->cell == b->cell && a->repetition == b->repetition &&
                        a->role == b->role && a->test_slot == b->test_slot &&
                        a->first_shown == b->first_shown && a->seed == b->seed);
        }
        plan_destroy(whole);
        plan_destroy(bare);
    }
    protocol_destroy(protocol);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_philox_known_answers),
        cmocka_unit_test(test_below_is_even),
        cmocka_unit_test(test_nine_decisions),
        cmocka_unit_test(test_other_designs),
        cmocka_unit_test(test_order_is_even),
        cmocka_unit_test(test_fixed_order_and_listed_trials),
        cmocka_unit_test(test_a_plan_depends_on_its_keys_only),
        cmocka_unit_test(test_tables_and_counts),
        cmocka_unit_test(test_bare),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
