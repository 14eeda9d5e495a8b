// The parts of gltf_check.
#ifndef STIMULI_GLTF_CHECK_H
#define STIMULI_GLTF_CHECK_H

#include "stimuli/gltf/accessor.h"

bool gltf_check_meshes(const struct gltf_document *document, struct gltf_report *report);
bool gltf_check_animation(const struct gltf_document *document, struct gltf_report *report);
bool gltf_check_nodes(const struct gltf_document *document, struct gltf_report *report);

// An index that may be absent (-1).
bool gltf_check_index(int32_t index, uint32_t count, const char *table, const struct gltf_report *report);

#endif
