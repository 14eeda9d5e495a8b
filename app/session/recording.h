// The frames of one option along one flight, packed in memory.
//
// Use: recording_create -> recording_add each frame in order -> recording_eye -> recording_destroy.
// One thread adds; once all are there any thread may read. Does not: draw, keep time.
#ifndef APP_SESSION_RECORDING_H
#define APP_SESSION_RECORDING_H

#include "stimuli/viewing.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

struct recording_frame {
    uint8_t *packed[EYES]; // owned
    size_t size[EYES];
    int64_t shaded_px, triangles; // of when it was rendered
};

struct recording {
    uint32_t width, height;         // of each eye
    uint32_t count, capacity;       // frames there, and to come
    struct recording_frame *frames; // owned
    uint64_t bytes;                 // of all packed pictures
    uint8_t *scratch, *out;         // owned
};

// NULL: out of memory.
struct recording *recording_create(uint32_t width, uint32_t height, uint32_t capacity);
void recording_destroy(struct recording *recording); // NULL is fine
// False: no memory is left, or all frames are there. rgba: both eyes' pictures, opaque.
bool recording_add(struct recording *recording, const uint8_t *const rgba[EYES], int64_t shaded_px,
                   int64_t triangles);
// Bytes that all frames will need, from those that are there; 0: none is.
uint64_t recording_forecast(const struct recording *recording);

#endif
