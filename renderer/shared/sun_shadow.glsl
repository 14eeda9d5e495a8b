// Reads the map of passes/shadow. Needs shared.h and `frame`.

// Share of the sun that reaches a surface, 0..1: 3x3 bilinear comparisons a texel apart, weighted 1 2 1 both ways. Two
// of the four texels of a row that this touches fall into one comparison between them, so four comparisons give the
// same sum.
//
// The filter reads depths up to 2 texels away along each axis of the map, 2 sqrt(2) along its diagonal; a lit plane
// tilted by `a` from the sun is nearer to it there by that times tan(a). Lifting the surface along its normal by
// 2 sqrt(2) sin(a) texels takes it just clear of its own plane at any angle. A tenth of a texel covers rounding.
float sun_share(sampler2DArrayShadow map, vec3 position, vec3 normal)
{
    float facing = dot(normal, frame.sun_direction.xyz);
    float lift = 0.1 + 2.8284 * sqrt(clamp(1.0 - facing * facing, 0.0, 1.0));
    vec3 at = (frame.shadow_from_world * vec4(position + normal * (lift * frame.shadow_texel_m), 1.0)).xyz;
    vec2 size = vec2(textureSize(map, 0).xy);
    vec2 texel = at.xy * size - 0.5, first = floor(texel), part = texel - first;
    vec2 low = (first - 0.5 + (2.0 - part) / (3.0 - 2.0 * part)) / size;
    vec2 high = (first + 1.5 + part / (1.0 + 2.0 * part)) / size;
    vec2 low_weight = 3.0 - 2.0 * part, high_weight = 1.0 + 2.0 * part;
    // what lies behind everything that casts shadows, a moving object's feet, is as far as the empty map
    float depth = min(at.z, 1.0);
    float sum = low_weight.x * low_weight.y * texture(map, vec4(low, 0.0, depth)) +
                high_weight.x * low_weight.y * texture(map, vec4(high.x, low.y, 0.0, depth)) +
                low_weight.x * high_weight.y * texture(map, vec4(low.x, high.y, 0.0, depth)) +
                high_weight.x * high_weight.y * texture(map, vec4(high, 0.0, depth));
    return sum / 16.0;
}
