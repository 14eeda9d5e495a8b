#include "studies/engine/balance.h"

#include <string.h>

enum {
    BALANCE_SHUFFLES =
        4096, // for blocks of at most BALANCE_SHORT trials; longer ones hardly come out right by chance
    BALANCE_SHORT = 16,
    BALANCE_STARTS = 5,  // the last one diagonal
    BALANCE_STEPS = 200, // per trial and start
    BALANCE_CLASSES = PROTOCOL_SCENES,
    BALANCE_GROUPS = BALANCE_MEMBERSHIPS * PROTOCOL_TRIALS
};

// An assignment with its counts, so that a step costs only what it touches.
struct balance {
    const struct balance_design *design;
    uint32_t classes; // 0: pairs
    uint32_t *values;
    uint32_t cost;
    uint16_t size[BALANCE_GROUPS];
    uint16_t count[BALANCE_GROUPS][BALANCE_CLASSES];
};

void balance_group(struct balance_design *design, const uint32_t *key, uint32_t count, uint32_t weight)
{
    for (uint32_t i = 0; i < design->trials; i++)
        design->member[i][design->memberships] = (uint16_t)(design->groups + key[i]);
    design->weight[design->memberships++] = weight;
    design->groups += count;
}

// By how many trials a class misses: within one means floor or ceiling of size / classes.
static uint32_t miss(uint32_t count, uint32_t size, uint32_t classes)
{
    uint32_t least = size / classes, most = (size + classes - 1) / classes;
    return count < least ? least - count : count > most ? count - most : 0;
}

static uint32_t group_cost(const struct balance *balance, uint32_t grouping, uint32_t group)
{
    const uint16_t *count = balance->count[group];
    uint32_t size = balance->size[group], weight = balance->design->weight[grouping], cost = 0;
    if (balance->classes > 0) {
        for (uint32_t i = 0; i < balance->classes; i++)
            cost += miss(count[i], size, balance->classes);
        return cost * weight;
    }
    cost =
        (miss((uint32_t)count[1] + count[3], size, 2) + miss((uint32_t)count[2] + count[3], size, 2)) * weight;
    for (uint32_t i = 0; i < 4 && grouping == 0; i++)
        cost += miss(count[i], size, 4) * BALANCE_SHOULD;
    return cost;
}

static void count_all(struct balance *balance)
{
    const struct balance_design *design = balance->design;
    memset(balance->size, 0, design->groups * sizeof balance->size[0]);
    memset(balance->count, 0, design->groups * sizeof balance->count[0]);
    for (uint32_t i = 0; i < design->trials; i++) {
        for (uint32_t m = 0; m < design->memberships; m++) {
            balance->size[design->member[i][m]]++;
            balance->count[design->member[i][m]][balance->values[i]]++;
        }
    }
    balance->cost = 0;
    uint32_t group = 0;
    for (uint32_t m = 0; m < design->memberships; m++) {
        uint32_t end = group;
        for (uint32_t i = 0; i < design->trials; i++)
            end = design->member[i][m] >= end ? design->member[i][m] + 1u : end;
        for (; group < end; group++)
            balance->cost += group_cost(balance, m, group);
    }
}

static void set_value(struct balance *balance, uint32_t trial, uint32_t value)
{
    for (uint32_t m = 0; m < balance->design->memberships; m++) {
        uint32_t group = balance->design->member[trial][m];
        balance->cost -= group_cost(balance, m, group);
        balance->count[group][balance->values[trial]]--;
        balance->count[group][value]++;
        balance->cost += group_cost(balance, m, group);
    }
    balance->values[trial] = value;
}

// Adds up each trial's digits, with the levels of every digit renamed at random, modulo `classes`. In a full
// factorial any part with some digits held fixed then has two or three classes within one: the sum's generating
// function is a product of factors of absolute value 0 or 1 at each root of unity but 1.
static void diagonal(const struct balance_design *design, struct random_stream *stream, uint32_t classes,
                     uint32_t *out)
{
    uint32_t offset = random_below(stream, classes);
    for (uint32_t i = 0; i < design->trials; i++)
        out[i] = offset;
    for (uint32_t k = 0; k < design->digits; k++) {
        uint32_t name[PROTOCOL_TRIALS];
        for (uint32_t level = 0; level < design->levels[k]; level++)
            name[level] = level;
        random_shuffle(stream, name, design->levels[k]);
        for (uint32_t i = 0; i < design->trials; i++)
            out[i] = (out[i] + name[design->digit[i][k]]) % classes;
    }
}

