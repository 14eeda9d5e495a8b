// The reversed depth of a kept pixel, 0 for the background. A filled hole's position is (depth, 0, 0, 0), see
// passes/pyramid; the others' are those of passes/reproject.
float kept_depth(vec4 forward, vec4 position, float near_m)
{
    if (position.w == 0.0)
        return position.x;
    return position.w < 0.0 ? 0.0 : near_m / max(dot(forward.xyz, position.xyz) + forward.w, near_m);
}
