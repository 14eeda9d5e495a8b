// The half-resolution pixel of a work item; with a list, of the tile that the work group takes. False: none.
#ifdef REDRAW
layout(scalar, binding = 4) readonly buffer Tiles { uint words[]; } tiles;
#endif

bool half_pixel(ivec2 size, out ivec3 pixel)
{
    pixel = ivec3(gl_GlobalInvocationID);
#ifdef REDRAW
    uint index = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
    if (index >= tiles.words[SHARED_TILES_FIRST - 1])
        return false;
    pixel = tile_pixel(tiles.words[SHARED_TILES_FIRST + index], gl_LocalInvocationID.xy);
#endif
    return all(lessThan(pixel.xy, size));
}
