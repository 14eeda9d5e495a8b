#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "renderer/shared/shared.h"
#include "renderer/shared/view.glsl"

// The redraw map of all but holes. c <= c_e, and c_e < epsilon is a matter of the angle alone; for what stands still no
// other term lowers c, so its position is not even read. MOVING: the scene has moving objects. Pixels that the map already
// holds are redrawn, and those of moving objects by their age and in turns of whole tiles.

layout(local_size_x = SHARED_TILE, local_size_y = SHARED_TILE) in;

layout(scalar, binding = 0) uniform Frame { shared_frame frame; };
#include "renderer/shared/eye.glsl"
layout(binding = 1, rgba32f) uniform readonly image2DArray position;
layout(binding = 2, r8ui) uniform uimage2DArray redraw_map;
#include "renderer/passes/pyramid/confidence.glsl"

#ifdef MOVING
#include "renderer/shared/turn.glsl"

// Whether it is the turn of the pixel's tile. c_e D^t falls under epsilon after P frames; a tile redraws its moving
// pixels every P frames.
bool tiles_turn(ivec3 pixel)
{
    if (push.dynamic_decay <= 0.0 || push.dynamic_decay >= 1.0 || push.epsilon <= 0.0)
        return false;
    ivec2 tile = pixel.xy / SHARED_TILE;
    float confidence = eccentricity_confidence(pixel, float(SHARED_TILE) * (vec2(tile) + 0.5));
    if (confidence <= push.epsilon)
        return false; // redrawn anyway
    float period = floor(log(push.epsilon / confidence) / log(push.dynamic_decay)) + 1.0;
    return period < 64.0 && tile_has_turn(uint(tile.x), frame.width, push.turn, uint(period));
}

bool moving_redrawn(ivec3 pixel)
{
    float w = imageLoad(position, pixel).w;
    if (imageLoad(redraw_map, pixel).x != 0u)
        return true;
    if (w < 2.0)
        return false;
    float age = round(fract(w) * 64.0);
    float confidence = eccentricity_confidence(pixel, vec2(pixel.xy) + 0.5) * pow(push.dynamic_decay, age); // c_e c_d
    return confidence < push.epsilon || tiles_turn(pixel);
}
#endif

void main()
{
    ivec3 pixel = ivec3(gl_GlobalInvocationID);
    if (pixel.x >= int(frame.width) || pixel.y >= int(frame.height))
        return;
    vec3 ray = view_ray(EYE(uint(pixel.z), tangents), vec2(frame.width, frame.height), vec2(pixel.xy) + 0.5);
    bool redraw = push.epsilon >= 1.0 ||
                  (push.epsilon > 0.0 && view_within(EYE(uint(pixel.z), gaze), ray, push.trusted_cosine));
#ifdef MOVING
    redraw = redraw || moving_redrawn(pixel);
#endif
    imageStore(redraw_map, pixel, uvec4(redraw ? 1u : 0u));
}
