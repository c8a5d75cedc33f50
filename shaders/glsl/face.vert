#version 330 core
// A face's vertices to clip space. One work-item: one vertex.
//   in_position  vec3, mm, world space, this frame     in_normal  vec3, any length, world space, this frame
//   in_rest      vec3, mm, world space at rest; of eyeballs the direction from the eyeball's centre, unit
//   in_surface   vec3: material number (gpu/gl/face.py), lip 0..1, openness to light at rest 0..1
#include "space.glsl"

in vec3 in_position;
in vec3 in_normal;
in vec3 in_rest;
in vec3 in_surface;

out vec3 pos_view;
out vec3 normal_view;
out vec3 rest;
out vec2 lip_open;
flat out int material;

void main() {
    vec4 at = view * vec4(in_position, 1.0);
    pos_view = at.xyz;
    normal_view = mat3(view) * in_normal;
    normal_view /= max(length(normal_view), 1e-12);
    rest = in_rest;
    material = int(in_surface.x + 0.5);
    lip_open = in_surface.yz;
    gl_Position = projection * at;
}
