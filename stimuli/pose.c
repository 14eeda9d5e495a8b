// Rigid node animation: glTF 2.0, section 3.11 and appendix C (interpolation).
#include "stimuli/scene.h"

#include <math.h>

static uint32_t components(const struct scene_channel *channel)
{
    return channel->target == SCENE_ROTATION ? 4u : 3u;
}

// Values of key k: group 0 is the in-tangent, 1 the value, 2 the out-tangent; only CUBIC has tangents.
static const float *key_values(const struct scene_channel *channel, uint32_t key, uint32_t group)
{
    uint32_t n = components(channel);
    if (channel->interpolation == SCENE_CUBIC)
        return channel->values + ((size_t)key * 3 + group) * n;
    return channel->values + (size_t)key * n;
}

// The last key at or before the time; 0 before the first.
static uint32_t find_key(const struct scene_channel *channel, double time_s)
{
    uint32_t low = 0, high = channel->key_count;
    while (high - low > 1) {
        uint32_t middle = low + (high - low) / 2;
        if ((double)channel->times[middle] <= time_s)
            low = middle;
        else
            high = middle;
    }
    return low;
}

static void copy_key(const struct scene_channel *channel, uint32_t key, double out[4])
{
    const float *value = key_values(channel, key, 1);
    for (uint32_t i = 0; i < components(channel); i++)
        out[i] = (double)value[i];
}

static void interpolate_linear(const struct scene_channel *channel, uint32_t key, double t, double out[4])
{
    const float *a = key_values(channel, key, 0), *b = key_values(channel, key + 1, 0);
    if (channel->target == SCENE_ROTATION) {
        struct dquat from = {(double)a[0], (double)a[1], (double)a[2], (double)a[3]};
        struct dquat to = {(double)b[0], (double)b[1], (double)b[2], (double)b[3]};
        struct dquat q = dquat_slerp(dquat_normalise(from), dquat_normalise(to), t);
        out[0] = q.x, out[1] = q.y, out[2] = q.z, out[3] = q.w;
        return;
    }
    for (uint32_t i = 0; i < 3; i++)
        out[i] = (1.0 - t) * (double)a[i] + t * (double)b[i];
}

static void interpolate_cubic(const struct scene_channel *channel, uint32_t key, double t, double step_s,
                              double out[4])
{
    const float *value0 = key_values(channel, key, 1), *out_tangent = key_values(channel, key, 2);
    const float *in_tangent = key_values(channel, key + 1, 0), *value1 = key_values(channel, key + 1, 1);
    double t2 = t * t, t3 = t2 * t;
    for (uint32_t i = 0; i < components(channel); i++)
        out[i] = (2.0 * t3 - 3.0 * t2 + 1.0) * (double)value0[i] +
                 step_s * (t3 - 2.0 * t2 + t) * (double)out_tangent[i] +
                 (3.0 * t2 - 2.0 * t3) * (double)value1[i] + step_s * (t3 - t2) * (double)in_tangent[i];
}

static void evaluate(const struct scene_channel *channel, double time_s, double out[4])
{
    uint32_t key = find_key(channel, time_s);
    double start_s = (double)channel->times[key];
    if (channel->interpolation == SCENE_STEP || key + 1 >= channel->key_count || time_s <= start_s) {
        copy_key(channel, key, out);
        return;
    }
    double step_s = (double)channel->times[key + 1] - start_s;
    double t = (time_s - start_s) / step_s;
    if (channel->interpolation == SCENE_CUBIC)
        interpolate_cubic(channel, key, t, step_s, out);
    else
        interpolate_linear(channel, key, t, out);
}

static struct dmat4 animated_local(const struct scene_node *node, const struct scene_channel *channels,
                                   uint32_t count, double time_s)
{
    struct dvec3 translation = node->translation, scale = node->scale;
    struct dquat rotation = node->rotation;
    for (uint32_t i = 0; i < count; i++) {
        double v[4];
        evaluate(&channels[i], time_s, v);
        if (channels[i].target == SCENE_TRANSLATION)
            translation = (struct dvec3){v[0], v[1], v[2]};
        else if (channels[i].target == SCENE_SCALE)
            scale = (struct dvec3){v[0], v[1], v[2]};
        else
            rotation = (struct dquat){v[0], v[1], v[2], v[3]};
    }
    return dmat4_compose(translation, dquat_normalise(rotation), scale);
}

void scene_pose(const struct scene *scene, double time_s, bool moving_only, struct dmat4 *out_world_from_node)
{
    double length_s = (double)scene->animation_s;
    double loop_s = length_s > 0.0 ? fmod(time_s, length_s) : 0.0;
    if (loop_s < 0.0)
        loop_s += length_s;
    uint32_t channel = 0;
    for (uint32_t i = 0; i < scene->node_count; i++) {
        const struct scene_node *node = &scene->nodes[i];
        uint32_t first = channel;
        while (channel < scene->channel_count && scene->channels[channel].node == i)
            channel++;
        if (moving_only && !node->moving)
            continue;
        struct dmat4 local = node->local;
        if (node->animated)
            local = animated_local(node, scene->channels + first, channel - first, loop_s);
        out_world_from_node[i] =
            node->parent >= 0 ? dmat4_multiply(&out_world_from_node[node->parent], &local) : local;
    }
}
