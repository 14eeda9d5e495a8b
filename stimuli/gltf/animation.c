// The first animation's channels. gltf_check has proved lengths and types; key times remain to be looked at.
#include "stimuli/gltf/build.h"

#include <stdlib.h>
#include <string.h>

static bool read_times(struct gltf_build *build, int32_t accessor, struct scene_channel *out)
{
    const struct gltf_report *report = &build->report;
    out->times = malloc(out->key_count * sizeof *out->times);
    if (out->times == NULL)
        return gltf_fail(report, "out of memory");
    if (!gltf_read_floats(build->document, accessor, out->times, report))
        return false;
    for (uint32_t i = 0; i < out->key_count; i++)
        if (out->times[i] < 0.0f || out->times[i] > 1e6f || (i > 0 && !(out->times[i] > out->times[i - 1])))
            return gltf_fail(report, "key time %u is %g; times must rise, from 0 to at most 1e6 s", i,
                             (double)out->times[i]);
    return true;
}

static bool check_rotations(const struct gltf_report *report, const struct scene_channel *channel)
{
    bool cubic = channel->interpolation == SCENE_CUBIC;
    for (uint32_t i = 0; channel->target == SCENE_ROTATION && i < channel->key_count; i++) {
        const float *q = channel->values + (cubic ? (size_t)i * 12 + 4 : (size_t)i * 4);
        float square = q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3];
        if (!(square > 1e-6f && square < 1e6f))
            return gltf_fail(report, "rotation of key %u is not near a unit quaternion", i);
    }
    return true;
}

static bool read_values(struct gltf_build *build, int32_t accessor, struct scene_channel *out)
{
    const struct gltf_accessor *a = &build->document->accessors[accessor];
    out->values = malloc(a->count * a->width * sizeof *out->values);
    if (out->values == NULL)
        return gltf_fail(&build->report, "out of memory");
    if (!gltf_read_floats(build->document, accessor, out->values, &build->report))
        return false;
    for (uint64_t i = 0; i < a->count * a->width; i++)
        if (out->values[i] > 1e9f || out->values[i] < -1e9f)
            return gltf_fail(&build->report, "a value is %g, not within 1e9", (double)out->values[i]);
    return check_rotations(&build->report, out);
}

static bool read_channel(struct gltf_build *build, const struct gltf_channel *channel)
{
    const struct gltf_document *d = build->document;
    struct scene *scene = build->scene;
    const struct gltf_animation_sampler *sampler = &d->animation_samplers[channel->sampler];
    struct scene_channel *out = &scene->channels[scene->channel_count++];
    *out = (struct scene_channel){.node = (uint32_t)build->scene_node[channel->node],
                                  .key_count = (uint32_t)d->accessors[sampler->input].count};
    out->target = channel->path[0] == 't'   ? SCENE_TRANSLATION
                  : channel->path[0] == 'r' ? SCENE_ROTATION
                                            : SCENE_SCALE;
    out->interpolation = sampler->interpolation[0] == 'S'   ? SCENE_STEP
                         : sampler->interpolation[0] == 'C' ? SCENE_CUBIC
                                                            : SCENE_LINEAR;
    gltf_at(&build->report, "animations[0].samplers[%d].input", channel->sampler);
    if (!read_times(build, sampler->input, out))
        return false;
    gltf_at(&build->report, "animations[0].samplers[%d].output", channel->sampler);
    if (!read_values(build, sampler->output, out))
        return false;
    if (out->times[out->key_count - 1] > scene->animation_s)
        scene->animation_s = out->times[out->key_count - 1];
    return true;
}

bool gltf_build_animation(struct gltf_build *build)
{
    const struct gltf_document *d = build->document;
    build->scene->channels = calloc(d->channel_count + 1u, sizeof *build->scene->channels);
    gltf_at(&build->report, "animations[0]");
    if (build->scene->channels == NULL)
        return gltf_fail(&build->report, "out of memory");
    for (uint32_t i = 0; i < d->channel_count; i++) {
        const struct gltf_channel *channel = &d->channels[i];
        bool weights = strcmp(channel->path, "weights") == 0;
        if (weights)
            build->ignored_channels++;
        if (!weights && build->scene_node[channel->node] >= 0 && !read_channel(build, channel))
            return false;
    }
    return true;
}
