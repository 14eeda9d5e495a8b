// Laws that every plan of every protocol obeys, over many random protocols. FOVSTUDY_PROPERTIES sets how many;
// a failure prints the protocol and the participant.
#include "studies/engine/plan.h"

#include "studies/engine/draw.h"
#include "tests/studies/engine/random_protocol.h"
#include "tests/studies/protocol/sample_catalogue.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

enum { PROTOCOLS = 20000, ROWS = 64 }; // ROWS: larger Latin groups are not looked at

// What is being looked at, for the message.
struct look {
    const char *text;
    const struct protocol *protocol;
    uint32_t number; // of the participant
    uint32_t block;
};

static void law(const struct look *look, bool holds, const char *what)
{
    if (holds)
        return;
    print_error("%s\nparticipant %u, block %u: %s\n", look->text, look->number, look->block, what);
    struct plan *plan = plan_create(look->protocol, look->protocol->seed, look->number);
    char *table = plan ? plan_table_text(plan) : NULL;
    print_error("%s\n", table ? table : "out of memory");
    free(table);
    plan_destroy(plan);
    fail();
}

static bool within_one(uint32_t a, uint32_t b)
{
    return a <= b + 1 && b <= a + 1;
}

static bool is_drawn_rating(const struct protocol_block *block)
{
    return block->kind == PROTOCOL_RATE && block->option_count == 2;
}

static const struct protocol_cell *cell_of(const struct protocol_block *block, const struct plan_trial *trial)
{
    return trial->cell < block->cell_count ? &block->cells[trial->cell]
                                           : &block->extras[trial->cell - block->cell_count].cell;
}

static bool is_extra(const struct protocol_block *block, const struct plan_trial *trial)
{
    return trial->cell >= block->cell_count;
}

// The trials of one block, in their order.
struct part {
    const struct plan_trial *trials;
    uint32_t count;
};

static struct part part_of(const struct plan *plan, uint32_t block)
{
    struct part part = {plan->trials, 0};
    uint32_t i = 0;
    while (i < plan->trial_count && plan->trials[i].block != block)
        i++;
    part.trials = plan->trials + i;
    while (i + part.count < plan->trial_count && part.trials[part.count].block == block)
        part.count++;
    return part;
}

// Every cell of the participant's group in every repetition once; null and catch trials as many as said.
static void check_counts(const struct look *look, const struct protocol_block *block, const struct part *part)
{
    uint32_t cells = block->cell_count, extras[2] = {0};
    static bool seen[PROTOCOL_TRIALS][PROTOCOL_TRIALS];
    for (uint32_t f = 0; f < block->factor_count; f++)
        cells /= block->factors[f].between ? block->factors[f].level_count : 1;
    law(look, part->count == cells * block->repetitions + block->extras[0].count + block->extras[1].count,
        "number of trials");
    for (uint32_t i = 0; i < part->count; i++)
        for (uint32_t k = 0; k < block->repetitions; k++)
            seen[part->trials[i].cell < block->cell_count ? part->trials[i].cell : 0][k] = false;
    for (uint32_t i = 0; i < part->count; i++) {
        const struct plan_trial *trial = &part->trials[i];
        if (is_extra(block, trial)) {
            extras[trial->cell - block->cell_count]++;
            continue;
        }
        law(look, trial->repetition < block->repetitions, "repetition");
        law(look, !seen[trial->cell][trial->repetition], "a cell twice in a repetition");
        seen[trial->cell][trial->repetition] = true;
    }
    law(look, extras[0] == block->extras[0].count && extras[1] == block->extras[1].count,
        "number of null and catch trials");
}

// People have one level of a factor between them, in all blocks.
static void check_between(const struct look *look, const struct plan *plan)
{
    const struct protocol *protocol = look->protocol;
    for (uint32_t b = 0; b < protocol->block_count; b++) {
        const struct protocol_block *block = &protocol->blocks[b];
        for (uint32_t f = 0; f < block->factor_count; f++) {
            const struct protocol_factor *factor = &block->factors[f];
            int level = -1;
            for (uint32_t i = 0; factor->between && i < plan->trial_count; i++) {
                const struct plan_trial *trial = &plan->trials[i];
                const struct protocol_block *other = &protocol->blocks[trial->block];
                for (uint32_t g = 0; g < other->factor_count && !is_extra(other, trial); g++) {
                    if (strcmp(other->factors[g].name, factor->name) != 0)
                        continue;
                    int mine = other->cells[trial->cell].level[g];
                    law(look, level < 0 || level == mine, "two levels of a factor between people");
                    level = mine;
                }
            }
        }
    }
}

