#include "stimuli/builtin/atrium.h"

#include "stimuli/builtin/atrium_parts.h"
#include "stimuli/builtin/visibility.h"

#include <math.h>
#include <stdlib.h>

#define PI 3.14159265358979f

struct solid_brush atrium_brush(const struct atrium *atrium, enum atrium_material material,
                                struct solid_place place)
{
    return (struct solid_brush){.maker = atrium->maker,
                                .material = atrium->material[material],
                                .tile_m = atrium_tile_m(material),
                                .place = place};
}

struct solid_place atrium_at(struct solid_place place, float x, float y, float z)
{
    for (int i = 0; i < 3; i++)
        place.origin[i] += place.x[i] * x + place.y[i] * y + place.z[i] * z;
    return place;
}

void atrium_each_bay(const struct atrium *atrium, atrium_bay_fn place)
{
    static const struct {
        uint32_t bays;
        float yaw, distance;
    } sides[4] = {
        {8, 0, ATRIUM_HALF_Z}, {3, -PI / 2, ATRIUM_HALF_X}, {8, PI, ATRIUM_HALF_Z}, {3, PI / 2, ATRIUM_HALF_X}};
    uint32_t number = 0;
    for (int side = 0; side < 4; side++) {
        struct solid_place middle = solid_place(0, 0, 0, sides[side].yaw);
        for (uint32_t i = 0; i < sides[side].bays; i++, number++) {
            float x = ((float)i - ((float)sides[side].bays - 1) / 2) * ATRIUM_BAY;
            place(atrium, atrium_at(middle, x, 0, -sides[side].distance), number);
        }
    }
}

static void add_light(struct scene *scene)
{
    // Late morning: the sun reaches half of the court's floor and the upper arcade of one side.
    scene->sun.direction = dvec3_normalise((struct dvec3){0.60, 0.74, 0.40});
    const float sun[3] = {75, 69, 60}, zenith[3] = {1.5f, 4.2f, 11.0f}, horizon[3] = {5.6f, 8.0f, 10.6f};
    const float ground[3] = {3.4f, 2.9f, 2.3f};
    for (int i = 0; i < 3; i++) {
        scene->sun.illuminance[i] = sun[i];
        scene->sky.zenith[i] = zenith[i];
        scene->sky.horizon[i] = horizon[i];
        scene->sky.ground[i] = ground[i];
    }
    scene->luminance = 1.3f;
}

bool atrium_path(struct camera_path *out)
{
    // Through the court past the basin, into the arcade, along it under the vaults, and out again.
    static const struct camera_path_knot knots[] = {
        {{-10.2, 1.65, 0.6}, {0, 3.0, 0}},       {{-6.5, 1.65, 1.8}, {3, 3.0, -2.5}},
        {{-2.8, 1.65, 2.45}, {5, 2.8, -4.5}},    {{1.5, 1.65, 2.5}, {8.5, 3.2, -3.5}},
        {{5.6, 1.65, 2.0}, {11, 3.6, -1.0}},     {{9.3, 1.65, 1.0}, {12.5, 3.0, -6.0}},
        {{9.9, 1.65, -1.4}, {6.0, 2.6, -8.0}},   {{8.4, 1.68, -3.5}, {3.5, 2.4, -8.0}},
        {{6.6, 1.79, -5.6}, {0, 2.3, -7.0}},     {{2.6, 1.81, -6.2}, {-6.0, 2.2, -5.9}},
        {{-1.6, 1.81, -6.1}, {-8.5, 2.3, -4.0}}, {{-4.5, 1.76, -4.4}, {-8.0, 2.9, 1.5}},
        {{-6.8, 1.67, -2.2}, {-5.0, 3.2, 5.5}},  {{-9.0, 1.65, -1.2}, {-1.5, 3.4, 5.0}},
    };
    *out = (struct camera_path){.knot_count = sizeof knots / sizeof knots[0], .speed_m_s = 1.2};
    for (uint32_t i = 0; i < out->knot_count; i++)
        out->knots[i] = knots[i];
    return camera_path_finish(out);
}

static void build(const struct atrium *atrium)
{
    struct maker *maker = atrium->maker;
    struct scene *scene = maker->scene;
    maker_mesh_begin(maker);
    atrium_add_arcades(atrium);
    atrium_add_trim(atrium);
    atrium_add_cloth(atrium);
    atrium_add_fountain(atrium);
    atrium_add_plants(atrium);
    struct visibility_desc light = {
        .sky = &scene->sky,
        .directions = 28,
        .open_material = atrium->material[ATRIUM_COURT],
        .below = {4.2f, 3.5f, 2.6f},
        .bounce = {0.95f, 0.82f, 0.66f},
        .lift_m = 0.1f,
    };
    if (!maker->failed && !visibility_bake(maker, &light))
        maker->failed = true;
    uint32_t mesh = maker_mesh_end(maker);
    uint32_t node = maker_node(maker, -1, (struct dvec3){0, 0, 0}, (struct dquat){0, 0, 0, 1});
    maker_instance(maker, mesh, node);
}

struct scene *atrium_make(const double *values)
{
    (void)values;
    struct maker *maker = malloc(sizeof *maker);
    if (maker == NULL)
        return NULL;
    struct scene *scene = NULL;
    if (maker_create(maker, "atrium")) {
        struct atrium atrium = {.maker = maker};
        add_light(maker->scene);
        if (!atrium_path(&maker->scene->path) || !atrium_make_materials(&atrium))
            maker->failed = true;
        if (!maker->failed)
            build(&atrium);
        scene = maker_finish(maker);
    }
    free(maker);
    return scene;
}
