// The rectangle that an item's box covers on the screen. Needs frame.

struct rectangle {
    vec2 low, high; // normalised device coordinates
};

void enclose(inout rectangle r, vec4 clip)
{
    vec2 at = clip.xy / clip.w;
    r.low = min(r.low, at);
    r.high = max(r.high, at);
}

// Where the box's edges meet the near plane.
void cut_off(inout rectangle r, vec4 corners[8], float near)
{
    for (int i = 0; i < 8; i++) {
        for (int axis = 1; axis < 8; axis <<= 1) {
            vec4 a = corners[i], b = corners[i | axis];
            if ((i & axis) == 0 && (a.w < near) != (b.w < near))
                enclose(r, mix(a, b, (near - a.w) / (b.w - a.w)));
        }
    }
}

// The box's rectangle; the part before the near plane is cut off edge by edge. Empty (low > high): all of it is.
rectangle project(shared_item item, mat4 clip_from_mesh)
{
    vec4 corners[8];
    rectangle r = rectangle(vec2(1e30), vec2(-1e30));
    // clip w is the distance in front of the eye; the hair keeps the part that the rasteriser rounds over the plane
    float near = 0.999 * frame.near_m;
    float nearest = 1e30;
    for (int i = 0; i < 8; i++) {
        bvec3 high = bvec3(i & 1, i & 2, i & 4);
        corners[i] = clip_from_mesh * vec4(mix(item.box_min, item.box_max, high), 1.0);
        nearest = min(nearest, corners[i].w);
        if (corners[i].w >= near)
            enclose(r, corners[i]);
    }
    // a loop of one turn: the software driver leaves out a loop that no lane enters, but no branch
    for (bool cut = nearest < near; cut; cut = false)
        cut_off(r, corners, near);
    return r;
}
