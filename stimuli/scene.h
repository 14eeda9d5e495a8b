// A scene in plain C: meshes cut into submodels, materials, textures with mip maps, nodes, lights, animation
// and a camera path. glTF files (gltf.h) and code (builtin/builtin.h) both make one; the renderer only reads
// it.
//
// Use: scene_open("town:triangles=200000" or "x.gltf") -> read the arrays -> scene_destroy.
// A scene does not: draw, own anything on a GPU, or change after it was made (scene_pose writes to the caller's
// memory). Threads may read one scene together.
#ifndef STIMULI_SCENE_H
#define STIMULI_SCENE_H

#include "stimuli/camera_path.h"
#include "stimuli/geometry.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

enum {
    SCENE_SUBMODEL_TRIANGLES = 500, // Franke 2021, section 6.1: at most 500 faces per object
};

struct scene_vertex {
    float position[3];  // metres, mesh space
    int16_t normal[2];  // unit, octahedral, snorm; scene_encode_normal
    int16_t tangent[4]; // xyz unit snorm, w the sign of the bitangent (+-32767); bitangent = w * cross(normal,
                        // tangent)
    float uv[2][2];     // two sets of texture coordinates, v down as in glTF
    uint8_t colour[4];  // linear rgba, unorm; white where the file has none
};

struct scene_box {
    float min[3], max[3]; // tight; min > max only for an empty box
};

// At most SCENE_SUBMODEL_TRIANGLES triangles of one material, close together.
struct scene_submodel {
    uint32_t first_index;
    uint32_t index_count; // a multiple of 3
    uint32_t material;
    struct scene_box bounds; // mesh space
};

struct scene_mesh {
    uint32_t first_submodel;
    uint32_t submodel_count;
};

enum scene_slot {
    SCENE_BASE_COLOUR,        // sRGB, alpha
    SCENE_METALLIC_ROUGHNESS, // linear: roughness in g, metallic in b
    SCENE_NORMAL,             // linear, tangent space, y up (OpenGL convention)
    SCENE_OCCLUSION,          // linear, r
    SCENE_EMISSIVE,           // sRGB
    SCENE_SLOTS
};

struct scene_texture_use {
    int32_t texture;    // index into scene.textures, -1 for none
    uint32_t uv_set;    // 0 or 1
    float transform[6]; // u' = t0 u + t1 v + t2, v' = t3 u + t4 v + t5 (KHR_texture_transform); identity 1 0 0
                        // 0 1 0
};

struct scene_material {
    char name[64];
    float base_colour[4]; // linear
    float emissive[3];    // linear, cd/m^2 in the scene's own scale
    float metallic, roughness;
    float normal_scale, occlusion_strength;
    float alpha_cutoff; // used where alpha_mask
    bool alpha_mask;
    bool double_sided;
    bool sky_in_alpha; // vertex alpha is the share of the sky that a surface sees, not opacity
    struct scene_texture_use use[SCENE_SLOTS];
};

enum scene_wrap { SCENE_REPEAT, SCENE_CLAMP, SCENE_MIRROR };

struct scene_texture {
    uint32_t width, height, levels; // full chain down to 1x1
    bool srgb;                      // how rgb is stored; alpha is always linear
    bool nearest;                   // magnified without filtering (block textures)
    enum scene_wrap wrap_u, wrap_v;
    uint8_t *rgba; // owned; level 0 first, each level tightly packed, max(1, size >> level)
};

struct scene_node {
    int32_t parent; // -1 for a root; always less than the node's own index
    struct dmat4 local;
    bool moving; // it or an ancestor is animated or held
    // used instead of `local` where a channel drives the node
    struct dvec3 translation;
    struct dquat rotation;
    struct dvec3 scale;
    bool animated;
    bool held; // counts as moving though it stands still, to measure what moving pixels cost
};

// A mesh at a node. Draw order is free.
struct scene_instance {
    uint32_t mesh;
    uint32_t node;
    uint32_t moving_id; // 0 for a static instance, 1..scene.moving_count otherwise
};

enum scene_channel_target { SCENE_TRANSLATION, SCENE_ROTATION, SCENE_SCALE };
enum scene_interpolation { SCENE_STEP, SCENE_LINEAR, SCENE_CUBIC };

