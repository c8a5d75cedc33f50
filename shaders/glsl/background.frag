#version 330 core
// The backdrop alone, where nothing else is.
#include "backdrop.glsl"

in vec2 at;

out vec4 colour;

void main() {
    colour = vec4(backdrop(at), 1.0);
}
