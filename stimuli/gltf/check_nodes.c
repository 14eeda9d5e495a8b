// The node hierarchy: a forest of bounded depth, with transforms that have an inverse-free meaning (finite
// numbers).
#include "stimuli/gltf/check.h"

#include <math.h>
#include <stdlib.h>

static bool check_transform(const struct gltf_node *node, const struct gltf_report *report)
{
    const struct {
        const char *name;
        const double *values;
        uint32_t count, expected;
    } parts[] = {{"matrix", node->matrix, node->matrix_count, 16},
                 {"translation", node->translation, node->translation_count, 3},
                 {"rotation", node->rotation, node->rotation_count, 4},
                 {"scale", node->scale, node->scale_count, 3}};
    for (int part = 0; part < 4; part++) {
        if (parts[part].count != 0 && parts[part].count != parts[part].expected)
            return gltf_fail(report, "%s has %u numbers, not %u", parts[part].name, parts[part].count,
                             parts[part].expected);
        // 1e9: a metre in a millionth of a millimetre, or further than the Moon.
        for (uint32_t i = 0; i < parts[part].count; i++)
            if (!(fabs(parts[part].values[i]) <= 1e9))
                return gltf_fail(report, "%s[%u] is %g, not within 1e9", parts[part].name, i,
                                 parts[part].values[i]);
    }
    const double *r = node->rotation, *m = node->matrix;
    if (node->rotation_count == 4 && !(r[0] * r[0] + r[1] * r[1] + r[2] * r[2] + r[3] * r[3] > 1e-12))
        return gltf_fail(report, "rotation is zero, not a unit quaternion");
    if (node->matrix_count == 16 &&
        (fabs(m[3]) > 1e-6 || fabs(m[7]) > 1e-6 || fabs(m[11]) > 1e-6 || fabs(m[15] - 1.0) > 1e-6))
        return gltf_fail(report, "matrix is not affine: its last row is not 0 0 0 1");
    return true;
}

static bool check_node(const struct gltf_document *d, uint32_t index, int32_t *parents,
                       struct gltf_report *report)
{
    const struct gltf_node *node = &d->nodes[index];
    gltf_at(report, "nodes[%u]", index);
    if (!gltf_check_index(node->mesh, d->mesh_count, "mesh", report) ||
        !gltf_check_index(node->camera, d->camera_count, "camera", report) ||
        !gltf_check_index(node->skin, d->skin_count, "skin", report) ||
        !gltf_check_index(node->light, d->light_count, "light", report) || !check_transform(node, report))
        return false;
    for (uint32_t i = 0; i < node->child_count; i++) {
        int32_t child = d->children[node->first_child + i];
        gltf_at(report, "nodes[%u].children[%u]", index, i);
        if (child < 0 || (uint32_t)child >= d->node_count)
            return gltf_fail(report, "names node %d, the file has %u", child, d->node_count);
        if ((uint32_t)child == index)
            return gltf_fail(report, "node %d is its own child", child);
        if (parents[child] != -1)
            return gltf_fail(report, "node %d already has the parent %d", child, parents[child]);
        parents[child] = (int32_t)index;
    }
    return true;
}

// Walks up from every node. With one parent each, a walk that does not end within the depth limit is either a
// chain too long or a cycle; a cycle comes back to where it has been.
static bool check_depth(const struct gltf_document *d, const int32_t *parents, struct gltf_report *report)
{
    for (uint32_t i = 0; i < d->node_count; i++) {
        uint32_t depth = 0;
        int32_t slow = (int32_t)i;
        gltf_at(report, "nodes[%u]", i);
        for (int32_t at = parents[i]; at != -1; at = parents[at]) {
            if (at == (int32_t)i || at == slow)
                return gltf_fail(report, "is part of a cycle of children");
            if (++depth >= GLTF_MAX_NODE_DEPTH)
                return gltf_fail(report, "has more than 256 ancestors, our limit");
            if (depth % 2 == 0)
                slow = parents[slow];
        }
    }
    return true;
}

static bool check_scenes(const struct gltf_document *d, const int32_t *parents, int32_t *seen,
                         struct gltf_report *report)
{
    gltf_at(report, "scene");
    if (!gltf_check_index(d->default_scene, d->scene_count, "scene", report))
        return false;
    for (uint32_t i = 0; i < d->scene_count; i++)
        for (uint32_t k = 0; k < d->scenes[i].count; k++) {
            int32_t root = d->roots[d->scenes[i].first + k];
            gltf_at(report, "scenes[%u].nodes[%u]", i, k);
            if (root < 0 || (uint32_t)root >= d->node_count)
                return gltf_fail(report, "names node %d, the file has %u", root, d->node_count);
            if (parents[root] != -1)
                return gltf_fail(report, "node %d has the parent %d, so it is no root", root, parents[root]);
            if (seen[root] == (int32_t)i)
                return gltf_fail(report, "node %d is listed twice", root);
            seen[root] = (int32_t)i;
        }
    return true;
}

bool gltf_check_nodes(const struct gltf_document *d, struct gltf_report *report)
{
    int32_t *parents = malloc((d->node_count + 1u) * sizeof *parents);
    int32_t *seen = malloc((d->node_count + 1u) * sizeof *seen);
    bool ok = parents != NULL && seen != NULL;
    gltf_at(report, "nodes");
    if (!ok)
        gltf_fail(report, "out of memory");
    for (uint32_t i = 0; ok && i < d->node_count; i++)
        parents[i] = seen[i] = -1;
    for (uint32_t i = 0; ok && i < d->node_count; i++)
        ok = check_node(d, i, parents, report);
    ok = ok && check_depth(d, parents, report) && check_scenes(d, parents, seen, report);
    free(parents);
    free(seen);
    return ok;
}
