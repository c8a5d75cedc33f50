#version 330 core
// Splats of the phoneme Isomap (eFASE, equation 3). One work-item: one corner of one splat's square of 3 sigma.
//   in_at      vec2, pixels, y down, one a splat     in_colour  vec3, 0..1, one a splat
//   Reference: core/manifold/splat.py
in vec2 in_at;
in vec3 in_colour;

uniform vec2 size_px;
uniform float sigma_px;
uniform float cut_sigmas;

out vec3 splat_colour;
flat out vec2 centre_px;

void main() {
    vec2 corner = vec2(gl_VertexID & 1, gl_VertexID >> 1) * 2.0 - 1.0;
    vec2 at = in_at + corner * cut_sigmas * sigma_px;
    centre_px = in_at;
    splat_colour = in_colour;
    // row 0 of the framebuffer is the picture's top row, so reading it back needs no turning
    gl_Position = vec4(at / size_px * 2.0 - 1.0, 0.0, 1.0);
}
