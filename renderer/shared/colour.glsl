// Colour: Rec. 709 primaries, linear unless it says encoded.

float colour_luminance(vec3 c)
{
    return dot(c, vec3(0.2126, 0.7152, 0.0722)); // ITU-R BT.709
}

vec3 colour_encode(vec3 c) // IEC 61966-2-1
{
    return mix(1.055 * pow(c, vec3(1.0 / 2.4)) - 0.055, 12.92 * c, lessThanEqual(c, vec3(0.0031308)));
}

vec3 colour_decode(vec3 c)
{
    return mix(pow((c + 0.055) / 1.055, vec3(2.4)), c / 12.92, lessThanEqual(c, vec3(0.04045)));
}
