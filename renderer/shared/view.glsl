// Pixels, directions and positions of an eye. Needs shared.h.

// The point of the image plane at distance 1 through a pixel position (centres at +0.5), eye space.
vec3 view_ray(const shared_eye eye, vec2 size, vec2 pixel)
{
    vec2 t = pixel / size;
    return vec3(t.x * (eye.tangents.x + eye.tangents.y) - eye.tangents.x,
                eye.tangents.w - t.y * (eye.tangents.z + eye.tangents.w), -1.0);
}

// Where an eye-space point or direction in front of the eye falls, pixels.
vec2 view_pixel(const shared_eye eye, vec2 size, vec3 p)
{
    vec2 t = p.xy / -p.z;
    return vec2(t.x + eye.tangents.x, eye.tangents.w - t.y) /
           vec2(eye.tangents.x + eye.tangents.y, eye.tangents.z + eye.tangents.w) * size;
}

// Whether an eye-space direction is less than an angle, given by its cosine, from the gaze; everywhere without a valid
// gaze. For deciding only: near 0 degrees a cosine in floats tells no angles apart, so use it from about 1 degree on.
bool view_within(const shared_eye eye, vec3 ray, float cosine)
{
    float along = dot(ray, eye.gaze.xyz);
    return eye.gaze.w == 0.0 || along > cosine * length(ray);
}

// Angle between an eye-space direction and the gaze, degrees: atan2(|a x b|, a.b). Without a valid gaze every
// direction is foveal.
float view_eccentricity_deg(const shared_eye eye, vec3 ray)
{
    if (eye.gaze.w == 0.0)
        return 0.0;
    return degrees(atan(length(cross(ray, eye.gaze.xyz)), dot(ray, eye.gaze.xyz)));
}
