#version 330 core
// The shaded face. One work-item: one pixel of the mesh; see face.vert for what comes in.
//   Alpha is 1 but for lashes, which are drawn last.
//   Compiled once for each of these, because a processor that draws runs both sides of every branch:
//   PART     0 skin, 1 eyes, 2 upper teeth, 6 lower teeth, 3 tongue, 5 mouth socket, 4 lashes
//   TEXTURE  of skin; 0: one colour; 1: procedural; 2: `picture`, sRGB
//   BROW, HAIR, FADE  1 where skin has brows, has hair, or ends
//   arch  of the teeth: z of its middle, half its width, its depth; edges: y of the incisors' edges; mm at rest
#include "light.glsl"
#include "backdrop.glsl"
#include "hairs.glsl"

in vec3 pos_view;
in vec3 normal_view;
in vec3 rest;
in vec3 surface;
in vec3 hair;
in vec2 uv;

uniform sampler2D picture;
uniform mat4 view;
uniform vec2 viewport_px;
uniform vec3 skin_colour;
uniform vec3 lip_colour;
uniform vec3 brow_colour;
uniform vec3 hair_colour;
uniform vec3 iris_colour;
uniform vec4 marks;         // lip tint, blush, freckles, stubble
uniform vec2 age_and_lash;  // age, weight of the lashes
uniform vec3 arch;
uniform vec2 edges;

out vec4 colour;

const vec3 SCLERA = vec3(0.500, 0.455, 0.420);
const vec3 TOOTH = vec3(0.545, 0.475, 0.375);
const vec3 GUM = vec3(0.330, 0.090, 0.080);
const vec3 TONGUE = vec3(0.420, 0.130, 0.115);
const vec3 SOCKET = vec3(0.170, 0.036, 0.030);
const vec3 LASH = vec3(0.012, 0.008, 0.007);

#if PART == 0
vec3 skin(vec3 n, vec3 to_eye) {
    float lip = smoothstep(0.20, 0.75, surface.x), open = surface.y, blush = surface.z, age = age_and_lash.x;
    vec3 albedo = skin_colour;
    float gloss = 0.55;
#if TEXTURE == 2
    vec3 painted = texture(picture, uv).rgb;
    albedo = painted * painted * (0.2 + 0.8 * painted);
    lip = 0.0;
#else
    albedo = mix(albedo, albedo * vec3(1.10, 0.74, 0.72), marks.y * 0.55 * blush);
#if TEXTURE == 1
    vec4 broad = texture(grain, rest * 0.0042), fine = texture(grain, rest * 0.047);
    albedo *= 1.0 + (0.10 + 0.06 * age) * (broad.r - 0.5) + 0.11 * (fine.g - 0.5);
    albedo *= mix(vec3(1.0), vec3(1.05, 0.90, 0.88), (0.5 + 0.3 * age) * smoothstep(0.45, 0.75, broad.g));
    float spot = smoothstep(0.66, 0.78, fine.b) * blush;
    albedo *= 1.0 - vec3(0.20, 0.34, 0.40) * spot * marks.z;
    float blotch = smoothstep(0.64, 0.74, broad.b) * age;
    albedo *= 1.0 - vec3(0.06, 0.10, 0.12) * blotch;
    // pores and creases: three noises make one small tilt
    n = normalize(n + (0.09 + 0.08 * age) * (1.0 - lip) * (fine.rga - 0.5));
    gloss *= 0.75 + 0.5 * fine.r;
    float shadow = marks.w * hair.y * (0.45 + 0.55 * smoothstep(0.35, 0.65, fine.a));
    albedo = mix(albedo, albedo * 0.45 + hair_colour * 0.25, 0.55 * shadow);
#endif
    albedo = mix(albedo, lip_colour, lip * marks.x);
#if BROW == 1
    float brow = rest.z > brows[1].z - 25.0 ? brow_cover(rest) : 0.0;
    albedo = mix(albedo, brow_colour, brow);
    gloss *= 1.0 - 0.8 * brow;
#endif
#endif
    gloss = mix(gloss, 1.0, lip) * open;
    vec3 bleed = mix(vec3(0.86, 0.60, 0.54), vec3(1.0), open);  // light that leaks into shaded skin is red
    vec3 lit = albedo * bleed * diffuse_light(n, vec3(0.42, 0.20, 0.14), open);
    lit += highlights(n, to_eye, mix(15.0, 48.0, lip), 0.030) * gloss;
#if HAIR == 1 && TEXTURE != 2
    float strand = strands(rest);
    float cover = smoothstep(-3.5, 4.5, hair.x + 10.0 * (strand - 0.80));
    vec3 back = view[2].xyz;
    vec3 along = normalize(back - n * dot(n, back));
    float across = dot(along, normalize(KEY_DIRECTION + to_eye)), other = dot(along, normalize(FILL_DIRECTION + to_eye));
    float sheen = exp2(-26.0 * across * across) + 0.35 * exp2(-26.0 * other * other);
    vec3 hairs = hair_colour * strand * strand * diffuse_light(n, vec3(0.3), 0.25 + 0.75 * open);
    hairs += (0.35 * hair_colour + 0.022) * KEY_COLOUR * sheen * strand * open * max(n.z, 0.0);
    lit = mix(lit, hairs, cover);
#endif
    return lit + rim_light(n, to_eye, open) * 0.30;
}
#endif

