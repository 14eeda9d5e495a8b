// One draw of the map (shadow.c). From double: the map may span kilometres.
layout(push_constant) uniform Push {
    mat4 clip_from_mesh;
    uint material;
    uint sky_in_alpha;
} push;
