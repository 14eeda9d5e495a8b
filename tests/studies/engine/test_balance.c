// Random full factorials: what DESIGN section 4 promises for all of them holds in every one.
#include "studies/engine/plan.h"

#include "tests/studies/engine/sample_design.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>

#include <cmocka.h>

static uint32_t next_random(uint32_t *state, uint32_t n)
{
    *state = *state * 1664525u + 1013904223u; // Numerical Recipes' generator, not the one under test
    return (*state >> 8) % n;
}

// One to four factors of one to six levels, at most about 400 trials.
static void random_design(uint32_t *state, char *out, size_t size)
{
    static const char *const parameters[] = {"epsilon", "fovea_deg", "periphery_deg", "hole_decay"};
    uint32_t factors = 1 + next_random(state, 4), cells = 1;
    int used = snprintf(out, size, "  factors: {");
    for (uint32_t f = 0; f < factors; f++) {
        uint32_t levels = 1 + next_random(state, cells > 32 ? 2 : 6);
        cells *= levels;
        used += snprintf(out + used, size - (size_t)used, "%s%s: [", f ? ", " : "", parameters[f]);
        for (uint32_t level = 0; level < levels; level++)
            used += snprintf(out + used, size - (size_t)used, "%s%g", level ? ", " : "", 0.01 * (level + 1));
        used += snprintf(out + used, size - (size_t)used, "]");
    }
    snprintf(out + used, size - (size_t)used, "}\n  repetitions: %u\n",
             1 + next_random(state, cells > 100 ? 1 : 3));
}

static void within_one(const uint32_t *counts, uint32_t classes)
{
    for (uint32_t i = 0; i < classes; i++)
        for (uint32_t k = 0; k < classes; k++)
            assert_true(counts[i] <= counts[k] + 1);
}

static void check(const struct plan *plan)
{
    const struct protocol_block *block = &plan->protocol->blocks[1];
    uint32_t scenes[PROTOCOL_SCENES] = {0}, cells[PROTOCOL_TRIALS] = {0};
    assert_int_equal(plan->imbalance, 0);
    for (int f = -1; f < (int)block->factor_count; f++) {
        uint32_t sides[PROTOCOL_LEVELS][2] = {{0}}, first[PROTOCOL_LEVELS][2] = {{0}};
        for (uint32_t i = 0; i < plan->trial_count; i++) {
            const struct plan_trial *trial = &plan->trials[i];
            if (trial->block != 1)
                continue;
            uint32_t level = 0;
            if (f >= 0) { // the level by its value, as it is shown
                static const char *const parameters[] = {"epsilon", "fovea_deg", "periphery_deg", "hole_decay"};
                const struct protocol_factor *factor = &block->factors[f];
                uint32_t parameter = 0;
                while (strcmp(parameters[parameter], factor->name) != 0)
                    assert_true(++parameter < 4);
                double value = plan->conditions[trial->option[trial->test_slot]].values[parameter];
                while (atof(factor->level[level]) < value || atof(factor->level[level]) > value)
                    assert_true(++level < factor->level_count);
            } else {
                cells[trial->cell]++;
                for (uint32_t s = 0; s < plan->protocol->scene_count; s++)
                    scenes[s] += strcmp(plan->protocol->scenes[s], trial->scene) == 0;
            }
            sides[level][trial->test_slot]++;
            first[level][trial->first_shown == trial->test_slot]++;
        }
        for (uint32_t level = 0; level < PROTOCOL_LEVELS; level++) {
            within_one(sides[level], 2);
            within_one(first[level], 2);
        }
    }
    within_one(scenes, plan->protocol->scene_count);
    for (uint32_t i = 0; i < protocol_block_trials(block) / block->repetitions; i++)
        assert_int_equal(cells[i], block->repetitions);
}

static void test_random_factorials(void **state)
{
    (void)state;
    static const char *const scenes[] = {"[atrium]", "[atrium, town]", "[atrium, town, yard]"};
    uint32_t random = 1;
    for (int i = 0; i < 150; i++) {
        char design[1024], error[PROTOCOL_ERROR] = "";
        random_design(&random, design, sizeof design);
        struct protocol *protocol = sample_design(scenes[i % 3], design, error, sizeof error);
        assert_string_equal(error, "");
        struct plan *plan = plan_create(protocol, (uint64_t)i, next_random(&random, 1000));
        assert_non_null(plan);
        check(plan);
        plan_destroy(plan);
        protocol_destroy(protocol);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_random_factorials)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
