// Lights of KHR_lights_punctual, what stands in where a file has none, and the luminance that tone mapping goes
// by.
#include "stimuli/gltf/build.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define PI 3.14159265358979323846

// A hazy afternoon in the scene's own scale, in which a white wall is near 3 cd/m^2: sun 3.2 3.0 2.7 times pi
// lx from 60 degrees above the horizon, and a sky of about 1.2 cd/m^2: a third of the light on the ground is
// the sky's.
static const struct dvec3 default_sun_direction = {0.35, 0.85, 0.3};
static const float default_sun[3] = {3.2f * (float)PI, 3.0f * (float)PI, 2.7f * (float)PI};
static const struct scene_sky default_sky = {
    {0.50f, 0.85f, 1.60f}, {1.35f, 1.50f, 1.65f}, {0.52f, 0.48f, 0.42f}};

// A file with only local lights was meant for the evening: a third of the day's sun and sky, so that lamps
// still show.
#define EVENING 0.35f

// ITU-R BT.709
static double luminance(const float rgb[3])
{
    return 0.2126 * (double)rgb[0] + 0.7152 * (double)rgb[1] + 0.0722 * (double)rgb[2];
}

static void scale_sky(struct scene *scene, float factor)
{
    const float *from[3] = {default_sky.zenith, default_sky.horizon, default_sky.ground};
    float *to[3] = {scene->sky.zenith, scene->sky.horizon, scene->sky.ground};
    for (int part = 0; part < 3; part++)
        for (int k = 0; k < 3; k++)
            to[part][k] = from[part][k] * factor;
}

static void use_default_sun(struct scene *scene, float factor)
{
    scene->sun.direction = dvec3_normalise(default_sun_direction);
    for (int k = 0; k < 3; k++)
        scene->sun.illuminance[k] = default_sun[k] * factor;
    scale_sky(scene, factor);
}

// The brightest directional light is the sun; the renderer has one.
static void take_sun(struct gltf_build *build, const struct gltf_light *light, const struct dmat4 *world,
                     bool *found)
{
    struct scene_sun sun;
    for (int k = 0; k < 3; k++)
        sun.illuminance[k] = (float)(light->colour[k] * light->intensity);
    sun.direction = dvec3_normalise(dmat4_direction(world, (struct dvec3){0.0, 0.0, 1.0}));
    if (!(luminance(sun.illuminance) > 0.0) || !(dvec3_length(sun.direction) > 0.5))
        return;
    if (*found)
        build->further_suns++;
    if (!*found || luminance(sun.illuminance) > luminance(build->scene->sun.illuminance))
        build->scene->sun = sun;
    *found = true;
}

static void take_local(struct scene *scene, const struct gltf_light *light, const struct dmat4 *world)
{
    struct scene_light out = {.range_m = (float)light->range, .cos_outer = -2.0f};
    for (int k = 0; k < 3; k++)
        out.intensity[k] = (float)(light->colour[k] * light->intensity);
    out.position = dmat4_point(world, (struct dvec3){0.0, 0.0, 0.0});
    out.direction = dvec3_normalise(dmat4_direction(world, (struct dvec3){0.0, 0.0, -1.0}));
    if (strcmp(light->type, "spot") == 0 && dvec3_length(out.direction) > 0.5) {
        out.cos_inner = (float)cos(light->inner_angle);
        out.cos_outer = (float)cos(light->outer_angle);
    }
    if (luminance(out.intensity) > 0.0)
        scene->lights[scene->light_count++] = out;
}

static double sky_luminance(const struct scene *scene)
{
    return (luminance(scene->sky.zenith) + luminance(scene->sky.horizon)) / 2.0;
}

// Without a range a light reaches everywhere, and each pixel would ask every light. We end it where its
// illuminance has fallen to 0.5 % of what sun and sky give: I / d^2 = 0.005 E.
static void limit_ranges(struct scene *scene)
{
    double daylight = luminance(scene->sun.illuminance) + PI * sky_luminance(scene);
    for (uint32_t i = 0; i < scene->light_count; i++) {
        struct scene_light *light = &scene->lights[i];
        double peak =
            fmax((double)light->intensity[0], fmax((double)light->intensity[1], (double)light->intensity[2]));
        if (!(light->range_m > 0.0f))
            light->range_m = (float)sqrt(peak / (0.005 * daylight));
    }
}

bool gltf_build_lights(struct gltf_build *build, const struct dmat4 *world)
{
    const struct gltf_document *d = build->document;
    struct scene *scene = build->scene;
    scene->lights = calloc(d->node_count + 1u, sizeof *scene->lights);
    gltf_at(&build->report, "lights");
    if (scene->lights == NULL)
        return gltf_fail(&build->report, "out of memory");
    bool sun = false;
    for (uint32_t i = 0; i < d->node_count; i++) {
        int32_t at = build->scene_node[i];
        if (at < 0 || d->nodes[i].light < 0)
            continue;
        const struct gltf_light *light = &d->lights[d->nodes[i].light];
        if (strcmp(light->type, "directional") == 0)
            take_sun(build, light, &world[at], &sun);
        else
            take_local(scene, light, &world[at]);
    }
    if (sun)
        scale_sky(scene, (float)(luminance(scene->sun.illuminance) / luminance(default_sun)));
    else
        use_default_sun(scene, scene->light_count > 0 ? EVENING : 1.0f);
    limit_ranges(scene);
    // A surface of albedo 0.2 (stone, ground and plants together), half of the time in the sun, which meets it
    // at 45 degrees, under the open sky: L = 0.2 / pi * (0.5 E_sun cos 45 + pi L_sky). Fixed, so that exposure
    // never depends on where one looks.
    scene->luminance =
        (float)(0.2 / PI * (0.5 * luminance(scene->sun.illuminance) * 0.70710678 + PI * sky_luminance(scene)));
    return true;
}
