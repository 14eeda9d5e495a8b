// How far a scene's still surfaces are along a ray, in double precision.
//
// Use: ray_scene_create once per scene -> ray_distance, ray_clear -> ray_scene_destroy.
// Every triangle that stands still counts, whichever side it shows; alpha masks are not looked up, so a leaf's
// card is solid. Moving objects are not there. Threads may read one ray scene together.
#ifndef STIMULI_RAY_H
#define STIMULI_RAY_H

#include "stimuli/scene.h"

#include <stdbool.h>

struct ray_scene;
// Keeps a pointer to the scene, which must outlive it. NULL: out of memory.
struct ray_scene *ray_scene_create(const struct scene *scene);
void ray_scene_destroy(struct ray_scene *rays); // NULL is fine

// Metres from `from` along the unit vector `direction` to the nearest surface; far_m where none is nearer.
double ray_distance(const struct ray_scene *rays, struct dvec3 from, struct dvec3 direction, double far_m);
// Whether no surface lies between two points.
bool ray_clear(const struct ray_scene *rays, struct dvec3 from, struct dvec3 to);

#endif
