/* phong.h - parity cases: the lighting of OpenGL 1. */

/* ---- phong.h ---- */

FN PhongMaterial parity_phong_material(float shininess)
{
    PhongMaterial m;
    m.ambient = vec3(0.1f, 0.2f, 0.05f);
    m.diffuse = vec3(0.7f, 0.3f, 0.5f);
    m.specular = vec3(0.9f, 1.0f, 0.4f);
    m.emission = vec3(0.02f, 0.0f, 0.1f);
    m.shininess = shininess;
    return m;
}

/* A point under a sun and a spot, in the variant that u chooses. */
FN vec3 case_phong_lights(vec2 u)
{
    PhongRules r = phong_rules(int(u[0] * 4.0f));
    PhongMaterial m = parity_phong_material(64.0f * u[1]);
    vec3 P = vec3(4.0f * u[0] - 2.0f, 0.3f, -5.0f);
    vec3 V = normalize(-P);
    vec3 N = phong_normal(r, normalize(vec3(u[1] - 0.2f, 0.4f, 0.3f - u[0])), V, u[1] < 0.5f);
    mat3 view = basis_from_normal(parity_L(u));
    vec3 L = normalize(phong_to_eye(view, vec3(0.1f), vec3(0.2f, 0.1f, 0.9f), r.direction_w));
    PhongLight sun = phong_light_directional(L, vec3(0.3f), vec3(1.0f, 0.8f, 0.6f), vec3(0.9f));
    PhongLight spot =
        phong_light_point(vec3(1.0f, 3.0f, 0.0f), vec3(0.1f), vec3(0.5f, 1.0f, 2.0f), vec3(1.0f));
    spot.attenuation = vec3(0.5f, 0.1f, 0.02f);
    spot.spot_direction = normalize(vec3(-0.3f, -0.4f, -1.0f));
    spot.spot_exponent = 2.0f;
    spot.spot_cos = 0.2f;
    PhongLit lit = phong_add(phong_unlit_part(r, m), phong_light_part(r, m, sun, P, N, V));
    lit = phong_add(lit, phong_light_part(r, m, spot, P, N, V));
    return lit.color + lit.highlight + phong_light_vector(spot, P) * 0.1f + phong_light_share(spot, P);
}

/* 1: with a driver's log2 near 1 a lobe is exact to 3e-6, absolutely */
FN vec3 case_phong_reflection(vec2 u)
{
    vec3 V = parity_V(u);
    vec3 L = parity_L(u);
    vec3 N = vec3(0.0f, 0.0f, 1.0f);
    return 1.0f + phong_reflection(N, V, L, vec3(0.3f, 0.5f, 0.8f), vec3(1.0f, 0.5f, 0.2f), 128.0f * u[1]) +
           phong_view(phong_rules(PHONG_VIGNETTE), V) +
           vec3(phong_NdotH(N, V, L), phong_power(u[0] - 0.5f, 10.0f * u[1]), phong_halo(0.3f, u[0]));
}

/* Every type and mode. */
FN vec3 case_phong_texture(vec2 u)
{
    PhongColor e;
    PhongColor t;
    e.rgb = vec3(0.8f, 0.1f, 0.5f);
    e.opacity = 0.7f;
    t.rgb = vec3(u[0], 0.3f, u[1]);
    t.opacity = 0.6f;
    int type = int(u[0] * 5.0f);
    PhongColor c = phong_texture(type, int(u[1] * 5.0f), e, t);
    PhongColor texel = phong_texel(type, t);
    return c.rgb + vec3(c.opacity, 2.0f * c.opacity, 0.0f) + texel.rgb * texel.opacity;
}

FN vec3 case_phong_sphere_map(vec2 u)
{
    vec3 V = parity_V(u);
    vec2 uv = phong_sphere_map(normalize(vec3(u[0] - 0.5f, u[1] - 0.5f, 0.4f)), V);
    return vec3(uv[0], uv[1], 1.0f);
}

/* Every mode in both forms. */
FN vec3 case_phong_fog(vec2 u)
{
    PhongFog f;
    f.mode = int(u[0] * 4.0f);
    f.color = vec3(0.9f, 0.5f, 0.1f);
    f.near_m = 2.0f;
    f.far_m = 7.0f;
    f.scale = 1.3f;
    f.w = phong_fog_w(3.0f * u[0]);
    float d = 8.0f * u[1];
    return phong_fogged(phong_rules(int(fract(u[1] * 7.0f) * 4.0f)), f, vec3(0.1f, 0.2f, 0.3f), d) +
           vec3(phong_fog_share(f, d), phong_fog_share_fixed(f, d), f.w);
}

FN vec3 case_blinn_phong(vec2 u)
{
    float s = 0.5f + 128.0f * u[0];
    return brdf_blinn_phong(vec3(0.04f, 0.5f, 1.0f), u[1], s) + phong_specular_from_F0(vec3(u[0]), s) +
           vec3(alpha_from_shininess(s), shininess_from_alpha(u[0] + 0.05f), D_BlinnPhong(u[1], s)) +
           vec3(blinn_phong_normalisation(s), blinn_phong_normalisation_linear(s), 0.0f);
}
