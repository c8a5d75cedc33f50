#version 330 core
// Depth from one direction, for gpu/gl/occlusion.py. One work-item: one vertex.
//   in_position  vec3, unit sphere around the mesh     turn  rotation whose third row looks back to the eye
uniform mat3 turn;

in vec3 in_position;

void main() {
    vec3 at = turn * in_position;
    gl_Position = vec4(at.xy, -at.z, 1.0);
}
