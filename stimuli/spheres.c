#include "stimuli/spheres.h"

#include "stimuli/builtin/random.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum {
    RAYS = 5,           // to the middle, and to four points near the rim
    ATTEMPTS = 250,     // per sphere and relaxation
    DRAWS = 8,          // random numbers of one attempt
    SHORTEST_STEPS = 2, // of a stretch
};

#define RIM 0.8        // of the radius, where the other rays go
#define SURFACES_M 0.1 // surfaces stay this far from a sphere's middle
#define PATH_M 0.45    // and so does the head
#define GAP_DEG 0.4    // between two spheres' rims
#define MARGIN_DEG                                                                                             \
    12.0 // beyond the image, where a sphere is looked at too, so that it is there when it comes in
#define SMALLEST_DEG 0.1 // angular radius under which nobody counts it

const struct spheres_colour spheres_colours[SPHERES_COLOURS] = {
    {"red", {0.90f, 0.12f, 0.12f}},    {"orange", {0.98f, 0.52f, 0.05f}}, {"yellow", {0.98f, 0.88f, 0.10f}},
    {"cyan", {0.10f, 0.80f, 0.88f}},   {"blue", {0.15f, 0.30f, 0.95f}},   {"violet", {0.55f, 0.20f, 0.85f}},
    {"magenta", {0.95f, 0.20f, 0.65f}}}; // no green: that is the fixation target's

const char *spheres_relaxed_name(enum spheres_relaxed relaxed)
{
    static const char *const names[SPHERES_RELAXED] = {"no",      "any_time", "nearer",
                                                       "briefly", "touching", "in_front"};
    return names[relaxed];
}

struct wish {
    double nearest_m, farthest_m, most_deg;
    bool own_share, alone, free;
    double seconds; // share of SPHERES_SECONDS
};
static const struct wish wishes[SPHERES_RELAXED] = {
    [SPHERES_AS_WISHED] = {1.5, 6.0, 20.0, true, true, true, 1.0},
    [SPHERES_ANY_TIME] = {1.0, 8.0, SPHERES_MOST_DEG, false, true, true, 1.0},
    [SPHERES_NEARER] = {0.5, 3.0, SPHERES_MOST_DEG, false, true, true, 1.0},
    [SPHERES_BRIEFLY] = {0.5, 8.0, SPHERES_MOST_DEG, false, true, true, 0.5},
    [SPHERES_TOUCHING] = {0.5, 8.0, SPHERES_MOST_DEG, false, false, true, 0.5},
    [SPHERES_IN_FRONT] = {2.0, 3.0, 15.0, false, false, false, 0.0},
};

struct placing {
    const struct spheres_desc *desc;
    struct spheres *spheres;
    struct pose *heads; // one per sample
    uint32_t samples;
    uint32_t first, last; // those free of fade
    double need_s;
};

// --- one sphere at one moment ---

static struct dvec3 turned_back(const struct pose *head, struct dvec3 point)
{
    const struct dquat q = head->orientation;
    return dquat_rotate((struct dquat){-q.x, -q.y, -q.z, q.w}, dvec3_sub(point, head->position));
}

static double radius_deg(double distance_m)
{
    return distance_m > SPHERES_RADIUS_M ? asin(SPHERES_RADIUS_M / distance_m) * 57.29577951308232 : 90.0;
}

// Whether a sphere's image is whole in the frustum, or with a margin at least near it.
static bool in_image(const struct viewing_fov *fov, struct dvec3 p, double inside_deg)
{
    const double scale = 57.29577951308232;
    const double forward = -p.z;
    if (!(forward > SPHERES_RADIUS_M))
        return false;
    const double right = atan(p.x / forward) * scale, up = atan(p.y / forward) * scale;
    return right + inside_deg < atan(fov->tan_right) * scale &&
           -right + inside_deg < atan(fov->tan_left) * scale && up + inside_deg < atan(fov->tan_up) * scale &&
           -up + inside_deg < atan(fov->tan_down) * scale;
}

