// The points that won their pixels. POINTS: they were drawn and lie in images; else their keys lie in a buffer. Needs
// frame.

#ifdef POINTS
layout(binding = 7) uniform usampler2DArray source_image;
layout(binding = 8) uniform sampler2DArray depth_image;
#else
layout(scalar, binding = 3) readonly buffer Keys { uvec2 keys[]; }; // ~source, depth
#endif

// ~source of a pixel, 0 for a hole.
uint source_at(ivec3 pixel)
{
#ifdef POINTS
    return texelFetch(source_image, pixel, 0).x;
#else
    return keys[(uint(pixel.z) * frame.height + uint(pixel.y)) * frame.width + uint(pixel.x)].x;
#endif
}

float depth_at(ivec3 pixel)
{
#ifdef POINTS
    return texelFetch(depth_image, pixel, 0).x;
#else
    return uintBitsToFloat(keys[(uint(pixel.z) * frame.height + uint(pixel.y)) * frame.width + uint(pixel.x)].y);
#endif
}

ivec2 source_pixel(uint inverted)
{
    uint index = ~inverted;
    return ivec2(index % frame.width, index / frame.width);
}
