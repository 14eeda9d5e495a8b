// What primitives and animation channels point at.
#include "stimuli/gltf/check.h"

#include <inttypes.h>
#include <string.h>

#define FLOAT GLTF_BIT(GLTF_FLOAT)
#define SIGNED (GLTF_BIT(GLTF_INT8) | GLTF_BIT(GLTF_INT16))
#define UNSIGNED (GLTF_BIT(GLTF_UINT8) | GLTF_BIT(GLTF_UINT16))

// glTF 2.0, section 3.7.2.1, and KHR_mesh_quantization.
static struct gltf_rule attribute_rule(enum gltf_attribute attribute, bool quantised)
{
    uint32_t any = quantised ? SIGNED | UNSIGNED : 0u, directions = quantised ? SIGNED : 0u;
    switch (attribute) {
    case GLTF_POSITION:
        return (struct gltf_rule){3, 3, FLOAT | any, any};
    case GLTF_NORMAL:
        return (struct gltf_rule){3, 3, FLOAT, directions};
    case GLTF_TANGENT:
        return (struct gltf_rule){4, 4, FLOAT, directions};
    case GLTF_COLOR_0:
        return (struct gltf_rule){3, 4, FLOAT, UNSIGNED};
    default:
        return (struct gltf_rule){2, 2, FLOAT | any, UNSIGNED | any};
    }
}

static bool check_attributes(const struct gltf_document *d, uint32_t mesh, uint32_t at,
                             struct gltf_report *report)
{
    static const char *const names[GLTF_ATTRIBUTES] = {"POSITION",   "NORMAL",     "TANGENT",
                                                       "TEXCOORD_0", "TEXCOORD_1", "COLOR_0"};
    const struct gltf_primitive *p = &d->primitives[d->meshes[mesh].first_primitive + at];
    bool quantised = gltf_uses(d, "KHR_mesh_quantization");
    for (int k = 0; k < GLTF_ATTRIBUTES; k++) {
        gltf_at(report, "meshes[%u].primitives[%u].attributes.%s", mesh, at, names[k]);
        if (p->attribute[k] == -1 && k == GLTF_POSITION)
            return gltf_fail(report, "is missing");
        if (p->attribute[k] == -1)
            continue;
        struct gltf_rule rule = attribute_rule((enum gltf_attribute)k, quantised);
        if (!gltf_check_accessor(d, p->attribute[k], &rule, report))
            return false;
        uint64_t count = d->accessors[p->attribute[k]].count;
        uint64_t vertices = d->accessors[p->attribute[GLTF_POSITION]].count;
        if (count != vertices)
            return gltf_fail(report, "accessor %d has %" PRIu64 " elements, POSITION has %" PRIu64,
                             p->attribute[k], count, vertices);
    }
    return true;
}

// Triangles from this many corners; the mode is 4, 5 or 6.
static uint64_t corner_triangles(int32_t mode, uint64_t corners)
{
    if (mode == 4)
        return corners / 3;
    return corners >= 3 ? corners - 2 : 0;
}

static bool check_primitive(const struct gltf_document *d, uint32_t mesh, uint32_t at, uint64_t *vertices,
                            uint64_t *indices, struct gltf_report *report)
{
    const struct gltf_primitive *p = &d->primitives[d->meshes[mesh].first_primitive + at];
    gltf_at(report, "meshes[%u].primitives[%u]", mesh, at);
    if (p->mode < 0 || p->mode > 6)
        return gltf_fail(report, "mode is %d, not from 0 to 6", p->mode);
    if (!gltf_check_index(p->material, d->material_count, "material", report))
        return false;
    if (p->mode < 4)
        return true; // points and lines are named, not read
    if (!check_attributes(d, mesh, at, report))
        return false;
    uint64_t corners = d->accessors[p->attribute[GLTF_POSITION]].count;
    *vertices += corners;
    if (p->indices != -1) {
        const struct gltf_rule rule = {1, 1, UNSIGNED | GLTF_BIT(GLTF_UINT32), 0};
        gltf_at(report, "meshes[%u].primitives[%u].indices", mesh, at);
        if (!gltf_check_accessor(d, p->indices, &rule, report))
            return false;
        corners = d->accessors[p->indices].count;
    }
    gltf_at(report, "meshes[%u].primitives[%u]", mesh, at);
    if (p->mode == 4 && corners % 3 != 0)
        return gltf_fail(report, "has %" PRIu64 " corners, not a multiple of 3", corners);
    uint64_t made = corner_triangles(p->mode, corners) * 3;
    *indices += made;
    // Flat normals need a vertex for every corner.
    if (p->attribute[GLTF_NORMAL] == -1)
        *vertices += made;
    if (*vertices > GLTF_MAX_VERTICES || *indices > GLTF_MAX_INDICES)
        return gltf_fail(report,
                         "the meshes up to here have %" PRIu64 " vertices and %" PRIu64
                         " indices; our limits are 20 and 60 million",
                         *vertices, *indices);
    return true;
}

