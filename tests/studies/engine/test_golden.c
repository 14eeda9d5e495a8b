// Plans of frozen protocols keep their hashes on every machine and compiler. `test_studies_golden --write`
// prints the table; it may change only together with the tag in draw.c.
#include "studies/engine/plan.h"

#include "tests/studies/engine/sample_design.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>

#include <cmocka.h>

enum { DESIGNS = 12, SEEDS = 10, NUMBERS = 12 };

static struct protocol *design(int index)
{
    static const char *const scenes[DESIGNS] = {
        "[atrium, town]",
        "[atrium]",
        "[atrium, town, yard]",
        "[atrium, town]",
        "[atrium, {name: bistro, stand_in: town, labels: {type: real}}]",
        "[atrium, town]",
        "[atrium, town, yard]",
        "[atrium]",
        "[atrium, town]",
        "[atrium, town, yard]",
        "[atrium, town]",
        "[atrium, town]"};
    static const char *const block[DESIGNS] = {
        SAMPLE_NINE,
        "  factors: {epsilon: [0.2, 0.1]}\n  repetitions: 3\n",
        "  factors: {epsilon: [0.2, 0.1, 0.05, 0.025], splat: [atomic, points]}\n",
        "  factors: {epsilon: [0.2, 0.1, 0.05, 0.025]}\n  repetitions: 2\n  order: latin\n",
        "  factors: {epsilon: [0.2, 0.1, 0.05]}\n  repetitions: 2\n  order: latin\n",
        "  factors:\n    epsilon: [0.2, 0.1]\n    group: {between: yes, levels: {a: {}, b: {settings: {camera: "
        "still}}}}\n"
        "  repetitions: 4\n  order: block_random\n",
        "  factors: {scene: {scenes: all}, epsilon: [0.2, 0.1]}\n  null: 3\n  catch: {count: 2, option: f, "
        "parameters: {f: {epsilon: 1}}}\n",
        "  order: fixed\n  trials: [{name: one, labels: {test: I}}, {options: [r, f]}, {role: 'null'}]\n",
        "  factors: {fixation: {levels: {cross: {settings: {fixation: cross, foveate: target}}, moving: "
        "{settings: "
        "{fixation: moving}}}}}\n  repetitions: 2\n  settings: {spheres: [2, 6], count: n}\n",
        "  scene_use: random\n  factors: {epsilon: [0.2, 0.1], which: {options: [f]}}\n  null: 2\n"
        "  catch: {count: 2, option: f, parameters: {f: {epsilon: 1}}}\n",
        "  trials: [{name: one, role: 'null'}, {name: two, role: catch}, {name: three, scene: town}, {}, {}]\n",
        "  order: block_random\n  repetitions: 2\n  trials: [{role: 'null'}, {}, {scene: town}]\n"};
    char error[PROTOCOL_ERROR] = "";
    struct protocol *protocol = sample_design(scenes[index], block[index], error, sizeof error);
    if (!protocol)
        fprintf(stderr, "%s\n", error);
    return protocol;
}

static void line(const struct protocol *protocol, int index, uint32_t seed_index, uint32_t number, char *out,
                 size_t size)
{
    const uint64_t seed = seed_index * UINT64_C(1000000007) * seed_index; // small ones and ones beyond 32 bits
    char hash[SHA256_HEX] = "";
    struct plan *plan = plan_create(protocol, seed, number);
    if (plan)
        plan_hash(plan, hash);
    plan_destroy(plan);
    snprintf(out, size, "%d %llu %u %s\n", index, (unsigned long long)seed, number, hash);
}

static void test_golden_hashes(void **state)
{
    (void)state;
    FILE *file = fopen(SOURCE_DIR "/tests/studies/engine/golden_plans.txt", "r");
    assert_non_null(file);
    for (int index = 0; index < DESIGNS; index++) {
        struct protocol *protocol = design(index);
        assert_non_null(protocol);
        for (uint32_t i = 0; i < SEEDS * NUMBERS; i++) {
            char wanted[128], got[128];
            assert_non_null(fgets(wanted, sizeof wanted, file));
            line(protocol, index, i / NUMBERS, i % NUMBERS, got, sizeof got);
            assert_string_equal(got, wanted);
        }
        protocol_destroy(protocol);
    }
    fclose(file);
}

static int write_table(void)
{
    for (int index = 0; index < DESIGNS; index++) {
        struct protocol *protocol = design(index);
        for (uint32_t i = 0; protocol && i < SEEDS * NUMBERS; i++) {
            char got[128];
            line(protocol, index, i / NUMBERS, i % NUMBERS, got, sizeof got);
            fputs(got, stdout);
        }
        protocol_destroy(protocol);
    }
    return 0;
}

int main(int argc, char **argv)
{
    if (argc == 2 && strcmp(argv[1], "--write") == 0)
        return write_table();
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_golden_hashes)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
