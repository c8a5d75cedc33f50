#version 330 core
// A quiet, dark backdrop with a faint glow behind the head. A pixel's noise hides the bands of 8-bit shades.
in vec2 at;

out vec4 colour;

void main() {
    float glow = exp(-1.1 * dot(at - vec2(0.0, 0.1), at - vec2(0.0, 0.1)));
    float noise = fract(52.9829189 * fract(dot(gl_FragCoord.xy, vec2(0.06711056, 0.00583715)))) - 0.5;
    colour = vec4(mix(vec3(0.055, 0.059, 0.068), vec3(0.118, 0.126, 0.142), glow) + noise / 255.0, 1.0);
}
