#version 330 core
// Adds to each triangle the distance in pixels to its edges, so that wire.frag can draw smooth lines.
//   hidden_edges  one texel a triangle, bit i set where the edge opposite to corner i is only a quad's diagonal
layout(triangles) in;
layout(triangle_strip, max_vertices = 3) out;

in vec3 pos_view[];
in vec3 normal_view[];
flat in int material[];

uniform usampler2D hidden_edges;
uniform vec2 viewport_px;

out vec3 wire_normal;
noperspective out vec3 edge_px;
flat out float wire_material;
flat out float size_px;

void main() {
    vec2 corner_px[3];
    for (int i = 0; i < 3; i++) corner_px[i] = 0.5 * viewport_px * gl_in[i].gl_Position.xy / gl_in[i].gl_Position.w;
    vec2 a = corner_px[1] - corner_px[0], b = corner_px[2] - corner_px[0];
    float twice_area = abs(a.x * b.y - a.y * b.x);
    int width = textureSize(hidden_edges, 0).x;
    uint hidden = texelFetch(hidden_edges, ivec2(gl_PrimitiveIDIn % width, gl_PrimitiveIDIn / width), 0).r;
    vec3 far = vec3(0.0);
    for (int i = 0; i < 3; i++) if ((hidden & (1u << i)) != 0u) far[i] = 1e4;
    for (int i = 0; i < 3; i++) {
        float height = twice_area / max(distance(corner_px[(i + 1) % 3], corner_px[(i + 2) % 3]), 1e-6);
        edge_px = far;
        edge_px[i] += height;
        wire_normal = normal_view[i];
        wire_material = float(material[i]);
        size_px = sqrt(twice_area);
        gl_Position = gl_in[i].gl_Position;
        EmitVertex();
    }
    EndPrimitive();
}
