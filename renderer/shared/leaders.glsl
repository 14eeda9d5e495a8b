// Who shades for whom, where one pixel shades for others of its block of 4x4 pixels: 4 bits a pixel, the leader's place
// in the block; places go row by row, and so do blocks, the right eye's after the left's. Two words a block.

const uvec2 leaders_alone = uvec2(0x76543210u, 0xfedcba98u); // every pixel for itself

// The first word of a block.
uint leaders_word(uvec2 block, uint eye, uvec2 image_size)
{
    uvec2 blocks = (image_size + 3u) / 4u;
    return 2u * ((eye * blocks.y + block.y) * blocks.x + block.x);
}

// The pixel that shades for one; `word` is the first of its block, or for the lower two rows the second.
ivec3 leaders_pixel(uint word, ivec3 pixel)
{
    int place = int(word >> 4 * (pixel.x & 3 | (pixel.y & 1) << 2) & 15u);
    return ivec3(pixel.x & ~3 | place & 3, pixel.y & ~3 | place >> 2, pixel.z);
}
