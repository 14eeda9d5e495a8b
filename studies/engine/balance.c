#include "studies/engine/balance.h"

#include <string.h>

enum {
    BALANCE_TRIES = 4096, // shuffles tried before exchanges begin
    BALANCE_EXCHANGES = 20000,
    BALANCE_GROUPS = BALANCE_MEMBERSHIPS * PROTOCOL_TRIALS
};

void balance_group(struct balance_design *design, const uint32_t *key, uint32_t count)
{
    for (uint32_t i = 0; i < design->trials; i++)
        design->member[i][design->memberships] = (uint16_t)(design->groups + key[i]);
    design->groups += count;
    design->memberships++;
}

// By how many trials classes miss, summed over all groups: within one means that each class comes floor or
// ceiling of size / classes times.
static uint32_t excess_of(const struct balance_design *design, const uint32_t *values, uint32_t classes,
                          uint32_t shift)
{
    uint16_t sizes[BALANCE_GROUPS], counts[BALANCE_GROUPS];
    uint32_t excess = 0;
    memset(sizes, 0, design->groups * sizeof sizes[0]);
    for (uint32_t i = 0; i < design->trials; i++)
        for (uint32_t m = 0; m < design->memberships; m++)
            sizes[design->member[i][m]]++;
    for (uint32_t c = 0; c < classes; c++) {
        memset(counts, 0, design->groups * sizeof counts[0]);
        for (uint32_t i = 0; i < design->trials; i++)
            if ((values[i] >> shift) % classes == c)
                for (uint32_t m = 0; m < design->memberships; m++)
                    counts[design->member[i][m]]++;
        for (uint32_t g = 0; g < design->groups; g++) {
            uint32_t least = sizes[g] / classes, most = (sizes[g] + classes - 1) / classes, count = counts[g];
            excess += count < least ? least - count : count > most ? count - most : 0;
        }
    }
    return excess;
}

static uint32_t cost(const struct balance_design *design, const uint32_t *values, uint32_t classes)
{
    return classes ? excess_of(design, values, classes, 0)
                   : excess_of(design, values, 2, 0) + excess_of(design, values, 2, 1);
}

// Shuffles `values` until nothing is in excess, then exchanges while that helps. classes 0: pairs.
static uint32_t search(const struct balance_design *design, struct random_stream *stream, uint32_t classes,
                       uint32_t *values)
{
    uint32_t count = design->trials, best = UINT32_MAX;
    uint32_t tries =
        count <= 16 ? BALANCE_TRIES : 16; // long designs hardly ever come out right by chance alone
    uint32_t kept[PROTOCOL_TRIALS];
    for (uint32_t i = 0; i < tries && best > 0; i++) {
        random_shuffle(stream, values, count);
        uint32_t now = cost(design, values, classes);
        if (now < best) {
            best = now;
            memcpy(kept, values, count * sizeof kept[0]);
        }
    }
    memcpy(values, kept, count * sizeof kept[0]);
    for (uint32_t i = 0; i < BALANCE_EXCHANGES && best > 0; i++) {
        uint32_t a = random_below(stream, count), b = random_below(stream, count), value = values[a];
        if (values[b] == value)
            continue;
        values[a] = values[b];
        values[b] = value;
        uint32_t now = cost(design, values, classes);
        if (now <= best) {
            best = now;
        } else {
            values[b] = values[a];
            values[a] = value;
        }
    }
    return best;
}

uint32_t balance_classes(const struct balance_design *design, struct random_stream *stream, uint32_t classes,
                         uint32_t *out)
{
    // Which classes come once more than the others is drawn too.
    uint32_t names[PROTOCOL_TRIALS];
    for (uint32_t i = 0; i < classes; i++)
        names[i] = i;
    random_shuffle(stream, names, classes);
    for (uint32_t i = 0; i < design->trials; i++)
        out[i] = names[i % classes];
    return search(design, stream, classes, out);
}

uint32_t balance_pairs(const struct balance_design *design, struct random_stream *stream, uint32_t *out)
{
    // Whole rounds of the four pairs, then the rest. The pairs beyond whole rounds: a rest of two takes
    // opposite pairs, since two that share a side would put the sides two apart.
    uint32_t turn = random_below(stream, 4), diagonal = random_below(stream, 2);
    const uint32_t opposite[4] = {diagonal, 3 - diagonal, 1 - diagonal, 2 + diagonal};
    for (uint32_t i = 0; i < design->trials; i++)
        out[i] = design->trials % 4 == 2 ? opposite[i % 4] : (i + turn) % 4;
    return search(design, stream, 0, out);
}
