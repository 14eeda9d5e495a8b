// A scene's copy on the GPU: vertices, textures, materials, lights, and the list of what can be drawn.
//
// Use: scene_gpu_create -> per frame scene_gpu_update, then passes read the buffers -> scene_gpu_destroy.
// Several options may share one copy as long as each calls scene_gpu_update for its own frame.
#ifndef RENDERER_SCENE_SCENE_GPU_H
#define RENDERER_SCENE_SCENE_GPU_H

#include "renderer/gpu/gpu.h"
#include "renderer/shared/shared.h"
#include "stimuli/scene.h"

// What a bucket's pipeline must do: one bit per thing that costs something.
enum {
    SCENE_GPU_MASK = 1 << SCENE_SLOTS,           // alpha test
    SCENE_GPU_EMISSIVE = 1 << (SCENE_SLOTS + 1), // glows, with or without a texture
    SCENE_GPU_PLAIN_UV = 1 << (SCENE_SLOTS + 2), // every texture reads the first set as it is
    SCENE_GPU_SKY = 1 << (SCENE_SLOTS + 3),      // vertex alpha occludes the sky
    SCENE_GPU_FEATURES = SCENE_SLOTS + 4,
    // bits 0..SCENE_SLOTS-1: the texture slot is used
};

// Items drawn with one pipeline, one material and one winding, all moving or all static.
struct scene_bucket {
    uint32_t material;
    uint32_t features;
    bool mirrored;
    bool moving; // its objects have moving ids
    bool double_sided;
    uint32_t first_item, item_count;
    uint32_t first_group, group_count;
};

struct scene_gpu {
    struct gpu *gpu;
    const struct scene *scene; // borrowed

    struct gpu_buffer vertices, indices;
    struct gpu_buffer items;   // shared_item, sorted by bucket
    struct gpu_buffer groups;  // shared_cull_group
    struct gpu_buffer objects; // shared_object, moving ones first
    struct gpu_buffer
        motions;           // mat4 by moving id: world now from world before, then as many the other way round
    uint32_t motion_count; // of one way, with the identity at 0
    struct gpu_buffer materials; // shared_material
    struct gpu_buffer lights;    // shared_light
    struct gpu_buffer staging;   // objects and motions, written by the CPU
    uint32_t item_count, group_count, bucket_count, object_count, moving_object_count;
    struct scene_bucket *buckets;
    uint32_t features; // of all buckets together

    VkDescriptorSetLayout material_layout; // SCENE_SLOTS combined image samplers
    VkDescriptorSet *material_sets;        // one a material
    struct gpu_image *textures;
    VkSampler *samplers; // one a texture
    struct gpu_image white;
    VkSampler plain;

    struct dvec3 origin; // positions on the GPU are relative to it
    bool placed;         // objects hold valid matrices for `origin`
    uint32_t *object_instance;
    struct dmat4 *now, *before; // world_from_node
    uint32_t *still;            // per object: updates in a row without motion
};

struct scene_gpu *scene_gpu_create(struct gpu *gpu, const struct scene *scene);
void scene_gpu_destroy(struct scene_gpu *scene); // NULL is fine

// Moves the origin near `position`, places moving objects at `animation_s` and records the copies to the GPU.
// Motions lead from `before_s` to `animation_s`.
void scene_gpu_update(struct scene_gpu *scene, VkCommandBuffer cmd, struct dvec3 position, double animation_s,
                      double before_s);

// The part of shared_frame that depends on the scene alone.
void scene_gpu_constants(const struct scene_gpu *scene, struct shared_frame *out);

#endif
