// The built-in scenes as geometry: counts, vertices, winding, submodels, determinism, motion, room for the
// camera.
#include "stimuli/builtin/builtin.h"

#include <float.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static struct scene *open_or_fail(const char *spec)
{
    char error[512] = "";
    struct scene *scene = builtin_scene_open(spec, error, sizeof error);
    if (scene == NULL)
        fail_msg("%s: %s", spec, error);
    return scene;
}

static void decode(const int16_t e[2], double out[3])
{
    double x = e[0] / 32767.0, y = e[1] / 32767.0, z = 1 - fabs(x) - fabs(y);
    if (z < 0) {
        double fold = (1 - fabs(y)) * (x < 0 ? -1 : 1);
        y = (1 - fabs(x)) * (y < 0 ? -1 : 1);
        x = fold;
    }
    double n = sqrt(x * x + y * y + z * z);
    out[0] = x / n, out[1] = y / n, out[2] = z / n;
}

static uint64_t drawn(const struct scene *s)
{
    uint64_t sum = 0;
    for (uint32_t i = 0; i < s->instance_count; i++) {
        const struct scene_mesh *m = &s->meshes[s->instances[i].mesh];
        for (uint32_t k = 0; k < m->submodel_count; k++)
            sum += s->submodels[m->first_submodel + k].index_count / 3;
    }
    return sum;
}

static void check_vertices(const struct scene *s)
{
    for (uint32_t i = 0; i < s->vertex_count; i++) {
        const struct scene_vertex *v = &s->vertices[i];
        for (int k = 0; k < 3; k++)
            if (!isfinite(v->position[k]) || fabsf(v->position[k]) > 1000)
                fail_msg("vertex %u at %g", i, (double)v->position[k]);
        assert_true(isfinite(v->uv[0][0]) && isfinite(v->uv[0][1]));
        double n[3], t[3], length = 0, level = 0;
        decode(v->normal, n);
        for (int k = 0; k < 3; k++) {
            t[k] = v->tangent[k] / 32767.0;
            length += t[k] * t[k];
            level += t[k] * n[k];
        }
        if (fabs(length - 1) > 1e-3 || fabs(level) > 2e-2 || abs(v->tangent[3]) != 32767)
            fail_msg("vertex %u: tangent of length^2 %g, cosine %g to the normal, w %d", i, length, level,
                     v->tangent[3]);
    }
}

// Triangles have area and their corners lie in the submodel's box, which they touch on all six sides; front
// faces look where the normals do. Billboards are lit like the ground below them and are exempt from the last.
static void check_submodel(const struct scene *s, uint32_t number, uint64_t *backwards)
{
    const struct scene_submodel *m = &s->submodels[number];
    assert_true(m->index_count > 0 && m->index_count % 3 == 0 &&
                m->index_count / 3 <= SCENE_SUBMODEL_TRIANGLES);
    assert_true(m->first_index + m->index_count <= s->index_count && m->material < s->material_count);
    float low[3] = {FLT_MAX, FLT_MAX, FLT_MAX}, high[3] = {-FLT_MAX, -FLT_MAX, -FLT_MAX};
    for (uint32_t i = m->first_index; i < m->first_index + m->index_count; i += 3) {
        double p[3][3], sum[3] = {0}, face[3], facing = 0, area = 0;
        for (int c = 0; c < 3; c++) {
            assert_true(s->indices[i + (uint32_t)c] < s->vertex_count);
            const struct scene_vertex *v = &s->vertices[s->indices[i + (uint32_t)c]];
            double n[3];
            decode(v->normal, n);
            for (int k = 0; k < 3; k++) {
                p[c][k] = (double)v->position[k];
                sum[k] += n[k];
                low[k] = fminf(low[k], v->position[k]);
                high[k] = fmaxf(high[k], v->position[k]);
            }
        }
        for (int k = 0; k < 3; k++) {
            int a = (k + 1) % 3, b = (k + 2) % 3;
            face[k] = (p[1][a] - p[0][a]) * (p[2][b] - p[0][b]) - (p[1][b] - p[0][b]) * (p[2][a] - p[0][a]);
            area += face[k] * face[k];
            facing += face[k] * sum[k];
        }
        if (!(area > 1e-20))
            fail_msg("%s: submodel %u of %s has a triangle without area", s->name, number,
                     s->materials[m->material].name);
        *backwards += facing <= 0 && !s->materials[m->material].alpha_mask;
    }
    for (int k = 0; k < 3; k++)
        if (low[k] != m->bounds.min[k] || high[k] != m->bounds.max[k])
            fail_msg("%s: submodel %u has loose bounds", s->name, number);
}

