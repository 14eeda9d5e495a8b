layout(constant_id = 0) const bool has_motion = true; // objects of the scene move

// A kept position brought to this frame: the origin's shift, then the motion of its object.
vec4 move_position(vec4 position)
{
    if (position.w < 0.0)
        return position; // a direction
    vec3 p = position.xyz + frame.origin_shift.xyz;
    if (has_motion && position.w >= 2.0)
        p = (motions[uint(position.w) - 1u] * vec4(p, 1.0)).xyz;
    return vec4(p, position.w);
}
