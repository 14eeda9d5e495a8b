// Pixels, directions and positions of an eye, from its constants of the same names (shared.h).

// The point of the image plane at distance 1 through a pixel position (centres at +0.5), eye space.
vec3 view_ray(vec4 tangents, vec2 size, vec2 pixel)
{
    vec2 t = pixel / size;
    return vec3(t.x * (tangents.x + tangents.y) - tangents.x,
                tangents.w - t.y * (tangents.z + tangents.w), -1.0);
}

// Where an eye-space point or direction in front of the eye falls, pixels.
vec2 view_pixel(vec4 tangents, vec2 size, vec3 p)
{
    vec2 t = p.xy / -p.z;
    return vec2(t.x + tangents.x, tangents.w - t.y) /
           vec2(tangents.x + tangents.y, tangents.z + tangents.w) * size;
}

// Whether an eye-space direction is less than an angle, given by its cosine, from the gaze; everywhere without a valid
// gaze. For deciding only: near 0 degrees a cosine in floats tells no angles apart, so use it from about 1 degree on.
bool view_within(vec4 gaze, vec3 ray, float cosine)
{
    float along = dot(ray, gaze.xyz);
    return gaze.w == 0.0 || along > cosine * length(ray);
}

// Angle between an eye-space direction and the gaze, degrees: atan2(|a x b|, a.b). Without a valid gaze every
// direction is foveal.
float view_eccentricity_deg(vec4 gaze, vec3 ray)
{
    if (gaze.w == 0.0)
        return 0.0;
    return degrees(atan(length(cross(ray, gaze.xyz)), dot(ray, gaze.xyz)));
}
