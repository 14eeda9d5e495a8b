// Draws that spread classes over a block's trials so that they come equally often, in the whole and in each
// group.
//
// Groups are sets of trials: the block itself, the trials of one factor level, of one scene, of one cell.
// "Within one" means that the most and the least frequent class of a group differ by at most one. Drawn
// uniformly among all assignments that hold everywhere, as long as a bounded number of tries finds one (nine
// decisions: always, tested); beyond that exchanges lead to the best found, and the excess that is left is
// returned.
#ifndef STUDIES_ENGINE_BALANCE_H
#define STUDIES_ENGINE_BALANCE_H

#include "studies/engine/random.h"
#include "studies/protocol/protocol.h"

enum { BALANCE_MEMBERSHIPS = PROTOCOL_FACTORS + 3 };

struct balance_design {
    uint32_t trials;
    uint32_t groups; // at most BALANCE_MEMBERSHIPS * PROTOCOL_TRIALS
    uint32_t memberships;
    uint16_t member[PROTOCOL_TRIALS][BALANCE_MEMBERSHIPS]; // group of each trial, one per kind of grouping
};

// Adds a grouping: trial i belongs to group key[i] (0..count-1) of it.
void balance_group(struct balance_design *design, const uint32_t *key, uint32_t count);

// Gives each trial a class 0..classes-1, within one in every group. Returns the excess.
uint32_t balance_classes(const struct balance_design *design, struct random_stream *stream, uint32_t classes,
                         uint32_t *out);

// Gives each trial a pair: bit 0 the side, bit 1 the option shown first. Sides and first-shown options within
// one in every group, the four pairs within one over the block. Returns the excess.
uint32_t balance_pairs(const struct balance_design *design, struct random_stream *stream, uint32_t *out);

#endif