bool gltf_check_meshes(const struct gltf_document *d, struct gltf_report *report)
{
    uint64_t vertices = 0, indices = 0;
    for (uint32_t mesh = 0; mesh < d->mesh_count; mesh++)
        for (uint32_t at = 0; at < d->meshes[mesh].primitive_count; at++)
            if (!check_primitive(d, mesh, at, &vertices, &indices, report))
                return false;
    return true;
}

static bool check_path(const struct gltf_document *d, const struct gltf_channel *channel, uint32_t *out_width,
                       struct gltf_report *report)
{
    if (strcmp(channel->path, "translation") == 0 || strcmp(channel->path, "scale") == 0)
        *out_width = 3;
    else if (strcmp(channel->path, "rotation") == 0)
        *out_width = 4;
    else if (strcmp(channel->path, "weights") != 0)
        return gltf_fail(report, "path '%.40s' is not translation, rotation, scale or weights", channel->path);
    if (*out_width > 0 && d->nodes[channel->node].matrix_count > 0)
        return gltf_fail(report, "animates node %d, which has a matrix", channel->node);
    return true;
}

static bool check_channel(const struct gltf_document *d, uint32_t at, uint64_t *keys,
                          struct gltf_report *report)
{
    const struct gltf_channel *channel = &d->channels[at];
    gltf_at(report, "animations[0].channels[%u]", at);
    if (channel->node < 0 || (uint32_t)channel->node >= d->node_count)
        return gltf_fail(report, "names node %d, the file has %u", channel->node, d->node_count);
    if (channel->sampler < 0 || (uint32_t)channel->sampler >= d->animation_sampler_count)
        return gltf_fail(report, "names sampler %d, the animation has %u", channel->sampler,
                         d->animation_sampler_count);
    uint32_t width = 0;
    if (!check_path(d, channel, &width, report))
        return false;
    if (width == 0)
        return true; // morph weights are named, not read
    const struct gltf_animation_sampler *sampler = &d->animation_samplers[channel->sampler];
    bool cubic = strcmp(sampler->interpolation, "CUBICSPLINE") == 0;
    if (!cubic && strcmp(sampler->interpolation, "LINEAR") != 0 && strcmp(sampler->interpolation, "STEP") != 0)
        return gltf_fail(report, "interpolation '%.40s' is not LINEAR, STEP or CUBICSPLINE",
                         sampler->interpolation);
    const struct gltf_rule input = {1, 1, FLOAT, 0};
    const struct gltf_rule output = {width, width, FLOAT, width == 4 ? SIGNED | UNSIGNED : 0u};
    gltf_at(report, "animations[0].samplers[%d].input", channel->sampler);
    if (!gltf_check_accessor(d, sampler->input, &input, report))
        return false;
    gltf_at(report, "animations[0].samplers[%d].output", channel->sampler);
    if (!gltf_check_accessor(d, sampler->output, &output, report))
        return false;
    uint64_t times = d->accessors[sampler->input].count, values = d->accessors[sampler->output].count;
    if (values != times * (cubic ? 3u : 1u))
        return gltf_fail(report, "has %" PRIu64 " values for %" PRIu64 " %skeys", values, times,
                         cubic ? "cubic " : "");
    *keys += times;
    return *keys <= GLTF_MAX_KEYS ||
           gltf_fail(report, "the channels up to here have more than 20 million keys");
}

bool gltf_check_animation(const struct gltf_document *d, struct gltf_report *report)
{
    uint64_t keys = 0;
    for (uint32_t i = 0; i < d->channel_count; i++)
        if (!check_channel(d, i, &keys, report))
            return false;
    return true;
}
