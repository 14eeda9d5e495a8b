// Tangents from texture coordinates: Lengyel, Foundations of Game Engine Development vol. 2, section 7.5; the
// same per-triangle directions, weighted by area instead of by texture density, so that one stretched triangle
// does not turn its neighbours' frames.
#include "stimuli/scene.h"

#include <math.h>
#include <stdlib.h>

struct sums {
    double tangent[3], bitangent[3];
};

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void cross(const double a[3], const double b[3], double out[3])
{
    out[0] = a[1] * b[2] - a[2] * b[1];
    out[1] = a[2] * b[0] - a[0] * b[2];
    out[2] = a[0] * b[1] - a[1] * b[0];
}

static bool normalise(double v[3])
{
    double length = sqrt(dot(v, v));
    if (!(length > 1e-30) || !isfinite(length))
        return false;
    for (int i = 0; i < 3; i++)
        v[i] /= length;
    return true;
}

static void decode_normal(const int16_t encoded[2], double out[3])
{
    double u = encoded[0] / 32767.0, v = encoded[1] / 32767.0;
    double z = 1.0 - fabs(u) - fabs(v);
    out[0] = z >= 0.0 ? u : copysign(1.0 - fabs(v), u);
    out[1] = z >= 0.0 ? v : copysign(1.0 - fabs(u), v);
    out[2] = z;
    normalise(out);
}

static void add_triangle(const struct scene_vertex *vertices, const uint32_t triangle[3], struct sums *sums)
{
    const struct scene_vertex *a = &vertices[triangle[0]], *b = &vertices[triangle[1]],
                              *c = &vertices[triangle[2]];
    double e1[3], e2[3], normal[3];
    for (int i = 0; i < 3; i++) {
        e1[i] = (double)b->position[i] - (double)a->position[i];
        e2[i] = (double)c->position[i] - (double)a->position[i];
    }
    double u1 = (double)b->uv[0][0] - (double)a->uv[0][0], v1 = (double)b->uv[0][1] - (double)a->uv[0][1];
    double u2 = (double)c->uv[0][0] - (double)a->uv[0][0], v2 = (double)c->uv[0][1] - (double)a->uv[0][1];
    double turn = u1 * v2 - u2 * v1;
    if (fabs(turn) < 1e-20 || !isfinite(turn))
        return;
    double tangent[3], bitangent[3];
    for (int i = 0; i < 3; i++) {
        tangent[i] = (e1[i] * v2 - e2[i] * v1) * copysign(1.0, turn);
        bitangent[i] = (e2[i] * u1 - e1[i] * u2) * copysign(1.0, turn);
    }
    cross(e1, e2, normal);
    double area = sqrt(dot(normal, normal));
    if (!normalise(tangent) || !normalise(bitangent))
        return;
    for (int k = 0; k < 3; k++)
        for (int i = 0; i < 3; i++) {
            sums[triangle[k]].tangent[i] += area * tangent[i];
            sums[triangle[k]].bitangent[i] += area * bitangent[i];
        }
}

// Any direction at right angles to the normal: from the axis that the normal leans to least.
static void any_tangent(const double normal[3], double out[3])
{
    double axis[3] = {0.0, 0.0, 0.0};
    int least = 0;
    for (int i = 1; i < 3; i++)
        if (fabs(normal[i]) < fabs(normal[least]))
            least = i;
    axis[least] = 1.0;
    cross(normal, axis, out);
    normalise(out);
}

static void write_tangent(struct scene_vertex *vertex, const struct sums *sums)
{
    double normal[3], tangent[3], bitangent[3];
    decode_normal(vertex->normal, normal);
    double sign = 1.0;
    bool ok = false;
    if (sums != NULL) {
        double along = dot(normal, sums->tangent);
        for (int i = 0; i < 3; i++)
            tangent[i] = sums->tangent[i] - along * normal[i];
        ok = normalise(tangent);
        cross(normal, sums->tangent, bitangent);
        sign = dot(bitangent, sums->bitangent) < 0.0 ? -1.0 : 1.0;
    }
    if (!ok) {
        any_tangent(normal, tangent);
        sign = 1.0;
    }
    for (int i = 0; i < 3; i++)
        vertex->tangent[i] = (int16_t)lround(tangent[i] * 32767.0);
    vertex->tangent[3] = (int16_t)(sign * 32767.0);
}

void scene_make_tangents(struct scene_vertex *vertices, uint32_t vertex_count, const uint32_t *indices,
                         uint32_t index_count)
{
    // Without memory for the sums every tangent is merely some direction at right angles to the normal.
    struct sums *sums = calloc((size_t)vertex_count + 1, sizeof *sums);
    for (uint32_t i = 0; sums != NULL && i + 2 < index_count; i += 3)
        add_triangle(vertices, indices + i, sums);
    for (uint32_t i = 0; i < vertex_count; i++)
        if (vertices[i].tangent[3] == 0)
            write_tangent(&vertices[i], sums != NULL ? &sums[i] : NULL);
    free(sums);
}
