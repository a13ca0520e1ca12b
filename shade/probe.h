/* probe.h - three results of shared functions over u in (0, 1)^2, for each number below PROBE_COUNT; together they
 * call every function of the shared text. Itself shared text: parity_test.c runs it in C and on the GPU. */
#define PROBE_COUNT 45

/* Two directions above the horizon, in tangent space, away from the poles of the functions. */
FN vec3 probe_V(vec2 u)
{
    return normalize(vec3(0.6f - 0.4f * u[1], -0.2f, 0.2f + 0.5f * u[0]));
}
FN vec3 probe_L(vec2 u)
{
    return normalize(vec3(2.0f * u[0] - 1.0f, 2.0f * u[1] - 1.0f, 0.4f));
}

FN Surface probe_surface(vec2 u)
{
    return surface_from_gltf(normalize(vec3(0.1f, 0.05f, 1.0f)), vec3(0.9f, 0.5f, 0.1f), u[0],
                             0.25f + 0.75f * u[1], 1.3f + u[0], 0.8f, vec3(1.0f, 0.7f, 2.0f),
                             occlusion_from_texel(u[0], 0.5f), vec3(u[1]));
}

FN vec3 probe_brdf(int which, vec2 u)
{
    float alpha = alpha_from_roughness(0.2f + 0.8f * u[1]);
    vec3 V = probe_V(u);
    vec3 L = probe_L(u);
    vec3 H = normalize(V + L);
    vec3 N = vec3(0.0f, 0.0f, 1.0f);
    float alpha_y = 1.2f - alpha;
    if (which == 0)
        return vec3(D_GGX(u[0], alpha), D_GGX_stable(H[2], cross(N, H), alpha),
                    D_GGX_anisotropic(H, alpha, alpha_y));
    if (which == 1)
        return vec3(smith_root_GGX(u[0], alpha), Lambda_SmithGGX(u[0], alpha), G1_SmithGGX(u[0], alpha));
    if (which == 2)
        return vec3(V_SmithGGX(u[0], 0.3f, alpha), V_SmithGGX_separable(u[0], 0.3f, alpha),
                    V_SmithGGX_anisotropic(L, V, alpha, alpha_y));
    if (which == 3)
        return vec3(V_SchlickGGX(u[0], 0.4f, k_ibl(alpha)), V_SchlickGGX(u[0], 0.4f, k_direct(u[1])),
                    G1_SmithGGX_anisotropic(V, alpha, alpha_y));
    vec3 F_mean = vec3(u[0], 0.04f, 1.0f);
    float E = 0.3f + 0.6f * u[1];
    if (which == 4)
        return multiscatter_scale(F_mean, E) + multiscatter_scale_turquin(F_mean, E) * 0.1f;
    return multiscatter_scale_cycles(F_mean, E, E_avg_GGX(u[1])) + brdf_kulla_conty(F_mean, E, u[0], 0.6f) +
           brdf_lambert(F_mean);
}

FN vec3 probe_fresnel(int which, vec2 u)
{
    vec3 F0 = vec3(0.04f, u[1], 0.9f);
    if (which == 6)
        return F_Schlick(F0, vec3(1.0f, 0.5f, 1.0f), u[0]) +
               vec3(schlick_weight(u[1]), F_Schlick1(0.1f, 1.0f, u[0]), 0.0f);
    if (which == 7)
        return F_Schlick_SG(F0, u[0]) + F_avg(F0, vec3(1.0f)) * 0.1f;
    if (which == 8)
        return F_Schlick_roughness(F0, vec3(1.0f), u[1], u[0]);
    if (which == 9)
        return vec3(F_dielectric(u[0], 1.1f + u[1]), F_dielectric(u[0], 1.0f / (1.1f + u[1])),
                    F_dielectric_avg(1.0f + u[1]));
    if (which == 10)
        return F_conductor(u[0], vec3(0.2f, 1.5f, 0.1f + u[1]), vec3(3.9f, 7.6f, 2.0f));
    return vec3(F0_from_ior(1.0f + u[0]), ior_from_F0(0.9f * u[0]), F_conductor1(u[0], 1.0f, u[1]));
}

FN vec3 probe_sampling(int which, vec2 u)
{
    float alpha = alpha_from_roughness(0.2f + 0.8f * u[1]);
    vec3 V = probe_V(u);
    if (which == 12) {
        vec2 h = hammersley(uint(u[0] * 4096.0f), 4096u);
        return vec3(h[0], h[1], radical_inverse(uint(u[1] * 1e6f)));
    }
    if (which == 13)
        return mul(basis_from_normal(probe_L(u)), sample_D_GGX(u, alpha));
    if (which == 14)
        return mul(transpose(basis_from_normal(-probe_L(u))), sample_cosine(u));
    if (which == 15)
        return sample_VNDF_GGX(u, V, alpha, 0.5f);
    vec3 H = normalize(V + probe_L(u));
    return vec3(pdf_D_GGX(u[0], alpha), pdf_VNDF_GGX(V, H, alpha, 0.5f), pdf_cosine(u[0] - 0.3f));
}

