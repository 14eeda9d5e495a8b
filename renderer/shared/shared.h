// Types read by both C and GLSL (scalar layout), written once.
//
// Coordinates: world positions are relative to the frame's origin (geometry.h). Pixels are counted from the
// upper left corner; layer 0 is the left eye.
#ifndef RENDERER_SHARED_SHARED_H
#define RENDERER_SHARED_SHARED_H

#ifdef GL_core_profile
#define SHARED_MAT4(name) mat4 name
#define SHARED_VEC4(name) vec4 name
#define SHARED_VEC3(name) vec3 name
#define SHARED_VEC2(name) vec2 name
#define SHARED_STRUCT(name) name
#define SHARED_UINT uint
#define SHARED_INT int
#define SHARED_FLOAT float
#else
#include <stdint.h>
#define SHARED_MAT4(name) float name[16]
#define SHARED_VEC4(name) float name[4]
#define SHARED_VEC3(name) float name[3]
#define SHARED_VEC2(name) float name[2]
#define SHARED_STRUCT(name) struct name
#define SHARED_UINT uint32_t
#define SHARED_INT int32_t
#define SHARED_FLOAT float
#endif

#define SHARED_TILE 8        // work groups are 8x8 pixels
#define SHARED_CULL_GROUP 64 // items per culling work group
#define SHARED_MARK_CROSS 0
#define SHARED_MARK_BALL 1
#define SHARED_TILES_FIRST 4 // word of a tile list (tiles.glsl) where the tiles begin

struct shared_eye {
    SHARED_MAT4(clip_from_world);      // jittered
    SHARED_MAT4(last_clip_from_world); // of the last frame, unjittered, relative to this frame's origin
    SHARED_MAT4(world_from_eye);       // rotation and position
    SHARED_VEC4(tangents);             // unjittered: left, right, down, up; positive away from the axis
    SHARED_VEC4(gaze);                 // unit direction in the eye's frame; w = 0 where there is no valid gaze
    SHARED_VEC4(planes[4]);            // left, right, bottom, top of the frustum, inward unit normals, world
    SHARED_VEC4(forward);              // unit, world; w = -dot(forward, position): distance in front of the eye
};

struct shared_frame {
    SHARED_STRUCT(shared_eye) eyes[2];
    SHARED_VEC4(sun_direction);   // towards the sun, world; w = 1 where there is a sun
    SHARED_VEC4(sun_illuminance); // lx, rgb
    SHARED_VEC4(sky_zenith);      // cd/m^2, rgb
    SHARED_VEC4(sky_horizon);
    SHARED_VEC4(sky_ground);
    SHARED_MAT4(shadow_from_world); // texture coordinates and depth in the sun's map
    SHARED_VEC4(origin_shift);      // old origin minus new origin: added to positions kept from the last frame
    SHARED_UINT width;
    SHARED_UINT height;
    SHARED_UINT light_count;
    SHARED_UINT item_count;
    SHARED_VEC2(jitter); // pixels: pixel p of the G-buffer shows the image at p + 0.5 - jitter
    SHARED_FLOAT near_m;
    SHARED_FLOAT exposure; // 0.18 / luminance
    SHARED_UINT moving;    // 0: moving ids are ignored, objects stand still
    SHARED_FLOAT shadow_texel_m;
};

// A submodel of one instance: what is culled and drawn.
struct shared_item {
    SHARED_UINT object;
    SHARED_UINT material;
    SHARED_UINT bucket;
    SHARED_UINT first_index;
    SHARED_UINT index_count;
    SHARED_VEC3(box_min); // mesh space
    SHARED_VEC3(box_max);
};

// Items [first_item, first_item + item_count) of one bucket, culled by one work group.
struct shared_cull_group {
    SHARED_UINT bucket;
    SHARED_UINT first_item;
    SHARED_UINT item_count;
    SHARED_UINT first_group; // of the bucket
    SHARED_UINT bucket_first_item;
    SHARED_UINT last; // 1: the bucket's last group
};

struct shared_object {
    SHARED_MAT4(world_from_mesh);
    SHARED_UINT moving_id; // 0: static
    SHARED_UINT moved;     // 1: its place changed lately (scene_gpu.h)
};

struct shared_material {
    SHARED_VEC4(base_colour);
    SHARED_VEC3(emissive);
    SHARED_FLOAT metallic;
    SHARED_FLOAT roughness;
    SHARED_FLOAT normal_scale;
    SHARED_FLOAT occlusion_strength;
    SHARED_FLOAT alpha_cutoff;
    SHARED_UINT uv_sets;            // bit i: texture slot i reads the second set
    SHARED_FLOAT transforms[5 * 6]; // per slot: u' = t0 u + t1 v + t2, v' = t3 u + t4 v + t5
};

struct shared_light {
    SHARED_VEC3(position);
    SHARED_FLOAT range_m;
    SHARED_VEC3(intensity); // cd
    SHARED_FLOAT cos_inner;
    SHARED_VEC3(direction);
    SHARED_FLOAT cos_outer; // -2: a point light
};

// VkDrawIndexedIndirectCommand
struct shared_draw {
    SHARED_UINT index_count;
    SHARED_UINT instance_count;
    SHARED_UINT first_index;
    SHARED_INT vertex_offset;
    SHARED_UINT first_instance;
};

// Counted by the frame's kernels, read back after it.
struct shared_counters {
    SHARED_UINT shaded_px;
    SHARED_UINT triangles;
    SHARED_UINT submodels;
    SHARED_UINT frustum_triangles; // 0 where culling is by the frustum alone
    SHARED_UINT frustum_submodels;
    SHARED_UINT moving_px; // counted by passes/motion alone
};

// Something laid over the pictures, e.g. a fixation target.
struct shared_mark_eye {
    SHARED_VEC2(centre); // pixels
    SHARED_VEC2(
        unit_from_x); // takes pixels from there to the unit disc, right and up positive: of a pixel right
    SHARED_VEC2(unit_from_y); // and of one down
    SHARED_FLOAT opacity;     // 0: not in this eye
};

struct shared_mark {
    SHARED_STRUCT(shared_mark_eye) eyes[2];
    SHARED_VEC3(colour); // sRGB-encoded
    SHARED_UINT kind;    // SHARED_MARK_*
    SHARED_FLOAT fade;   // how far its colours are mixed with mid gray
};

#ifndef GL_core_profile
_Static_assert(sizeof(struct shared_mark) == 2 * 28 + 20, "scalar layout has no padding");
_Static_assert(sizeof(struct shared_eye) == 16 * 4 * 3 + 16 * 7, "scalar layout has no padding");
_Static_assert(sizeof(struct shared_item) == 44, "scalar layout has no padding");
_Static_assert(sizeof(struct shared_draw) == 20, "VkDrawIndexedIndirectCommand");
#endif

#endif
