// Counter-based random numbers: Philox4x32-10 of Salmon, Moraes, Dror and Shaw 2011, "Parallel random numbers:
// as easy as 1, 2, 3" (SC11). A stream is named by what it is for, so no draw depends on how many others were
// made.
#ifndef STUDIES_ENGINE_RANDOM_H
#define STUDIES_ENGINE_RANDOM_H

#include <stdint.h>

struct random_stream {
    uint64_t key;
    uint32_t name[3];  // purpose, subject, part: the upper words of the counter
    uint32_t block;    // the lowest word, counted up
    uint32_t words[4]; // of the current block
    uint32_t used;
};

void random_philox(const uint32_t counter[4], const uint32_t key[2], uint32_t out[4]);

struct random_stream random_stream(uint64_t key, uint32_t purpose, uint32_t subject, uint32_t part);
uint32_t random_u32(struct random_stream *stream);
uint64_t random_u64(struct random_stream *stream);
uint32_t random_below(struct random_stream *stream, uint32_t n); // 0..n-1, every value equally likely; n > 0
void random_shuffle(struct random_stream *stream, uint32_t *values, uint32_t count); // Fisher-Yates
double random_unit(struct random_stream *stream);                                    // in (0, 1), 53 bits
double random_normal(struct random_stream *stream); // mean 0, sd 1, Box and Muller 1958

#endif
