#version 330 core
// A face's vertices to clip space. One work-item: one vertex.
//   in_position  vec3, mm, world space, this frame     in_normal  vec3, any length, world space, this frame
//   in_rest      vec3, what it keeps of its resting place; see gpu/gl/complexion.py
//   in_surface   vec4: material number (gpu/gl/complexion.py), lip 0..1, openness to light at rest 0..1, blush 0..1
//   in_hair      vec3: depth under the hairline, mm; beard 0..1; faded away 0..1
//   in_uv        vec2: texture coordinates, v up
#include "space.glsl"

in vec3 in_position;
in vec3 in_normal;
in vec3 in_rest;
in vec4 in_surface;
in vec3 in_hair;
in vec2 in_uv;

out vec3 pos_view;
out vec3 normal_view;
out vec3 rest;
out vec3 surface;
out vec3 hair;
out vec2 uv;
flat out int material;

void main() {
    vec4 at = view * vec4(in_position, 1.0);
    pos_view = at.xyz;
    normal_view = mat3(view) * in_normal;
    normal_view /= max(length(normal_view), 1e-12);
    rest = in_rest;
    material = int(in_surface.x + 0.5);
    surface = in_surface.yzw;
    hair = in_hair;
    uv = in_uv;
    gl_Position = projection * at;
}
