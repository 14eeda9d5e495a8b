// The list of tiles of SHARED_TILE x SHARED_TILE pixels that hold redrawn ones, for indirect dispatches of one work
// group a tile. Words: a VkDispatchIndirectCommand (3), the count, then one code a tile.

uint tile_code(uvec2 tile, uint eye)
{
    return tile.x | tile.y << 15 | eye << 30;
}

// The pixel of a work item in a coded tile; z is the eye.
ivec3 tile_pixel(uint code, uvec2 lane)
{
    return ivec3(SHARED_TILE * ivec2(code & 0x7fffu, code >> 15 & 0x7fffu) + ivec2(lane), code >> 30);
}
