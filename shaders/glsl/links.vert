#version 330 core
// Faint lines between markers. One work-item: one end of a line.
#include "space.glsl"

in vec3 in_position;

void main() {
    gl_Position = projection * view * vec4(in_position, 1.0);
}
