// Marks over a picture, with edges as smooth as a pixel. Needs marks.

// How much of a pixel lies within an edge that is `distance_px` outside of its middle.
float mark_cover(float distance_px)
{
    return clamp(0.5 - distance_px, 0.0, 1.0);
}

// Lays a linear colour over an encoded picture, mixed with gray as the picture was.
vec3 mark_mix(vec3 encoded, vec3 colour, float share, float fade)
{
    vec3 faded = mix(colour, colour_decode(vec3(0.5)), fade);
    return colour_encode(mix(colour_decode(encoded), faded, share));
}

// A ball lit from the upper left in front, with a highlight and a dark rim, so that it stands out on any ground.
// u: place on the unit disc; px: the disc's radius there.
vec3 mark_ball(vec3 encoded, vec3 colour, vec2 u, float px, float opacity, float fade)
{
    float r = length(u);
    vec3 normal = vec3(u, sqrt(max(1.0 - r * r, 0.0)));
    const vec3 light = normalize(vec3(-0.5, 0.7, 0.65)), halfway = normalize(light + vec3(0.0, 0.0, 1.0));
    float diffuse = max(dot(normal, light), 0.0);
    float highlight = pow(max(dot(normal, halfway), 0.0), 40.0);
    vec3 lit = min(colour_decode(colour) * (0.22 + 1.1 * diffuse) + 0.6 * highlight, 1.0);
    float rim = max(0.5, 0.1 * px); // pixels; of a small ball little, so that its colour stays
    vec3 shaded = mix(lit, vec3(0.005), mark_cover((1.0 - r) * px - rim));
    return mark_mix(encoded, shaded, opacity * mark_cover((r - 1.0) * px), fade);
}

// Two thin bars with dark edges. d: pixels from the middle; arm: pixels from there to the bars' ends.
vec3 mark_cross(vec3 encoded, vec3 colour, vec2 d, float arm, float opacity, float fade)
{
    float half_width = max(0.75, 0.08 * arm), edge = max(1.3, 0.1 * arm);
    vec2 a = abs(d);
    float inside = min(max(a.x - arm, a.y - half_width), max(a.y - arm, a.x - half_width));
    encoded = mark_mix(encoded, vec3(0.002), opacity * mark_cover(inside - edge), fade);
    return mark_mix(encoded, colour_decode(colour), opacity * mark_cover(inside), fade);
}

vec3 mark_over(vec3 encoded, uint index, int eye, vec2 place)
{
    shared_mark_eye at = marks[index].eyes[eye];
    if (at.opacity <= 0.0)
        return encoded;
    vec2 d = place - at.centre;
    vec2 u = d.x * at.unit_from_x + d.y * at.unit_from_y;
    // the step of |u| over a pixel in the direction of u, whose inverse is the disc's radius in pixels
    vec2 along = dot(u, u) > 1e-12 ? normalize(u) : vec2(1.0, 0.0);
    float px = 1.0 / length(vec2(dot(along, at.unit_from_x), dot(along, at.unit_from_y)));
    if (length(u) > 1.0 + 4.0 / px + 0.2)
        return encoded;
    float fade = marks[index].fade;
    if (marks[index].kind == SHARED_MARK_BALL)
        return mark_ball(encoded, marks[index].colour, u, px, at.opacity, fade);
    return mark_cross(encoded, marks[index].colour, u * px, px, at.opacity, fade);
}