FN vec3 probe_surface_brdf(int which, vec2 u)
{
    Surface s = probe_surface(u);
    vec3 V = probe_V(u);
    vec3 L = probe_L(u);
    vec2 dfg = vec2(0.7f, 0.3f * u[0]);
    if (which == 17)
        return surface_brdf_cos(s, V, L);
    if (which == 18)
        return surface_brdf_cos_energy(s, V, L, ENERGY_CONSERVING, dfg);
    if (which == 19) {
        SurfaceLobes lobes = surface_lobes_cos(s, V, L, ENERGY_GLTF, dfg);
        return lobes.specular - lobes.diffuse;
    }
    if (which == 20)
        return specular_albedo(s.F0, vec3(s.F90), dfg) + dielectric_F0(u[0], u[1], vec3(2.0f, 1.0f, 0.5f));
    Surface plain = surface_from_metallic_roughness(V, vec3(u[0], u[1], 0.5f), u[0], u[1]);
    return face_forward(plain.N, L, vec3(0.0f, 1.0f, 0.0f)) * max3(plain.base_color) + surface_NdotV(s, V) +
           s.occlusion + s.emissive + plain.F0;
}

FN vec3 probe_light(int which, vec2 u)
{
    Surface s = probe_surface(u);
    vec3 V = probe_V(u);
    vec3 P = probe_L(u);
    vec3 position = vec3(3.0f, 1.0f + u[0], 2.0f);
    vec3 intensity = vec3(100.0f, 50.0f, 25.0f);
    vec2 dfg = vec2(0.6f, 0.1f);
    Light spot = light_spot(position, normalize(vec3(-3.0f, -1.0f, -2.0f)), intensity, 9.0f, 0.1f, 0.8f);
    if (which == 22)
        return shade_punctual(s, P, V, spot, ENERGY_GLTF, dfg);
    if (which == 23)
        return shade_punctual(s, P, V, light_directional(normalize(vec3(0.2f, 0.1f, -1.0f)), intensity),
                              ENERGY_CONSERVING, dfg);
    if (which == 24) {
        LightSample l = light_illuminate(light_point(position, intensity, 20.0f * u[1] + 2.0f), P);
        return l.L + l.E * 0.01f + l.distance_m;
    }
    if (which == 25)
        return vec3(attenuation_range(8.0f * u[0], 6.0f), attenuation_ue4(8.0f * u[0], 6.0f),
                    attenuation_filament(8.0f * u[0], 0.0f));
    return vec3(range_window(u[0] * 40.0f, 5.0f), spot_cone(u[0], 3.0f, -1.0f), spot_cone(u[1], 0.0f, 1.0f));
}

FN vec3 probe_area_light(int which, vec2 u)
{
    Surface s = probe_surface(u);
    vec3 V = probe_V(u);
    vec3 P = probe_L(u);
    vec3 center = vec3(2.0f, -1.0f, 1.5f);
    vec2 dfg = vec2(0.6f, 0.1f);
    if (which == 27)
        return shade_sphere(s, P, V, center, 0.8f * u[0], vec3(10.0f, 5.0f, 1.0f), ENERGY_GLTF, dfg);
    if (which == 28)
        return shade_sphere_widened(s, P, V, center, 0.8f * u[0], vec3(10.0f, 5.0f, 1.0f), ENERGY_CONSERVING,
                                    dfg);
    if (which == 29) {
        RepresentativePoint p =
            representative_point_tube(center, P * 3.0f + 1.0f, V, 0.1f, 0.2f + 0.5f * u[1]);
        return p.L + p.normalisation;
    }
    if (which == 30) {
        RepresentativePoint p = representative_point_sphere(center, V, 0.5f, 0.2f + 0.5f * u[1]);
        return p.L * p.normalisation;
    }
    /* 0.1: a sphere that sets is the small difference of numbers near 1, exact to 2e-6 absolutely */
    return vec3(0.1f + sphere_irradiance(2.0f * u[0] - 1.0f, 0.2f + 0.7f * u[1]),
                line_irradiance(V, center, P + 0.5f), widened_alpha(u[0], 0.3f, 2.0f, 3.0f));
}