// How many of the rays from an eye reach the sphere.
static uint8_t free_rays(const struct ray_scene *rays, const struct pose *eye, struct dvec3 position, bool all)
{
    uint8_t count = 0;
    for (int i = 0; i < RAYS; i++) {
        const double x = i == 1 ? RIM : i == 2 ? -RIM : 0, y = i == 3 ? RIM : i == 4 ? -RIM : 0;
        struct dvec3 side = {x * SPHERES_RADIUS_M, y * SPHERES_RADIUS_M, 0};
        if (ray_clear(rays, eye->position, dvec3_add(position, dquat_rotate(eye->orientation, side))))
            count++;
        else if (all)
            return 0;
    }
    return count;
}

static bool whole(const struct placing *p, uint32_t sample, struct dvec3 position, const struct wish *wish)
{
    const struct pose *head = &p->heads[sample];
    const struct dvec3 local = turned_back(head, position);
    const double distance_m = dvec3_length(local), rim_deg = radius_deg(distance_m);
    const double most_deg = fmax(wish->most_deg, SPHERES_MOST_DEG);
    if (geometry_angle_deg(local, (struct dvec3){0, 0, -1}) > most_deg || distance_m < PATH_M ||
        rim_deg < SMALLEST_DEG)
        return false;
    for (int eye = 0; eye < EYES; eye++) {
        const struct pose pose = viewing_eye_pose(head, eye, p->desc->ipd_m);
        if (!in_image(&p->desc->fov, turned_back(&pose, position), rim_deg) ||
            (wish->free && free_rays(p->desc->rays, &pose, position, true) < RAYS))
            return false;
    }
    return true;
}

static bool apart(const struct placing *p, uint32_t sample, struct dvec3 a, struct dvec3 b)
{
    const struct dvec3 la = dvec3_sub(a, p->heads[sample].position),
                       lb = dvec3_sub(b, p->heads[sample].position);
    return geometry_angle_deg(la, lb) > radius_deg(dvec3_length(la)) + radius_deg(dvec3_length(lb)) + GAP_DEG;
}

// --- one sphere along the flight ---

static uint32_t sample_of(const struct placing *p, double time_s)
{
    const double at = floor(time_s / SPHERES_SAMPLE_S + 0.5);
    return at < 0 ? 0 : at >= p->samples ? p->samples - 1 : (uint32_t)at;
}

// The stretch around a sample in which the sphere is whole; as long as is needed, no longer.
static bool find_stretch(const struct placing *p, const struct wish *wish, uint32_t around,
                         struct sphere *sphere)
{
    uint32_t first = around, last = around;
    const uint32_t need = (uint32_t)ceil(wish->seconds * p->need_s / SPHERES_SAMPLE_S - 1e-9);
    if (!whole(p, around, sphere->position, wish))
        return false;
    bool back = true, on = true;
    while (last - first < need && (back || on)) {
        back = back && first > p->first && whole(p, first - 1, sphere->position, wish);
        first -= back;
        on = on && last < p->last && whole(p, last + 1, sphere->position, wish);
        last += on;
    }
    sphere->from_s = first * SPHERES_SAMPLE_S;
    sphere->to_s = last * SPHERES_SAMPLE_S;
    return last - first >= need;
}

// Nobody covers it in its stretch, and it covers nobody in theirs.
static bool is_alone(const struct placing *p, const struct sphere *sphere, uint32_t others)
{
    for (uint32_t i = 0; i < others; i++) {
        const struct sphere *other = &p->spheres->all[i];
        const struct sphere *const stretches[2] = {sphere, other};
        for (int k = 0; k < 2; k++)
            for (uint32_t s = sample_of(p, stretches[k]->from_s); s <= sample_of(p, stretches[k]->to_s); s++)
                if (!apart(p, s, sphere->position, other->position))
                    return false;
    }
    return true;
}

