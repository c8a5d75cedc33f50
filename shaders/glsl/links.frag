#version 330 core
// Faint lines between markers, one colour.
out vec4 colour;

void main() {
    colour = vec4(0.55, 0.62, 0.70, 0.30);
}