static bool same_option(const struct plan_condition *condition, const struct protocol_option *option)
{
    return condition->mode_index == option->mode &&
           memcmp(condition->values, option->values, sizeof option->values) == 0;
}

// What a factor over a parameter says is what is shown.
static void check_levels(const struct look *look, const struct protocol_block *block,
                         const struct protocol_cell *cell, const struct plan_condition *tested)
{
    static const char *const parameters[] = {"epsilon", "fovea_deg", NULL, "hole_decay", NULL, NULL};
    for (uint32_t f = 0; f < block->factor_count; f++)
        for (uint32_t p = 0; p < 6; p++)
            if (parameters[p] && strcmp(block->factors[f].name, parameters[p]) == 0) {
                double wanted = strtod(block->factors[f].level[cell->level[f]], NULL);
                law(look, !(tested->values[p] < wanted || tested->values[p] > wanted),
                    "a level is not what is shown");
            }
}

static void check_options(const struct look *look, const struct plan *plan, const struct protocol_block *block,
                          const struct part *part)
{
    bool pair = block->kind != PROTOCOL_RATE && block->kind != PROTOCOL_TASK;
    for (uint32_t i = 0; i < part->count; i++) {
        const struct plan_trial *trial = &part->trials[i];
        const struct protocol_cell *cell = cell_of(block, trial);
        law(look, trial->kind == block->kind && trial->role == cell->role, "kind or role");
        if (!pair) {
            law(look,
                trial->option[1] == -1 && trial->test_slot == PLAN_SLOT_A &&
                    same_option(&plan->conditions[trial->option[0]], &cell->option[0]),
                "the option shown");
            check_levels(look, block, cell, &plan->conditions[trial->option[0]]);
            continue;
        }
        law(look, trial->test_slot < PLAN_SLOT_NONE && trial->first_shown < PLAN_SLOT_NONE, "slots");
        law(look, block->kind != PROTOCOL_SEQUENTIAL || trial->first_shown == PLAN_SLOT_A,
            "one after the other begins with A");
        const struct plan_condition *tested = &plan->conditions[trial->option[trial->test_slot]],
                                    *other = &plan->conditions[trial->option[1 - (int)trial->test_slot]];
        law(look, same_option(tested, &cell->option[0]) && same_option(other, &cell->option[1]),
            "the options shown");
        law(look, (trial->role == PROTOCOL_NULL) == (tested == other), "null trials show one option twice");
        if (!is_extra(block, trial) && trial->role != PROTOCOL_NULL)
            check_levels(look, block, cell, tested);
    }
}

// Sides and first-shown options of those trials for which `factor` has `level` (-1: all).
static void count_pairs(const struct protocol_block *block, const struct part *part, int factor, uint32_t level,
                        uint32_t sides[2], uint32_t first[2])
{
    sides[0] = sides[1] = first[0] = first[1] = 0;
    for (uint32_t i = 0; i < part->count; i++) {
        const struct plan_trial *trial = &part->trials[i];
        if (is_extra(block, trial) || (factor >= 0 && block->cells[trial->cell].level[factor] != level))
            continue;
        sides[trial->test_slot]++;
        first[trial->first_shown == trial->test_slot]++;
    }
}

static void check_sides(const struct look *look, const struct plan *plan, const struct protocol_block *block,
                        const struct part *part)
{
    for (int f = -1; f < (int)block->factor_count; f++) {
        for (uint32_t level = 0; level < (f < 0 ? 1 : block->factors[f].level_count); level++) {
            uint32_t sides[2], first[2];
            count_pairs(block, part, f, level, sides, first);
            if (f >= 0 && block->factors[f].between)
                continue;
            bool even = within_one(sides[0], sides[1]) &&
                        (block->kind == PROTOCOL_SEQUENTIAL || within_one(first[0], first[1]));
            law(look, even || plan->imbalance > 0, "sides or first-shown options");
        }
    }
    for (uint32_t e = 0; e < 2; e++) { // null trials among themselves, and catch trials
        uint32_t sides[2] = {0}, first[2] = {0};
        for (uint32_t i = 0; i < part->count; i++) {
            if (part->trials[i].cell != block->cell_count + e)
                continue;
            sides[part->trials[i].test_slot]++;
            first[part->trials[i].first_shown == part->trials[i].test_slot]++;
        }
        law(look, within_one(sides[0], sides[1]), "sides of null or catch trials");
        law(look, block->kind == PROTOCOL_SEQUENTIAL || within_one(first[0], first[1]),
            "first-shown options of null or catch trials");
    }
}

