#version 460
#extension GL_EXT_scalar_block_layout : require

// Every texel of a half-float image (SINGLE: of one of single floats, one a texel) to a buffer that the CPU reads, layer
// by layer and row by row.

layout(local_size_x = 8, local_size_y = 8) in;

#ifdef SINGLE
layout(binding = 0, r32f) uniform readonly image2DArray image;
#else
layout(binding = 0, rgba16f) uniform readonly image2DArray image;
#endif
layout(scalar, binding = 1) writeonly buffer To { vec4 to[]; };

void main()
{
    uvec3 pixel = gl_GlobalInvocationID;
    uvec2 size = uvec2(imageSize(image).xy);
    if (pixel.x < size.x && pixel.y < size.y)
        to[(pixel.z * size.y + pixel.y) * size.x + pixel.x] = imageLoad(image, ivec3(pixel));
}