// Exchanges two trials' values (of pairs also the side or the first-shown option alone), or changes one; taken
// back where that makes the cost rise.
static void step(struct balance *balance, struct random_stream *stream)
{
    uint32_t count = balance->design->trials, before = balance->cost;
    uint32_t a = random_below(stream, count), was_a = balance->values[a];
    if (random_below(stream, 2)) {
        uint32_t b = random_below(stream, count), was_b = balance->values[b];
        uint32_t bits = balance->classes ? UINT32_MAX : 1 + random_below(stream, 3);
        set_value(balance, a, (was_a & ~bits) | (was_b & bits));
        set_value(balance, b, (was_b & ~bits) | (was_a & bits));
        if (balance->cost > before) {
            set_value(balance, a, was_a);
            set_value(balance, b, was_b);
        }
        return;
    }
    set_value(balance, a, random_below(stream, balance->classes ? balance->classes : 4));
    if (balance->cost > before)
        set_value(balance, a, was_a);
}

static void start_diagonal(const struct balance_design *design, struct random_stream *stream, uint32_t classes,
                           uint32_t *values)
{
    diagonal(design, stream, classes ? classes : 2, values);
    if (classes > 0)
        return;
    uint32_t first[PROTOCOL_TRIALS];
    diagonal(design, stream, 2, first);
    for (uint32_t i = 0; i < design->trials; i++)
        values[i] |= first[i] << 1;
}

// values: a first assignment with the right totals.
static uint32_t search(const struct balance_design *design, struct random_stream *stream, uint32_t classes,
                       uint32_t *values)
{
    struct balance balance = {.design = design, .classes = classes, .values = values, .cost = UINT32_MAX};
    uint32_t shuffles = design->trials <= BALANCE_SHORT ? BALANCE_SHUFFLES : 0;
    for (uint32_t i = 0; i < shuffles && balance.cost > 0; i++) {
        random_shuffle(stream, values, design->trials);
        count_all(&balance);
    }
    if (balance.cost == 0)
        return 0;
    uint32_t kept[PROTOCOL_TRIALS], best = UINT32_MAX;
    memcpy(kept, values, design->trials * sizeof kept[0]);
    for (uint32_t i = 0; i < BALANCE_STARTS && best > 0; i++) {
        if (i + 1 < BALANCE_STARTS)
            random_shuffle(stream, values, design->trials);
        else
            start_diagonal(design, stream, classes, values);
        count_all(&balance);
        for (uint32_t k = 0; k < BALANCE_STEPS * design->trials && balance.cost > 0; k++)
            step(&balance, stream);
        if (balance.cost < best) {
            best = balance.cost;
            memcpy(kept, values, design->trials * sizeof kept[0]);
        }
    }
    memcpy(values, kept, design->trials * sizeof kept[0]);
    return best / BALANCE_MUST;
}

uint32_t balance_classes(const struct balance_design *design, struct random_stream *stream, uint32_t classes,
                         uint32_t *out)
{
    // Which classes come once more than the others is drawn too.
    uint32_t names[BALANCE_CLASSES];
    for (uint32_t i = 0; i < classes; i++)
        names[i] = i;
    random_shuffle(stream, names, classes);
    for (uint32_t i = 0; i < design->trials; i++)
        out[i] = names[i % classes];
    return search(design, stream, classes, out);
}

uint32_t balance_pairs(const struct balance_design *design, struct random_stream *stream, uint32_t *out)
{
    // Whole rounds of the four pairs, then the rest. A rest of two takes opposite pairs, since two that share a
    // side would put the sides two apart.
    uint32_t turn = random_below(stream, 4), diagonal_pair = random_below(stream, 2);
    const uint32_t opposite[4] = {diagonal_pair, 3 - diagonal_pair, 1 - diagonal_pair, 2 + diagonal_pair};
    for (uint32_t i = 0; i < design->trials; i++)
        out[i] = design->trials % 4 == 2 ? opposite[i % 4] : (i + turn) % 4;
    return search(design, stream, 0, out);
}
