#version 330 core
// Fills the depth buffer before the face is shaded, so that each pixel is shaded once.
void main() {}
