/* sea.vert - the mesh of a sea: nodes were computed before (sea_grid.frag). */
uniform highp sampler2D u_sea_grid;

out highp vec3 v_at;   /* from the eye, m */
out highp vec2 v_rest; /* of the water */

void main()
{
    int columns = int(sea_fan_ends.x);
    ivec2 node = ivec2(gl_VertexID % columns, gl_VertexID / columns);
    v_at = texelFetch(u_sea_grid, node, 0).xyz;
    v_rest = sea_grid_rest(node);
    gl_Position = view_projection * vec4(v_at, 1.0);
    if (far_depth > 0.0) /* depth is not reversed: 1 - 2 n / w, which needs no far plane */
        gl_Position.z = gl_Position.w - 2.0 * sea_ray.z;
}
