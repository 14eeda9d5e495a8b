#include "studies/engine/balance.h"

#include <string.h>

enum {
    // Blocks of at most BALANCE_SHORT trials; longer ones hardly come out right by chance.
    BALANCE_SHUFFLES = 4096,
    BALANCE_SHORT = 16,
    BALANCE_STARTS = 5,  // the last one diagonal
    BALANCE_STEPS = 200, // per trial and start
    BALANCE_CLASSES = PROTOCOL_SCENES,
    BALANCE_GROUPS = BALANCE_MEMBERSHIPS * PROTOCOL_TRIALS
};

// What counts as within one: floor and ceiling of a group's size by its number of classes.
struct bounds {
    uint16_t least, most;
};

// An assignment with its counts, so that a step costs only what it touches.
struct balance {
    const struct balance_design *design;
    uint32_t classes; // 0: pairs
    uint32_t *values;
    uint32_t cost;
    struct bounds bounds[BALANCE_GROUPS], quarter;
    // Of each class; of pairs, of those on side b [0] and of those that show the reference first [1]: what
    // these have more than their share, the others have less.
    uint16_t count[BALANCE_GROUPS][BALANCE_CLASSES];
    uint16_t quarters[4]; // of pairs, in the whole block
};

void balance_group(struct balance_design *design, const uint32_t *key, uint32_t count, uint32_t weight)
{
    for (uint32_t i = 0; i < design->trials; i++)
        design->member[i][design->memberships] = (uint16_t)(design->groups + key[i]);
    design->weight[design->memberships++] = weight;
    design->groups += count;
    design->end[design->memberships - 1] = design->groups;
}

static struct bounds bounds_of(uint32_t size, uint32_t classes)
{
    return (struct bounds){(uint16_t)(size / classes), (uint16_t)((size + classes - 1) / classes)};
}

// By how many trials a class misses.
static uint32_t miss(uint32_t count, struct bounds bounds)
{
    return count < bounds.least ? bounds.least - count : count > bounds.most ? count - bounds.most : 0;
}

static void measure(struct balance *balance)
{
    const struct balance_design *design = balance->design;
    uint32_t size[BALANCE_GROUPS] = {0};
    for (uint32_t i = 0; i < design->trials; i++)
        for (uint32_t m = 0; m < design->memberships; m++)
            size[design->member[i][m]]++;
    for (uint32_t group = 0; group < design->groups; group++)
        balance->bounds[group] = bounds_of(size[group], balance->classes > 0 ? balance->classes : 2);
    balance->quarter = bounds_of(design->trials, 4);
}

// Counts one grouping anew and returns what it misses.
static uint32_t count_grouping(struct balance *balance, uint32_t m)
{
    const struct balance_design *design = balance->design;
    uint32_t begin = m > 0 ? design->end[m - 1] : 0, counts = balance->classes > 0 ? balance->classes : 2,
             cost = 0;
    memset(balance->count[begin], 0, (design->end[m] - begin) * sizeof balance->count[0]);
    for (uint32_t i = 0; i < design->trials; i++) {
        uint16_t *count = balance->count[design->member[i][m]];
        if (balance->classes > 0) {
            count[balance->values[i]]++;
        } else {
            count[0] = (uint16_t)(count[0] + (balance->values[i] & 1));
            count[1] = (uint16_t)(count[1] + (balance->values[i] >> 1));
        }
    }
    for (uint32_t group = begin; group < design->end[m]; group++)
        for (uint32_t i = 0; i < counts; i++)
            cost += miss(balance->count[group][i], balance->bounds[group]);
    return cost * design->weight[m];
}

static uint32_t count_quarters(struct balance *balance)
{
    uint32_t cost = 0;
    if (balance->classes > 0)
        return 0;
    memset(balance->quarters, 0, sizeof balance->quarters);
    for (uint32_t i = 0; i < balance->design->trials; i++)
        balance->quarters[balance->values[i]]++;
    for (uint32_t i = 0; i < 4; i++)
        cost += miss(balance->quarters[i], balance->quarter);
    return cost * BALANCE_SHOULD;
}

static void count_all(struct balance *balance)
{
    balance->cost = count_quarters(balance);
    for (uint32_t m = 0; m < balance->design->memberships; m++)
        balance->cost += count_grouping(balance, m);
}

// Whether the cost is 0; most assignments fail at an early grouping.
static bool holds(struct balance *balance)
{
    for (uint32_t m = 0; m < balance->design->memberships; m++)
        if (count_grouping(balance, m) > 0)
            return false;
    return count_quarters(balance) == 0;
}

static void shift(uint16_t *count, int by, struct bounds bounds, uint32_t weight, uint32_t *cost)
{
    *cost -= miss(*count, bounds) * weight;
    *count = (uint16_t)(*count + by);
    *cost += miss(*count, bounds) * weight;
}

static void set_value(struct balance *balance, uint32_t trial, uint32_t value)
{
    const struct balance_design *design = balance->design;
    uint32_t was = balance->values[trial], *cost = &balance->cost;
    int side = (int)(value & 1) - (int)(was & 1), first = (int)(value >> 1) - (int)(was >> 1);
    if (was == value)
        return;
    for (uint32_t m = 0; m < design->memberships; m++) {
        uint32_t group = design->member[trial][m], weight = design->weight[m];
        uint16_t *count = balance->count[group];
        if (balance->classes > 0) {
            shift(&count[was], -1, balance->bounds[group], weight, cost);
            shift(&count[value], 1, balance->bounds[group], weight, cost);
        } else {
            shift(&count[0], side, balance->bounds[group], weight, cost);
            shift(&count[1], first, balance->bounds[group], weight, cost);
        }
    }
    if (balance->classes == 0) {
        shift(&balance->quarters[was], -1, balance->quarter, BALANCE_SHOULD, cost);
        shift(&balance->quarters[value], 1, balance->quarter, BALANCE_SHOULD, cost);
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
    struct balance balance;
    uint32_t shuffles = design->trials <= BALANCE_SHORT ? BALANCE_SHUFFLES : 0;
    balance.design = design;
    balance.classes = classes;
    balance.values = values;
    measure(&balance);
    for (uint32_t i = 0; i < shuffles; i++) {
        random_shuffle(stream, values, design->trials);
        if (holds(&balance))
            return 0;
    }
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
