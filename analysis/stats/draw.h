// Counter-based random numbers: the draw is a function of its name and of nothing else, so that a bootstrap
// gives the same numbers on every machine and in any order of its replicates.
// Source: SplitMix64 of Steele, G. L., Lea, D. & Flood, C. H. (2014), Fast splittable pseudorandom number
// generators, OOPSLA, 453-472, its finaliser applied to each part of the name in turn.
#ifndef ANALYSIS_STATS_DRAW_H
#define ANALYSIS_STATS_DRAW_H

#include <stdint.h>

// The finaliser of SplitMix64 at the next state after z: 64 bits that look random.
uint64_t stat_mix(uint64_t z);

// Uniform in (0, 1), 52 bits, by seed, replicate and index.
double stat_draw(uint64_t seed, uint64_t replicate, uint64_t index);

#endif
