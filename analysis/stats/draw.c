#include "analysis/stats/draw.h"

uint64_t stat_mix(uint64_t z)
{
    z += UINT64_C(0x9e3779b97f4a7c15); // 2^64 over the golden ratio
    z = (z ^ (z >> 30)) * UINT64_C(0xbf58476d1ce4e5b9);
    z = (z ^ (z >> 27)) * UINT64_C(0x94d049bb133111eb);
    return z ^ (z >> 31);
}

double stat_draw(uint64_t seed, uint64_t replicate, uint64_t index)
{
    uint64_t bits = stat_mix(stat_mix(stat_mix(seed) ^ replicate) ^ index);
    return ((double)(bits >> 12) + 0.5) * 0x1p-52; // with a bit more the largest would round to 1
}
