#version 330 core
// The shaded face. One work-item: one pixel of the mesh; see face.vert for what comes in.
//   Alpha is 1 but for lashes, which are drawn last.
//   brows  two arcs, each three points (inner end, arch, outer end), mm at rest; brow_width_mm 0: none
#include "light.glsl"

in vec3 pos_view;
in vec3 normal_view;
in vec3 rest;
in vec2 lip_open;
flat in int material;

uniform vec3 brows[6];
uniform float brow_width_mm;

out vec4 colour;

const vec3 SKIN = vec3(0.520, 0.275, 0.185);
const vec3 LIP = vec3(0.400, 0.105, 0.095);
const vec3 BROW = vec3(0.050, 0.028, 0.018);
const vec3 SCLERA = vec3(0.480, 0.440, 0.405);
const vec3 IRIS = vec3(0.085, 0.120, 0.110);
const vec3 TOOTH = vec3(0.560, 0.480, 0.370);
const vec3 TONGUE = vec3(0.310, 0.085, 0.080);
const vec3 SOCKET = vec3(0.120, 0.022, 0.018);
const vec3 LASH = vec3(0.012, 0.008, 0.007);

float hash(vec2 p) {
    return fract(sin(dot(p, vec2(12.9898, 78.233))) * 43758.5453);
}

// How much of an eyebrow covers this place: a curve through three points, hair thin at both ends and at the rims.
float brow_cover() {
    float cover = 0.0;
    for (int side = 0; side < 2; side++) {
        vec2 inner = brows[3 * side].xy, arch = brows[3 * side + 1].xy, outer = brows[3 * side + 2].xy;
        float u = (rest.x - inner.x) / (outer.x - inner.x);
        float top = (arch.x - inner.x) / (outer.x - inner.x);
        float rise = arch.y - mix(inner.y, outer.y, top);
        float middle = mix(inner.y, outer.y, u) + rise * u * (1.0 - u) / (top * (1.0 - top));
        float width = 0.5 * brow_width_mm * mix(1.0, 0.40, u * u);
        float hair = 0.72 + 0.45 * hash(floor(vec2(rest.x * 2.6 + abs(rest.y) * 1.3, rest.y * 0.5)));
        float here = 1.0 - smoothstep(0.35, 1.0, abs(rest.y - middle) / width);
        cover = max(cover, here * hair * smoothstep(-0.06, 0.16, u) * (1.0 - smoothstep(0.78, 1.04, u)));
    }
    return clamp(cover, 0.0, 0.85) * step(brows[1].z - 25.0, rest.z);
}

// Enamel is whole in the mesh; the gaps between teeth are painted, every 0.2 rad along the arch.
float tooth_gaps() {
    float along = atan(rest.x, rest.z + 22.0) / 0.20;
    float gap = abs(fract(along) - 0.5);
    return 1.0 - 0.45 * smoothstep(0.40, 0.49, gap);
}

vec3 skin(vec3 n, vec3 to_eye) {
    float lip = smoothstep(0.25, 0.75, lip_open.x);
    float open = lip_open.y;
    vec3 albedo = mix(SKIN, LIP, lip * 0.72);
    float brow = abs(rest.y - brows[1].y) < 1.5 * brow_width_mm ? brow_cover() : 0.0;
    albedo = mix(albedo, BROW, brow);
    // light that leaks into shaded skin is red
    vec3 bleed = mix(vec3(0.80, 0.46, 0.38), vec3(1.0), open);
    vec3 lit = albedo * diffuse_light(n, vec3(0.42, 0.20, 0.14), open) * mix(bleed, vec3(1.0), 0.4);
    float gloss = mix(0.55, 1.0, lip) * (1.0 - 0.8 * brow) * open;
    lit += highlights(n, to_eye, mix(16.0, 42.0, lip), 0.030) * gloss;
    return lit + rim_light(n, to_eye, open) * 0.30;
}

vec3 eye(vec3 n, vec3 to_eye) {
    vec3 direction = normalize(rest);
    float angle = acos(clamp(direction.z, -1.0, 1.0));
    float around = atan(direction.y, direction.x);
    const float IRIS_RIM = 0.50, PUPIL_RIM = 0.19;
    float fibres = 0.75 + 0.35 * sin(around * 38.0 + 3.0 * sin(around * 7.0)) * sin(around * 17.0 + 1.0);
    float depth = smoothstep(PUPIL_RIM, IRIS_RIM, angle);
    vec3 iris = IRIS * fibres * mix(1.5, 0.7, depth) + vec3(0.06, 0.035, 0.012) * (1.0 - depth);
    iris *= 1.0 - 0.75 * smoothstep(IRIS_RIM - 0.07, IRIS_RIM, angle);
    iris = mix(vec3(0.004), iris, smoothstep(PUPIL_RIM - 0.025, PUPIL_RIM + 0.025, angle));
    vec3 white = mix(SCLERA, SCLERA * vec3(0.86, 0.60, 0.55), smoothstep(0.75, 1.35, angle));
    float edge = fwidth(angle) + 0.02;
    vec3 albedo = mix(iris, white, smoothstep(IRIS_RIM - edge, IRIS_RIM + edge, angle));
    // lids throw a soft shadow on the upper part of the ball
    float lid = 1.0 - 0.55 * smoothstep(0.10, 0.60, direction.y);
    vec3 lit = albedo * diffuse_light(n, vec3(0.25), 0.8) * lid;
    return lit + highlights(n, to_eye, 260.0, 0.05) * 1.3 + highlights(n, to_eye, 30.0, 0.03) * 0.2;
}

void main() {
    vec3 to_eye = normalize(-pos_view);
    vec3 n = normalize(normal_view);
    float open = lip_open.y;
    vec3 lit;
    float cover = 1.0;
    if (material == 0) {
        lit = skin(n, to_eye);
        if (!gl_FrontFacing) lit = SOCKET * 0.12;
    } else if (material == 1) {
        lit = eye(n, to_eye);
    } else if (material == 2) {
        lit = TOOTH * tooth_gaps() * diffuse_light(n, vec3(0.45, 0.40, 0.34), 0.6) * open;
        lit += highlights(n, to_eye, 60.0, 0.04) * open * open;
    } else if (material == 3) {
        lit = TONGUE * diffuse_light(n, vec3(0.35, 0.2, 0.15), 0.8) * open + highlights(n, to_eye, 40.0, 0.04) * open;
    } else if (material == 4) {
        // many fine hairs, thinner towards their tips
        float hairs = abs(sin(atan(rest.y, rest.x) * 61.0));
        cover = (1.0 - smoothstep(0.15, 1.0, rest.z)) * mix(1.0, 0.25 + 0.75 * smoothstep(0.25, 0.75, hairs), rest.z);
        lit = LASH;
    } else {
        if (dot(n, to_eye) < 0.0) n = -n;
        lit = SOCKET * diffuse_light(n, vec3(0.2), 0.5) * open;
    }
    colour = vec4(to_screen(lit), cover);
}
