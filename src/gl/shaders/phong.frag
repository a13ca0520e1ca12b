/* phong.frag - a material of OpenGL 1. */
#ifndef AOVS
void main()
{
    Ogl1Host host = fragment_host();
    PhongColor c = ogl1_fragment(host);
    put_fragment(host_frame(host).is_encoded ? c.rgb : c.rgb * exposure, c.opacity);
}
#else
void main()
{
    Ogl1Host host = fragment_host();
    PhongColor c = ogl1_with_texture(host, ogl1_base_color(host));
    vec3 N = host_mapped_normal(host) * seen_side();
    vec3 world = ogl1_view[0].xyz * N.x + ogl1_view[1].xyz * N.y + ogl1_view[2].xyz * N.z;
    put_aovs(world, phong_to_linear(host_frame(host), c.rgb), 1.0, ogl1_coverage(host, c.opacity));
}
#endif
