// Vectors, matrices and quaternions in plain C; the arithmetic is GLM's (geometry.cpp).
//
// Right-handed, metres, y up; a camera looks along its -z. Matrices are column-major (m[column * 4 + row]) and
// named to_from: `world_from_eye` takes eye coordinates to world coordinates. Positions and transforms are
// double until an origin near the camera has been subtracted; see geometry_snap_origin.
#ifndef STIMULI_GEOMETRY_H
#define STIMULI_GEOMETRY_H

#ifdef __cplusplus
extern "C" {
#endif

struct dvec3 {
    double x, y, z;
};

struct dquat {
    double x, y, z, w;
};

struct dmat4 {
    double m[16];
};

struct fmat4 {
    float m[16];
};

// Where something stands and how it is turned.
struct pose {
    struct dvec3 position;    // metres, world
    struct dquat orientation; // unit, world from local
};

struct dvec3 dvec3_add(struct dvec3 a, struct dvec3 b);
struct dvec3 dvec3_sub(struct dvec3 a, struct dvec3 b);
struct dvec3 dvec3_scale(struct dvec3 a, double s);
struct dvec3 dvec3_cross(struct dvec3 a, struct dvec3 b);
double dvec3_dot(struct dvec3 a, struct dvec3 b);
double dvec3_length(struct dvec3 a);
// The zero vector stays zero.
struct dvec3 dvec3_normalise(struct dvec3 a);

// Angle between two directions, degrees, 0..180, by atan2(|a x b|, a.b); NaN in gives NaN out.
double geometry_angle_deg(struct dvec3 a, struct dvec3 b);

struct dmat4 dmat4_identity(void);
struct dmat4 dmat4_multiply(const struct dmat4 *a, const struct dmat4 *b);
// A singular matrix gives non-finite values.
struct dmat4 dmat4_inverse(const struct dmat4 *a);
double dmat4_determinant3(const struct dmat4 *a); // of the upper-left 3x3
struct dmat4 dmat4_compose(struct dvec3 translation, struct dquat rotation, struct dvec3 scale);
struct dvec3 dmat4_point(const struct dmat4 *a, struct dvec3 p);     // w = 1, no division
struct dvec3 dmat4_direction(const struct dmat4 *a, struct dvec3 d); // w = 0

struct dquat dquat_normalise(struct dquat q);
struct dquat dquat_slerp(struct dquat a, struct dquat b, double t);
struct dvec3 dquat_rotate(struct dquat q, struct dvec3 v);
// The orientation that looks along `forward` with `up` as upright as it can be; forward need not be a unit
// vector.
struct dquat dquat_look(struct dvec3 forward, struct dvec3 up);

// Infinite reversed-depth projection from the tangents of the half angles, all positive for a frustum that
// contains its axis: depth is near / distance, 1 at `near_m`, 0 at infinity. y points down in clip space
// (Vulkan).
struct fmat4 geometry_projection(double tan_left, double tan_right, double tan_down, double tan_up,
                                 double near_m);

// Transforms with the translation already relative to the origin, rounded to float last.
struct fmat4 geometry_relative(const struct dmat4 *world_from_local, struct dvec3 origin);
// The inverse of a rigid pose, relative to the origin.
struct fmat4 geometry_view(const struct pose *eye, struct dvec3 origin);
struct fmat4 fmat4_multiply(const struct fmat4 *a, const struct fmat4 *b);

// The nearest point of a 64 m grid, moved only when `position` is more than 128 m from `origin` on any axis, so
// that float offsets from it keep about 1e-5 m anywhere in the world.
struct dvec3 geometry_snap_origin(struct dvec3 origin, struct dvec3 position);

#ifdef __cplusplus
}
#endif
#endif