static void check_textures(const struct scene *s)
{
    for (uint32_t i = 0; i < s->texture_count; i++) {
        const struct scene_texture *t = &s->textures[i];
        assert_true(t->levels > 1 && t->width >> (t->levels - 1) == 1);
    }
    for (uint32_t i = 0; i < s->material_count; i++)
        for (int slot = 0; slot < SCENE_SLOTS; slot++) {
            int32_t texture = s->materials[i].use[slot].texture;
            assert_true(texture >= -1 && texture < (int32_t)s->texture_count);
            if (texture >= 0)
                assert_int_equal(s->textures[texture].srgb,
                                 slot == SCENE_BASE_COLOUR || slot == SCENE_EMISSIVE);
        }
}

static void check_geometry(const struct scene *s)
{
    assert_int_equal(drawn(s), s->triangle_count);
    check_vertices(s);
    check_textures(s);
    uint64_t backwards = 0;
    for (uint32_t i = 0; i < s->submodel_count; i++)
        check_submodel(s, i, &backwards);
    if (backwards > 0)
        fail_msg("%s: %llu triangles face away from their normals", s->name, (unsigned long long)backwards);
    assert_true(fabs(dvec3_length(s->sun.direction) - 1) < 1e-12 && s->luminance > 0);
}

static void atrium_is_sound(void **state)
{
    (void)state;
    struct scene *s = open_or_fail("atrium");
    assert_in_range(s->triangle_count, 200000, 400000);
    assert_int_equal(s->light_count, 0);
    assert_int_equal(s->moving_count, 0);
    check_geometry(s);
    scene_destroy(s);
}

static void town_is_sound_at_every_size(void **state)
{
    (void)state;
    const uint32_t sizes[] = {20000, 27000, 60000, 149999, 150000, 200000, 500000, 1000000, 3000000, 8000000};
    for (size_t i = 0; i < sizeof sizes / sizeof sizes[0]; i++) {
        for (int seed = 1; seed <= 2; seed++) {
            char spec[64];
            snprintf(spec, sizeof spec, "town:triangles=%u,seed=%d", sizes[i], seed);
            struct scene *s = open_or_fail(spec);
            double share = (double)s->triangle_count / sizes[i];
            if (share < 0.9 || share > 1.1)
                fail_msg("%s draws %llu triangles", spec, (unsigned long long)s->triangle_count);
            assert_true(s->light_count <= 20 && s->light_count >= 8);
            assert_true(s->index_count / 3 < 800000);
            if (seed == 1)
                check_geometry(s);
            scene_destroy(s);
        }
    }
}

static void same_array(const void *a, const void *b, size_t bytes)
{
    assert_int_equal(bytes > 0 ? memcmp(a, b, bytes) : 0, 0);
}

