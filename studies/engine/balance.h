// Draws that spread classes over a block's trials so that they come equally often, in the whole and in each
// group.
//
// Groups are sets of trials: the block itself, the trials of one factor level, of one scene, of one cell.
// "Within one" means that the most and the least frequent class of a group differ by at most one. Groups have a
// weight: what DESIGN promises must hold (BALANCE_MUST), the rest holds where it can.
//
// Drawn uniformly among all assignments that hold everywhere, as long as a bounded number of shuffles finds one
// (nine decisions: always, tested). Where that fails (long designs; designs in which not everything can hold
// together) the draw begins at a diagonal pattern, which for full factorials keeps every promise on sides, and
// random exchanges and changes that make nothing worse lead on from there.
#ifndef STUDIES_ENGINE_BALANCE_H
#define STUDIES_ENGINE_BALANCE_H

#include "studies/engine/random.h"
#include "studies/protocol/protocol.h"

enum {
    BALANCE_DIGITS = PROTOCOL_FACTORS + 1,      // factor levels, and the repetition
    BALANCE_MEMBERSHIPS = PROTOCOL_FACTORS + 3, // block, levels, cell, scene
    BALANCE_MUST = 1000000,                     // more than all lighter misses together
    BALANCE_SHOULD = 30,
    BALANCE_MAY = 1
};

struct balance_design {
    uint32_t trials;
    uint32_t digits; // what tells trials apart: trial i has digit[i][k] of levels[k]
    uint32_t levels[BALANCE_DIGITS];
    uint16_t digit[PROTOCOL_TRIALS][BALANCE_DIGITS];
    uint32_t groups; // at most BALANCE_MEMBERSHIPS * PROTOCOL_TRIALS
    uint32_t memberships;
    uint16_t member[PROTOCOL_TRIALS][BALANCE_MEMBERSHIPS];          // group of each trial, one per grouping
    uint32_t weight[BALANCE_MEMBERSHIPS], end[BALANCE_MEMBERSHIPS]; // of each grouping; end: of its groups
};

// Adds a grouping: trial i belongs to group key[i] (0..count-1) of it. The first grouping is the whole block.
void balance_group(struct balance_design *design, const uint32_t *key, uint32_t count, uint32_t weight);

// Gives each trial a class 0..classes-1, within one in every group. Returns by how many trials the groups that
// must hold miss that, summed.
uint32_t balance_classes(const struct balance_design *design, struct random_stream *stream, uint32_t classes,
                         uint32_t *out);

// Gives each trial a pair: bit 0 the side, bit 1 the option shown first. Sides and first-shown options within
// one in every group; the four pairs within one over the block (should). Returns as balance_classes.
uint32_t balance_pairs(const struct balance_design *design, struct random_stream *stream, uint32_t *out);

#endif