// Surfaces and the head stay away, so that it is no half sphere and the flight does not go through it.
static bool has_room(const struct placing *p, struct dvec3 position)
{
    for (int i = 0; i < 14; i++) { // faces' and corners' directions of a cube
        struct dvec3 d = i < 6
                             ? (struct dvec3){i == 0   ? 1
                                              : i == 1 ? -1
                                                       : 0,
                                              i == 2   ? 1
                                              : i == 3 ? -1
                                                       : 0,
                                              i == 4   ? 1
                                              : i == 5 ? -1
                                                       : 0}
                             : (struct dvec3){(i - 6) & 1 ? 1 : -1, (i - 6) & 2 ? 1 : -1, (i - 6) & 4 ? 1 : -1};
        if (ray_distance(p->desc->rays, position, dvec3_normalise(d), SURFACES_M) < SURFACES_M)
            return false;
    }
    for (uint32_t s = 0; s < p->samples; s++)
        if (dvec3_length(dvec3_sub(position, p->heads[s].position)) < PATH_M)
            return false;
    return true;
}

// A place seen from some moment of the flight, in front of what is there.
static bool try_place(const struct placing *p, uint32_t index, enum spheres_relaxed relaxed, uint64_t attempt)
{
    const struct wish *wish = &wishes[relaxed];
    const uint64_t seed = p->desc->seed;
    const uint64_t at = ((uint64_t)(index * SPHERES_RELAXED + (uint32_t)relaxed) * ATTEMPTS + attempt) * DRAWS;
    struct sphere sphere = {.relaxed = relaxed, .colour = random_below(seed, at, SPHERES_COLOURS)};
    double share = (double)random_unit(seed, at + 1);
    if (wish->own_share)
        share = (index + share) / p->desc->count;
    const uint32_t sample = p->first + (uint32_t)(share * (p->last - p->first));
    const struct pose *head = &p->heads[sample];
    // uniform over the cap: the cosine of the eccentricity is
    const double cap = 1.0 - cos(wish->most_deg / 57.29577951308232);
    const double cosine = 1.0 - cap * (double)random_unit(seed, at + 2), sine = sqrt(1.0 - cosine * cosine);
    const double turn = 6.283185307179586 * (double)random_unit(seed, at + 3);
    const struct dvec3 local = {sine * cos(turn), sine * sin(turn), -cosine};
    const struct dvec3 direction = dquat_rotate(head->orientation, local);
    double free_m = wish->farthest_m;
    if (wish->free)
        free_m =
            ray_distance(p->desc->rays, head->position, direction, wish->farthest_m + SURFACES_M) - SURFACES_M;
    if (free_m < wish->nearest_m)
        return false;
    const double distance_m = wish->nearest_m + (free_m - wish->nearest_m) * (double)random_unit(seed, at + 4);
    sphere.position = dvec3_add(head->position, dvec3_scale(direction, distance_m));
    if ((wish->free && !has_room(p, sphere.position)) || !find_stretch(p, wish, sample, &sphere) ||
        (wish->alone && !is_alone(p, &sphere, index)))
        return false;
    p->spheres->all[index] = sphere;
    return true;
}

// Straight ahead at some moment, whatever is there: cannot fail.
static void force_place(const struct placing *p, uint32_t index)
{
    const uint32_t sample = p->first + random_below(p->desc->seed, index, p->last - p->first + 1);
    const struct pose *head = &p->heads[sample];
    const struct dvec3 ahead = dquat_rotate(head->orientation, (struct dvec3){0, 0, -2.5});
    p->spheres->all[index] =
        (struct sphere){.position = dvec3_add(head->position, ahead),
                        .colour = random_below(p->desc->seed, index + 64u, SPHERES_COLOURS),
                        .relaxed = SPHERES_IN_FRONT,
                        .from_s = sample * SPHERES_SAMPLE_S,
                        .to_s = sample * SPHERES_SAMPLE_S};
}

static void place_one(const struct placing *p, uint32_t index)
{
    for (int relaxed = 0; relaxed < SPHERES_RELAXED; relaxed++)
        for (uint64_t attempt = 0; attempt < ATTEMPTS; attempt++)
            if (try_place(p, index, (enum spheres_relaxed)relaxed, attempt))
                return;
    force_place(p, index);
}

// --- what covers them, over the whole flight ---

static void look(const struct placing *p, const struct sphere *sphere, int eye, uint32_t sample, uint8_t *out)
{
    const struct pose pose = viewing_eye_pose(&p->heads[sample], eye, p->desc->ipd_m);
    const struct dvec3 local = turned_back(&pose, sphere->position);
    const double rim_deg = radius_deg(dvec3_length(local));
    if (rim_deg < SMALLEST_DEG || !in_image(&p->desc->fov, local, -rim_deg - MARGIN_DEG))
        *out = 0;
    else if (sphere->relaxed == SPHERES_IN_FRONT)
        *out = RAYS;
    else
        *out = free_rays(p->desc->rays, &pose, sphere->position, false);
}

