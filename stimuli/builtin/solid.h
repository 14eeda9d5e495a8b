// Curved and flat surfaces as triangles: patches, boxes, lathed, extruded and arched profiles.
//
// A brush says what a surface is made of and where it stands; every shape is given in the brush's own frame and
// its front faces are counter-clockwise from outside. Texture coordinates follow metres on the surface.
#ifndef STIMULI_BUILTIN_SOLID_H
#define STIMULI_BUILTIN_SOLID_H

#include "stimuli/builtin/maker.h"

// Axes are orthonormal and right-handed, so that winding survives.
struct solid_place {
    float origin[3], x[3], y[3], z[3];
};

struct solid_brush {
    struct maker *maker;
    uint32_t material;
    float tile_m;      // metres covered by one texture
    float uv_shift[2]; // in textures, so that neighbours do not look alike
    struct solid_place place;
};

// At `origin`, turned by `yaw` radians about y (0: axes as the world's; x turns towards -z).
struct solid_place solid_place(float x, float y, float z, float yaw);

// Front side: cross(dP/du, dP/dv). out_uv_m: texture coordinates in metres, v down.
typedef void (*solid_surface_fn)(const void *shape, float u, float v, float out_position[3], float out_uv_m[2]);
// nu x nv quads over 0..1 x 0..1; triangles without area are left out.
void solid_patch(const struct solid_brush *brush, const void *shape, solid_surface_fn surface, uint32_t nu,
                 uint32_t nv);

// A parallelogram with its front to cross(along, up), cut into quads of at most cell_m.
void solid_quad(const struct solid_brush *brush, const float corner[3], const float along[3], const float up[3],
                float cell_m);

enum { SOLID_LEFT = 1, SOLID_RIGHT = 2, SOLID_BOTTOM = 4, SOLID_TOP = 8, SOLID_BACK = 16, SOLID_FRONT = 32 };
#define SOLID_ALL 63u
// Faces named in `faces` (x-, x+, y-, y+, z-, z+).
void solid_box(const struct solid_brush *brush, const float min[3], const float max[3], unsigned faces,
               float cell_m);

// A profile is a chain of corners; the piece to the next corner is straight or a quarter or half ellipse.
// Pieces meet in hard edges. The chain runs so that the outside lies to its right (upwards with x outwards).
enum solid_piece {
    SOLID_LINE,
    SOLID_OVOLO, // quarter ellipse, leaves along x first (bulges)
    SOLID_COVE,  // quarter ellipse, leaves along y first (hollow when growing outwards)
    SOLID_TORUS, // half ellipse bulging outwards between two corners of equal x
    SOLID_SHAFT, // straight with entasis: a swelling of 2 % of its length, greatest at a third
};
struct solid_corner {
    float x, y; // x: radius or distance outwards
    enum solid_piece piece;
    uint32_t cuts; // segments of this piece
};

// Turned about y through 0; `sides` quads around.
void solid_lathe(const struct solid_brush *brush, const struct solid_corner *profile, uint32_t corners,
                 uint32_t sides);
// The profile around the inside of the rectangle |x| <= half_x, |z| <= half_z, x measured inwards; mitred
// corners.
void solid_frame(const struct solid_brush *brush, const struct solid_corner *profile, uint32_t corners,
                 float half_x, float half_z, float cell_m);
// The profile along a half circle about the origin in the x-y plane: radius = profile.x, z = profile.y.
void solid_arch(const struct solid_brush *brush, const struct solid_corner *profile, uint32_t corners,
                uint32_t sides);
// A whole ring in the x-y plane with a round section.
void solid_ring(const struct solid_brush *brush, float radius, float thickness, uint32_t sides, uint32_t cuts);

#endif
