// A tree of boxes over the boxes of all still submodels in world space, halved at the median of the longest
// axis; in its leaves the slab test decides whose triangles are tried, in mesh space, where they lie. A
// submodel's triangles are ordered to be close to their neighbours, so each few of them have a box of their
// own.
//
// Triangles: Moller and Trumbore, "Fast, Minimum Storage Ray/Triangle Intersection", Journal of Graphics Tools
// 2(1), 1997, without culling. The ray is taken into mesh space with its length, so t stays metres.
#include "stimuli/ray.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>

// Boxes are this much larger, so that rounding never takes a flat one's surface out of it.
#define PADDING_M 1e-6
// Nearer than this the ray is at its own start.
#define NEAREST_M 1e-9
// In place of a direction's zero: its inverse is finite, and a slab that holds the start still holds it.
#define SMALLEST 1e-200

enum { LEAF = 2, DEPTH = 64, CHUNK = 8 };

struct box {
    double min[3], max[3];
};

struct leaf {
    struct box box;
    uint32_t instance, submodel;
};

struct node {
    struct box box;
    uint32_t first, count; // leaves; count 0: the nodes first and first + 1
};

struct ray_scene {
    const struct scene *scene;
    struct dmat4 *mesh_from_world; // one per instance, of those that stand still
    struct box *chunks;            // of CHUNK triangles in mesh space, one submodel after the other
    uint32_t *first_chunk;         // of each submodel
    struct leaf *leaves;
    uint32_t leaf_count;
    struct node *nodes;
    uint32_t node_count;
};

struct ray {
    struct dvec3 from, direction;
    double start[3], inverse[3];
    double nearest; // so far
    bool any;       // the first hit will do
};

static const struct box nothing = {{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}};

static void grow(struct box *box, const struct box *by)
{
    for (int axis = 0; axis < 3; axis++) {
        box->min[axis] = by->min[axis] < box->min[axis] ? by->min[axis] : box->min[axis];
        box->max[axis] = by->max[axis] > box->max[axis] ? by->max[axis] : box->max[axis];
    }
}

static struct box world_box(const struct scene_box *bounds, const struct dmat4 *world_from_mesh)
{
    struct box box = nothing;
    for (int corner = 0; corner < 8; corner++) {
        struct dvec3 p =
            dmat4_point(world_from_mesh, (struct dvec3){(double)(corner & 1 ? bounds->max : bounds->min)[0],
                                                        (double)(corner & 2 ? bounds->max : bounds->min)[1],
                                                        (double)(corner & 4 ? bounds->max : bounds->min)[2]});
        const struct box point = {{p.x - PADDING_M, p.y - PADDING_M, p.z - PADDING_M},
                                  {p.x + PADDING_M, p.y + PADDING_M, p.z + PADDING_M}};
        grow(&box, &point);
    }
    return box;
}

// --- the tree ---

static double middle(const struct leaf *leaf, int axis)
{
    return leaf->box.min[axis] + leaf->box.max[axis];
}

// Puts the `nth` in order, smaller ones before it (Hoare's quickselect).
static void select_leaf(struct leaf *leaves, int64_t count, int64_t nth, int axis)
{
    int64_t low = 0, high = count - 1;
    while (low < high) {
        const double pivot = middle(&leaves[low + (high - low) / 2], axis);
        int64_t i = low - 1, k = high + 1;
        for (;;) {
            do
                i++;
            while (middle(&leaves[i], axis) < pivot);
            do
                k--;
            while (middle(&leaves[k], axis) > pivot);
            if (i >= k)
                break;
            const struct leaf swapped = leaves[i];
            leaves[i] = leaves[k];
            leaves[k] = swapped;
        }
        if (nth <= k)
            high = k;
        else
            low = k + 1;
    }
}

static void build(struct ray_scene *rays, uint32_t index, uint32_t first, uint32_t count)
{
    struct node node = {nothing, first, count};
    struct box centres = nothing;
    for (uint32_t i = first; i < first + count; i++) {
        struct box centre;
        for (int axis = 0; axis < 3; axis++)
            centre.min[axis] = centre.max[axis] = middle(&rays->leaves[i], axis);
        grow(&node.box, &rays->leaves[i].box);
        grow(&centres, &centre);
    }
    if (count > LEAF) {
        int axis = 0;
        for (int other = 1; other < 3; other++)
            if (centres.max[other] - centres.min[other] > centres.max[axis] - centres.min[axis])
                axis = other;
        select_leaf(rays->leaves + first, count, count / 2, axis);
        node.first = rays->node_count;
        node.count = 0;
        rays->node_count += 2;
        build(rays, node.first, first, count / 2);
        build(rays, node.first + 1, first + count / 2, count - count / 2);
    }
    rays->nodes[index] = node;
}

static uint32_t count_leaves(const struct scene *scene)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < scene->instance_count; i++)
        if (scene->instances[i].moving_id == 0)
            count += scene->meshes[scene->instances[i].mesh].submodel_count;
    return count;
}