// One animated property of one node; every channel repeats with the scene's animation_s.
struct scene_channel {
    uint32_t node;
    enum scene_channel_target target;
    enum scene_interpolation interpolation;
    uint32_t key_count;
    float *times;  // owned, seconds, strictly increasing
    float *values; // owned, 3 or 4 floats a key; three such groups a key (in-tangent, value, out-tangent) for
                   // CUBIC
};

struct scene_sun {
    struct dvec3 direction; // unit, towards the sun
    float illuminance[3];   // lx on a surface facing it, linear rgb; all zero: no sun
};

struct scene_light {
    struct dvec3 position; // metres, world
    float intensity[3];    // cd, linear rgb
    float range_m;         // finite; the light is windowed to zero there (KHR_lights_punctual's recommendation)
    struct dvec3 direction;     // unit, where a spot shines; unused for a point light
    float cos_inner, cos_outer; // of a spot's half angles; cos_outer = -2 for a point light
};

// Background and ambient light: radiance in cd/m^2, linear rgb, blended by the direction's height.
struct scene_sky {
    float zenith[3], horizon[3], ground[3];
};

struct scene {
    char name[64];

    struct scene_vertex *vertices; // owned, as every array here
    uint32_t vertex_count;
    uint32_t *indices;
    uint32_t index_count;
    struct scene_submodel *submodels;
    uint32_t submodel_count;
    struct scene_mesh *meshes;
    uint32_t mesh_count;
    struct scene_material *materials; // never empty
    uint32_t material_count;
    struct scene_texture *textures;
    uint32_t texture_count;

    struct scene_node *nodes;
    uint32_t node_count;
    struct scene_instance *instances;
    uint32_t instance_count;
    struct scene_channel *channels;
    uint32_t channel_count;
    float animation_s; // length of the loop, 0 without animation
    uint32_t moving_count;

    struct scene_sun sun;
    struct scene_light *lights;
    uint32_t light_count;
    struct scene_sky sky;
    float luminance; // cd/m^2, the fixed log-average luminance for tone mapping (Reinhard et al. 2002)

    struct camera_path path;
    struct dvec3 bounds_min, bounds_max; // world, static instances
    uint64_t triangle_count;             // drawn without culling: all instances

    char notes[1024]; // what the file has and we do not draw: one sentence a line, for stderr; "" for none
};

// Opens a built-in scene ("atrium", "town", "town:triangles=N,seed=N") or a glTF/GLB file by its path (a name
// that ends in .gltf or .glb, or contains a slash). On failure returns NULL and writes one sentence to `error`:
// the file or name, what is wrong, and where.
struct scene *scene_open(const char *spec, char *error, size_t error_size);
void scene_destroy(struct scene *scene);

// World transforms of all nodes at a time; `out_world_from_node` holds scene->node_count matrices. Time repeats
// with animation_s. With moving_only, entries of nodes that do not move are left alone.
void scene_pose(const struct scene *scene, double time_s, bool moving_only, struct dmat4 *out_world_from_node);

// --- for those who make scenes ---

void scene_encode_normal(const float normal[3], int16_t out[2]);

// Tangents for vertices whose tangent w is 0, from normals and uv[0] per index triple (area-weighted,
// Gram-Schmidt); where texture coordinates are degenerate, any direction normal to the normal.
void scene_make_tangents(struct scene_vertex *vertices, uint32_t vertex_count, const uint32_t *indices,
                         uint32_t index_count);

// Cuts an index range of one material into submodels of at most SCENE_SUBMODEL_TRIANGLES triangles, compact in
// space (meshoptimizer orders and clusters), reordering indices[0..index_count) in place. first_index is added
// to each submodel's first_index. Writes at most index_count / 3 submodels to out; returns how many.
uint32_t scene_split(const struct scene_vertex *vertices, uint32_t vertex_count, uint32_t *indices,
                     uint32_t index_count, uint32_t first_index, uint32_t material, struct scene_submodel *out);

// Replaces texture->rgba (level 0 only) by the full mip chain and sets levels: box filter in linear light; with
// alpha_cutoff > 0 each level's alpha is scaled to keep the covered area (Castano 2010). False: out of memory.
bool scene_make_mips(struct scene_texture *texture, float alpha_cutoff);

// Fills moving flags and ids, bounds, triangle_count. Called last by every maker.
void scene_finish(struct scene *scene);

#ifdef __cplusplus
}
#endif
#endif
