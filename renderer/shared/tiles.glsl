// Lists of tiles of SHARED_TILE x SHARED_TILE pixels for indirect dispatches of one work group a tile. Words: a
// VkDispatchIndirectCommand (3), the count, then one code a tile. Emptied to {0, 1, 1, 0}.

uint tile_code(uvec2 tile, uint eye)
{
    return tile.x | tile.y << 15 | eye << 30;
}

// The coded tile; z is the eye.
ivec3 tile_of(uint code)
{
    return ivec3(code & 0x7fffu, code >> 15 & 0x7fffu, code >> 30);
}

// The pixel of a work item in a coded tile.
ivec3 tile_pixel(uint code, uvec2 lane)
{
    return tile_of(code) * ivec3(SHARED_TILE, SHARED_TILE, 1) + ivec3(lane, 0);
}

// Adds a tile to a list. More than 65535 groups, the least that every device allows in one dimension, make rows; the
// last may have more groups than there are tiles.
#define TILE_APPEND(list, code)                                                                                        \
    {                                                                                                                  \
        uint slot = atomicAdd(list[3], 1u);                                                                            \
        list[SHARED_TILES_FIRST + slot] = code;                                                                        \
        atomicMax(list[0], min(slot + 1u, 65535u));                                                                    \
        atomicMax(list[1], slot / 65535u + 1u);                                                                        \
    }

// Adds a pixel to a list of which a work group takes 64.
#define PIXEL_APPEND(list, pixel)                                                                                      \
    {                                                                                                                  \
        uint slot = atomicAdd(list[3], 1u);                                                                            \
        list[SHARED_TILES_FIRST + slot] = tile_code(uvec2(pixel.xy), uint(pixel.z));                                   \
        if ((slot & 63u) == 0u) {                                                                                      \
            atomicMax(list[0], min(slot / 64u + 1u, 65535u));                                                          \
            atomicMax(list[1], slot / 64u / 65535u + 1u);                                                              \
        }                                                                                                              \
    }

// The place in a list of a work group's tile; none where it is not less than the count, word 3.
#define TILE_INDEX (gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x)