static void list_leaves(struct ray_scene *rays, const struct dmat4 *world)
{
    const struct scene *scene = rays->scene;
    struct leaf *leaf = rays->leaves;
    for (uint32_t i = 0; i < scene->instance_count; i++) {
        const struct scene_instance *instance = &scene->instances[i];
        const struct scene_mesh *mesh = &scene->meshes[instance->mesh];
        if (instance->moving_id != 0)
            continue;
        rays->mesh_from_world[i] = dmat4_inverse(&world[instance->node]);
        for (uint32_t k = mesh->first_submodel; k < mesh->first_submodel + mesh->submodel_count; k++)
            *leaf++ = (struct leaf){world_box(&scene->submodels[k].bounds, &world[instance->node]), i, k};
    }
}

static uint32_t chunks_of(const struct scene_submodel *submodel)
{
    return (submodel->index_count / 3 + CHUNK - 1) / CHUNK;
}

static struct dvec3 vertex(const struct scene *scene, uint32_t index)
{
    const float *p = scene->vertices[scene->indices[index]].position;
    return (struct dvec3){(double)p[0], (double)p[1], (double)p[2]};
}

static void list_chunks(struct ray_scene *rays)
{
    const struct scene *scene = rays->scene;
    for (uint32_t k = 0; k < scene->submodel_count; k++) {
        const struct scene_submodel *submodel = &scene->submodels[k];
        struct box *chunk = &rays->chunks[rays->first_chunk[k]];
        for (uint32_t i = 0; i < submodel->index_count; i++) {
            const struct dvec3 p = vertex(scene, submodel->first_index + i);
            const struct box point = {{p.x - PADDING_M, p.y - PADDING_M, p.z - PADDING_M},
                                      {p.x + PADDING_M, p.y + PADDING_M, p.z + PADDING_M}};
            if (i % (3 * CHUNK) == 0)
                chunk[i / (3 * CHUNK)] = nothing;
            grow(&chunk[i / (3 * CHUNK)], &point);
        }
    }
}

static bool create_chunks(struct ray_scene *rays)
{
    const struct scene *scene = rays->scene;
    uint32_t count = 0;
    rays->first_chunk = malloc((scene->submodel_count + 1u) * sizeof *rays->first_chunk);
    if (!rays->first_chunk)
        return false;
    for (uint32_t k = 0; k < scene->submodel_count; k++) {
        rays->first_chunk[k] = count;
        count += chunks_of(&scene->submodels[k]);
    }
    rays->chunks = malloc((count + 1u) * sizeof *rays->chunks);
    if (rays->chunks)
        list_chunks(rays);
    return rays->chunks != NULL;
}

struct ray_scene *ray_scene_create(const struct scene *scene)
{
    struct ray_scene *rays = calloc(1, sizeof *rays);
    struct dmat4 *world = calloc(scene->node_count + 1u, sizeof *world);
    if (!rays || !world)
        goto error;
    rays->scene = scene;
    rays->leaf_count = count_leaves(scene);
    rays->mesh_from_world = malloc((scene->instance_count + 1u) * sizeof *rays->mesh_from_world);
    rays->leaves = malloc((rays->leaf_count + 1u) * sizeof *rays->leaves);
    rays->nodes = malloc(2 * (rays->leaf_count + 1u) * sizeof *rays->nodes);
    if (!rays->mesh_from_world || !rays->leaves || !rays->nodes || !create_chunks(rays))
        goto error;
    scene_pose(scene, 0.0, false, world);
    list_leaves(rays, world);
    rays->node_count = 1;
    build(rays, 0, 0, rays->leaf_count);
    free(world);
    return rays;
error:
    free(world);
    ray_scene_destroy(rays);
    return NULL;
}

void ray_scene_destroy(struct ray_scene *rays)
{
    if (!rays)
        return;
    free(rays->mesh_from_world);
    free(rays->chunks);
    free(rays->first_chunk);
    free(rays->leaves);
    free(rays->nodes);
    free(rays);
}

// --- rays ---

// Where the ray enters the box; infinity where it misses it, or enters beyond the nearest hit.
static double enter(const struct ray *ray, const struct box *box)
{
    double from = 0.0, to = ray->nearest;
    for (int axis = 0; axis < 3; axis++) {
        double a = (box->min[axis] - ray->start[axis]) * ray->inverse[axis];
        double b = (box->max[axis] - ray->start[axis]) * ray->inverse[axis];
        double low = a < b ? a : b, high = a < b ? b : a;
        from = low > from ? low : from;
        to = high < to ? high : to;
    }
    return from <= to ? from : INFINITY;
}