static void scenes_repeat_byte_for_byte(void **state)
{
    (void)state;
    const char *specs[] = {"atrium", "town:triangles=300000,seed=7"};
    for (int i = 0; i < 2; i++) {
        struct scene *a = open_or_fail(specs[i]), *b = open_or_fail(specs[i]);
        assert_int_equal(a->vertex_count, b->vertex_count);
        assert_int_equal(a->index_count, b->index_count);
        same_array(a->vertices, b->vertices, a->vertex_count * sizeof *a->vertices);
        same_array(a->indices, b->indices, a->index_count * sizeof *a->indices);
        assert_int_equal(a->submodel_count, b->submodel_count);
        same_array(a->submodels, b->submodels, a->submodel_count * sizeof *a->submodels);
        assert_int_equal(a->instance_count, b->instance_count);
        same_array(a->instances, b->instances, a->instance_count * sizeof *a->instances);
        for (uint32_t t = 0; t < a->texture_count; t++)
            same_array(a->textures[t].rgba, b->textures[t].rgba,
                       (size_t)a->textures[t].width * a->textures[t].height * 4);
        for (uint32_t n = 0; n < a->node_count; n++)
            same_array(&a->nodes[n].local, &b->nodes[n].local, sizeof a->nodes[n].local);
        same_array(a->path.time_s, b->path.time_s, sizeof a->path.time_s);
        scene_destroy(a);
        scene_destroy(b);
    }
    struct scene *a = open_or_fail("town:triangles=300000,seed=7"),
                 *b = open_or_fail("town:triangles=300000,seed=8");
    assert_true(a->vertex_count != b->vertex_count ||
                memcmp(a->vertices, b->vertices, a->vertex_count * sizeof *a->vertices) != 0);
    scene_destroy(a);
    scene_destroy(b);
}

static void objects_move_and_come_back(void **state)
{
    (void)state;
    struct scene *s = open_or_fail("town:triangles=100000");
    struct dmat4 *start = malloc(s->node_count * sizeof *start), *now = malloc(s->node_count * sizeof *now);
    assert_true(s->animation_s > 0 && s->moving_count >= 8);
    scene_pose(s, 0, false, start);
    uint32_t roots = 0;
    for (uint32_t n = 0; n < s->node_count; n++) {
        if (!s->nodes[n].animated || s->nodes[n].parent >= 0)
            continue;
        roots++;
        double farthest = 0, turned = 0, step = 0;
        struct dmat4 before = start[n];
        for (double t = 0; t < (double)s->animation_s; t += 0.1) {
            scene_pose(s, t, false, now);
            double d = 0, r = 0, e = 0;
            for (int k = 12; k < 15; k++) {
                d += pow(now[n].m[k] - start[n].m[k], 2);
                e += pow(now[n].m[k] - before.m[k], 2);
            }
            for (int k = 0; k < 11; k++)
                r += pow(now[n].m[k] - start[n].m[k], 2);
            farthest = fmax(farthest, sqrt(d));
            step = fmax(step, sqrt(e));
            turned = fmax(turned, sqrt(r));
            before = now[n];
        }
        if (farthest < 1 || turned < 0.5 || step > 1.5)
            fail_msg("node %u goes %g m, turns by %g, leaps %g m", n, farthest, turned, step);
    }
    assert_true(roots >= 8);
    scene_pose(s, (double)s->animation_s * 3, false, now);
    for (uint32_t n = 0; n < s->node_count; n++)
        for (int k = 0; k < 16; k++)
            assert_true(fabs(now[n].m[k] - start[n].m[k]) < 1e-4);
    // No leap where the loop closes.
    scene_pose(s, (double)s->animation_s - 1e-3, false, now);
    for (uint32_t n = 0; n < s->node_count; n++)
        for (int k = 0; k < 16; k++)
            assert_true(fabs(now[n].m[k] - start[n].m[k]) < 0.02);
    free(start);
    free(now);
    scene_destroy(s);
}

