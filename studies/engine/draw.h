// What is drawn for each block of one participant's plan. Inside this room only; how stands in draw.c.
#ifndef STUDIES_ENGINE_DRAW_H
#define STUDIES_ENGINE_DRAW_H

#include "studies/engine/random.h"
#include "studies/protocol/protocol.h"

enum { DRAW_TRIALS = PROTOCOL_TRIALS };

// Trial i below `count` has cell[i / repetitions] and repetition i % repetitions; the rest are null and catch
// trials.
struct draw {
    uint32_t count, total;
    uint32_t cell[DRAW_TRIALS];  // indices into block.cells, of this participant's group
    uint32_t scene[DRAW_TRIALS]; // indices into protocol.scenes
    uint32_t pair[DRAW_TRIALS];  // bit 0: the tested option is in slot b; bit 1: the reference is shown first
    uint32_t order[DRAW_TRIALS]; // which trial of the block comes at each place
    uint32_t option;             // of a rating of one of two: 0 or 1 into block.options
    uint32_t turn;               // by how many places of the block's scenes this participant's are moved on
    uint32_t excess;             // as plan.imbalance
};

struct draw_person {
    uint64_t key; // of (protocol hash, seed)
    uint32_t number;
    uint32_t group; // of people; and the place within it
    uint32_t rank;
};

uint64_t draw_key(const struct protocol *protocol, uint64_t seed);
struct draw_person draw_person(const struct protocol *protocol, uint64_t seed, uint32_t number);
// draws: of all blocks; those before `block` are drawn already.
void draw_block(const struct protocol *protocol, const struct draw_person *person, uint32_t block,
                struct draw *draws);
uint64_t draw_trial_seed(const struct draw_person *person, uint32_t ordinal); // 63 bits
uint32_t draw_target_seed(const struct draw_person *person, uint32_t block, uint32_t cell);
// For what a single trial draws: how many spheres, where an adjustment begins.
struct random_stream draw_trial_stream(const struct draw_person *person, uint32_t ordinal);

// Row `row` of a Williams design for `count` treatments: count rows, or twice as many where count is odd.
uint32_t draw_williams_rows(uint32_t count);
void draw_williams(uint32_t count, uint32_t row, uint32_t *out);

#endif
