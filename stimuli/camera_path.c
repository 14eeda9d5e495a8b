// Uniform Catmull-Rom (Catmull and Rom 1974, tension 1/2): knot i is reached at curve parameter i / knot_count,
// in the position and in the target alike, so that the two curves stay paired. Uneven knot spacing therefore
// changes the curve's shape but never the speed: the time table is laid over the measured curve.
#include "stimuli/camera_path.h"

#include <math.h>

enum { SUBSAMPLES = 8 }; // of each table interval, to find its fastest stretch

#define DEG (180.0 / 3.14159265358979323846)
#define CLOSEST_TARGET_M 0.01
#define STEEPEST 0.001  // horizontal share of the view below which "upright" means nothing
#define SMOOTHING_S 1.0 // changes of speed are spread over about this time to either side
#define STILL_DURATION_S 1.0

static struct dvec3 catmull_rom(struct dvec3 a, struct dvec3 b, struct dvec3 c, struct dvec3 d, double t)
{
    double wa = 0.5 * (-t + 2.0 * t * t - t * t * t);
    double wb = 0.5 * (2.0 - 5.0 * t * t + 3.0 * t * t * t);
    double wc = 0.5 * (t + 4.0 * t * t - 3.0 * t * t * t);
    double wd = 0.5 * (-t * t + t * t * t);
    return dvec3_add(dvec3_add(dvec3_scale(a, wa), dvec3_scale(b, wb)),
                     dvec3_add(dvec3_scale(c, wc), dvec3_scale(d, wd)));
}

static struct camera_path_knot curve_at(const struct camera_path *path, double parameter)
{
    uint32_t n = path->knot_count;
    double at = parameter * n;
    double whole = floor(at);
    uint32_t i = (uint32_t)whole % n;
    const struct camera_path_knot *k = path->knots;
    const struct camera_path_knot *a = &k[(i + n - 1) % n], *b = &k[i], *c = &k[(i + 1) % n],
                                  *d = &k[(i + 2) % n];
    return (struct camera_path_knot){
        .position = catmull_rom(a->position, b->position, c->position, d->position, at - whole),
        .target = catmull_rom(a->target, b->target, c->target, d->target, at - whole),
    };
}

static bool knot_ok(const struct camera_path_knot *knot)
{
    struct dvec3 p = knot->position, t = knot->target;
    return isfinite(p.x) && isfinite(p.y) && isfinite(p.z) && isfinite(t.x) && isfinite(t.y) && isfinite(t.z);
}

static bool view_ok(const struct camera_path_knot *knot)
{
    struct dvec3 view = dvec3_sub(knot->target, knot->position);
    double length = dvec3_length(view);
    return length > CLOSEST_TARGET_M && hypot(view.x, view.z) > STEEPEST * length;
}

static struct pose pose_of(const struct camera_path_knot *knot)
{
    return (struct pose){
        .position = knot->position,
        .orientation = dquat_look(dvec3_sub(knot->target, knot->position), (struct dvec3){0, 1, 0}),
    };
}

static double turn_deg(struct dquat a, struct dquat b)
{
    double c = a.x * b.x + a.y * b.y + a.z * b.z + a.w * b.w;
    double s = c < 0 ? -1 : 1;
    double dx = a.x - s * b.x, dy = a.y - s * b.y, dz = a.z - s * b.z, dw = a.w - s * b.w;
    // Half the chord between unit quaternions is the sine of a quarter of the turn; exact for small turns.
    double half_chord = 0.5 * sqrt(dx * dx + dy * dy + dz * dz + dw * dw);
    return 4.0 * asin(fmin(half_chord, 1.0)) * DEG;
}

// Seconds the flight must at least take from table entry i to the next; negative where the view is degenerate.
static double interval_s(const struct camera_path *path, uint32_t i)
{
    struct pose before = {0};
    double slowest = 0;
    for (uint32_t s = 0; s <= SUBSAMPLES; s++) {
        struct camera_path_knot at = curve_at(path, (i + s / (double)SUBSAMPLES) / CAMERA_PATH_SAMPLES);
        if (!view_ok(&at))
            return -1;
        struct pose now = pose_of(&at);
        if (s > 0) {
            double metres = dvec3_length(dvec3_sub(now.position, before.position));
            double degrees = turn_deg(now.orientation, before.orientation);
            slowest = fmax(slowest, fmax(metres / path->speed_m_s, degrees / CAMERA_PATH_MAX_DEG_S));
        }
        before = now;
    }
    return slowest * SUBSAMPLES;
}

static uint32_t wrap(int64_t i)
{
    return (uint32_t)((i % CAMERA_PATH_SAMPLES + CAMERA_PATH_SAMPLES) % CAMERA_PATH_SAMPLES);
}

// The greatest value within `reach`, then the mean within `reach`: nowhere below the input, and without jumps.
static void smooth_upwards(double *s, int64_t reach)
{
    double greatest[CAMERA_PATH_SAMPLES];
    for (int64_t i = 0; i < CAMERA_PATH_SAMPLES; i++) {
        greatest[i] = 0;
        for (int64_t k = -reach; k <= reach; k++)
            greatest[i] = fmax(greatest[i], s[wrap(i + k)]);
    }
    for (int64_t i = 0; i < CAMERA_PATH_SAMPLES; i++) {
        double sum = 0;
        for (int64_t k = -reach; k <= reach; k++)
            sum += greatest[wrap(i + k)];
        s[i] = sum / (double)(2 * reach + 1);
    }
}

bool camera_path_finish(struct camera_path *path)
{
    if (path->knot_count < 1 || path->knot_count > CAMERA_PATH_KNOTS)
        return false;
    if (!(path->speed_m_s > 0 && path->speed_m_s <= CAMERA_PATH_MAX_M_S))
        return false;
    for (uint32_t i = 0; i < path->knot_count; i++)
        if (!knot_ok(&path->knots[i]))
            return false;
    double seconds[CAMERA_PATH_SAMPLES], total = 0;
    for (uint32_t i = 0; i < CAMERA_PATH_SAMPLES; i++) {
        seconds[i] = interval_s(path, i);
        if (seconds[i] < 0)
            return false;
        total += seconds[i];
    }
    if (total > 0) {
        double reach = ceil(SMOOTHING_S / total * CAMERA_PATH_SAMPLES);
        smooth_upwards(seconds, (int64_t)fmin(reach, CAMERA_PATH_SAMPLES / 4));
    }
    path->time_s[0] = 0;
    for (uint32_t i = 0; i < CAMERA_PATH_SAMPLES; i++)
        path->time_s[i + 1] =
            path->time_s[i] + (total > 0 ? seconds[i] : STILL_DURATION_S / CAMERA_PATH_SAMPLES);
    path->duration_s = path->time_s[CAMERA_PATH_SAMPLES];
    return true;
}

struct pose camera_path_pose(const struct camera_path *path, double time_s)
{
    double t = fmod(time_s, path->duration_s);
    if (t < 0)
        t += path->duration_s;
    uint32_t low = 0, high = CAMERA_PATH_SAMPLES;
    while (high - low > 1) {
        uint32_t middle = (low + high) / 2;
        if (path->time_s[middle] <= t)
            low = middle;
        else
            high = middle;
    }
    double length = path->time_s[low + 1] - path->time_s[low];
    double share = length > 0 ? (t - path->time_s[low]) / length : 0;
    double parameter = (low + share) / CAMERA_PATH_SAMPLES;
    struct camera_path_knot at = curve_at(path, parameter < 1 ? parameter : 0);
    return pose_of(&at);
}
