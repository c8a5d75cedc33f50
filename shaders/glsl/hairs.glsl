// Brows and hair, painted on the skin in its resting place.
//   grain  RGBA8 noise in a cube, repeating     brows  two arcs of three points (inner end, arch, outer end), mm
uniform sampler3D grain;
uniform vec3 brows[6];
uniform float brow_width_mm;
uniform float brow_weight;

// How much of an eyebrow covers this place: single hairs along an arc, upright at the inner end, flat at the outer.
float brow_cover(vec3 rest) {
    int first = rest.x > 0.0 ? 0 : 3;
    vec2 inner = brows[first].xy, arch = brows[first + 1].xy, outer = brows[first + 2].xy;
    float u = (rest.x - inner.x) / (outer.x - inner.x);
    if (u < -0.15 || u > 1.12) return 0.0;
    float top = (arch.x - inner.x) / (outer.x - inner.x);
    float rise = arch.y - mix(inner.y, outer.y, top);
    float middle = mix(inner.y, outer.y, u) + rise * u * (1.0 - u) / (top * (1.0 - top));
    float width = 0.55 * brow_width_mm * mix(0.55, 1.0, brow_weight) * mix(1.0, 0.30, u * u);
    float v = (rest.y - middle) / width;
    if (abs(v) > 1.6) return 0.0;
    // hairs lean outwards, more so towards the outer end
    float lean = mix(0.25, 1.5, clamp(u, 0.0, 1.0));
    float along = (rest.x - inner.x) * sign(outer.x - inner.x) - lean * (rest.y - middle);
    vec4 fine = texture(grain, vec3(along * 0.135, v * 0.030, 0.31));
    vec4 coarse = texture(grain, vec3(along * 0.040, v * 0.05, 0.67));
    float hairs = smoothstep(0.20, 0.80, fine.r * 0.75 + coarse.g * 0.25);
    float rim = 1.0 - smoothstep(0.30, 1.05 + 0.9 * (fine.g - 0.45), abs(v));
    float ends = smoothstep(-0.08, 0.20, u + 0.16 * (fine.b - 0.5)) * (1.0 - smoothstep(0.72, 1.06, u));
    return clamp(rim * ends * (0.50 + 0.48 * hairs) * mix(0.75, 1.0, brow_weight), 0.0, 0.92);
}

// How bright the strands are here, about 1; they run from the hairline back over the crown.
float strands(vec3 rest) {
    float turn = atan(rest.x, rest.y - 15.0);
    vec4 fine = texture(grain, vec3(turn * 3.1, rest.z * 0.0022, 0.13));
    vec4 broad = texture(grain, vec3(turn * 0.8, rest.z * 0.0035, 0.77));
    return 0.50 + 0.55 * fine.r + 0.45 * broad.g - 0.20;
}