static uint32_t scene_index(const struct protocol *protocol, const char *scene)
{
    uint32_t i = 0;
    while (i < protocol->scene_count && strcmp(protocol->scenes[i], scene) != 0)
        i++;
    return i;
}

static void check_scenes(const struct look *look, const struct plan *plan, const struct protocol_block *block,
                         const struct part *part)
{
    uint32_t count[PROTOCOL_SCENES] = {0}, drawn = UINT32_MAX;
    for (uint32_t i = 0; i < part->count; i++) {
        const struct protocol_cell *cell = cell_of(block, &part->trials[i]);
        uint32_t scene = scene_index(look->protocol, part->trials[i].scene), k = 0;
        if (cell->scene >= 0) {
            law(look, scene == (uint32_t)cell->scene, "the scene that the cell names");
            continue;
        }
        while (k < block->scene_count && block->scenes[k] != scene)
            k++;
        law(look, k < block->scene_count, "a scene of the block");
        law(look, block->scene_use == PROTOCOL_ALTERNATE || drawn == UINT32_MAX || drawn == scene,
            "one drawn scene for the whole block");
        drawn = scene;
        if (!is_extra(block, &part->trials[i]))
            count[k]++;
    }
    for (uint32_t i = 0; i < block->scene_count && block->scene_use == PROTOCOL_ALTERNATE; i++)
        law(look, within_one(count[0], count[i]) || plan->imbalance > 0, "scenes");
    for (uint32_t i = 0; i < block->scene_count && block->scene_use == PROTOCOL_ALTERNATE; i++)
        for (uint32_t k = 0; k < i; k++)
            law(look, within_one(count[k], count[i]) || plan->imbalance > 0, "scenes");
}

// Null and catch trials are never first, unless there is nothing else or the order is the protocol's own.
static void check_first(const struct look *look, const struct protocol_block *block, const struct part *part)
{
    bool others = false;
    for (uint32_t i = 0; i < part->count; i++)
        others = others || (!is_extra(block, &part->trials[i]) && part->trials[i].role != PROTOCOL_NULL &&
                            part->trials[i].role != PROTOCOL_CATCH);
    const struct plan_trial *first = &part->trials[0];
    law(look, !is_extra(block, first), "a null or catch trial comes first");
    bool shuffled = block->order == PROTOCOL_ORDER_RANDOM ||
                    (block->order == PROTOCOL_ORDER_BLOCK_RANDOM && block->kind != PROTOCOL_STAIRCASE);
    law(look, !shuffled || !others || (first->role != PROTOCOL_NULL && first->role != PROTOCOL_CATCH),
        "a listed null or catch trial comes first");
}

static void check_order(const struct look *look, const struct protocol_block *block, const struct part *part)
{
    uint32_t cells = 0, place = 0, last = 0;
    for (uint32_t i = 0; i < part->count; i++)
        cells += !is_extra(block, &part->trials[i]);
    cells /= block->repetitions;
    for (uint32_t i = 0; i < part->count; i++) {
        const struct plan_trial *trial = &part->trials[i];
        law(look, trial->break_before == (block->break_every > 0 && i > 0 && i % block->break_every == 0),
            "breaks");
        if (is_extra(block, trial))
            continue;
        law(look, block->order == PROTOCOL_ORDER_RANDOM || trial->repetition == place / cells,
            "repetition after repetition");
        law(look, block->order != PROTOCOL_ORDER_FIXED || place % cells == 0 || trial->cell > last,
            "as listed");
        last = trial->cell;
        place++;
    }
}

static void check_rating(const struct look *look, const struct plan *plan, const struct protocol_block *block,
                         const struct part *part)
{
    law(look, part->count == 1, "one rating");
    const struct plan_trial *trial = &part->trials[0];
    uint32_t option = trial->test_slot == PLAN_SLOT_A ? 0 : 1;
    law(look, same_option(&plan->conditions[trial->option[0]], &block->cells[0].option[option]),
        "the option rated");
    if (block->complement_of < 0)
        return;
    struct part earlier = part_of(plan, (uint32_t)block->complement_of);
    law(look, strcmp(earlier.trials[0].scene, trial->scene) == 0, "a complement's scene");
    law(look, earlier.trials[0].test_slot != trial->test_slot, "a complement's option");
}

