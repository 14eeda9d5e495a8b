// Foveation culling (Franke et al. 2021, section 6.1): whether a box may own a pixel of the redraw map. Its rectangle
// on the screen is looked up in the or-pyramid, at the finest level where it spans at most QUERY texels a side: with 8
// instead of the paper's 2 fewer boxes are kept for what lies beside them (Sponza: 42 instead of 49 % of the triangles).

#include "renderer/shared/box.glsl"

const uint QUERY = 8u;

bool redrawn(shared_item item, uint eye)
{
    rectangle r = project(item, frame_eye(eye).clip_from_world * objects[item.object].world_from_mesh);
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
