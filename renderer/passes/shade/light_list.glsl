// Which lights may reach a work group's pixels: a bit each in shared memory, so that every pixel adds its lights in
// the order of the scene and a run repeats to the last bit. Tiled culling after Andersson, "Parallel Graphics in
// Frostbite", SIGGRAPH 2009 course notes. Needs view.glsl, and `frame` and `lights`.

const uint light_words = 32u; // 1024 lights at a time
const uint light_chunk = 32u * light_words;

shared uint light_mask[light_words];
shared uint nearest_bits, farthest_bits; // distances along the view axis; positive floats order like their bits

// Every work item calls it once; `lit`: its pixel shows a surface, at `distance` along the view axis.
void measure_tile(bool lit, float distance)
{
    if (gl_LocalInvocationIndex == 0u) {
        nearest_bits = 0xffffffffu;
        farthest_bits = 0u;
    }
    barrier();
    if (lit) {
        atomicMin(nearest_bits, floatBitsToUint(distance));
        atomicMax(farthest_bits, floatBitsToUint(distance));
    }
    barrier();
}

// False only where no surface of the tile can lie in the sphere. `low`, `high`: the tile's corners, in the image plane
// at distance 1 (view_ray), y up.
bool sphere_meets_tile(vec3 centre, float radius, vec2 low, vec2 high)
{
    float nearest = uintBitsToFloat(nearest_bits), farthest = uintBitsToFloat(farthest_bits);
    vec3 box_min = vec3(min(low * nearest, low * farthest), -farthest);
    vec3 box_max = vec3(max(high * nearest, high * farthest), -nearest);
    vec3 off = centre - clamp(centre, box_min, box_max);
    // signed distances to the four side planes, inside positive
    vec4 inside = vec4(centre.xy + low * centre.z, -centre.xy - high * centre.z) *
                  inversesqrt(1.0 + vec4(low * low, high * high));
    return dot(off, off) <= radius * radius && min(min(inside.x, inside.y), min(inside.z, inside.w)) >= -radius;
}

// Sets the bits of lights [first, first + light_chunk). Every work item calls it; `corner` is the tile's upper left
// pixel.
void list_lights(uint first, uint eye, uvec2 corner)
{
    vec2 size = vec2(frame.width, frame.height);
    vec2 upper = view_ray(frame_eye(eye), size, vec2(corner) - frame.jitter).xy;
    vec2 lower = view_ray(frame_eye(eye), size, vec2(corner) - frame.jitter + float(SHARED_TILE)).xy;
    mat4 world_from_eye = frame_eye(eye).world_from_eye;
    barrier();
    if (gl_LocalInvocationIndex < light_words)
        light_mask[gl_LocalInvocationIndex] = 0u;
    barrier();
    for (uint i = gl_LocalInvocationIndex; i < light_chunk && first + i < frame.light_count; i += 64u) {
        shared_light light = lights[first + i];
        vec3 centre = (light.position - world_from_eye[3].xyz) * mat3(world_from_eye);
        // the margin covers rounding: floats of 10 km from the origin are 1 mm apart
        float radius = light.range_m * 1.0001 + 1e-3 + 1e-6 * length(centre);
        if (sphere_meets_tile(centre, radius, vec2(upper.x, lower.y), vec2(lower.x, upper.y)))
            atomicOr(light_mask[i >> 5], 1u << (i & 31u));
    }
    barrier();
}