static void check_participant(struct look *look, const struct plan *plan)
{
    const struct protocol *protocol = look->protocol;
    bool factorials = true;
    look->number = plan->number;
    for (uint32_t b = 0; b < protocol->block_count; b++) {
        const struct protocol_block *block = &protocol->blocks[b];
        struct part part = part_of(plan, b);
        look->block = b;
        factorials = factorials && !block->listed;
        if (is_drawn_rating(block)) {
            check_rating(look, plan, block, &part);
            continue;
        }
        check_counts(look, block, &part);
        check_options(look, plan, block, &part);
        if (block->kind != PROTOCOL_RATE && block->kind != PROTOCOL_TASK)
            check_sides(look, plan, block, &part);
        check_scenes(look, plan, block, &part);
        check_first(look, block, &part);
        check_order(look, block, &part);
    }
    check_between(look, plan);
    law(look, plan->imbalance == 0 || !factorials, "every full factorial can be balanced");
    for (uint32_t i = 0; i < plan->trial_count; i++)
        law(look, plan->trials[i].ordinal == i + 1, "ordinals");
}

// The number of the participant who is the rank-th of a group; those before are known to be.
static uint32_t number_of(const struct protocol *protocol, uint32_t groups, uint32_t group, uint32_t rank)
{
    for (uint32_t i = 0; i < groups; i++)
        if (draw_person(protocol, protocol->seed, groups * rank + i).group == group)
            return groups * rank + i;
    fail_msg("nobody of group %u is among %u people", group, groups);
    return 0;
}

static const struct plan_trial *find(const struct part *part, uint32_t cell, uint32_t repetition)
{
    for (uint32_t i = 0; i < part->count; i++)
        if (part->trials[i].cell == cell && part->trials[i].repetition == repetition)
            return &part->trials[i];
    return NULL;
}

// Four in a row of one group: each trial has every side x first-shown pair once; its scene, unless named, steps
// through the list.
static void check_four(struct look *look, uint32_t group, uint32_t four)
{
    const struct protocol *protocol = look->protocol;
    uint32_t groups = protocol_groups(protocol);
    struct plan *plans[4];
    for (uint32_t p = 0; p < 4; p++) {
        plans[p] = plan_create(protocol, protocol->seed, number_of(protocol, groups, group, 4 * four + p));
        assert_non_null(plans[p]);
        look->number = plans[p]->number;
        law(look, plans[p]->group == group, "the group of the plan");
    }
    for (uint32_t b = 0; b < protocol->block_count; b++) {
        const struct protocol_block *block = &protocol->blocks[b];
        struct part parts[4];
        look->block = b;
        for (uint32_t p = 0; p < 4; p++)
            parts[p] = part_of(plans[p], b);
        for (uint32_t i = 0; i < parts[0].count && !is_drawn_rating(block); i++) {
            const struct plan_trial *one = &parts[0].trials[i];
            uint32_t pairs = 0, sides = 0;
            for (uint32_t p = 0; p < 4; p++) {
                const struct plan_trial *same = find(&parts[p], one->cell, one->repetition);
                law(look, same != NULL, "the same trials for a whole group");
                pairs |= 1u << (2 * (same->test_slot == PLAN_SLOT_A) + (same->first_shown == same->test_slot));
                sides += same->test_slot == PLAN_SLOT_A;
                uint32_t was = scene_index(protocol, one->scene), now = scene_index(protocol, same->scene),
                         k = 0;
                while (block->scenes[k] != was && k < block->scene_count)
                    k++;
                bool steps = cell_of(block, one)->scene < 0 && block->scene_use == PROTOCOL_ALTERNATE;
                law(look, !steps || now == block->scenes[(k + p) % block->scene_count],
                    "scenes step from participant to participant");
            }
            if (block->kind == PROTOCOL_RATE || block->kind == PROTOCOL_TASK)
                continue;
            law(look, sides == 2, "sides over four participants");
            law(look, pairs == 15 || block->kind == PROTOCOL_SEQUENTIAL, "four reflections");
        }
    }
    for (uint32_t p = 0; p < 4; p++)
        plan_destroy(plans[p]);
}

