// The studio: one warm key, one cool fill, one rim light, fixed to the camera, so that every orbit is well lit.
// Directions point from the surface to the light, view space; colours are linear.

const vec3 KEY_DIRECTION = vec3(-0.459, 0.510, 0.728);
const vec3 KEY_COLOUR = vec3(2.30, 2.12, 1.92);
const vec3 FILL_DIRECTION = vec3(0.802, 0.134, 0.582);
const vec3 FILL_COLOUR = vec3(0.52, 0.60, 0.74);
const vec3 RIM_DIRECTION = vec3(0.576, 0.452, -0.681);
const vec3 RIM_COLOUR = vec3(1.55, 1.70, 2.00);
const vec3 SKY_COLOUR = vec3(0.26, 0.28, 0.32);
const vec3 GROUND_COLOUR = vec3(0.11, 0.08, 0.07);

// Diffuse light on a surface of normal n; wrap > 0 lets a channel bleed past the terminator, as light does in skin.
vec3 diffuse_light(vec3 n, vec3 wrap, float occlusion) {
    vec3 key = clamp((dot(n, KEY_DIRECTION) + wrap) / ((1.0 + wrap) * (1.0 + wrap)), 0.0, 1.0);
    vec3 fill = clamp((dot(n, FILL_DIRECTION) + wrap) / ((1.0 + wrap) * (1.0 + wrap)), 0.0, 1.0);
    vec3 ambient = mix(GROUND_COLOUR, SKY_COLOUR, 0.5 + 0.5 * n.y);
    return KEY_COLOUR * key * mix(0.55, 1.0, occlusion) + FILL_COLOUR * fill * occlusion + ambient * occlusion;
}

// One light's highlight: Blinn-Phong, normalised, with Schlick's Fresnel term.
float highlight(vec3 n, vec3 to_eye, vec3 to_light, float shininess, float f0) {
    vec3 halfway = normalize(to_light + to_eye);
    float fresnel = f0 + (1.0 - f0) * pow(1.0 - max(dot(to_eye, halfway), 0.0), 5.0);
    float lobe = (shininess + 8.0) / 25.0 * pow(max(dot(n, halfway), 0.0), shininess);
    return fresnel * lobe * max(dot(n, to_light), 0.0);
}

vec3 highlights(vec3 n, vec3 to_eye, float shininess, float f0) {
    return KEY_COLOUR * highlight(n, to_eye, KEY_DIRECTION, shininess, f0)
         + FILL_COLOUR * highlight(n, to_eye, FILL_DIRECTION, shininess, f0);
}

vec3 rim_light(vec3 n, vec3 to_eye, float occlusion) {
    float edge = pow(1.0 - max(dot(n, to_eye), 0.0), 3.0);
    return RIM_COLOUR * edge * max(dot(n, RIM_DIRECTION) + 0.25, 0.0) * occlusion;
}

// Linear light to what a screen shows: a soft shoulder, then sRGB's gamma.
vec3 to_screen(vec3 linear) {
    vec3 shoulder = linear * (1.0 + linear * 0.16) / (1.0 + linear * 0.62);
    return pow(max(shoulder, vec3(0.0)), vec3(1.0 / 2.2));
}
