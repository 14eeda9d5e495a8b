// The walk is a ring around some centre: at each of RING_KNOTS angles a radius, a fraction of the model's
// extent. For each of a few centres the cheapest closed ring is found by dynamic programming; what costs is
// coming near an obstacle, being far from a quarter of the extent, and changing the radius.
#include "stimuli/gltf/walk.h"

#include "stimuli/gltf/clearance.h"

#include <math.h>
#include <string.h>

#define PI 3.14159265358979323846
#define EYE_HEIGHT_M 1.6
#define WANTED_CLEARANCE_M 0.6
#define OPEN 0.12          // of the shorter extent
#define OPEN_MOST_M 2.0    // beyond that no wall presses
#define WANTED_RADIUS 0.25 // of the extent

enum { RING_KNOTS = 24, RADII = 14, CENTRES = 7, LEG_SAMPLES = 6, LEAD_KNOTS = 5 };

struct ring {
    struct dvec3 centre, extent;
    int radius[RING_KNOTS];
    double cost;
};

struct ring_costs {
    double leg[RING_KNOTS][RADII][RADII]; // from knot i at one radius to knot i + 1 at another
};

static double fraction(int radius)
{
    return 0.05 + 0.37 * radius / (RADII - 1);
}

static struct dvec3 ring_point(const struct ring *ring, int knot, int radius)
{
    double angle = 2.0 * PI * knot / RING_KNOTS, r = fraction(radius);
    return (struct dvec3){ring->centre.x + r * ring->extent.x * cos(angle), ring->centre.y,
                          ring->centre.z + r * ring->extent.z * sin(angle)};
}

static double leg_cost(const struct clearance *map, const struct ring *ring, int knot, int from, int to)
{
    struct dvec3 a = ring_point(ring, knot, from), b = ring_point(ring, knot + 1, to);
    double off = fraction(to) - WANTED_RADIUS, change = fraction(to) - fraction(from);
    double open_m = fmin(OPEN * fmin(ring->extent.x, ring->extent.z), OPEN_MOST_M);
    double cost = 8.0 * off * off + 30.0 * change * change;
    for (int i = 1; i <= LEG_SAMPLES; i++) {
        double t = (double)i / LEG_SAMPLES;
        double clear = clearance_at(map, a.x + t * (b.x - a.x), a.z + t * (b.z - a.z));
        if (clear <= map->cell_m)
            cost += 100.0;
        else if (clear < WANTED_CLEARANCE_M)
            cost += 2.0 * (1.0 - clear / WANTED_CLEARANCE_M);
        // The nave rather than the aisle.
        if (clear < open_m)
            cost += 0.4 * (1.0 - clear / open_m);
    }
    return cost;
}

// The cheapest ring that starts and ends at one radius.
static double close_ring(const struct ring_costs *costs, int start, int out[RING_KNOTS])
{
    double best[RADII];
    int from[RING_KNOTS][RADII];
    for (int r = 0; r < RADII; r++)
        best[r] = r == start ? 0.0 : INFINITY;
    for (int knot = 0; knot < RING_KNOTS; knot++) {
        double next[RADII];
        for (int to = 0; to < RADII; to++) {
            next[to] = INFINITY;
            from[knot][to] = start;
            for (int r = 0; r < RADII; r++)
                if (best[r] + costs->leg[knot][r][to] < next[to]) {
                    next[to] = best[r] + costs->leg[knot][r][to];
                    from[knot][to] = r;
                }
        }
        memcpy(best, next, sizeof best);
    }
    int r = start;
    for (int knot = RING_KNOTS - 1; knot >= 0; knot--) {
        r = from[knot][r];
        out[knot] = r;
    }
    return best[start];
}

static void find_ring(const struct clearance *map, struct ring *ring)
{
    struct ring_costs costs;
    for (int knot = 0; knot < RING_KNOTS; knot++)
        for (int from = 0; from < RADII; from++)
            for (int to = 0; to < RADII; to++)
                costs.leg[knot][from][to] = leg_cost(map, ring, knot, from, to);
    ring->cost = INFINITY;
    for (int start = 0; start < RADII; start++) {
        int radius[RING_KNOTS];
        double cost = close_ring(&costs, start, radius);
        if (cost < ring->cost) {
            ring->cost = cost;
            memcpy(ring->radius, radius, sizeof radius);
        }
    }
}

// Ahead along the ring, which from its outside is also across the space, and a little down to where the scene
// is.
static void write_path(struct scene *scene, const struct ring *ring)
{
    struct camera_path *path = &scene->path;
    path->knot_count = RING_KNOTS;
    for (int i = 0; i < RING_KNOTS; i++) {
        int ahead = (i + LEAD_KNOTS) % RING_KNOTS;
        struct dvec3 position = ring_point(ring, i, ring->radius[i]);
        struct dvec3 target = ring_point(ring, ahead, ring->radius[ahead]);
        target.y -= 0.06 * dvec3_length(dvec3_sub(target, position));
        path->knots[i] = (struct camera_path_knot){position, target};
    }
}

void gltf_walk(struct scene *scene, const struct dmat4 *world)
{
    struct dvec3 extent = dvec3_sub(scene->bounds_max, scene->bounds_min);
    double floor_y = clearance_floor(scene, world);
    // Half way up in a model of a city whose houses are knee-high.
    double eye = fmin(EYE_HEIGHT_M, 0.5 * fmax(scene->bounds_max.y - floor_y, 1e-3));
    struct clearance map;
    if (!clearance_make(&map, scene, world, floor_y, eye))
        return;
    struct ring best = {.cost = INFINITY};
    for (int i = 0; i < CENTRES * CENTRES; i++) {
        double u = (i % CENTRES - CENTRES / 2) / 10.0, v = (i / CENTRES - CENTRES / 2) / 10.0;
        struct ring ring = {.extent = extent,
                            .centre = {(scene->bounds_min.x + scene->bounds_max.x) / 2.0 + u * extent.x,
                                       floor_y + eye,
                                       (scene->bounds_min.z + scene->bounds_max.z) / 2.0 + v * extent.z}};
        find_ring(&map, &ring);
        ring.cost += 2.0 * (u * u + v * v); // the middle, all else being equal
        if (ring.cost < best.cost)
            best = ring;
    }
    clearance_finish(&map);
    write_path(scene, &best);
}
