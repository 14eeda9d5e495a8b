// How light leaves a surface: the same for deferred and forward shading. Needs shared.h and a shared_frame `frame`.

const float pi = 3.14159265;

struct surface_point {
    vec3 albedo; // diffuse
    vec3 f0;     // reflectance at normal incidence
    float roughness;
    vec3 normal;
    vec3 view; // unit, towards the eye
};

// Cook-Torrance, Karis 2013: D of GGX with alpha = roughness^2 (eq. 3), Schlick-Smith G with k = (roughness + 1)^2 / 8
// (eq. 4), Schlick's F. Radiance towards the eye for unit irradiance on a surface facing the light.
vec3 reflect_light(surface_point s, vec3 light)
{
    float nl = dot(s.normal, light);
    if (nl <= 0.0)
        return vec3(0.0);
    vec3 h = normalize(light + s.view);
    float nv = max(dot(s.normal, s.view), 1e-4), nh = max(dot(s.normal, h), 0.0), vh = max(dot(s.view, h), 0.0);
    float a2 = s.roughness * s.roughness;
    a2 *= a2;
    float d = nh * nh * (a2 - 1.0) + 1.0;
    float k = (s.roughness + 1.0) * (s.roughness + 1.0) / 8.0;
    float visibility = 0.25 / ((nv * (1.0 - k) + k) * (nl * (1.0 - k) + k)); // G / (4 nl nv)
    vec3 fresnel = s.f0 + (1.0 - s.f0) * pow(1.0 - vh, 5.0);
    vec3 specular = fresnel * (a2 / (pi * d * d) * visibility);
    return (s.albedo * (1.0 - fresnel) / pi + specular) * nl;
}

// A surface as glTF describes it: base colour, roughness, metallic.
surface_point surface_of(vec3 base, vec2 surface, vec3 normal, vec3 view)
{
    surface_point s;
    s.albedo = base * (1.0 - surface.y);
    s.f0 = mix(vec3(0.04), base, surface.y); // 0.04: dielectrics, as glTF has it
    s.roughness = max(surface.x, 0.045);     // below this the highlight of a point leaves half-float range
    s.normal = normal;
    s.view = view;
    return s;
}

vec3 sky(vec3 direction)
{
    return direction.y >= 0.0 ? mix(frame.sky_horizon.rgb, frame.sky_zenith.rgb, sqrt(direction.y))
                              : mix(frame.sky_horizon.rgb, frame.sky_ground.rgb, min(1.0, -4.0 * direction.y));
}

// Mean radiance of the sky over the hemisphere around a normal, cosine-weighted, by its up component: exact at the
// poles for a sky and a ground of one radiance each, the usual hemisphere light between.
vec3 sky_irradiance(vec3 normal)
{
    vec3 above = mix(frame.sky_horizon.rgb, frame.sky_zenith.rgb, 0.6);
    vec3 below = mix(frame.sky_horizon.rgb, frame.sky_ground.rgb, 0.85);
    return mix(below, above, 0.5 + 0.5 * normal.y);
}

// Karis, "Physically Based Shading on Mobile", 2014: the environment BRDF without a table.
vec3 environment_brdf(vec3 f0, float roughness, float nv)
{
    const vec4 c0 = vec4(-1.0, -0.0275, -0.572, 0.022), c1 = vec4(1.0, 0.0425, 1.04, -0.04);
    vec4 r = roughness * c0 + c1;
    float a = min(r.x * r.x, exp2(-9.28 * nv)) * r.x + r.y;
    vec2 scale_bias = vec2(-1.04, 1.04) * a + r.zw;
    return f0 * scale_bias.x + scale_bias.y;
}

vec3 ambient(surface_point s, float occlusion)
{
    vec3 reflected = reflect(-s.view, s.normal);
    float nv = max(dot(s.normal, s.view), 0.0);
    vec3 mirror = mix(sky(reflected), sky_irradiance(reflected), s.roughness);
    return occlusion * (s.albedo * sky_irradiance(s.normal) + mirror * environment_brdf(s.f0, s.roughness, nv));
}

vec3 sun_light(surface_point s)
{
    return frame.sun_direction.w == 0.0 ? vec3(0.0) : frame.sun_illuminance.rgb * reflect_light(s, frame.sun_direction.xyz);
}

// KHR_lights_punctual: inverse square, windowed to zero at the range; spots fall off between two cosines.
vec3 point_light(surface_point s, vec3 position, shared_light light)
{
    vec3 to = light.position - position;
    float d2 = dot(to, to), ratio = d2 / (light.range_m * light.range_m);
    float window = clamp(1.0 - ratio * ratio, 0.0, 1.0);
    if (window == 0.0)
        return vec3(0.0);
    vec3 direction = to * inversesqrt(max(d2, 1e-8));
    float cone = 1.0;
    if (light.cos_outer >= -1.0) {
        cone = clamp((dot(light.direction, -direction) - light.cos_outer) / max(light.cos_inner - light.cos_outer, 1e-4),
                     0.0, 1.0);
        cone *= cone;
    }
    // 1 cm is as near as a light comes, so that none is infinitely bright
    return light.intensity * (cone * window / max(d2, 1e-4)) * reflect_light(s, direction);
}