FN vec3 probe_ibl(int which, vec2 u)
{
    Surface s = probe_surface(u);
    vec3 V = probe_V(u);
    float r = 0.2f + 0.8f * u[1];
    uint i = uint(u[0] * 64.0f);
    vec2 dfg = vec2(0.5f + 0.3f * u[0], 0.2f * u[1]);
    if (which == 32) {
        SpecularSample t = specular_ibl_sample(i, 64u, s.F0, vec3(1.0f), r, s.N, V);
        return t.L + t.weight + t.pdf * 0.1f;
    }
    if (which == 33) {
        PrefilterSample t = prefilter_sample(i, 64u, r, V);
        return t.L * (t.weight + 0.1f) + prefilter_lod(t.pdf, 64u, 1e-4f);
    }
    if (which == 34) {
        vec2 a = dfg_sample_k(i, 64u, r, u[0], 0.3f);
        vec2 b = dfg_sample(i, 64u, r, u[0]);
        return vec3(a[0] + a[1], b[0], b[1]) + dfg_sample_karis(i, 64u, r, u[0])[0];
    }
    if (which == 35) {
        vec2 a = integrate_dfg(r, u[0], 16u);
        vec2 b = integrate_dfg_karis(r, u[0], 16u);
        return vec3(a[0], a[1], b[0] + b[1]);
    }
    if (which == 36) {
        MultiScatter m = multiscatter_ibl(s.F0, s.F0, vec3(1.0f), dfg);
        return m.single + m.multiple + approximate_specular_ibl(s.F0, vec3(1.0f), vec3(2.0f), dfg);
    }
    int energy = ENERGY_GLTF;
    if (u[1] > 0.5f)
        energy = ENERGY_CONSERVING;
    return surface_ibl(s, surface_NdotV(s, V), dfg, vec3(3.0f, 1.0f, 0.2f), vec3(0.5f, 0.7f, 1.0f), energy);
}

FN vec3 probe_color(int which, vec2 u)
{
    vec3 hdr = vec3(8.0f * u[0], 8.0f * u[1], 1.0f);
    if (which == 38)
        return srgb_from_linear(vec3(u[0], u[1], u[0] * 0.01f)) +
               linear_from_srgb(vec3(u[0], u[1], u[0] * 0.1f)) + srgb_from_linear1(u[1]) +
               linear_from_srgb1(u[0]);
    if (which == 39)
        return rec709_from_xyz(xyz_from_rec709(hdr) + 1.0f) +
               rec709_from_rec2020(rec2020_from_rec709(hdr) + 1.0f) + luminance(hdr);
    if (which == 40)
        return tonemap(int(u[0] * 8.0f), vec3(4.0f * u[0], 4.0f * u[1], 1.0f));
    return tonemap_reinhard(hdr) + tonemap_reinhard_extended(hdr, 4.0f) + tonemap_hable(hdr) +
           hable_curve(hdr) + tonemap_aces_narkowicz(hdr) + tonemap_aces(hdr) + tonemap_pbr_neutral(hdr) +
           agx_contrast(vec3(u[0], u[1], 0.5f)) + tonemap_agx(hdr);
}

/* Every layer at once, or the subset whose bits come with u. */
FN Layers probe_layers(vec2 u)
{
    Layers m = layers_from_surface(probe_surface(u));
    m.layers = uint(u[0] * 512.0f);
    return m;
}

FN vec3 probe_layered(int which, vec2 u)
{
    Layers m = probe_layers(u);
    vec3 V = probe_V(u);
    int energy = ENERGY_GLTF;
    if (u[1] > 0.5f)
        energy = ENERGY_CONSERVING;
    LayerTables t = layer_tables(m, V, vec2(0.6f, 0.2f * u[0]), 0.9f, 0.8f, 0.3f);
    if (which == 42)
        return layers_brdf_cos(m, V, probe_L(u), energy, t, 0.2f) + vec3(layers_dfg_roughness(m, V, energy),
                                                                         layers_transmission_roughness(m),
                                                                         layers_clearcoat_NdotV(m, V));
    if (which == 43)
        return layers_punctual(m, probe_L(u), V, light_point(vec3(3.0f, 1.0f, 2.0f), vec3(100.0f), 0.0f),
                               energy, t, 0.2f) +
               layers_reflection(m, V) + layers_clearcoat_reflection(m, V);
    LayerLight light;
    light.specular = vec3(3.0f, 1.0f, 0.2f);
    light.irradiance_over_pi = vec3(0.5f, 0.7f, 1.0f);
    light.irradiance_back_over_pi = vec3(0.2f, 0.1f, 0.3f);
    light.clearcoat = vec3(1.0f, 2.0f, 3.0f);
    light.sheen = vec3(0.3f, 0.2f, 0.1f);
    light.transmitted = vec3(1.0f, 0.5f, 0.7f);
    vec3 radiance = layers_ibl(m, V, t, light, energy) + layers_emission(m, V);
    if (has_layer(m, LAYER_SHEEN))
        radiance += 1.0f;
    return radiance;
}

FN vec3 probe(int which, vec2 u)
{
    if (which < 6)
        return probe_brdf(which, u);
    if (which < 12)
        return probe_fresnel(which, u);
    if (which < 17)
        return probe_sampling(which, u);
    if (which < 22)
        return probe_surface_brdf(which, u);
    if (which < 27)
        return probe_light(which, u);
    if (which < 32)
        return probe_area_light(which, u);
    if (which < 38)
        return probe_ibl(which, u);
    if (which < 42)
        return probe_color(which, u);
    return probe_layered(which, u);
}
