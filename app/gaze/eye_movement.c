// Constants: TECHNIQUES D.3 (saccade duration after Carpenter; peak velocity after Bahill, Clark & Stark 1975,
// values of Dai 2016), others at their place.
#include "app/gaze/eye_movement.h"

#include <math.h>

#define PI 3.14159265358979323846

#define DURATION_S_PER_DEG 0.0022
#define DURATION_BASE_S 0.021
#define PEAK_LIMIT_DEG_S 600.0
#define PEAK_SCALE_DEG 6.0

// A new saccade every third of a second on average (Rayner 1998: fixations of 260 to 330 ms on scenes). Each
// onset lies anywhere in the first 55 % of its slot, so a fixation lasts at least 149 ms less the saccade
// before it.
#define SLOT_S 0.33
#define ONSET_SPREAD 0.55

// 17 blinks a minute at rest (Bentivoglio et al. 1997), lids closed for 100 to 300 ms.
#define BLINK_SLOT_S 3.5
#define BLINK_MIN_S 0.1
#define BLINK_MAX_S 0.3

enum stream { STREAM_TARGET = 1, STREAM_ONSET, STREAM_BLINK, STREAM_DRIFT };

// Counter-based: the finaliser of splitmix64 (Steele, Lea & Flood 2014) over seed, stream and index.
static uint64_t scramble(uint64_t z)
{
    z += 0x9e3779b97f4a7c15u;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
}

static double uniform(uint64_t seed, enum stream stream, uint64_t index, uint64_t draw)
{
    uint64_t z = scramble(scramble(scramble(seed) ^ (uint64_t)stream) ^ index);
    return (double)(scramble(z ^ draw) >> 11) * 0x1p-53;
}

double saccade_duration_s(double amplitude_deg)
{
    return DURATION_S_PER_DEG * amplitude_deg + DURATION_BASE_S;
}

double saccade_peak_deg_s(double amplitude_deg)
{
    return PEAK_LIMIT_DEG_S * (1.0 - exp(-amplitude_deg / PEAK_SCALE_DEG));
}

// The velocity is a blend of two symmetric bells, 6u(1-u) and 630 u^4(1-u)^4, whose peaks are 1.5 and 630/256
// times the mean velocity: the blend meets duration and peak velocity of the main sequence exactly between
// those two.
double saccade_progress(double amplitude_deg, double time_s)
{
    const double low = 1.5, high = 630.0 / 256.0;
    double duration = saccade_duration_s(amplitude_deg);
    if (time_s <= 0.0 || amplitude_deg <= 0.0)
        return amplitude_deg <= 0.0 && time_s > 0.0 ? 1.0 : 0.0;
    if (time_s >= duration)
        return 1.0;
    double peak = saccade_peak_deg_s(amplitude_deg) * duration / amplitude_deg;
    double weight = fmin(fmax((peak - low) / (high - low), 0.0), 1.0);
    double u = time_s / duration, u2 = u * u;
    double broad = u2 * (3.0 - 2.0 * u);
    double sharp = u2 * u2 * u * (126.0 + u * (-420.0 + u * (540.0 + u * (-315.0 + u * 70.0))));
    return (1.0 - weight) * broad + weight * sharp;
}

// The mean of four uniform numbers: bounded, and denser near straight ahead as eyes are.
static double target(uint64_t seed, uint64_t index, uint64_t axis, double limit_deg)
{
    double sum = 0.0;
    for (uint64_t i = 0; i < 4; i++)
        sum += uniform(seed, STREAM_TARGET, index, axis * 4 + i);
    return limit_deg * (sum / 2.0 - 1.0);
}

static double onset_s(uint64_t seed, uint64_t index)
{
    return ((double)index + ONSET_SPREAD * uniform(seed, STREAM_ONSET, index, 0)) * SLOT_S;
}

struct eye_movement_step eye_movement_step(uint64_t seed, double time_s)
{
    double time = time_s > 0.0 ? time_s : 0.0;
    // Index 0 is the fixation the eye starts with, so slot n holds the onset of step n + 1.
    uint64_t index = (uint64_t)(time / SLOT_S);
    if (time >= onset_s(seed, index))
        index++;
    uint64_t before = index > 0 ? index - 1 : 0;
    return (struct eye_movement_step){
        .onset_s = index > 0 ? onset_s(seed, index - 1) : 0.0,
        .x_deg = target(seed, index, 0, EYE_MOVEMENT_MAX_X_DEG),
        .y_deg = target(seed, index, 1, EYE_MOVEMENT_MAX_Y_DEG),
        .from_x_deg = target(seed, before, 0, EYE_MOVEMENT_MAX_X_DEG),
        .from_y_deg = target(seed, before, 1, EYE_MOVEMENT_MAX_Y_DEG),
    };
}

void eye_movement_scan(uint64_t seed, double time_s, double *out_x_deg, double *out_y_deg)
{
    struct eye_movement_step step = eye_movement_step(seed, time_s);
    double dx = step.x_deg - step.from_x_deg, dy = step.y_deg - step.from_y_deg;
    double way = saccade_progress(hypot(dx, dy), time_s - step.onset_s);
    *out_x_deg = step.from_x_deg + way * dx;
    *out_y_deg = step.from_y_deg + way * dy;
}

// Drift as three slow sines per axis (below 0.2 deg in all) and tremor as one of 80 Hz and 0.004 deg (Carpenter
// 1988, Movements of the Eyes: drift of minutes of arc at 0.1 to 0.5 deg/s, tremor of up to a quarter minute at
// 80 Hz).
void eye_movement_tremble(uint64_t seed, int eye, double time_s, double *out_x_deg, double *out_y_deg)
{
    static const double hertz[] = {0.31, 0.87, 1.9, 80.0}, degrees[] = {0.08, 0.04, 0.02, 0.004};
    double *out[] = {out_x_deg, out_y_deg};
    for (uint64_t axis = 0; axis < 2; axis++) {
        double sum = 0.0;
        for (uint64_t i = 0; i < 4; i++) {
            double phase = uniform(seed, STREAM_DRIFT, (uint64_t)eye, axis * 4 + i);
            sum += degrees[i] * sin(2.0 * PI * (hertz[i] * time_s + phase));
        }
        *out[axis] = sum;
    }
}

bool eye_movement_blink(uint64_t seed, double time_s)
{
    double time = time_s > 0.0 ? time_s : 0.0;
    uint64_t slot = (uint64_t)(time / BLINK_SLOT_S);
    double length = BLINK_MIN_S + (BLINK_MAX_S - BLINK_MIN_S) * uniform(seed, STREAM_BLINK, slot, 1);
    double onset =
        ((double)slot * BLINK_SLOT_S) + (BLINK_SLOT_S - BLINK_MAX_S) * uniform(seed, STREAM_BLINK, slot, 0);
    return time >= onset && time < onset + length;
}
