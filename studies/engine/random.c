#include "studies/engine/random.h"

#include <math.h>

// Multipliers and key increments of the paper's Philox4x32; the increments are Weyl sequences of the golden
// ratio and of the square root of 3 minus 1.
#define PHILOX_M0 0xD2511F53u
#define PHILOX_M1 0xCD9E8D57u
#define PHILOX_W0 0x9E3779B9u
#define PHILOX_W1 0xBB67AE85u

void random_philox(const uint32_t counter[4], const uint32_t key[2], uint32_t out[4])
{
    uint32_t c0 = counter[0], c1 = counter[1], c2 = counter[2], c3 = counter[3], k0 = key[0], k1 = key[1];
    for (int round = 0; round < 10; round++) {
        uint64_t p0 = (uint64_t)PHILOX_M0 * c0, p1 = (uint64_t)PHILOX_M1 * c2;
        c0 = (uint32_t)(p1 >> 32) ^ c1 ^ k0;
        c1 = (uint32_t)p1;
        c2 = (uint32_t)(p0 >> 32) ^ c3 ^ k1;
        c3 = (uint32_t)p0;
        k0 += PHILOX_W0;
        k1 += PHILOX_W1;
    }
    out[0] = c0;
    out[1] = c1;
    out[2] = c2;
    out[3] = c3;
}

struct random_stream random_stream(uint64_t key, uint32_t purpose, uint32_t subject, uint32_t part)
{
    return (struct random_stream){.key = key, .name = {purpose, subject, part}, .used = 4};
}

uint32_t random_u32(struct random_stream *stream)
{
    if (stream->used == 4) {
        const uint32_t counter[4] = {stream->block++, stream->name[0], stream->name[1], stream->name[2]};
        const uint32_t key[2] = {(uint32_t)stream->key, (uint32_t)(stream->key >> 32)};
        random_philox(counter, key, stream->words);
        stream->used = 0;
    }
    return stream->words[stream->used++];
}

uint64_t random_u64(struct random_stream *stream)
{
    uint64_t low = random_u32(stream);
    return low | (uint64_t)random_u32(stream) << 32;
}

uint32_t random_below(struct random_stream *stream, uint32_t n)
{
    // Values under 2^32 mod n are drawn again, so that what is left is a whole number of rounds.
    uint32_t value;
    do
        value = random_u32(stream);
    while (value < n && value < (uint32_t)(0u - n) % n);
    return value % n;
}

void random_shuffle(struct random_stream *stream, uint32_t *values, uint32_t count)
{
    for (uint32_t i = count; i > 1; i--) {
        uint32_t j = random_below(stream, i), kept = values[i - 1];
        values[i - 1] = values[j];
        values[j] = kept;
    }
}

double random_unit(struct random_stream *stream)
{
    return ((double)(random_u64(stream) >> 11) + 0.5) * 0x1p-53;
}

double random_normal(struct random_stream *stream)
{
    double radius = sqrt(-2 * log(random_unit(stream)));
    return radius * cos(6.283185307179586 * random_unit(stream));
}
