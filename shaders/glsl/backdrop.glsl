// What lies behind the head: quiet and dark with a faint glow. A pixel's noise hides the bands of 8-bit shades.
// at: -1..1 across the picture and up
vec3 backdrop(vec2 at) {
    vec2 off = at - vec2(0.0, 0.1);
    float glow = exp(-1.1 * dot(off, off));
    float noise = fract(52.9829189 * fract(dot(gl_FragCoord.xy, vec2(0.06711056, 0.00583715)))) - 0.5;
    return mix(vec3(0.055, 0.059, 0.068), vec3(0.118, 0.126, 0.142), glow) + noise / 255.0;
}
