// The reversed depth of a kept pixel, 0 for the background. A filled hole's position is (depth, 0, 0, 0), see
// passes/pyramid; the others' are those of passes/reproject.
float kept_depth(const shared_eye eye, vec4 position, float near_m)
{
    if (position.w == 0.0)
        return position.x;
    return position.w < 0.0 ? 0.0 : near_m / max(dot(eye.forward.xyz, position.xyz) + eye.forward.w, near_m);
}
