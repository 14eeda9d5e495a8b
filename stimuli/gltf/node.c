// The chosen scene's nodes, parents first, and the meshes that stand at them.
#include "stimuli/gltf/build.h"

#include <stdlib.h>
#include <string.h>

static void take_transform(const struct gltf_node *node, struct scene_node *out)
{
    const double *t = node->translation, *r = node->rotation, *s = node->scale;
    out->translation = (struct dvec3){0.0, 0.0, 0.0};
    out->rotation = (struct dquat){0.0, 0.0, 0.0, 1.0};
    out->scale = (struct dvec3){1.0, 1.0, 1.0};
    if (node->translation_count == 3)
        out->translation = (struct dvec3){t[0], t[1], t[2]};
    if (node->rotation_count == 4)
        out->rotation = dquat_normalise((struct dquat){r[0], r[1], r[2], r[3]});
    if (node->scale_count == 3)
        out->scale = (struct dvec3){s[0], s[1], s[2]};
    if (node->matrix_count == 16)
        memcpy(out->local.m, node->matrix, sizeof out->local.m);
    else
        out->local = dmat4_compose(out->translation, out->rotation, out->scale);
}

static void add_node(struct gltf_build *build, int32_t file_node, int32_t parent)
{
    struct scene *scene = build->scene;
    const struct gltf_node *node = &build->document->nodes[file_node];
    struct scene_node *out = &scene->nodes[scene->node_count];
    *out = (struct scene_node){.parent = parent};
    take_transform(node, out);
    build->scene_node[file_node] = (int32_t)scene->node_count;
    if (node->mesh >= 0)
        scene->instances[scene->instance_count++] =
            (struct scene_instance){.mesh = (uint32_t)node->mesh, .node = scene->node_count};
    scene->node_count++;
}

// Roots of the scene that the file shows first; of a file without scenes, every node without a parent.
static uint32_t add_roots(struct gltf_build *build, int32_t *order)
{
    const struct gltf_document *d = build->document;
    uint32_t count = 0;
    if (d->scene_count > 0) {
        const struct gltf_root_list *list = &d->scenes[d->default_scene >= 0 ? d->default_scene : 0];
        for (uint32_t i = 0; i < list->count; i++)
            order[count++] = d->roots[list->first + i];
    } else {
        for (uint32_t i = 0; i < d->child_count; i++)
            build->scene_node[d->children[i]] = -2;
        for (uint32_t i = 0; i < d->node_count; i++)
            if (build->scene_node[i] != -2)
                order[count++] = (int32_t)i;
        for (uint32_t i = 0; i < d->node_count; i++)
            build->scene_node[i] = -1;
    }
    for (uint32_t i = 0; i < count; i++)
        add_node(build, order[i], -1);
    return count;
}

bool gltf_build_nodes(struct gltf_build *build)
{
    const struct gltf_document *d = build->document;
    struct scene *scene = build->scene;
    scene->nodes = malloc((d->node_count + 1u) * sizeof *scene->nodes);
    scene->instances = malloc((d->node_count + 1u) * sizeof *scene->instances);
    int32_t *order = malloc((d->node_count + 1u) * sizeof *order);
    gltf_at(&build->report, "nodes");
    bool ok = scene->nodes != NULL && scene->instances != NULL && order != NULL;
    for (uint32_t i = 0; i < d->node_count; i++)
        build->scene_node[i] = -1;
    // Breadth first: `order` is both the queue and the record of which file node became which.
    uint32_t count = ok ? add_roots(build, order) : 0;
    for (uint32_t at = 0; ok && at < count; at++) {
        const struct gltf_node *node = &d->nodes[order[at]];
        for (uint32_t i = 0; i < node->child_count; i++) {
            int32_t child = d->children[node->first_child + i];
            order[count++] = child;
            add_node(build, child, (int32_t)at);
        }
    }
    free(order);
    if (!ok)
        return gltf_fail(&build->report, "out of memory");
    return scene->instance_count > 0 || gltf_fail(&build->report, "no node of the scene has a mesh");
}
