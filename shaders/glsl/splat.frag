#version 330 core
// One splat's light on one pixel, added by the blender. Reference: core/manifold/splat.py
in vec3 splat_colour;
flat in vec2 centre_px;

uniform float sigma_px;
uniform float rho;

out vec4 colour;

void main() {
    vec2 d = gl_FragCoord.xy - centre_px;
    colour = vec4(splat_colour * rho * exp(-dot(d, d) / (2.0 * sigma_px * sigma_px)), 1.0);
}
