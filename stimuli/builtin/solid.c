#include "stimuli/builtin/solid.h"

#include <math.h>

#define PI 3.14159265358979f
#define STEP 1e-3f           // of a patch's side, for the derivatives that give its normals
#define SMALLEST_AREA 1e-10f // m^2; smaller triangles are poles or folded edges

struct solid_place solid_place(float x, float y, float z, float yaw)
{
    float c = cosf(yaw), s = sinf(yaw);
    return (struct solid_place){.origin = {x, y, z}, .x = {c, 0, -s}, .y = {0, 1, 0}, .z = {s, 0, c}};
}

static void cross(const float a[3], const float b[3], float out[3])
{
    out[0] = a[1] * b[2] - a[2] * b[1];
    out[1] = a[2] * b[0] - a[0] * b[2];
    out[2] = a[0] * b[1] - a[1] * b[0];
}

static float length(const float a[3])
{
    return sqrtf(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]);
}

static void to_world(const struct solid_place *p, const float v[3], float w, float out[3])
{
    for (int i = 0; i < 3; i++)
        out[i] = p->x[i] * v[0] + p->y[i] * v[1] + p->z[i] * v[2] + w * p->origin[i];
}

static void patch_normal(const void *shape, solid_surface_fn surface, float u, float v, float out[3])
{
    // At a pole one derivative vanishes; a little further inside it does not.
    for (int attempt = 0; attempt < 3; attempt++) {
        float a[3], b[3], c[3], d[3], uv[2];
        surface(shape, u - STEP, v, a, uv);
        surface(shape, u + STEP, v, b, uv);
        surface(shape, u, v - STEP, c, uv);
        surface(shape, u, v + STEP, d, uv);
        float du[3] = {b[0] - a[0], b[1] - a[1], b[2] - a[2]}, dv[3] = {d[0] - c[0], d[1] - c[1], d[2] - c[2]};
        cross(du, dv, out);
        float n = length(out);
        if (n > 1e-4f * (length(du) * length(dv)) && n > 1e-14f) {
            for (int i = 0; i < 3; i++)
                out[i] /= n;
            return;
        }
        u = 0.5f + (u - 0.5f) * 0.98f;
        v = 0.5f + (v - 0.5f) * 0.98f;
    }
    out[0] = out[2] = 0;
    out[1] = 1;
}

static float area2(const struct maker_vertex *a, const struct maker_vertex *b, const struct maker_vertex *c)
{
    float ab[3], ac[3], n[3];
    for (int i = 0; i < 3; i++) {
        ab[i] = b->position[i] - a->position[i];
        ac[i] = c->position[i] - a->position[i];
    }
    cross(ab, ac, n);
    return length(n);
}

static void triangle(const struct solid_brush *brush, uint32_t a, uint32_t b, uint32_t c)
{
    if (brush->maker->failed)
        return;
    const struct maker_vertex *v = brush->maker->buckets[brush->material].vertices;
    if (area2(&v[a], &v[b], &v[c]) > 2 * SMALLEST_AREA)
        maker_triangle(brush->maker, brush->material, a, b, c);
}

void solid_patch(const struct solid_brush *brush, const void *shape, solid_surface_fn surface, uint32_t nu,
                 uint32_t nv)
{
    uint32_t first = brush->maker->buckets[brush->material].vertex_count;
    for (uint32_t j = 0; j <= nv; j++) {
        for (uint32_t i = 0; i <= nu; i++) {
            float u = (float)i / (float)nu, v = (float)j / (float)nv, p[3], n[3], uv[2];
            surface(shape, u, v, p, uv);
            patch_normal(shape, surface, u, v, n);
            struct maker_vertex vertex = {.colour = {1, 1, 1}};
            to_world(&brush->place, p, 1, vertex.position);
            to_world(&brush->place, n, 0, vertex.normal);
            vertex.uv[0] = uv[0] / brush->tile_m + brush->uv_shift[0];
            vertex.uv[1] = uv[1] / brush->tile_m + brush->uv_shift[1];
            maker_vertex(brush->maker, brush->material, &vertex);
        }
    }
    for (uint32_t j = 0; j < nv; j++) {
        for (uint32_t i = 0; i < nu; i++) {
            uint32_t a = first + j * (nu + 1) + i, b = a + 1, c = b + nu + 1, d = a + nu + 1;
            triangle(brush, a, b, c);
            triangle(brush, a, c, d);
        }
    }
}

