// Where a kept point lands in this frame's pixels. Needs frame, motions, position_image, push and move.glsl.

struct landing {
    bool lands;
    vec2 at;     // the pixel, whole numbers
    float depth; // reversed; 0: the background
};

landing land(ivec3 source)
{
    const landing nowhere = landing(false, vec2(0.0), 0.0);
    vec4 position = imageLoad(position_image, source);
    if (position.w == 0.0) // a filled hole is never warped again
        return nowhere;
    if (push.drop_moving != 0u && position.w >= 2.0)
        return nowhere;
    mat4 world_from_eye = frame_eye(uint(source.z)).world_from_eye;
    position = move_position(position);
    bool direction = position.w < 0.0;
    vec3 away = direction ? position.xyz : position.xyz - world_from_eye[3].xyz;
    vec3 p = away * mat3(world_from_eye); // the transposed rotation
    // written so that what is not a number is out: the motion of an object once scaled to nothing is none
    if (any(isnan(p)) || any(isinf(p)) || (direction ? p.z >= 0.0 : -p.z < frame.near_m))
        return nowhere;
    vec2 size = vec2(frame.width, frame.height);
    vec2 at = floor(view_pixel(frame_eye(uint(source.z)), size, p));
    if (!all(greaterThanEqual(at, vec2(0.0))) || !all(lessThan(at, size)))
        return nowhere;
    if (push.drop_cosine <= 1.0 &&
        view_within(frame_eye(uint(source.z)), view_ray(frame_eye(uint(source.z)), size, at + 0.5), push.drop_cosine))
        return nowhere;
    // far beyond everything all surfaces are alike, and none is denormal, which devices treat differently
    return landing(true, at, direction ? 0.0 : max(frame.near_m / -p.z, 1e-35));
}