// The arithmetic is written out: a call per vector costs more than the test.
static double triangle(struct dvec3 o, struct dvec3 d, struct dvec3 a, struct dvec3 b, struct dvec3 c)
{
    const double ux = b.x - a.x, uy = b.y - a.y, uz = b.z - a.z;
    const double vx = c.x - a.x, vy = c.y - a.y, vz = c.z - a.z;
    const double px = d.y * vz - d.z * vy, py = d.z * vx - d.x * vz, pz = d.x * vy - d.y * vx;
    const double determinant = ux * px + uy * py + uz * pz;
    if (!(determinant < 0.0 || determinant > 0.0))
        return INFINITY;
    const double inverse = 1.0 / determinant;
    const double tx = o.x - a.x, ty = o.y - a.y, tz = o.z - a.z;
    const double u = (tx * px + ty * py + tz * pz) * inverse;
    if (!(u >= 0.0 && u <= 1.0))
        return INFINITY;
    const double qx = ty * uz - tz * uy, qy = tz * ux - tx * uz, qz = tx * uy - ty * ux;
    const double v = (d.x * qx + d.y * qy + d.z * qz) * inverse;
    if (!(v >= 0.0 && u + v <= 1.0))
        return INFINITY;
    const double t = (vx * qx + vy * qy + vz * qz) * inverse;
    return t > NEAREST_M ? t : INFINITY;
}

static double inverse_of(double component)
{
    return 1.0 / (fabs(component) < SMALLEST ? copysign(SMALLEST, component) : component);
}

static struct ray ray_of(struct dvec3 from, struct dvec3 direction, double far_m, bool any)
{
    return (struct ray){
        .from = from,
        .direction = direction,
        .start = {from.x, from.y, from.z},
        .inverse = {inverse_of(direction.x), inverse_of(direction.y), inverse_of(direction.z)},
        .nearest = far_m,
        .any = any,
    };
}

static void try_leaf(const struct ray_scene *rays, const struct leaf *leaf, struct ray *ray)
{
    const struct scene *scene = rays->scene;
    const struct scene_submodel *submodel = &scene->submodels[leaf->submodel];
    const struct dmat4 *mesh_from_world = &rays->mesh_from_world[leaf->instance];
    const struct box *chunks = &rays->chunks[rays->first_chunk[leaf->submodel]];
    struct ray local = ray_of(dmat4_point(mesh_from_world, ray->from),
                              dmat4_direction(mesh_from_world, ray->direction), ray->nearest, ray->any);
    for (uint32_t i = 0; i + 2 < submodel->index_count; i += 3) {
        const uint32_t at = submodel->first_index + i;
        if (i % (3 * CHUNK) == 0 && !isfinite(enter(&local, &chunks[i / (3 * CHUNK)]))) {
            i += 3 * (CHUNK - 1);
            continue;
        }
        double t = triangle(local.from, local.direction, vertex(scene, at), vertex(scene, at + 1),
                            vertex(scene, at + 2));
        if (t < local.nearest)
            local.nearest = t;
    }
    ray->nearest = local.nearest;
}

// Nearer children first. Returns whether anything was hit.
static bool trace(const struct ray_scene *rays, struct ray *ray)
{
    const double far_m = ray->nearest;
    struct {
        uint32_t node;
        double enters;
    } stack[DEPTH];
    uint32_t depth;
    stack[0].node = 0;
    stack[0].enters = enter(ray, &rays->nodes[0].box);
    depth = rays->leaf_count > 0 && isfinite(stack[0].enters);
    while (depth > 0 && !(ray->any && ray->nearest < far_m)) {
        depth--;
        const struct node *node = &rays->nodes[stack[depth].node];
        if (stack[depth].enters > ray->nearest)
            continue;
        if (node->count > 0) {
            for (uint32_t i = node->first; i < node->first + node->count; i++)
                if (isfinite(enter(ray, &rays->leaves[i].box)))
                    try_leaf(rays, &rays->leaves[i], ray);
            continue;
        }
        const double enters[2] = {enter(ray, &rays->nodes[node->first].box),
                                  enter(ray, &rays->nodes[node->first + 1].box)};
        const uint32_t farther = enters[1] > enters[0]; // goes onto the stack first
        for (uint32_t i = 0; i < 2; i++) {
            const uint32_t child = i ? 1 - farther : farther;
            if (isfinite(enters[child]) && depth < DEPTH) {
                stack[depth].node = node->first + child;
                stack[depth++].enters = enters[child];
            }
        }
    }
    return ray->nearest < far_m;
}

double ray_distance(const struct ray_scene *rays, struct dvec3 from, struct dvec3 direction, double far_m)
{
    struct ray ray = ray_of(from, direction, far_m, false);
    trace(rays, &ray);
    return ray.nearest;
}

bool ray_clear(const struct ray_scene *rays, struct dvec3 from, struct dvec3 to)
{
    const struct dvec3 way = dvec3_sub(to, from);
    const double length = dvec3_length(way);
    struct ray ray = ray_of(from, dvec3_normalise(way), length, true);
    return !(length > 0.0) || !trace(rays, &ray);
}
