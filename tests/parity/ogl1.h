/* ogl1.h - parity cases: a fragment of OpenGL 1, with the look-ups of ogl1_host.h. */

FN PhongFog parity_phong_fog(int mode)
{
    PhongFog f;
    f.mode = mode;
    f.color = vec3(0.9f, 0.5f, 0.1f);
    f.near_m = 2.0f;
    f.far_m = 7.0f;
    f.scale = 1.3f;
    f.w = 0.3f;
    return f;
}

/* In all variants, types and modes, with any subset of maps. */
FN Ogl1Host parity_ogl1_host(vec2 u)
{
    int bits = int(u[0] * 64.0f) * 64 + int(u[1] * 64.0f);
    Ogl1Host host;
    host.frame.rules = phong_rules(bits & 3);
    host.frame.fog = parity_phong_fog(bits >> 1 & 3);
    host.frame.is_encoded = (bits & 4) != 0;
    host.frame.are_colors_srgb = (bits & 8) != 0;
    host.frame.has_rgl_colors = (bits & 128) != 0;
    host.surface.material = parity_phong_material(4.0f + 30.0f * u[1]);
    host.surface.opacity = 0.9f;
    host.surface.texture_type = int(u[0] * 5.0f);
    host.surface.texture_mode = int(u[1] * 5.0f);
    host.surface.has_texture_over_light = (bits & 16) != 0;
    host.surface.is_halo = (bits & 32) != 0;
    host.surface.has_fog = (bits & 256) != 0;
    host.P = vec3(2.0f * u[0] - 1.0f, 2.0f * u[1] - 1.0f, -4.0f);
    host.V = normalize(-host.P);
    host.is_front = (bits & 64) != 0;
    host.maps = bits >> 3;
    return host;
}

/* ---- ogl1_light.h ---- */

FN vec3 case_ogl1_light(vec2 u)
{
    Ogl1Host host = parity_ogl1_host(u);
    PhongLit lit = ogl1_light_at(host, host.surface.material, host_normal(host));
    PhongLit corner = ogl1_light_at_corner(host);
    return lit.color + lit.highlight + corner.color + corner.highlight * 2.0f +
           ogl1_color(host).rgb * ogl1_color(host).opacity + phong_to_linear(host.frame, vec3(u[0])) +
           phong_from_linear(host.frame, vec3(u[1]));
}

/* ---- ogl1_fragment.h ---- */

FN vec3 case_ogl1_fragment(vec2 u)
{
    Ogl1Host host = parity_ogl1_host(u);
    PhongColor c = ogl1_fragment(host);
    return vec3(0.1f) + c.rgb * c.opacity;
}

FN vec3 case_ogl1_color(vec2 u)
{
    Ogl1Host host = parity_ogl1_host(u);
    PhongColor c = ogl1_base_color(host);
    PhongColor lit = ogl1_lit_color(host);
    PhongColor textured = ogl1_with_texture(host, c);
    PhongMaterial m = ogl1_mapped_material(host, c.rgb);
    PhongLit light = phong_with_highlight(ogl1_light(host, c.rgb));
    return c.rgb + lit.rgb + textured.rgb + m.ambient + m.specular + m.emission + light.color +
           vec3(m.shininess * 0.01f, ogl1_coverage(host, c.opacity), textured.opacity);
}
