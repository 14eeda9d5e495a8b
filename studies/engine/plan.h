// The trials of one participant, a pure function of (protocol hash, seed, participant number).
//
// Integer arithmetic on Philox4x32-10 (random.h): the same on every machine and compiler. How each thing is
// drawn stands in plan.c. Use: plan_create -> read -> plan_destroy. Does not: change while the session runs, do
// I/O.
#ifndef STUDIES_ENGINE_PLAN_H
#define STUDIES_ENGINE_PLAN_H

#include "studies/protocol/protocol.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum { PLAN_JSON = 1024 };

// A place in front of the participant. The numbers are fixed: 0 and 1 index arrays.
enum plan_slot { PLAN_SLOT_A = 0, PLAN_SLOT_B = 1, PLAN_SLOT_NONE = 2 };
const char *plan_slot_name(enum plan_slot slot); // "a", "b", NULL for none: as the store has them

// A distinct option: mode and every parameter resolved.
struct plan_condition {
    const char *mode;
    uint32_t mode_index; // into the protocol's catalogue
    double values[CATALOGUE_PARAMETERS];
    char parameters[PLAN_JSON]; // JSON
};

struct plan_trial {
    uint32_t ordinal; // 1.. over the session
    uint32_t block;   // index into protocol.blocks; the name is the store's `block`
    enum protocol_kind kind;
    enum protocol_role role;
    const char *scene;
    char settings[PLAN_JSON]; // JSON
    char factors[PLAN_JSON];  // JSON; of a drawn rating {"option":"foveated","order":"first"} (order: of a pair
                              // only)
    int32_t option[2];        // conditions in slots a and b; one-option kinds have theirs in a and -1 in b
    enum plan_slot test_slot; // the slot of the block's first option; NONE where it is not shown
    enum plan_slot first_shown;
    const char *fixation;
    uint64_t seed; // 63 bits, for what the trial itself draws
    const struct protocol_settings *resolved;
    const struct protocol_question *question; // the first one asked; NULL: none
    uint32_t cell;                            // of the block, from 0; cell_count and on: null and catch trials
    uint32_t repetition;                      // from 0
    uint32_t target_seed; // of the path of a moving target: differs between cells and people, not between
                          // repetitions
    uint32_t spheres[2];  // to count, in each of a sequential trial's two showings; else [0] alone
    double adjust_start[PROTOCOL_ADJUSTED];
    bool prerendered[2]; // slots that are played back
    bool break_before;
};
// The store's `kind`: the role of practice, catch and null trials, else what is done.
const char *plan_trial_kind(const struct plan_trial *trial);

struct plan {
    const struct protocol *protocol;
    uint64_t seed;
    uint32_t number;
    uint32_t group; // of people, below protocol_groups
    struct plan_condition *conditions;
    uint32_t condition_count;
    struct plan_trial *trials;
    uint32_t trial_count;
    // By how many trials what DESIGN promises is missed, summed over the worst block: scenes within one over
    // the trials that name none; sides and first-shown options within one over the block and each factor level.
    // 0 for every full factorial.
    uint32_t imbalance;
};

// number counts from 0, so that 4j..4j+3 are whole groups. The protocol must outlive the plan. NULL: out of
// memory.
struct plan *plan_create(const struct protocol *protocol, uint64_t seed, uint32_t number);
// The same without the texts of settings and parameters, which take most of the time: for counting many people.
struct plan *plan_create_bare(const struct protocol *protocol, uint64_t seed, uint32_t number);
void plan_destroy(struct plan *plan); // NULL is fine

// A level or an adjusted value as an option has it, rounded to 9 digits: those reached by adding steps differ
// in their last ones and are the same condition. What the store keeps of a staircase's step is this level, so
// that it equals its condition's.
double plan_level(double level);
// The option under test of a staircase trial at a level.
struct protocol_option plan_level_option(const struct plan *plan, const struct plan_trial *trial, double level);

// SHA-256 over every column of every trial and condition, as text: what golden tables and resume compare.
void plan_hash(const struct plan *plan, char out[SHA256_HEX]);

// For `fovstudy check`. Each returns a heap string to free, NULL: out of memory. The number is printed as
// people and files have it: counted from 1.
char *plan_table_text(const struct plan *plan);
char *plan_table_json(const struct plan *plan);
// Over participants first..first+count-1: per block and cell how often each scene, side and first-shown option
// came.
char *plan_counts_text(const struct protocol *protocol, uint64_t seed, uint32_t first, uint32_t count);
char *plan_counts_json(const struct protocol *protocol, uint64_t seed, uint32_t first, uint32_t count);

// Each participant's plan in turn, bare, until one is refused. False: out of memory, or refused.
typedef bool (*plan_fn)(void *user, const struct plan *plan);
bool plan_each(const struct protocol *protocol, uint64_t seed, uint32_t first, uint32_t count, plan_fn visit,
               void *user);

// First-order carry-over: how often each cell of a block came right after each other one, null and catch trials
// in between apart.
struct plan_carry {
    uint32_t pairs;       // ordered pairs of different cells that one participant can get; 0: nothing follows
    uint32_t least, most; // times that the rarest and the most frequent of them came
    double even;          // times that each would come if all came equally often
};
bool plan_carry_over(const struct protocol *protocol, uint64_t seed, uint32_t first, uint32_t count,
                     struct plan_carry out[PROTOCOL_BLOCKS]); // false: out of memory

#endif
