/* surface.frag - radiance (cd/m^2, premultiplied) of a material. */
centroid in vec3 v_position;
centroid in vec3 v_normal;
centroid in vec4 v_color;
centroid in vec4 v_texcoord01;
centroid in vec4 v_texcoord23;
flat in vec4 v_instance;

out vec4 fragment;

void main()
{
    vec3 N = normalize(gl_FrontFacing ? v_normal : -v_normal);
    vec3 V = -normalize(v_position);
    Surface s = surface_from_gltf(N, v_color.xyz, 0.0, 0.5, 1.5, 1.0, vec3(1.0), 1.0, vec3(0.0));
    vec3 radiance = surface_ibl(s, surface_NdotV(s, V), vec2(0.9, 0.05), vec3(0.5 + 0.5 * N.y), vec3(0.5 + 0.5 * N.y), energy);
    fragment = vec4(radiance * exposure, 1.0);
}
