#version 330 core
// Markers as balls. One work-item: one marker, drawn as a point that just covers the ball.
//   in_position  vec3, mm, world space     in_colour  vec3, 0..1, as on screen
#include "space.glsl"

in vec3 in_position;
in vec3 in_colour;

uniform float radius_mm;
uniform vec2 viewport_px;

out vec3 ball_colour;
flat out float radius_px;

void main() {
    vec4 at = view * vec4(in_position, 1.0);
    at.z += radius_mm;  // the ball's near side, so that a marker on skin is not half buried
    gl_Position = projection * at;
    radius_px = max(projection[1][1] * radius_mm * 0.5 * viewport_px.y / gl_Position.w, 1.5);
    gl_PointSize = 2.0 * radius_px + 2.0;
    ball_colour = in_colour;
}
