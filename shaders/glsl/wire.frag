#version 330 core
// The wireframe: smooth lines on a quiet, dimly lit surface that hides what lies behind it; or the lines alone, in one
// colour, over another picture.
#include "light.glsl"

in vec3 wire_normal;
noperspective in vec3 edge_px;
flat in float wire_material;
flat in float size_px;

uniform vec4 alone;  // colour of the lines alone, and 1; 0: lines on their surface

out vec4 colour;

void main() {
    vec3 n = normalize(wire_normal);
    if (!gl_FrontFacing) n = -n;
    float light = max(dot(n, KEY_DIRECTION), 0.0) + 0.35 * max(dot(n, FILL_DIRECTION), 0.0);
    float facing = abs(n.z);
    vec3 surface = mix(vec3(0.055, 0.060, 0.072), vec3(0.115, 0.125, 0.150), light);
    vec3 line = mix(vec3(0.26, 0.36, 0.46), vec3(0.56, 0.76, 0.90), facing);
    if (wire_material > 0.5) line = mix(line, vec3(0.92, 0.74, 0.50), 0.55);
    if (!gl_FrontFacing) line *= 0.35;
    float nearest = min(edge_px.x, min(edge_px.y, edge_px.z));
    // where triangles shrink to a few pixels, lines pale so that the picture does not fill up
    float room = clamp(size_px / 7.0, 0.30, 1.0);
    float covered = room * (1.0 - smoothstep(0.30, 1.15, nearest));
    if (alone.a > 0.5) {
        colour = vec4(alone.rgb, gl_FrontFacing ? covered : 0.0);
    } else {
        colour = vec4(mix(surface, line, covered), 1.0);
    }
}
