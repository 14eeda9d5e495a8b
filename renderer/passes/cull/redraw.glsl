// Foveation culling (Franke et al. 2021, section 6.1): whether a box may own a pixel of the redraw map. Its rectangle
// on the screen is looked up in the or-pyramid, at the finest level where it spans at most QUERY texels a side: with 4
// instead of the paper's 2 fewer boxes are kept for what lies beside them.

const uint QUERY = 4u;

struct rectangle {
    vec2 low, high; // normalised device coordinates
};

void enclose(inout rectangle r, vec4 clip)
{
    vec2 at = clip.xy / clip.w;
    r.low = min(r.low, at);
    r.high = max(r.high, at);
}

// The box's rectangle; the part before the near plane is cut off edge by edge. Empty (low > high): all of it is.
rectangle project(shared_item item, uint eye)
{
    mat4 clip_from_mesh = frame.eyes[eye].clip_from_world * objects[item.object].world_from_mesh;
    vec4 corners[8];
    rectangle r = rectangle(vec2(1e30), vec2(-1e30));
    // clip w is the distance in front of the eye; the hair keeps the part that the rasteriser rounds over the plane
    float near = 0.999 * frame.near_m;
    for (int i = 0; i < 8; i++) {
        bvec3 high = bvec3(i & 1, i & 2, i & 4);
        corners[i] = clip_from_mesh * vec4(mix(item.box_min, item.box_max, high), 1.0);
        if (corners[i].w >= near)
            enclose(r, corners[i]);
    }
    for (int i = 0; i < 8; i++) {
        for (int axis = 1; axis < 8; axis <<= 1) {
            vec4 a = corners[i], b = corners[i | axis];
            if ((i & axis) == 0 && (a.w < near) != (b.w < near))
                enclose(r, mix(a, b, (near - a.w) / (b.w - a.w)));
        }
    }
    return r;
}

bool redrawn(shared_item item, uint eye)
{
    rectangle r = project(item, eye);
    vec2 size = vec2(frame.width, frame.height);
    // two pixels more: half of one for the jitter of the projection, the rest for the rounding of floats
    vec2 low = (r.low * 0.5 + 0.5) * size - 2.0, high = (r.high * 0.5 + 0.5) * size + 2.0;
    if (!all(lessThan(low, size)) || !all(greaterThan(high, vec2(0.0))))
        return false;
    uvec2 first = uvec2(clamp(low, vec2(0.0), size - 1.0)) / SHARED_TILE;
    uvec2 last = uvec2(clamp(high, vec2(0.0), size - 1.0)) / SHARED_TILE;
    uint base = 0u, level = 0u;
    uvec2 tiles = uvec2(push.tiles_x, push.tiles_y);
    while (level + 1u < push.levels && any(greaterThanEqual(last - first, uvec2(QUERY)))) {
        base += 2u * tiles.x * tiles.y;
        tiles = max(tiles / 2u, uvec2(1u));
        first /= 2u;
        last /= 2u;
        level++;
    }
    for (uint y = first.y; y <= last.y; y++)
        for (uint x = first.x; x <= last.x; x++)
            if (pyramid[base + (eye * tiles.y + y) * tiles.x + x] != 0u)
                return true;
    return false;
}
