#include "analysis/stats/coins.h"

void stat_coin_sums(const uint64_t *weights, size_t n, double *chance, uint64_t most)
{
    uint64_t reached = 0;
    for (uint64_t s = 1; s <= most; s++)
        chance[s] = 0;
    chance[0] = 1;
    for (size_t i = 0; i < n; i++) {
        uint64_t weight = weights[i];
        if (weight == 0)
            continue;
        reached = weight < most - reached ? reached + weight : most;
        for (uint64_t s = reached + 1; s-- > weight;)
            chance[s] = 0.5 * (chance[s] + chance[s - weight]);
        for (uint64_t s = 0; s < weight && s <= reached; s++)
            chance[s] *= 0.5;
    }
}
