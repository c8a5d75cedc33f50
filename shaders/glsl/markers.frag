#version 330 core
// A marker's ball, lit by the key and fill of the studio, with a smooth rim.
#include "light.glsl"

in vec3 ball_colour;
flat in float radius_px;

out vec4 colour;

void main() {
    vec2 at = (gl_PointCoord * 2.0 - 1.0) * (radius_px + 1.0) / radius_px;
    float r = length(vec2(at.x, -at.y));
    float cover = clamp((1.0 - r) * radius_px + 0.5, 0.0, 1.0);
    if (cover <= 0.0) discard;
    vec3 n = vec3(at.x, -at.y, sqrt(max(1.0 - r * r, 0.0)));
    float light = 0.42 + 0.58 * max(dot(n, KEY_DIRECTION), 0.0) + 0.12 * max(dot(n, FILL_DIRECTION), 0.0);
    float gleam = pow(max(dot(n, normalize(KEY_DIRECTION + vec3(0.0, 0.0, 1.0))), 0.0), 40.0);
    colour = vec4(ball_colour * light + 0.35 * gleam, cover);
}
