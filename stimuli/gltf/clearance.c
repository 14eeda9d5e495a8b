#include "stimuli/gltf/clearance.h"

#include <math.h>
#include <stdlib.h>

enum {
    FLOOR_BINS = 128,
    // Triangles looked at in one scene, evenly thinned beyond: keeps the largest city below half a second.
    BUDGET = 3000000,
    HALVINGS = 20000000,
    MAX_DEPTH = 9, // of halving a triangle until it is as small as a cell
};

#define FAR_M 1e6f

// What is done with each triangle, in world space.
typedef void (*visit_fn)(void *context, const struct dvec3 corners[3]);

static struct dvec3 corner_at(const struct scene *scene, uint32_t index, const struct dmat4 *world)
{
    const float *p = scene->vertices[scene->indices[index]].position;
    return dmat4_point(world, (struct dvec3){(double)p[0], (double)p[1], (double)p[2]});
}

// Whether a box reaches into the heights: its centre and the extent of the transformed half size along y.
static bool overlaps(const struct scene_box *box, const struct dmat4 *world, double low, double high)
{
    double centre = world->m[13], half = 0.0;
    for (int k = 0; k < 3; k++) {
        centre += world->m[k * 4 + 1] * ((double)box->min[k] + (double)box->max[k]) / 2.0;
        half += fabs(world->m[k * 4 + 1]) * ((double)box->max[k] - (double)box->min[k]) / 2.0;
    }
    return centre - half <= high && centre + half >= low;
}

static void visit(const struct scene *scene, const struct dmat4 *world, double low, double high, uint64_t step,
                  visit_fn fn, void *context)
{
    for (uint32_t i = 0; i < scene->instance_count; i++) {
        const struct scene_instance *instance = &scene->instances[i];
        const struct scene_mesh *mesh = &scene->meshes[instance->mesh];
        const struct dmat4 *from_mesh = &world[instance->node];
        for (uint32_t s = 0; instance->moving_id == 0 && s < mesh->submodel_count; s++) {
            const struct scene_submodel *submodel = &scene->submodels[mesh->first_submodel + s];
            if (!overlaps(&submodel->bounds, from_mesh, low, high))
                continue;
            for (uint64_t k = 0; k < submodel->index_count; k += 3 * step) {
                uint32_t at = submodel->first_index + (uint32_t)k;
                const struct dvec3 corners[3] = {corner_at(scene, at, from_mesh),
                                                 corner_at(scene, at + 1, from_mesh),
                                                 corner_at(scene, at + 2, from_mesh)};
                fn(context, corners);
            }
        }
    }
}

struct floor_search {
    double low, height;
    double area[FLOOR_BINS];
};

static void add_floor(void *context, const struct dvec3 corners[3])
{
    struct floor_search *search = context;
    struct dvec3 normal = dvec3_cross(dvec3_sub(corners[1], corners[0]), dvec3_sub(corners[2], corners[0]));
    double length = dvec3_length(normal);
    if (!(normal.y > 0.95 * length) || !(length > 0.0))
        return;
    double at = ((corners[0].y + corners[1].y + corners[2].y) / 3.0 - search->low) / search->height;
    int bin = (int)(fmin(fmax(at, 0.0), 1.0) * (FLOOR_BINS - 1));
    search->area[bin] += length;
}

double clearance_floor(const struct scene *scene, const struct dmat4 *world)
{
    struct floor_search search = {.low = scene->bounds_min.y,
                                  .height = fmax(scene->bounds_max.y - scene->bounds_min.y, 1e-6)};
    uint64_t step = scene->triangle_count / BUDGET + 1;
    visit(scene, world, scene->bounds_min.y, scene->bounds_max.y, step, add_floor, &search);
    double most = 0.0;
    for (int i = 0; i < FLOOR_BINS / 2; i++)
        most = fmax(most, search.area[i]);
    for (int i = FLOOR_BINS / 2 - 1; i >= 0 && most > 0.0; i--)
        if (search.area[i] > 0.4 * most)
            return search.low + search.height * (i + 1) / (FLOOR_BINS - 1);
    return search.low;
}

// What lies between two heights gives its cells this distance.
struct marking {
    struct clearance *map;
    double low, high;
    double size_m; // triangles are halved down to this
    float distance_m;
    bool upward;   // only what faces up
    uint64_t left; // halvings: a file may stack any number of huge triangles
};

static void mark(const struct marking *marking, double x, double z)
{
    struct clearance *map = marking->map;
    double column = (x - map->x) / map->cell_m, row = (z - map->z) / map->cell_m;
    if (column >= 0.0 && row >= 0.0 && column < map->columns && row < map->rows)
        map->distance_m[(size_t)row * map->columns + (size_t)column] = marking->distance_m;
}

static struct dvec3 middle(struct dvec3 a, struct dvec3 b)
{
    return dvec3_scale(dvec3_add(a, b), 0.5);
}

