#include "stimuli/fixation_target.h"

#include "stimuli/builtin/random.h"

#include <math.h>
#include <stdlib.h>

#define RAD (3.14159265358979323846 / 180.0)
// The far end lies opposite the near one, up to this angle to either side.
#define SPREAD_DEG 40.0

enum { ANGLE, SPREAD }; // counters of the random draws

static void end_point(double angle, double out[2])
{
    out[0] = tan(FIXATION_MOST_X_DEG * RAD) * cos(angle);
    out[1] = tan(FIXATION_MOST_Y_DEG * RAD) * sin(angle);
}

static bool is_timed(const struct fixation_flight *flight)
{
    return flight->view_s > 0.0;
}

void fixation_target_init(struct fixation_target *target, enum fixation_kind kind,
                          const struct fixation_flight *flight, uint32_t seed)
{
    *target = (struct fixation_target){.kind = kind, .flight = *flight};
    const double angle = 360.0 * RAD * (double)random_unit(seed, ANGLE);
    const double spread = SPREAD_DEG * RAD * (2.0 * (double)random_unit(seed, SPREAD) - 1.0);
    if (kind == FIXATION_MOVING) {
        end_point(angle, target->from);
        end_point(angle + 180.0 * RAD + spread, target->to);
    }
    if (is_timed(flight)) {
        target->sweep_s = flight->view_s;
        target->round_s = INFINITY;
        return;
    }
    // There and back as often as it fits into a round of the camera.
    const double round_s = flight->still ? 2.0 * FIXATION_SWEEP_S : flight->path->duration_s;
    target->sweep_s = round_s / (2.0 * fmax(1.0, round(round_s / (2.0 * FIXATION_SWEEP_S))));
    target->round_s = round_s;
}

void fixation_target_finish(struct fixation_target *target)
{
    free(target->dioptres);
    *target = (struct fixation_target){0};
}

struct pose fixation_head(const struct fixation_flight *flight, double time_s)
{
    return camera_path_pose(flight->path, flight->start_s + (flight->still ? 0.0 : time_s));
}

static struct dvec3 direction_at(const struct fixation_target *target, double time_s)
{
    double way = (time_s - target->flight.begin_s) / target->sweep_s;
    if (is_timed(&target->flight)) {
        way = fmin(fmax(way, 0.0), 1.0);
    } else {
        way = fabs(fmod(way, 2.0)); // before begin_s it comes from where it will go to
        way = way > 1.0 ? 2.0 - way : way;
    }
    return dvec3_normalise((struct dvec3){target->from[0] + way * (target->to[0] - target->from[0]),
                                          target->from[1] + way * (target->to[1] - target->from[1]), -1.0});
}

static double dioptres_of(double distance_m)
{
    return 1.0 / fmin(fmax(distance_m, FIXATION_NEAREST_M), FIXATION_FARTHEST_M);
}

bool fixation_target_measure(struct fixation_target *target, const struct ray_scene *rays)
{
    const struct fixation_flight *flight = &target->flight;
    const double length_s = is_timed(flight) ? 2.0 * flight->begin_s + flight->view_s : target->round_s;
    const uint32_t count = (uint32_t)ceil(length_s / FIXATION_SAMPLE_S) + 2;
    free(target->dioptres);
    target->count = 0;
    target->dioptres = malloc(count * sizeof *target->dioptres);
    if (!target->dioptres)
        return false;
    for (uint32_t i = 0; i < count; i++) {
        const double time_s = i * FIXATION_SAMPLE_S;
        const struct pose head = fixation_head(flight, time_s);
        const struct dvec3 direction = dquat_rotate(head.orientation, direction_at(target, time_s));
        target->dioptres[i] = dioptres_of(ray_distance(rays, head.position, direction, FIXATION_FARTHEST_M));
    }
    target->count = count;
    return true;
}

static double distance_at(const struct fixation_target *target, double time_s)
{
    if (target->count == 0)
        return FIXATION_FARTHEST_M;
    const double at = fmin(fmax(time_s / FIXATION_SAMPLE_S, 0.0), (double)(target->count - 1));
    const uint32_t low = (uint32_t)at, high = low + 1 < target->count ? low + 1 : low;
    const double share = at - low;
    return 1.0 / ((1.0 - share) * target->dioptres[low] + share * target->dioptres[high]);
}

struct fixation_place fixation_target_at(const struct fixation_target *target, double time_s)
{
    if (isfinite(target->round_s))
        time_s = fmod(fmax(time_s, 0.0), target->round_s);
    const struct dvec3 direction = direction_at(target, time_s);
    struct fixation_place place = {.distance_m = distance_at(target, time_s)};
    viewing_angles(direction, &place.x_deg, &place.y_deg);
    place.point = dvec3_scale(direction, place.distance_m);
    return place;
}
