// A picture in memory: rgba8 without its alpha, each pixel as its difference from the one before, by LZ4
// (github.com/lz4/lz4, block format). Lossless for opaque pictures.
//
// LZ4, not zstd: what it holds is about a third larger, but it must be unpacked far faster than it is shown.
// Measured on 2026-11-25, one core of a busy machine, both eyes at 1280x1440: LZ4 5.9 ms at a ratio of 1.9
// (Sponza), 2.6 (atrium), 4.3 (town) to rgba8; zstd level 1 11 ms at 3.0, 4.0, 6.5. Any thread. Does not: keep
// pictures (recording.h).
#ifndef APP_SESSION_PACK_H
#define APP_SESSION_PACK_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

// Bytes of `out` that suffice for a picture, and of `scratch` for either way.
size_t pack_bound(size_t pixels);
size_t pack_scratch(size_t pixels);
// The packed size; 0: pixels or out_size are out of LZ4's range.
size_t pack(const uint8_t *rgba, size_t pixels, uint8_t *scratch, uint8_t *out, size_t out_size);
// Writes every byte of out_rgba once, in order, and reads none: it may be memory of the GPU. False: `packed` is
// damaged.
bool unpack(const uint8_t *packed, size_t size, size_t pixels, uint8_t *scratch, uint8_t *out_rgba);

#endif
