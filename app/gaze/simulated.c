// A simulated tracker on simulated eyes (eye_movement.h): samples of both eyes at a steady rate, invalid in
// blinks.
#include "app/gaze/eye_movement.h"
#include "app/gaze/gaze_source.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

// What is looked at lies two metres away, where the text screens stand too.
#define FIXATION_DISTANCE_M 2.0
// An adult pupil in the light of a headset's screens (Watson & Yellott 2012, JoV 12(10):12: about 4 mm at 50
// cd/m^2).
#define PUPIL_MM 4.0
#define DEGREES (180.0 / 3.14159265358979323846)

struct simulated_gaze {
    struct gaze_source base;
    uint64_t seed;
    double rate_hz;
    double vergence_deg; // of each eye
    int64_t next;        // sample number; two samples, left and right, each
    int next_eye;
};

static struct gaze_source *create(const struct gaze_desc *desc, char *error, size_t error_size)
{
    double rate = desc->rate_hz == 0.0 ? GAZE_SIMULATED_RATE_HZ : desc->rate_hz;
    if (!(rate >= 1.0 && rate <= 10000.0)) {
        snprintf(error, error_size, "a simulated tracker samples at 1 to 10000 Hz");
        return NULL;
    }
    struct simulated_gaze *gaze = calloc(1, sizeof *gaze);
    if (!gaze) {
        snprintf(error, error_size, "out of memory");
        return NULL;
    }
    gaze->base.kind = &gaze_simulated;
    gaze->seed = desc->seed;
    gaze->rate_hz = rate;
    gaze->vergence_deg = atan2(desc->ipd_m / 2.0, FIXATION_DISTANCE_M) * DEGREES;
    return &gaze->base;
}

static struct gaze_sample sample(const struct simulated_gaze *gaze, int64_t at_ns, int eye)
{
    double time_s = (double)at_ns * 1e-9;
    bool closed = eye_movement_blink(gaze->seed, time_s);
    double x = NAN, y = NAN;
    if (!closed) {
        double drift_x = 0.0, drift_y = 0.0;
        eye_movement_scan(gaze->seed, time_s, &x, &y);
        eye_movement_tremble(gaze->seed, eye, time_s, &drift_x, &drift_y);
        x += drift_x + (eye == EYE_LEFT ? gaze->vergence_deg : -gaze->vergence_deg);
        y += drift_y;
    }
    return (struct gaze_sample){
        .device_ns = at_ns,
        .host_ns = at_ns,
        .eye = eye == EYE_LEFT ? GAZE_LEFT : GAZE_RIGHT,
        .x_deg = x,
        .y_deg = y,
        .pupil_mm = closed ? NAN : PUPIL_MM,
        .confidence = closed ? 0.0 : 1.0,
        .valid = !closed,
    };
}

static size_t poll_samples(struct gaze_source *source, int64_t now_ns, struct gaze_sample *out, size_t capacity)
{
    struct simulated_gaze *gaze = (struct simulated_gaze *)source;
    size_t count = 0;
    while (count < capacity) {
        int64_t at_ns = (int64_t)llround((double)gaze->next * 1e9 / gaze->rate_hz);
        if (at_ns > now_ns)
            break;
        out[count++] = sample(gaze, at_ns, gaze->next_eye);
        gaze->next += gaze->next_eye;
        gaze->next_eye = !gaze->next_eye;
    }
    return count;
}

static void destroy(struct gaze_source *source)
{
    free(source);
}

const struct gaze_kind gaze_simulated = {
    .name = "sim",
    .description = "simulated eyes: fixations, saccades, drift, blinks",
    .create = create,
    .poll = poll_samples,
    .destroy = destroy,
};
