// A glTF file as plain C structs, one for one with the file's own tables; the texts and bytes stay owned by the
// parser.
//
// gltf_parse fills it and promises only that pointers are valid for their stated lengths; numbers are as the
// file has them until gltf_check has passed. Indices are -1 where the file has none.
#ifndef STIMULI_GLTF_DOCUMENT_H
#define STIMULI_GLTF_DOCUMENT_H

#include "stimuli/gltf/file.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

// Limits against files that are small and ask for much. They bound memory to about 4 GiB and leave ten times
// what the largest of our test scenes needs.
enum {
    GLTF_MAX_VERTICES = 20000000, // of all primitives together, before sharing
    GLTF_MAX_INDICES = 60000000,  // likewise
    GLTF_MAX_NODE_DEPTH = 256,
    GLTF_MAX_KEYS = 20000000,    // animation keys of all channels together
    GLTF_MAX_IMAGE_SIZE = 16384, // pixels a side
    GLTF_MAX_TEXELS = 256 << 20, // of all textures together, without mip maps: 1 GiB
};

enum gltf_attribute {
    GLTF_POSITION,
    GLTF_NORMAL,
    GLTF_TANGENT,
    GLTF_TEXCOORD_0,
    GLTF_TEXCOORD_1,
    GLTF_COLOR_0,
    GLTF_ATTRIBUTES
};

enum gltf_component {
    GLTF_INT8 = 5120,
    GLTF_UINT8 = 5121,
    GLTF_INT16 = 5122,
    GLTF_UINT16 = 5123,
    GLTF_UINT32 = 5125,
    GLTF_FLOAT = 5126,
};

struct gltf_span {
    const uint8_t *bytes;
    size_t size;
};

struct gltf_view {
    int32_t buffer;
    uint64_t offset, length;
    uint64_t stride; // 0: packed
};

struct gltf_accessor {
    int32_t view; // -1: zeros
    uint64_t offset, count;
    int32_t component; // enum gltf_component
    uint32_t width;    // numbers an element, 1..4; 0 for matrices
    bool normalised;
    bool sparse;
    int32_t sparse_count;
    int32_t sparse_index_view, sparse_index_offset, sparse_index_component;
    int32_t sparse_value_view, sparse_value_offset;
};

struct gltf_primitive {
    int32_t attribute[GLTF_ATTRIBUTES]; // accessors
    int32_t indices, material;
    int32_t mode; // 0..6
    bool morph;
};

struct gltf_mesh {
    uint32_t first_primitive, primitive_count;
};

struct gltf_texture_use {
    int32_t texture, uv_set;
    double offset[2], rotation, scale[2]; // KHR_texture_transform
};

struct gltf_material {
    const char *name;
    double base_colour[4], emissive[3];
    double metallic, roughness, normal_scale, occlusion_strength, alpha_cutoff;
    bool mask, blend, double_sided, extended; // extended: has a KHR_materials_* we leave out
    struct gltf_texture_use use[5];           // in the order of enum scene_slot
};

struct gltf_texture {
    int32_t image, sampler;
};

struct gltf_sampler {
    int32_t mag_filter, wrap_u, wrap_v;
};

struct gltf_image {
    struct gltf_span bytes; // as in the file, PNG or JPEG; empty where a view has them or nothing was found
    int32_t view;
    const char *uri;
};

struct gltf_node {
    int32_t mesh, camera, skin, light;
    uint32_t first_child, child_count;                                     // in children
    uint32_t matrix_count, translation_count, rotation_count, scale_count; // numbers given; 0 for none
    double matrix[16], translation[3], rotation[4], scale[3];
};

struct gltf_root_list {
    uint32_t first, count; // in roots
};

struct gltf_channel {
    int32_t sampler, node;
    const char *path;
};

struct gltf_animation_sampler {
    int32_t input, output;
    const char *interpolation;
};

struct gltf_light {
    const char *type;
    double colour[3], intensity, range, inner_angle, outer_angle;
};

struct gltf_document {
    struct gltf_span *buffers;
    struct gltf_view *views;
    struct gltf_accessor *accessors;
    struct gltf_primitive *primitives;
    struct gltf_mesh *meshes;
    struct gltf_material *materials;
    struct gltf_texture *textures;
    struct gltf_sampler *samplers;
    struct gltf_image *images;
    struct gltf_node *nodes;
    int32_t *children;
    struct gltf_root_list *scenes;
    int32_t *roots;
    struct gltf_channel *channels; // of the first animation
    struct gltf_animation_sampler *animation_samplers;
    struct gltf_light *lights;
    const char **extensions_used;
    const char **extensions_required;
    uint32_t buffer_count, view_count, accessor_count, primitive_count, mesh_count, material_count,
        texture_count;
    uint32_t sampler_count, image_count, node_count, child_count, scene_count, root_count, channel_count;
    uint32_t animation_sampler_count, light_count, extension_used_count, extension_required_count;
    uint32_t animation_count, skin_count, camera_count;
    int32_t default_scene;
    void *parser; // owns texts and bytes
};

// Parses a whole file that gltf_scan has passed. NULL with a sentence (without the path) in `error`.
struct gltf_document *gltf_parse(struct gltf_file *file, char *error, size_t error_size);
void gltf_document_destroy(struct gltf_document *document);

// True if everything that the other rooms use is in range; else a sentence that names the place.
bool gltf_check(const struct gltf_document *document, char *error, size_t error_size);

// Whether extensionsUsed lists it.
bool gltf_uses(const struct gltf_document *document, const char *extension);

#ifdef __cplusplus
}
#endif
#endif
