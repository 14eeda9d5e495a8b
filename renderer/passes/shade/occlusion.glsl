// Ambient occlusion of half resolution at a full-resolution pixel: of the four nearest texels, those at the pixel's own
// distance count (Kopf et al. 2007, "Joint Bilateral Upsampling").

// `distance`: along the view axis; `distances` holds the texels' own, 0 for background.
float occlusion_at(sampler2DArray occlusion, sampler2DArray distances, ivec3 pixel, float distance)
{
    vec2 at = (vec2(pixel.xy) + 0.5) * 0.5 - 0.5; // in texels, centres at whole numbers
    ivec2 corner = ivec2(floor(at)), last = textureSize(occlusion, 0).xy - 1;
    vec2 part = at - vec2(corner);
    float sum = 0.0, weights = 0.0;
    for (int i = 0; i < 4; i++) {
        ivec2 offset = ivec2(i & 1, i >> 1);
        ivec3 texel = ivec3(clamp(corner + offset, ivec2(0), last), pixel.z);
        float other = texelFetch(distances, texel, 0).x;
        if (other <= 0.0)
            continue;
        vec2 bilinear = mix(1.0 - part, part, vec2(offset));
        // 1 %: a floor seen at 5 degrees changes its distance by less between texels of 0.1 degrees
        float weight = bilinear.x * bilinear.y / (0.01 + abs(other - distance) / distance);
        sum += weight * texelFetch(occlusion, texel, 0).x;
        weights += weight;
    }
    return weights > 0.0 ? sum / weights : 1.0;
}