// A run of as many people as there are groups has one of each.
static void check_run(struct look *look, uint32_t run)
{
    uint32_t groups = protocol_groups(look->protocol), seen[PROTOCOL_GROUPS] = {0};
    for (uint32_t i = 0; i < groups; i++) {
        struct plan *plan = plan_create(look->protocol, look->protocol->seed, run * groups + i);
        assert_non_null(plan);
        look->number = plan->number;
        law(look, plan->group < groups && seen[plan->group]++ == 0, "each group once in a run");
        plan_destroy(plan);
    }
}

struct latin {
    uint32_t follows[32][32], at[32][32]; // cell after cell; cell at place
};

static void count_rows(const struct protocol_block *block, const struct part *part, uint32_t repetition,
                       struct latin *latin)
{
    uint32_t before = UINT32_MAX, place = 0;
    for (uint32_t i = 0; i < part->count; i++) {
        const struct plan_trial *trial = &part->trials[i];
        if (is_extra(block, trial) || trial->repetition != repetition)
            continue;
        if (before != UINT32_MAX)
            latin->follows[before][trial->cell]++;
        latin->at[place++][trial->cell]++;
        before = trial->cell;
    }
}

// Over a whole group of rows each cell follows each other one equally often and is as often at each place.
static void check_latin(struct look *look, uint32_t b, uint32_t group, uint32_t rows_index)
{
    const struct protocol *protocol = look->protocol;
    const struct protocol_block *block = &protocol->blocks[b];
    uint32_t cells = protocol_block_cells(block), rows = cells % 2 ? 2 * cells : cells;
    uint32_t groups = protocol_groups(protocol), mine[32], count = 0;
    struct latin latin[3] = {0};
    if (rows > ROWS || block->cell_count > 32 || block->repetitions > 3)
        return;
    look->block = b;
    for (uint32_t row = 0; row < rows; row++) {
        uint32_t number = number_of(protocol, groups, group, rows_index * rows + row);
        struct plan *plan = plan_create(protocol, protocol->seed, number);
        assert_non_null(plan);
        struct part part = part_of(plan, b);
        look->number = number;
        for (uint32_t r = 0; r < block->repetitions; r++)
            count_rows(block, &part, r, &latin[r]);
        for (uint32_t i = 0; i < part.count && row == 0; i++)
            if (!is_extra(block, &part.trials[i]) && part.trials[i].repetition == 0)
                mine[count++] = part.trials[i].cell;
        plan_destroy(plan);
    }
    for (uint32_t r = 0; r < block->repetitions; r++)
        for (uint32_t i = 0; i < count; i++)
            for (uint32_t k = 0; k < count; k++) {
                law(look, latin[r].at[i][mine[k]] == rows / cells, "places in Latin squares");
                law(look, i == k || latin[r].follows[mine[i]][mine[k]] == rows / cells, "carry-over");
            }
}

// One protocol, by turns: a participant anywhere, four in a row, a run of groups, a group of Latin rows.
static void check_protocol(uint32_t seed)
{
    static char text[RANDOM_PROTOCOL];
    char error[PROTOCOL_ERROR] = "";
    random_protocol(seed, text, sizeof text);
    struct protocol *protocol =
        protocol_parse("random", text, strlen(text), sample_catalogue(), error, sizeof error);
    if (!protocol)
        fail_msg("%s\n%s", text, error);
    uint32_t groups = protocol_groups(protocol), someone = seed * UINT32_C(2654435761) >> 12;
    struct look look = {.text = text, .protocol = protocol};
    struct plan *plan = plan_create(protocol, protocol->seed, someone);
    assert_non_null(plan);
    check_participant(&look, plan);
    plan_destroy(plan);
    if (seed % 4 == 1)
        check_four(&look, seed / 4 % groups, seed / 16);
    if (seed % 4 == 2 && groups > 1)
        check_run(&look, seed);
    for (uint32_t b = 0; b < protocol->block_count && seed % 4 == 3; b++)
        if (protocol->blocks[b].order == PROTOCOL_ORDER_LATIN && !is_drawn_rating(&protocol->blocks[b]))
            check_latin(&look, b, seed / 4 % groups, seed / 64);
    protocol_destroy(protocol);
}

static void test_laws_of_plans(void **state)
{
    (void)state;
    const char *wanted = getenv("FOVSTUDY_PROPERTIES");
    uint32_t count = wanted ? (uint32_t)strtoul(wanted, NULL, 10) : PROTOCOLS;
    for (uint32_t seed = 0; seed < count; seed++)
        check_protocol(seed);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_laws_of_plans)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
