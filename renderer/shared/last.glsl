// Where a point of this frame was in the last one. Needs frame, `motions` (mat4 by moving id: world now from world
// before, then as many the other way round) and push.motion_count.

// `position` as in passes/reproject: w < 0 a direction, w >= 2 a moving object. xy: pixels of the unjittered grid; z: the
// distance in front of the eye then, 0 for a direction. Behind the eye: far off the image.
vec3 last_pixel(uint eye, vec4 position)
{
    vec3 p = position.xyz;
    if (position.w >= 2.0 && frame.moving != 0u)
        p = (motions[push.motion_count + uint(position.w) - 1u] * vec4(p, 1.0)).xyz;
    vec4 clip = frame_eye(eye).last_clip_from_world * vec4(p, position.w < 0.0 ? 0.0 : 1.0);
    if (!(clip.w > 1e-6)) // also where an object's motion is no number
        return vec3(-1e6, -1e6, 0.0);
    return vec3((clip.xy / clip.w * 0.5 + 0.5) * vec2(frame.width, frame.height), position.w < 0.0 ? 0.0 : clip.w);
}