struct quad {
    const float *corner, *along, *up;
    float width, height;
};

static void quad_surface(const void *shape, float u, float v, float p[3], float uv[2])
{
    const struct quad *q = shape;
    for (int i = 0; i < 3; i++)
        p[i] = q->corner[i] + q->along[i] * u + q->up[i] * v;
    uv[0] = u * q->width;
    uv[1] = -v * q->height;
}

static uint32_t cuts_of(float metres, float cell_m)
{
    float n = ceilf(metres / cell_m - 0.01f);
    return n < 1 ? 1 : (uint32_t)n;
}

void solid_quad(const struct solid_brush *brush, const float corner[3], const float along[3], const float up[3],
                float cell_m)
{
    struct quad q = {corner, along, up, length(along), length(up)};
    solid_patch(brush, &q, quad_surface, cuts_of(q.width, cell_m), cuts_of(q.height, cell_m));
}

void solid_box(const struct solid_brush *brush, const float min[3], const float max[3], unsigned faces,
               float cell_m)
{
    float x = max[0] - min[0], y = max[1] - min[1], z = max[2] - min[2];
    const struct {
        unsigned face;
        float corner[3], along[3], up[3];
    } sides[6] = {
        {SOLID_LEFT, {min[0], min[1], min[2]}, {0, 0, z}, {0, y, 0}},
        {SOLID_RIGHT, {max[0], min[1], max[2]}, {0, 0, -z}, {0, y, 0}},
        {SOLID_BOTTOM, {min[0], min[1], min[2]}, {x, 0, 0}, {0, 0, z}},
        {SOLID_TOP, {min[0], max[1], max[2]}, {x, 0, 0}, {0, 0, -z}},
        {SOLID_BACK, {max[0], min[1], min[2]}, {-x, 0, 0}, {0, y, 0}},
        {SOLID_FRONT, {min[0], min[1], max[2]}, {x, 0, 0}, {0, y, 0}},
    };
    for (int i = 0; i < 6; i++)
        if (faces & sides[i].face)
            solid_quad(brush, sides[i].corner, sides[i].along, sides[i].up, cell_m);
}

static void piece_at(const struct solid_corner *a, float t, float *x, float *y)
{
    const struct solid_corner *b = a + 1;
    float w = b->x - a->x, h = b->y - a->y, angle = t * PI / 2;
    switch (a->piece) {
    case SOLID_OVOLO:
        *x = a->x + w * sinf(angle);
        *y = a->y + h * (1 - cosf(angle));
        return;
    case SOLID_COVE:
        *x = a->x + w * (1 - cosf(angle));
        *y = a->y + h * sinf(angle);
        return;
    case SOLID_TORUS:
        *x = a->x + w * t + 0.5f * fabsf(h) * sinf(2 * angle);
        *y = a->y + h * 0.5f * (1 - cosf(2 * angle));
        return;
    case SOLID_SHAFT:
        *x = a->x + w * t + 0.02f * h * 0.35f * sinf(PI * powf(fmaxf(t, 0), 0.63f));
        *y = a->y + h * t;
        return;
    case SOLID_LINE:
        break;
    }
    *x = a->x + w * t;
    *y = a->y + h * t;
}

struct turned {
    const struct solid_corner *corner;
    float circumference, start_m;
    float half_x, half_z; // of a frame
    float depth_m;        // of a ring
};

static float piece_length(const struct solid_corner *a)
{
    float sum = 0, px = a->x, py = a->y;
    for (uint32_t i = 1; i <= 8; i++) {
        float x, y;
        piece_at(a, (float)i / 8, &x, &y);
        sum += hypotf(x - px, y - py);
        px = x;
        py = y;
    }
    return sum;
}

static void lathe_surface(const void *shape, float u, float v, float p[3], float uv[2])
{
    const struct turned *s = shape;
    float r, y;
    piece_at(s->corner, v, &r, &y);
    float a = -u * 2 * PI;
    p[0] = r * cosf(a);
    p[1] = y;
    p[2] = r * sinf(a);
    uv[0] = u * s->circumference;
    uv[1] = -(s->start_m + v * s->depth_m);
}

