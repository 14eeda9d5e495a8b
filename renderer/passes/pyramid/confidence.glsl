// Eccentricity confidence, and what both kernels are told. Needs frame and view.glsl.

layout(push_constant) uniform Push {
    float epsilon, fovea_deg, periphery_deg, hole_decay, dynamic_decay;
    uint levels, turn;
    float trusted_cosine; // of the angle at which c_e reaches epsilon; above 1: nothing is too near
    uint listed;          // 1: holes come from a list
} push;

float eccentricity_confidence(ivec3 pixel, vec2 place)
{
    vec3 ray = view_ray(EYE(uint(pixel.z), tangents), vec2(frame.width, frame.height), place);
    float ecc = view_eccentricity_deg(EYE(uint(pixel.z), gaze), ray);
    // c_e = S_1((phi - phi_F) / (phi_0 - phi_F)), section 5.2
    return smoothstep(push.fovea_deg, max(push.periphery_deg, push.fovea_deg + 1e-3), ecc);
}
