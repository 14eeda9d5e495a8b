// The making of a scene from a checked document, one part a file. All return false with a sentence in
// build->report.
#ifndef STIMULI_GLTF_BUILD_H
#define STIMULI_GLTF_BUILD_H

#include "stimuli/gltf/accessor.h"
#include "stimuli/scene.h"

struct gltf_build {
    const struct gltf_document *document;
    struct scene *scene;
    int32_t *scene_node; // owned; of each file node, -1 where the scene does not have it
    uint32_t further_suns;
    uint32_t high_uv_sets;
    uint32_t ignored_channels;
    uint32_t unused_cameras;
    struct gltf_report report;
};

bool gltf_build_materials(struct gltf_build *build); // and textures
bool gltf_build_meshes(struct gltf_build *build);
bool gltf_build_nodes(struct gltf_build *build); // and instances
bool gltf_build_animation(struct gltf_build *build);
// Both after scene_finish; world holds the nodes' transforms at time 0.
bool gltf_build_lights(struct gltf_build *build, const struct dmat4 *world);
bool gltf_build_path(struct gltf_build *build, const struct dmat4 *world);
// One line a kind of thing that the file has and we do not draw.
void gltf_write_notes(struct gltf_build *build);

// Of a texture's image, decoded and with mip maps, for each texture that gltf_build_materials has laid out;
// images[i] is the file's image of scene texture i, cutoffs[i] the alpha cutoff its mip maps keep.
bool gltf_load_images(struct gltf_build *build, const uint32_t *images, const float *cutoffs);

#endif