// Halves the longest edge until the triangle is small enough, dropping what lies above or below.
static void mark_triangle(struct marking *marking, const struct dvec3 c[3], int depth)
{
    double low = fmin(c[0].y, fmin(c[1].y, c[2].y)), high = fmax(c[0].y, fmax(c[1].y, c[2].y));
    if (low > marking->high || high < marking->low)
        return;
    double edge[3];
    int longest = 0;
    for (int i = 0; i < 3; i++) {
        edge[i] = dvec3_length(dvec3_sub(c[(i + 1) % 3], c[i]));
        longest = edge[i] > edge[longest] ? i : longest;
    }
    if (depth == 2 * MAX_DEPTH || marking->left == 0 || edge[longest] <= marking->size_m) {
        struct dvec3 centre = dvec3_scale(dvec3_add(dvec3_add(c[0], c[1]), c[2]), 1.0 / 3.0);
        mark(marking, centre.x, centre.z);
        return;
    }
    marking->left--;
    struct dvec3 a = c[longest], b = c[(longest + 1) % 3], other = c[(longest + 2) % 3], half = middle(a, b);
    mark_triangle(marking, (const struct dvec3[3]){a, half, other}, depth + 1);
    mark_triangle(marking, (const struct dvec3[3]){half, b, other}, depth + 1);
}

static void add_mark(void *context, const struct dvec3 corners[3])
{
    struct marking *marking = context;
    struct dvec3 normal = dvec3_cross(dvec3_sub(corners[1], corners[0]), dvec3_sub(corners[2], corners[0]));
    if (!marking->upward || normal.y > 0.7 * dvec3_length(normal))
        mark_triangle(marking, corners, 0);
}

static void relax(struct clearance *map, int64_t column, int64_t row, int dx, int dz)
{
    int64_t x = column + dx, z = row + dz;
    if (x < 0 || z < 0 || x >= map->columns || z >= map->rows)
        return;
    float step = (float)(map->cell_m * (dx != 0 && dz != 0 ? 1.41421356 : 1.0));
    float *here = &map->distance_m[(size_t)row * map->columns + (size_t)column];
    *here = fminf(*here, map->distance_m[(size_t)z * map->columns + (size_t)x] + step);
}

// Two chamfer passes (Borgefors 1986, weights 1 and the root of 2).
static void spread(struct clearance *map)
{
    static const int back[4][2] = {{-1, 0}, {-1, -1}, {0, -1}, {1, -1}};
    for (int64_t row = 0; row < map->rows; row++)
        for (int64_t column = 0; column < map->columns; column++)
            for (int k = 0; k < 4; k++)
                relax(map, column, row, back[k][0], back[k][1]);
    for (int64_t row = (int64_t)map->rows - 1; row >= 0; row--)
        for (int64_t column = (int64_t)map->columns - 1; column >= 0; column--)
            for (int k = 0; k < 4; k++)
                relax(map, column, row, -back[k][0], -back[k][1]);
}

bool clearance_make(struct clearance *map, const struct scene *scene, const struct dmat4 *world, double floor_y,
                    double eye_m)
{
    struct dvec3 extent = dvec3_sub(scene->bounds_max, scene->bounds_min);
    map->x = scene->bounds_min.x;
    map->z = scene->bounds_min.z;
    map->cell_m = fmax(fmax(extent.x, extent.z), 1e-3) / CLEARANCE_CELLS;
    map->columns = (uint32_t)(extent.x / map->cell_m) + 1;
    map->rows = (uint32_t)(extent.z / map->cell_m) + 1;
    map->distance_m = malloc((size_t)map->columns * map->rows * sizeof *map->distance_m);
    if (map->distance_m == NULL)
        return false;
    uint64_t step = scene->triangle_count / BUDGET + 1;
    // Where no floor lies is outside a building. A thinned scene would have a floor full of holes: it counts as
    // open.
    for (size_t i = 0; i < (size_t)map->columns * map->rows; i++)
        map->distance_m[i] = step > 1 ? FAR_M : 0.0f;
    struct marking ground = {
        map, floor_y - 0.5 * eye_m, floor_y + 0.4 * eye_m, map->cell_m / 2.0, FAR_M, true, HALVINGS};
    if (step == 1)
        visit(scene, world, ground.low, ground.high, step, add_mark, &ground);
    struct marking obstacles = {map,     floor_y + 0.4 * eye_m, floor_y + 1.3 * eye_m, map->cell_m, 0.0f, false,
                                HALVINGS};
    visit(scene, world, obstacles.low, obstacles.high, step, add_mark, &obstacles);
    spread(map);
    return true;
}

void clearance_finish(struct clearance *map)
{
    free(map->distance_m);
    map->distance_m = NULL;
}

double clearance_at(const struct clearance *map, double x, double z)
{
    double column = (x - map->x) / map->cell_m, row = (z - map->z) / map->cell_m;
    if (!(column >= 0.0 && row >= 0.0 && column < map->columns && row < map->rows))
        return 0.0;
    return (double)map->distance_m[(size_t)row * map->columns + (size_t)column];
}
