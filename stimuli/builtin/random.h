// Counter-based random numbers: a value is a pure function of (seed, counter), so order of use never matters.
#ifndef STIMULI_BUILTIN_RANDOM_H
#define STIMULI_BUILTIN_RANDOM_H

#include <stdint.h>

// splitmix64's finaliser (Steele, Lea, Flood 2014).
static inline uint64_t random_bits(uint64_t seed, uint64_t counter)
{
    uint64_t z = seed * 0xD1B54A32D192ED03u + (counter + 1) * 0x9E3779B97F4A7C15u;
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9u;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBu;
    return z ^ (z >> 31);
}

// 0 <= result < 1
static inline float random_unit(uint64_t seed, uint64_t counter)
{
    return (float)(random_bits(seed, counter) >> 40) * 0x1p-24f;
}

static inline float random_range(uint64_t seed, uint64_t counter, float low, float high)
{
    return low + (high - low) * random_unit(seed, counter);
}

// 0 <= result < n
static inline uint32_t random_below(uint64_t seed, uint64_t counter, uint32_t n)
{
    return (uint32_t)((random_bits(seed, counter) >> 32) * n >> 32);
}

// One counter for a place on a grid.
static inline uint64_t random_place(int32_t x, int32_t y, int32_t z)
{
    return (uint64_t)(uint32_t)x * 0x8DA6B343u ^ (uint64_t)(uint32_t)y * 0xD8163841u << 7 ^
           (uint64_t)(uint32_t)z * 0xCB1AB31Fu << 19;
}

#endif
