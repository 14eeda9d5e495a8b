#include "stimuli/geometry.h"

#include <cmath>
#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/gtc/type_ptr.hpp>

namespace
{

glm::dvec3 in(dvec3 v)
{
    return {v.x, v.y, v.z};
}
dvec3 out(glm::dvec3 v)
{
    return {v.x, v.y, v.z};
}
glm::dquat in(dquat q)
{
    return {q.w, q.x, q.y, q.z};
}
dquat out(glm::dquat q)
{
    return {q.x, q.y, q.z, q.w};
}
glm::dmat4 in(const dmat4 *a)
{
    return glm::make_mat4(a->m);
}
dmat4 out(const glm::dmat4 &a)
{
    dmat4 r;
    for (int i = 0; i < 16; i++)
        r.m[i] = glm::value_ptr(a)[i];
    return r;
}
fmat4 narrow(const glm::dmat4 &a)
{
    fmat4 r;
    for (int i = 0; i < 16; i++)
        r.m[i] = static_cast<float>(glm::value_ptr(a)[i]);
    return r;
}

} // namespace

struct dvec3 dvec3_add(struct dvec3 a, struct dvec3 b)
{
    return out(in(a) + in(b));
}

struct dvec3 dvec3_sub(struct dvec3 a, struct dvec3 b)
{
    return out(in(a)-in(b));
}

struct dvec3 dvec3_scale(struct dvec3 a, double s)
{
    return out(in(a)*s);
}

struct dvec3 dvec3_cross(struct dvec3 a, struct dvec3 b)
{
    return out(glm::cross(in(a), in(b)));
}

double dvec3_dot(struct dvec3 a, struct dvec3 b)
{
    return glm::dot(in(a), in(b));
}

double dvec3_length(struct dvec3 a)
{
    return glm::length(in(a));
}

struct dvec3 dvec3_normalise(struct dvec3 a)
{
    double length = dvec3_length(a);
    return length > 0 ? dvec3_scale(a, 1 / length) : a;
}

double geometry_angle_deg(struct dvec3 a, struct dvec3 b)
{
    return glm::degrees(std::atan2(dvec3_length(dvec3_cross(a, b)), dvec3_dot(a, b)));
}

struct dmat4 dmat4_identity(void)
{
    return out(glm::dmat4(1));
}

struct dmat4 dmat4_multiply(const struct dmat4 *a, const struct dmat4 *b)
{
    return out(in(a)*in(b));
}

struct dmat4 dmat4_inverse(const struct dmat4 *a)
{
    return out(glm::inverse(in(a)));
}

double dmat4_determinant3(const struct dmat4 *a)
{
    return glm::determinant(glm::dmat3(in(a)));
}

struct dmat4 dmat4_compose(struct dvec3 translation, struct dquat rotation, struct dvec3 scale)
{
    glm::dmat4 r = glm::mat4_cast(in(rotation));
    r[0] *= scale.x;
    r[1] *= scale.y;
    r[2] *= scale.z;
    r[3] = glm::dvec4(in(translation), 1);
    return out(r);
}

struct dvec3 dmat4_point(const struct dmat4 *a, struct dvec3 p)
{
    return out(glm::dvec3(in(a)*glm::dvec4(in(p), 1)));
}

struct dvec3 dmat4_direction(const struct dmat4 *a, struct dvec3 d)
{
    return out(glm::dvec3(in(a)*glm::dvec4(in(d), 0)));
}

struct dquat dquat_normalise(struct dquat q)
{
    return out(glm::normalize(in(q)));
}

struct dquat dquat_slerp(struct dquat a, struct dquat b, double t)
{
    return out(glm::slerp(in(a), in(b), t));
}

struct dvec3 dquat_rotate(struct dquat q, struct dvec3 v)
{
    return out(in(q)*in(v));
}

struct dquat dquat_look(struct dvec3 forward, struct dvec3 up)
{
    glm::dvec3 back = -glm::normalize(in(forward));
    glm::dvec3 right = glm::cross(in(up), back);
    if (glm::length(right) < 1e-9) // looking straight up or down: any right will do
        right = glm::cross(glm::dvec3(0, 0, 1), back);
    if (glm::length(right) < 1e-9)
        right = glm::cross(glm::dvec3(1, 0, 0), back);
    right = glm::normalize(right);
    return out(glm::normalize(glm::quat_cast(glm::dmat3(right, glm::cross(back, right), back))));
}

struct fmat4 geometry_projection(double tan_left, double tan_right, double tan_down, double tan_up,
                                 double near_m)
{
    glm::dmat4 p(0);
    p[0][0] = 2 / (tan_right + tan_left);
    p[1][1] = -2 / (tan_up + tan_down);
    p[2][0] = (tan_right - tan_left) / (tan_right + tan_left);
    p[2][1] = -(tan_up - tan_down) / (tan_up + tan_down);
    p[2][3] = -1;
    p[3][2] = near_m;
    return narrow(p);
}

struct fmat4 geometry_relative(const struct dmat4 *world_from_local, struct dvec3 origin)
{
    glm::dmat4 r = in(world_from_local);
    r[3] -= glm::dvec4(in(origin), 0);
    return narrow(r);
}

struct fmat4 geometry_view(const struct pose *eye, struct dvec3 origin)
{
    glm::dmat3 eye_from_world = glm::transpose(glm::mat3_cast(in(eye->orientation)));
    glm::dmat4 r(eye_from_world);
    r[3] = glm::dvec4(eye_from_world * (in(origin)-in(eye->position)), 1);
    return narrow(r);
}

struct fmat4 fmat4_multiply(const struct fmat4 *a, const struct fmat4 *b)
{
    return narrow(glm::dmat4(glm::make_mat4(a->m)) * glm::dmat4(glm::make_mat4(b->m)));
}

struct dvec3 geometry_snap_origin(struct dvec3 origin, struct dvec3 position)
{
    const double grid_m = 64, leash_m = 128;
    glm::dvec3 away = glm::abs(in(position)-in(origin));
    if (glm::max(away.x, glm::max(away.y, away.z)) <= leash_m)
        return origin;
    return out(glm::round(in(position) / grid_m) * grid_m);
}