static double point_triangle(const double q[3], double p[3][3])
{
    // Ericson 2004, Real-Time Collision Detection, section 5.1.5.
    double ab[3], ac[3], ap[3], bp[3], cp[3], d[6] = {0}, v, w, sum = 0;
    for (int k = 0; k < 3; k++) {
        ab[k] = p[1][k] - p[0][k], ac[k] = p[2][k] - p[0][k];
        ap[k] = q[k] - p[0][k], bp[k] = q[k] - p[1][k], cp[k] = q[k] - p[2][k];
        d[0] += ab[k] * ap[k], d[1] += ac[k] * ap[k], d[2] += ab[k] * bp[k];
        d[3] += ac[k] * bp[k], d[4] += ab[k] * cp[k], d[5] += ac[k] * cp[k];
    }
    double vc = d[0] * d[3] - d[2] * d[1], vb = d[4] * d[1] - d[0] * d[5], va = d[2] * d[5] - d[4] * d[3];
    if (d[0] <= 0 && d[1] <= 0)
        v = 0, w = 0;
    else if (d[2] >= 0 && d[3] <= d[2])
        v = 1, w = 0;
    else if (vc <= 0 && d[0] >= 0 && d[2] <= 0)
        v = d[0] / (d[0] - d[2]), w = 0;
    else if (d[5] >= 0 && d[4] <= d[5])
        v = 0, w = 1;
    else if (vb <= 0 && d[1] >= 0 && d[5] <= 0)
        v = 0, w = d[1] / (d[1] - d[5]);
    else if (va <= 0 && d[3] - d[2] >= 0 && d[4] - d[5] >= 0)
        w = (d[3] - d[2]) / (d[3] - d[2] + d[4] - d[5]), v = 1 - w;
    else
        v = vb / (va + vb + vc), w = vc / (va + vb + vc);
    for (int k = 0; k < 3; k++)
        sum += pow(p[0][k] + ab[k] * v + ac[k] * w - q[k], 2);
    return sqrt(sum);
}

static double box_distance(const double q[3], const double low[3], const double high[3])
{
    double sum = 0;
    for (int k = 0; k < 3; k++)
        sum += pow(fmax(fmax(low[k] - q[k], q[k] - high[k]), 0), 2);
    return sqrt(sum);
}

// Distance to the nearest static triangle where it is below `limit`; else limit.
static double clearance(const struct scene *s, const struct dmat4 *world, const double q[3], double limit)
{
    for (uint32_t i = 0; i < s->instance_count; i++) {
        if (s->instances[i].moving_id != 0)
            continue;
        const struct dmat4 inverse = dmat4_inverse(&world[s->instances[i].node]);
        struct dvec3 l = dmat4_point(&inverse, (struct dvec3){q[0], q[1], q[2]});
        double local[3] = {l.x, l.y, l.z};
        const struct scene_mesh *m = &s->meshes[s->instances[i].mesh];
        for (uint32_t k = m->first_submodel; k < m->first_submodel + m->submodel_count; k++) {
            const struct scene_submodel *sub = &s->submodels[k];
            double low[3], high[3];
            for (int a = 0; a < 3; a++)
                low[a] = (double)sub->bounds.min[a], high[a] = (double)sub->bounds.max[a];
            if (box_distance(local, low, high) >= limit)
                continue;
            for (uint32_t t = sub->first_index; t < sub->first_index + sub->index_count; t += 3) {
                double p[3][3];
                for (int c = 0; c < 3; c++)
                    for (int a = 0; a < 3; a++)
                        p[c][a] = (double)s->vertices[s->indices[t + (uint32_t)c]].position[a];
                limit = fmin(limit, point_triangle(local, p));
            }
        }
    }
    return limit;
}

static void cameras_keep_clear_of_geometry(void **state)
{
    (void)state;
    const char *specs[] = {"atrium", "town", "town:seed=2,triangles=1000000", "town:triangles=20000"};
    for (int i = 0; i < 4; i++) {
        struct scene *s = open_or_fail(specs[i]);
        struct dmat4 *world = malloc(s->node_count * sizeof *world);
        scene_pose(s, 0, false, world);
        for (double t = 0; t < s->path.duration_s; t += 0.25) {
            struct pose p = camera_path_pose(&s->path, t);
            double q[3] = {p.position.x, p.position.y, p.position.z}, d = clearance(s, world, q, 0.8);
            if (d < 0.4)
                fail_msg("%s: %g m from a surface at %g s (%g, %g, %g)", specs[i], d, t, q[0], q[1], q[2]);
        }
        free(world);
        scene_destroy(s);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(atrium_is_sound),
        cmocka_unit_test(town_is_sound_at_every_size),
        cmocka_unit_test(scenes_repeat_byte_for_byte),
        cmocka_unit_test(objects_move_and_come_back),
        cmocka_unit_test(cameras_keep_clear_of_geometry),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
