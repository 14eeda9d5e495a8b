// Counts what is made on the device, by standing between the renderer and the driver: volk's pointers are
// replaced.
//
// Use: creations_begin after renderer_create -> what must make nothing -> creations_end. One at a time.
#ifndef TESTS_RENDERER_CREATIONS_H
#define TESTS_RENDERER_CREATIONS_H

#include <stdint.h>

struct creations {
    uint32_t pipelines, shaders, images, views, buffers, allocations; // calls, also those that failed
};

void creations_begin(void);
// Since begin; the driver is called directly again.
struct creations creations_end(void);
uint32_t creations_total(const struct creations *creations);

#endif