#if PART == 1
vec3 eye(vec3 n, vec3 to_eye) {
    vec3 direction = normalize(rest);
    float angle = acos(clamp(direction.z, -1.0, 1.0));
    const float IRIS_RIM = 0.47, PUPIL_RIM = 0.18;
    float around = atan(direction.y, direction.x);
    float fibres = 0.78 + 0.34 * sin(around * 38.0 + 3.0 * sin(around * 7.0)) * sin(around * 17.0 + 1.0);
    float depth = smoothstep(PUPIL_RIM, IRIS_RIM, angle);
    vec3 iris = iris_colour * fibres * mix(1.7, 0.85, depth) + vec3(0.05, 0.03, 0.01) * (1.0 - depth);
    // light that enters on one side of the cornea brightens the far side of the iris
    iris *= 1.0 + 1.1 * smoothstep(0.05, IRIS_RIM, angle) * max(dot(direction.xy, -KEY_DIRECTION.xy), 0.0) * 2.2;
    iris *= 1.0 - 0.80 * smoothstep(IRIS_RIM - 0.09, IRIS_RIM, angle);
    iris = mix(vec3(0.004), iris, smoothstep(PUPIL_RIM - 0.025, PUPIL_RIM + 0.025, angle));
    vec3 white = mix(SCLERA, SCLERA * vec3(0.88, 0.62, 0.56), smoothstep(0.75, 1.35, angle) * (1.0 + 0.4 * age_and_lash.x));
    float edge = fwidth(angle) + 0.025;
    vec3 albedo = mix(iris, white, smoothstep(IRIS_RIM - edge, IRIS_RIM + edge, angle));
    // lids throw a soft shadow on the upper part of the ball, wherever it looks
    float up = dot(n, vec3(0.0, 1.0, 0.0));
    vec3 lit = albedo * diffuse_light(n, vec3(0.30), 0.85) * (1.0 - 0.60 * smoothstep(0.05, 0.55, up));
    lit += highlights(n, to_eye, 420.0, 0.05) * 1.1 + highlights(n, to_eye, 40.0, 0.03) * 0.12;
    return lit;
}
#endif

#if PART == 2 || PART == 6
// Teeth are one band in the mesh; crowns, gaps and gums are painted on an even arch.
vec3 tooth(vec3 to_eye) {
    float turn = atan(rest.x / arch.y, (rest.z - arch.x) / arch.z);
    vec3 n = normalize(mat3(view) * vec3(sin(turn) / arch.y, 0.0, cos(turn) / arch.z));
    const bool upper = PART == 2;
    // incisors are wide, the teeth beside them narrower
    float along = turn / (upper ? 0.30 : 0.22) + (upper ? 0.0 : 0.5);
    float within = abs(fract(along) - 0.5) * 2.0;
    float above = upper ? rest.y - edges.x : edges.y - rest.y;
    float gap = smoothstep(0.86, 1.0, within);
    vec3 bulge = mat3(view) * vec3(cos(turn), 0.0, -sin(turn)) * (fract(along) - 0.5);
    n = normalize(n + 0.55 * bulge);
    float gum = smoothstep(8.6, 9.6, above + 2.0 * within * within);
    vec3 albedo = mix(TOOTH * (1.0 - 0.50 * gap) * mix(1.06, 0.94, smoothstep(0.0, 8.0, above)), GUM, gum);
    albedo *= mix(vec3(1.0), vec3(0.92, 0.86, 0.74), age_and_lash.x);
    float open = surface.y;
    vec3 lit = albedo * diffuse_light(n, vec3(0.45, 0.40, 0.34), 0.65) * open;
    return lit + highlights(n, to_eye, 60.0, 0.04) * open * open * 0.7;
}
#endif

void main() {
    vec3 to_eye = normalize(-pos_view);
    vec3 n = normalize(normal_view);
    float open = surface.y;
    vec3 lit;
    float cover = 1.0;
#if PART == 0
    lit = gl_FrontFacing ? skin(n, to_eye) : SOCKET * 0.12;
#elif PART == 1
    lit = eye(n, to_eye);
#elif PART == 2 || PART == 6
    lit = tooth(to_eye);
#elif PART == 3
    float groove = 1.0 - 0.35 * exp(-rest.x * rest.x * 0.35);
    lit = TONGUE * groove * diffuse_light(n, vec3(0.9, 0.7, 0.65), 1.0) * (0.22 + 0.78 * open);
    lit += highlights(n, to_eye, 30.0, 0.035) * open * 0.7;
#elif PART == 4
    // rest: 0..1 from the inner to the outer corner, root to tip, and strength; single hairs that lean outwards
    vec4 odd = texture(grain, vec3(rest.x * 1.3, rest.y * 0.06, 0.5));
    float along = rest.x * 30.0 + rest.y * ((rest.x - 0.35) * 3.0 + 1.6 * (odd.r - 0.5));
    float hairs = 1.0 - abs(fract(along) * 2.0 - 1.0);
    float thin = mix(0.35, 0.95, rest.y);
    float line = smoothstep(thin - 0.25, thin + 0.30, hairs) * (0.55 + 0.9 * odd.g);
    float ends = smoothstep(0.05, 0.30, rest.x) * (1.0 - smoothstep(0.68, 0.84, rest.x));
    cover = clamp(line * ends * (1.0 - smoothstep(0.45, 1.0, rest.y)) * rest.z * age_and_lash.y, 0.0, 1.0);
    lit = LASH;
#else
    if (dot(n, to_eye) < 0.0) n = -n;
    lit = SOCKET * diffuse_light(n, vec3(0.2), 0.5) * open;
#endif
    vec3 shown = to_screen(lit);
#if FADE == 1
    shown = mix(shown, backdrop(gl_FragCoord.xy / viewport_px * 2.0 - 1.0), smoothstep(0.0, 0.92, hair.z));
#endif
    colour = vec4(shown, cover);
}
