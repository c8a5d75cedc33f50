// The studio: one warm key, one cool fill, one rim light, fixed to the camera, so that every orbit is well lit.
// Directions point from the surface to the light, view space; colours are linear.

const vec3 KEY_DIRECTION = vec3(-0.532, 0.552, 0.642);
const vec3 KEY_COLOUR = vec3(2.30, 2.08, 1.84);
const vec3 FILL_DIRECTION = vec3(0.822, 0.084, 0.563);
const vec3 FILL_COLOUR = vec3(0.40, 0.47, 0.60);
const vec3 RIM_DIRECTION = vec3(0.576, 0.452, -0.681);
const vec3 RIM_COLOUR = vec3(2.60, 2.90, 3.40);
const vec3 SKY_COLOUR = vec3(0.25, 0.26, 0.29);
const vec3 GROUND_COLOUR = vec3(0.12, 0.085, 0.07);

// Diffuse light on a surface of normal n; wrap > 0 lets a channel bleed past the terminator, as light does in skin.
vec3 diffuse_light(vec3 n, vec3 wrap, float occlusion) {
    vec3 share = 1.0 / ((1.0 + wrap) * (1.0 + wrap));
    vec3 key = max((dot(n, KEY_DIRECTION) + wrap) * share, 0.0);
    vec3 fill = max((dot(n, FILL_DIRECTION) + wrap) * share, 0.0);
    vec3 ambient = mix(GROUND_COLOUR, SKY_COLOUR, 0.5 + 0.5 * n.y);
    return KEY_COLOUR * key * (0.45 + 0.55 * occlusion) + (FILL_COLOUR * fill + ambient) * occlusion;
}

// One light's highlight: a Gaussian lobe as wide as Blinn and Phong's, normalised, with Schlick's Fresnel term.
float highlight(vec3 n, vec3 to_eye, vec3 to_light, float shininess, float f0) {
    vec3 halfway = normalize(to_light + to_eye);
    float grazing = 1.0 - max(dot(to_eye, halfway), 0.0);
    float squared = grazing * grazing;
    float fresnel = f0 + (1.0 - f0) * squared * squared * grazing;
    float lobe = (shininess + 8.0) / 25.0 * exp2(1.4427 * shininess * (dot(n, halfway) - 1.0));
    return fresnel * lobe * max(dot(n, to_light), 0.0);
}

vec3 highlights(vec3 n, vec3 to_eye, float shininess, float f0) {
    return KEY_COLOUR * highlight(n, to_eye, KEY_DIRECTION, shininess, f0)
         + FILL_COLOUR * highlight(n, to_eye, FILL_DIRECTION, shininess, f0);
}

vec3 rim_light(vec3 n, vec3 to_eye, float occlusion) {
    float edge = 1.0 - max(dot(n, to_eye), 0.0);
    edge *= edge * edge;
    return RIM_COLOUR * edge * max(dot(n, RIM_DIRECTION) + 0.2, 0.0) * occlusion * occlusion;
}

// Linear light to what a screen shows: a filmic curve (Narkowicz's fit of ACES), then sRGB's gamma, its power
// made of square roots (right to 0.004), which processors do fast.
vec3 to_screen(vec3 linear) {
    vec3 x = max(linear, vec3(0.0)) * 0.60;
    vec3 film = clamp(x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14), 0.0, 1.0);
    vec3 root = sqrt(film), root4 = sqrt(root), root8 = sqrt(root4);
    return clamp(0.585122381 * root + 0.783140355 * root4 - 0.368262736 * root8, 0.0, 1.0);
}