void solid_lathe(const struct solid_brush *brush, const struct solid_corner *profile, uint32_t corners,
                 uint32_t sides)
{
    float widest = 0, start = 0;
    for (uint32_t i = 0; i < corners; i++)
        widest = fmaxf(widest, profile[i].x);
    // A whole number of textures around, so that the seam does not show.
    float tiles = fmaxf(roundf(2 * PI * widest * 0.8f / brush->tile_m), 1);
    for (uint32_t i = 0; i + 1 < corners; i++) {
        struct turned shape = {.corner = &profile[i], .circumference = tiles * brush->tile_m, .start_m = start};
        shape.depth_m = piece_length(&profile[i]);
        solid_patch(brush, &shape, lathe_surface, sides, profile[i].cuts);
        start += shape.depth_m;
    }
}

static void frame_surface(const void *shape, float u, float v, float p[3], float uv[2])
{
    const struct turned *s = shape;
    float inwards, y;
    piece_at(s->corner, v, &inwards, &y);
    // The side at z = -half_z, seen from inside; x runs to the right.
    p[0] = (2 * u - 1) * (s->half_x - inwards);
    p[1] = y;
    p[2] = -(s->half_z - inwards);
    uv[0] = p[0];
    uv[1] = -(s->start_m + v * s->depth_m);
}

void solid_frame(const struct solid_brush *brush, const struct solid_corner *profile, uint32_t corners,
                 float half_x, float half_z, float cell_m)
{
    for (int side = 0; side < 4; side++) {
        struct solid_brush turned = *brush;
        struct solid_place turn = solid_place(0, 0, 0, (float)side * PI / 2);
        to_world(&brush->place, turn.x, 0, turned.place.x);
        to_world(&brush->place, turn.y, 0, turned.place.y);
        to_world(&brush->place, turn.z, 0, turned.place.z);
        float start = 0, x = side % 2 ? half_z : half_x, z = side % 2 ? half_x : half_z;
        for (uint32_t i = 0; i + 1 < corners; i++) {
            struct turned shape = {.corner = &profile[i], .half_x = x, .half_z = z, .start_m = start};
            shape.depth_m = piece_length(&profile[i]);
            solid_patch(&turned, &shape, frame_surface, cuts_of(2 * x, cell_m), profile[i].cuts);
            start += shape.depth_m;
        }
    }
}

static void arch_surface(const void *shape, float u, float v, float p[3], float uv[2])
{
    const struct turned *s = shape;
    float r, z;
    piece_at(s->corner, v, &r, &z);
    float a = PI * (1 - u);
    p[0] = r * cosf(a);
    p[1] = r * sinf(a);
    p[2] = z;
    uv[0] = u * s->circumference;
    uv[1] = s->start_m + v * s->depth_m;
}

void solid_arch(const struct solid_brush *brush, const struct solid_corner *profile, uint32_t corners,
                uint32_t sides)
{
    float start = 0;
    for (uint32_t i = 0; i + 1 < corners; i++) {
        struct turned shape = {.corner = &profile[i], .circumference = PI * profile[0].x, .start_m = start};
        shape.depth_m = piece_length(&profile[i]);
        solid_patch(brush, &shape, arch_surface, sides, profile[i].cuts);
        start += shape.depth_m;
    }
}

struct ring {
    float radius, thickness;
};

static void ring_surface(const void *shape, float u, float v, float p[3], float uv[2])
{
    const struct ring *s = shape;
    float a = 2 * PI * u, b = 2 * PI * v, r = s->radius + s->thickness * cosf(b);
    p[0] = r * cosf(a);
    p[1] = r * sinf(a);
    p[2] = s->thickness * sinf(b);
    uv[0] = u * 2 * PI * s->radius;
    uv[1] = -v * 2 * PI * s->thickness;
}

void solid_ring(const struct solid_brush *brush, float radius, float thickness, uint32_t sides, uint32_t cuts)
{
    struct ring shape = {radius, thickness};
    solid_patch(brush, &shape, ring_surface, sides, cuts);
}