// Every second sample, and those between where something changes: halves the time.
static void look_along(const struct placing *p, uint32_t index)
{
    for (int eye = 0; eye < EYES; eye++) {
        const struct sphere *sphere = &p->spheres->all[index];
        uint8_t *seen = &p->spheres->seen[((size_t)index * EYES + (size_t)eye) * p->samples];
        for (uint32_t s = 0; s < p->samples; s += 2)
            look(p, sphere, eye, s, &seen[s]);
        for (uint32_t s = 1; s < p->samples; s += 2) {
            const bool same = s + 1 < p->samples && seen[s - 1] == seen[s + 1];
            if (same && (seen[s - 1] == 0 || seen[s - 1] == RAYS))
                seen[s] = seen[s - 1];
            else
                look(p, sphere, eye, s, &seen[s]);
        }
    }
}

bool spheres_place(struct spheres *spheres, const struct spheres_desc *desc)
{
    const double round_s = desc->still ? SPHERES_SAMPLE_S : desc->path->duration_s;
    const double length_s = desc->length_s > 0.0 ? desc->length_s : fmin(round_s, SPHERES_LOOP_S);
    struct placing placing = {.desc = desc, .spheres = spheres};
    *spheres = (struct spheres){.round_s = desc->length_s > 0.0 ? INFINITY : round_s};
    if (desc->count == 0)
        return true;
    placing.samples = spheres->samples = (uint32_t)ceil(length_s / SPHERES_SAMPLE_S) + SHORTEST_STEPS;
    placing.first = (uint32_t)ceil(fmin(desc->begin_s, length_s / 4) / SPHERES_SAMPLE_S);
    placing.last = placing.samples - SHORTEST_STEPS - placing.first;
    placing.last = placing.last > placing.first ? placing.last : placing.first;
    placing.need_s =
        desc->still ? 0.0 : fmin(SPHERES_SECONDS, (placing.last - placing.first) * SPHERES_SAMPLE_S / 2);
    placing.heads = malloc(placing.samples * sizeof *placing.heads);
    spheres->seen = malloc((size_t)desc->count * EYES * placing.samples);
    if (!placing.heads || !spheres->seen) {
        free(placing.heads);
        spheres_finish(spheres);
        return false;
    }
    for (uint32_t s = 0; s < placing.samples; s++)
        placing.heads[s] =
            camera_path_pose(desc->path, desc->start_s + (desc->still ? 0.0 : s * SPHERES_SAMPLE_S));
    spheres->count = desc->count < SPHERES_MOST ? desc->count : SPHERES_MOST;
    for (uint32_t i = 0; i < spheres->count; i++)
        place_one(&placing, i);
    for (uint32_t i = 0; i < spheres->count; i++)
        look_along(&placing, i);
    free(placing.heads);
    return true;
}

void spheres_finish(struct spheres *spheres)
{
    free(spheres->seen);
    memset(spheres, 0, sizeof *spheres);
}

double spheres_seen(const struct spheres *spheres, uint32_t sphere, int eye, double time_s)
{
    if (sphere >= spheres->count)
        return 0.0;
    if (isfinite(spheres->round_s))
        time_s = fmod(fmax(time_s, 0.0), spheres->round_s);
    if (isfinite(spheres->round_s) && time_s > (spheres->samples - 1) * SPHERES_SAMPLE_S)
        return 0.0; // a part of a long round that nobody looked at
    const double at = fmin(fmax(time_s / SPHERES_SAMPLE_S, 0.0), (double)(spheres->samples - 1));
    const uint32_t low = (uint32_t)at, high = low + 1 < spheres->samples ? low + 1 : low;
    const uint8_t *seen = &spheres->seen[((size_t)sphere * EYES + (size_t)eye) * spheres->samples];
    return ((1.0 - (at - low)) * seen[low] + (at - low) * seen[high]) / RAYS;
}
