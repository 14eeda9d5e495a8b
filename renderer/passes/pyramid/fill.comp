#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "renderer/shared/shared.h"
#include "renderer/shared/view.glsl"

// MOVING: the scene has moving objects. Pixels that the map already holds are redrawn, whatever their confidence, and
// those of moving objects in turns of whole tiles.

layout(local_size_x = SHARED_TILE, local_size_y = SHARED_TILE) in;

layout(scalar, binding = 0) uniform Frame { shared_frame frame; };
#include "renderer/shared/eye.glsl"
layout(binding = 1, rgba8) uniform image2DArray colour;
layout(binding = 2, rgba32f) uniform image2DArray position;
layout(binding = 3) uniform sampler2DArray pyramid; // mip m - 1 is level m
layout(binding = 4) uniform sampler2DArray depths;
layout(binding = 5, r8ui) uniform uimage2DArray redraw_map;
layout(push_constant) uniform Push {
    float epsilon, fovea_deg, periphery_deg, hole_decay, dynamic_decay;
    uint levels, turn;
    float trusted_cosine; // of the angle at which c_e reaches epsilon; above 1: nothing is too near
} push;

float eccentricity_confidence(ivec3 pixel, vec2 place)
{
    const shared_eye eye = frame_eye(uint(pixel.z));
    float ecc = view_eccentricity_deg(eye, view_ray(eye, vec2(frame.width, frame.height), place));
    // c_e = S_1((phi - phi_F) / (phi_0 - phi_F)), section 5.2
    return smoothstep(push.fovea_deg, max(push.periphery_deg, push.fovea_deg + 1e-3), ecc);
}

#ifdef MOVING
#include "renderer/shared/turn.glsl"

// Whether it is the turn of the pixel's tile. c_e D^t falls under epsilon after P frames; a tile redraws its moving
// pixels every P frames, each tile in its own, so that neither one frame has all the work nor many tiles a few pixels.
bool tiles_turn(ivec3 pixel)
{
    if (push.dynamic_decay <= 0.0 || push.dynamic_decay >= 1.0 || push.epsilon <= 0.0)
        return false;
    ivec2 tile = pixel.xy / SHARED_TILE;
    float confidence = eccentricity_confidence(pixel, float(SHARED_TILE) * (vec2(tile) + 0.5));
    if (confidence <= push.epsilon)
        return false; // redrawn anyway
    float period = floor(log(push.epsilon / confidence) / log(push.dynamic_decay)) + 1.0;
    return period < 64.0 && tile_has_turn(uvec2(tile), uint(pixel.z), push.turn, uint(period));
}
#endif

// Level m around a pixel: the four nearest texels, weighted bilinearly, of those with a value and of the kind (surface
// or background) of the texel over the pixel itself; alpha is their contrast confidence, 0 where that texel has
// nothing.
vec4 level_value(ivec3 pixel, int m, out float depth)
{
    int mip = m - 1;
    ivec3 over = ivec3(pixel.xy >> m, pixel.z);
    depth = texelFetch(depths, over, mip).x;
    if (texelFetch(pyramid, over, mip).a == 0.0)
        return vec4(0.0);
    vec2 at = (vec2(pixel.xy) + 0.5) / float(1 << m) - 0.5;
    ivec2 corner = ivec2(floor(at)), last = textureSize(pyramid, mip).xy - 1;
    vec2 f = at - vec2(corner);
    vec4 sum = vec4(0.0);
    float weights = 0.0;
    for (int i = 0; i < 4; i++) {
        ivec2 step = ivec2(i & 1, i >> 1);
        ivec3 texel = ivec3(clamp(corner + step, ivec2(0), last), pixel.z);
        vec4 p = texelFetch(pyramid, texel, mip);
        vec2 w = mix(1.0 - f, f, vec2(step));
        if (p.a > 0.0 && (texelFetch(depths, texel, mip).x > 0.0) == (depth > 0.0)) {
            sum += w.x * w.y * p;
            weights += w.x * w.y;
        }
    }
    return sum / weights; // the texel over the pixel weighs at least 1/4
}

void main()
{
    ivec3 pixel = ivec3(gl_GlobalInvocationID);
    if (pixel.x >= int(frame.width) || pixel.y >= int(frame.height))
        return;
    float w = imageLoad(position, pixel).w, depth = 0.0, confidence = 1.0;
    vec4 filled = vec4(0.0);
    // c <= c_e, and c_e < epsilon is a matter of the angle alone: most pixels need no more
    const shared_eye eye = frame_eye(uint(pixel.z));
    vec3 ray = view_ray(eye, vec2(frame.width, frame.height), vec2(pixel.xy) + 0.5);
    bool redraw = push.epsilon >= 1.0 || (push.epsilon > 0.0 && view_within(eye, ray, push.trusted_cosine));
    if (redraw) {
        imageStore(redraw_map, pixel, uvec4(1u));
        return;
    }
    if (w == 0.0 || w >= 2.0)
        confidence = eccentricity_confidence(pixel, vec2(pixel.xy) + 0.5);
    if (w == 0.0) {
        int m = 0;
        while (filled.a == 0.0 && m < int(push.levels))
            filled = level_value(pixel, ++m, depth);
        confidence *= filled.a * pow(push.hole_decay, float(m)); // c_c c_s(m)
    } else if (w >= 2.0) {
        confidence *= pow(push.dynamic_decay, round(fract(w) * 64.0)); // c_d(t), section 7
    }
    redraw = confidence < push.epsilon;
#ifdef MOVING
    redraw = redraw || imageLoad(redraw_map, pixel).x != 0u || (w >= 2.0 && tiles_turn(pixel));
#endif
    if (!redraw && w == 0.0) {
        imageStore(colour, pixel, vec4(filled.rgb, 1.0));
        imageStore(position, pixel, vec4(depth, 0.0, 0.0, 0.0)); // still a hole; its depth is for smoothing
    }
    imageStore(redraw_map, pixel, uvec4(redraw ? 1u : 0u));
}
