// Numbers out of accessors: first the check that an accessor may be read the way it is about to be, then the
// reading.
#ifndef STIMULI_GLTF_ACCESSOR_H
#define STIMULI_GLTF_ACCESSOR_H

#include "stimuli/gltf/document.h"

// What an attribute may be made of; the bits are 1 << (component - GLTF_INT8).
struct gltf_rule {
    uint32_t min_width, max_width;
    uint32_t plain;      // components allowed without `normalized`
    uint32_t normalised; // and with it
};

#define GLTF_BIT(component) (1u << ((component)-GLTF_INT8))

// Where a sentence is to be written, and where in the file it is about.
struct gltf_report {
    char where[128]; // "meshes[3].primitives[0].attributes.POSITION"
    char *error;
    size_t error_size;
};

// Always false: writes "where: what" to the report.
bool gltf_fail(const struct gltf_report *report, const char *format, ...) __attribute__((format(printf, 2, 3)));
void gltf_at(struct gltf_report *report, const char *format, ...) __attribute__((format(printf, 2, 3)));

// The index, the component type against the rule, and every byte against view and buffer; sparse parts too.
bool gltf_check_accessor(const struct gltf_document *document, int32_t index, const struct gltf_rule *rule,
                         const struct gltf_report *report);

// Both need an accessor that has passed. Writes count * width floats, all finite, normalised integers in -1..1.
bool gltf_read_floats(const struct gltf_document *document, int32_t index, float *out,
                      const struct gltf_report *report);
// Writes count integers, all below `limit`.
bool gltf_read_indices(const struct gltf_document *document, int32_t index, uint64_t limit, uint32_t *out,
                       const struct gltf_report *report);

#endif
