// Collects a scene made by code: triangles go into one bucket per material of the mesh in work; ending the mesh
// makes tangents, cuts it into submodels and appends it to the scene.
//
// Use: maker_create -> maker_texture, maker_material -> maker_mesh_begin, maker_vertex, maker_triangle (or the
// shapes
//      of solid.h) -> maker_mesh_end -> maker_node, maker_instance, ... -> maker_finish gives the scene.
// A failed allocation is remembered; maker_finish then returns NULL. Does not check geometry.
#ifndef STIMULI_BUILTIN_MAKER_H
#define STIMULI_BUILTIN_MAKER_H

#include "stimuli/scene.h"

#include <stdbool.h>
#include <stdint.h>

enum { MAKER_MATERIALS = 48, MAKER_TEXTURES = 112 }; // at most, per scene

struct maker_vertex {
    float position[3], normal[3];
    float tangent[4]; // w 0: made at the end of the mesh
    float uv[2];
    float colour[3]; // linear, 0..1
    float hidden;    // share of the sky that does not reach it, 0..1
};

struct maker_bucket {
    struct maker_vertex *vertices;
    uint32_t *indices; // into this bucket's vertices
    uint32_t vertex_count, vertex_capacity, index_count, index_capacity;
};

struct maker {
    struct scene *scene;
    struct maker_bucket buckets[MAKER_MATERIALS]; // by material
    uint32_t vertex_capacity, index_capacity, submodel_capacity, mesh_capacity, node_capacity,
        instance_capacity;
    uint32_t channel_capacity, light_capacity;
    bool failed;
};

bool maker_create(struct maker *maker, const char *name);
// The finished scene, or NULL where memory ran out; the maker is empty afterwards.
struct scene *maker_finish(struct maker *maker);

// Takes over rgba (size * size * 4 bytes, from malloc; NULL marks the maker failed). Returns the texture's
// index.
int32_t maker_texture(struct maker *maker, uint32_t size, uint8_t *rgba, bool srgb, bool nearest,
                      float alpha_cutoff);

struct maker_material_desc {
    const char *name;
    float colour[3];                         // linear; all zero means white
    float roughness, metallic;               // factors
    float normal_scale;                      // 0 means 1
    int32_t base, surface, normal, emission; // texture index + 1; 0 means none
    float emissive[3];
    bool alpha_mask, double_sided;
};
uint32_t maker_material(struct maker *maker, const struct maker_material_desc *desc);

void maker_mesh_begin(struct maker *maker);
uint32_t maker_vertex(struct maker *maker, uint32_t material, const struct maker_vertex *vertex);
void maker_triangle(struct maker *maker, uint32_t material, uint32_t a, uint32_t b, uint32_t c);
uint32_t maker_mesh_triangles(const struct maker *maker); // of the mesh in work
uint32_t maker_mesh_end(struct maker *maker);             // the mesh's index

uint32_t maker_node(struct maker *maker, int32_t parent, struct dvec3 translation, struct dquat rotation);
void maker_instance(struct maker *maker, uint32_t mesh, uint32_t node);
// Linear keys; copies times and values (3 or 4 floats a key) and marks the node animated.
void maker_channel(struct maker *maker, uint32_t node, enum scene_channel_target target, uint32_t key_count,
                   const float *times, const float *values);
void maker_light(struct maker *maker, const struct scene_light *light);

#endif
