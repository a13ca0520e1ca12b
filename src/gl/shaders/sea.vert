/* sea.vert - the mesh of a sea: its nodes were computed before (sea_grid.frag). */
uniform highp sampler2D u_sea_grid;
uniform highp sampler2D u_sea_rest;

out highp vec3 v_at;   /* from the eye, m */
out highp vec2 v_rest; /* of the water */
out highp float v_closing; /* how fast a ray approaches the surface, m per m of distance */

/* Tangent of the elevation at which it is seen, and its distance. */
vec2 sea_seen_at(vec3 at)
{
    float r = max(length(at.xz), 1e-4);
    return vec2(at.y / r, r);
}

void main()
{
    /* at most 2^20; the offset of 0.5 makes the rounded division exact */
    float row = floor((float(gl_VertexID) + 0.5) / sea_fan_ends.x);
    ivec2 node = ivec2(float(gl_VertexID) - row * sea_fan_ends.x, row);
    v_at = texelFetch(u_sea_grid, node, 0).xyz;
    v_rest = texelFetch(u_sea_rest, node, 0).xy;
    vec3 beyond = texelFetch(u_sea_grid, ivec2(node.x, min(node.y + 1, int(sea_fan_ends.z) - 1)), 0).xyz;
    vec2 here = sea_seen_at(v_at);
    vec2 there = sea_seen_at(beyond);
    float apart = max(there.y - here.y, 1e-3 * here.y);
    v_closing = here.y * (there.x - here.x) / apart;
    gl_Position = view_projection * vec4(v_at, 1.0);
    if (far_depth > 0.0) /* depth is not reversed: 1 - 2 n / w, which needs no far plane */
        gl_Position.z = gl_Position.w - 2.0 * sea_ray.z;
}
