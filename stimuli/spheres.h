// Coloured spheres to count along a flight: Stengel et al. 2016, section 6.2, T1: "Count the colored spheres in
// the environment."
//
// Each stands still in the world and is whole in both eyes' images, in front of everything still, within an
// eccentricity of the head's direction, for a second without a break; during it no other sphere covers or
// touches it. Where a scene or a flight has too few such places, the wishes are given up in the order of
// spheres_relaxed, so that the number asked for is always the number there is.
//
// Use: spheres_place once, while nobody waits -> spheres_seen per frame -> spheres_finish.
// The same seed gives the same spheres. Does not: draw. Moving objects are not looked at.
#ifndef STIMULI_SPHERES_H
#define STIMULI_SPHERES_H

#include "stimuli/ray.h"
#include "stimuli/viewing.h"

#include <stdint.h>

enum { SPHERES_MOST = 64, SPHERES_COLOURS = 7 };

#define SPHERES_RADIUS_M 0.06 // 12 cm across
#define SPHERES_SECONDS 1.0   // in one piece; of a flight shorter than two of them, half the flight
#define SPHERES_SAMPLE_S 0.1  // between two looks
#define SPHERES_MOST_DEG 30.0 // eccentricity of that second
#define SPHERES_LOOP_S 300.0  // of an endless flight, what is looked at

enum spheres_relaxed {
    SPHERES_AS_WISHED, // 1.5 to 6 m from the head, within 20 degrees, in the sphere's own share of the flight
    SPHERES_ANY_TIME,  // anywhere in the flight, 1 to 8 m, within 30 degrees
    SPHERES_NEARER,    // 0.5 to 3 m
    SPHERES_BRIEFLY,   // half the time
    SPHERES_TOUCHING,  // others may touch it
    SPHERES_IN_FRONT,  // shown in front of everything, wherever it is
    SPHERES_RELAXED
};
const char *spheres_relaxed_name(enum spheres_relaxed relaxed);

struct spheres_colour {
    const char *name;
    float srgb[3]; // encoded
};
extern const struct spheres_colour spheres_colours[SPHERES_COLOURS];

struct sphere {
    struct dvec3 position; // world
    uint32_t colour;       // index into spheres_colours
    enum spheres_relaxed relaxed;
    double from_s, to_s; // the stretch of the flight that was found
};

struct spheres_desc {
    const struct ray_scene *rays;
    const struct camera_path *path;
    double start_s;  // where on the path the flight begins
    double length_s; // of the flight; 0: endless, it is looked at for a round of the path
    double begin_s;  // its first and last part in which nobody sees much: the fade
    bool still;      // the head stays at start_s
    struct viewing_fov fov;
    double ipd_m;
    uint64_t seed;
    uint32_t count; // at most SPHERES_MOST
};

struct spheres {
    uint32_t count, samples;
    struct sphere all[SPHERES_MOST];
    double round_s; // an endless flight is where it was after this; infinite for others
    uint8_t *seen;  // owned; [sphere][eye][sample]: how many of its rays are free
};

// False: out of memory; there are none then. Everything else succeeds.
bool spheres_place(struct spheres *spheres, const struct spheres_desc *desc);
void spheres_finish(struct spheres *spheres);
// What of a sphere nothing covers, 0..1, between samples linearly. time_s: since the flight began.
double spheres_seen(const struct spheres *spheres, uint32_t sphere, int eye, double time_s);

#endif
