/* probe.h - three results of shared functions over u in (0, 1)^2, for each number below PROBE_COUNT; together they
 * call every function of the shared text. Itself shared text: parity_test.c runs it in C and on the GPU. */
#define PROBE_COUNT 124

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

FN vec3 probe_sheen(int which, vec2 u)
{
    vec3 V = normalize(vec3(0.6f, 0.0f, 0.2f + u[0]));
    vec3 L = probe_L(u);
    float r = 0.3f + 0.7f * u[1];
    float alpha = sheen_alpha(r);
    if (which == 42)
        return vec3(D_Charlie(u[0], alpha), Lambda_Charlie(u[0], alpha) * 0.01f,
                    V_Charlie(u[0], 0.4f, alpha)) +
               vec3(brdf_sheen(u[0], 0.3f, 0.4f, alpha), V_Neubelt(u[0], 0.3f), pdf_D_Charlie(u[0], alpha)) +
               sheen_lambda_curve(u[0], alpha) * 0.1f;
    if (which == 43)
        return 0.1f + vec3(sheen_albedo_sample(uint(u[0] * 64.0f), 64u, r, u[1]),
                           integrate_sheen_albedo(r, u[0], 16u),
                           sheen_scaling(vec3(0.3f, 0.7f, 0.1f), u[0] * 2.0f));
    if (which == 44)
        return 0.5f + sample_D_Charlie(u, alpha) + clearcoat_lobe_cos(probe_V(u), u[0], V, L, alpha) +
               F_clearcoat(u[0]);
    vec2 t = sheen_ltc_transform(u[0], r);
    PrefilterSample p = prefilter_sheen_sample(uint(u[0] * 64.0f), 64u, alpha, normalize(L));
    return 3.0f + sample_sheen_ltc(u, V, r) + p.L * p.weight + p.pdf +
           vec3(pdf_sheen_ltc(V, L, r), sheen_ltc_albedo(u[0], r), t[0] + t[1]);
}

FN vec3 probe_films(int which, vec2 u)
{
    vec3 V = probe_V(u);
    vec3 L = probe_L(u);
    vec3 N = vec3(0.0f, 0.0f, 1.0f);
    if (which == 46)
        return F_iridescent(1.1f + u[1], 800.0f * u[0], vec3(0.04f, 0.3f, 1.0f), 0.2f + 0.7f * u[1]) + 0.01f +
               film_fade(0.03f * u[0]);
    if (which == 47)
        return 5.0f + film_sensitivity(800.0f * u[0], vec3(0.0f, PI, 2.0f)) +
               film_base_ior(vec3(0.04f, u[0], 0.5f)) +
               film_base_reflectance(1.3f, vec3(1.5f, 2.0f, 1.1f), u[1]) +
               film_series(0.1f, vec3(u[0], u[1], 0.5f), 100.0f, vec3(1.0f)) +
               film_gaussian(5e-13f, 1.6e6f, 4.3e9f, u[0] * 1e-6f, u[1]);
    vec2 a = anisotropic_alpha(0.1f + 0.4f * u[0], u[1]);
    vec2 d = anisotropy_direction(u + 0.1f, u[0]);
    if (which == 48)
        return anisotropic_reflection(N, vec3(d[0], d[1], 0.0f), V, u[0], u[1]) +
               to_frame(L, vec3(d[0], d[1], 0.0f), vec3(-d[1], d[0], 0.0f), N);
    vec2 p = anisotropic_table_point(V, a);
    vec2 q = anisotropic_table_bound(vec2(0.5f, 0.2f * u[0]), V, a);
    if (which == 49)
        return vec3(p[0] + q[0] + anisotropic_grazing_share(V, a), p[1] + q[1],
                    alpha_specular_aa(u[0], V * 0.1f, L * u[1]));
    Surface s = surface_from_specular_glossiness(N, vec3(u[0], 0.5f, 0.2f), vec3(0.2f, u[1], 0.3f), u[0],
                                                 1.0f, vec3(0.1f));
    return s.base_color + s.F0 + s.alpha + s.emissive;
}

FN vec3 probe_transmission(int which, vec2 u)
{
    vec3 V = probe_V(u);
    vec3 L = mirror_through(probe_L(u), vec3(0.0f, 0.0f, 1.0f));
    float alpha = 0.2f + 0.6f * u[1];
    float eta = sel(u[0] < 0.5f, 1.5f, 0.7f);
    if (which == 51)
        return refract_or_zero(-V, vec3(0.0f, 0.0f, 1.0f), 1.2f + u[1]) +
               half_vector_transmission(V, L, eta) +
               F_Schlick_boundary(vec3(0.04f), vec3(1.0f), 0.8f + 0.2f * u[0], 1.0f / 1.3f);
    if (which == 52)
        return vec3(btdf_GGX_cos(V, L, alpha, 0.5f, 1.5f), pdf_transmission(V, L, alpha, 0.5f, 1.5f),
                    transmission_jacobian(u[0], -u[1], 1.7f));
    if (which == 53) {
        TransmissionSample t = sample_transmission(u, V, alpha, 0.5f, 1.5f);
        return 2.0f + t.L + vec3(t.VdotH, t.weight, t.pdf * 0.1f);
    }
    if (which == 54)
        return vec3(thin_wall_cos(V, L, alpha, 0.5f), pdf_thin_wall(V, L, alpha, 0.5f),
                    thin_wall_alpha(alpha, 1.0f + u[0]) + weight_VNDF_GGX(V, L, alpha, 0.5f));
    if (which == 55) {
        TransmissionSample t = sample_thin_wall(u, V, alpha, 0.5f);
        return 2.0f + t.L + vec3(t.VdotH, t.weight, t.pdf * 0.1f);
    }
    if (which == 56)
        return volume_transmittance(vec3(0.5f, 0.9f, 0.0f), 2.0f, 5.0f * u[0]) +
               volume_extinction(vec3(0.5f, u[0], u[1]), 3.0f) +
               single_scatter_albedo(vec3(u[0], u[1], 0.3f)) + single_scatter_albedo1(u[0]);
    return sample_phase_HG(u, V, 0.7f) + vec3(phase_HG(2.0f * u[0] - 1.0f, 0.6f),
                                              dispersed_ior(1.5f, u[0], 0),
                                              dispersed_ior_at(1.5f, u[0], 400.0f + 300.0f * u[1]));
}

/* A subset of the layers that comes with u. */
FN Layers probe_layers(vec2 u)
{
    Layers m = layers_from_surface(probe_surface(u));
    mat3 basis = basis_from_normal(m.base.N);
    m.layers = uint(u[0] * 512.0f);
    m.ior = 1.3f + u[0];
    m.eta = sel(u[1] < 0.7f, m.ior, 1.0f / m.ior);
    m.clearcoat = 0.8f;
    m.clearcoat_roughness = 0.3f;
    m.clearcoat_N = vec3(0.0f, 0.0f, 1.0f);
    m.sheen_color = vec3(0.6f, 0.2f, 0.8f);
    m.sheen_roughness = 0.3f + 0.5f * u[1];
    m.anisotropy = 0.7f;
    m.anisotropy_T = COL(basis, 0);
    m.anisotropy_B = COL(basis, 1);
    m.iridescence = 0.6f;
    m.iridescence_thickness_nm = 100.0f + 500.0f * u[1];
    m.transmission = 0.5f;
    m.diffuse_transmission = 0.4f;
    m.diffuse_transmission_color = vec3(0.3f, 0.6f, 0.9f);
    m.thickness = 0.1f;
    m.attenuation_color = vec3(0.5f, 0.6f, 0.7f);
    m.attenuation_distance = 0.2f;
    m.dispersion = 2.0f;
    m.multiscatter_color = vec3(0.2f, 0.4f, 0.6f);
    return m;
}
FN LayerTables probe_layer_tables(Layers m, vec3 V, int energy, vec2 u)
{
    return layer_tables(m, V, energy, vec2(0.6f, 0.2f * u[0]), 0.9f, 0.8f, 0.3f + u[1],
                        vec3(0.1f + 0.2f * u[0], 0.9f, 0.8f));
}

/* The parts of layers_brdf_cos(). */
FN vec3 probe_layer_parts(Layers m, vec3 V, vec3 L, int energy, LayerTables t)
{
    vec3 N = m.base.N;
    float NdotV = surface_NdotV(m.base, V);
    vec3 V_local = layers_to_any_frame(m, V);
    vec3 L_below = layers_to_any_frame(m, mirror_through(sel(dot(N, L) > 0.0f, L, mirror_through(L, N)), N));
    BoundaryWeights w = boundary_weights(m, NdotV, 0.7f, energy, t);
    BoundaryWeights g = boundary_weights_gltf(m, 0.6f, t);
    BoundaryWeights c = boundary_weights_conserving(m, NdotV, 0.5f, t);
    BelowShares b = below_shares(m);
    return w.specular * w.below + g.specular * g.below + c.specular * c.below + b.diffuse + b.diffuse_back +
           b.specular + layers_F_base(m, 0.6f) + compensation(m.base.F0, vec3(1.0f), t.dfg) +
           vec3(layers_DV(m, V, N, normalize(V + N), 1.0f, NdotV),
                layers_thin_wall_cos(m, V_local, L_below, energy, t),
                transmission_VdotH(V_local, L_below, layers_eta(m, 0))) +
           layers_volume_cos(m, V_local, L_below, energy, t) +
           layers_volume_cos1(m, V_local, L_below, 1.4f, energy, t) + layers_to_frame(m, L) +
           layers_base_front_cos(m, V, N, energy, t, LOBES_ALL) +
           layers_base_back_cos(m, V, -N, energy, t, LOBES_ALL) +
           layers_sheen_cos(m, V, N, energy, t, 0.3f, vec3(1.0f)) +
           layers_clearcoat_cos(m, V, N, energy, t, layers_base_cos(m, V, N, energy, t, LOBES_ALL),
                                LOBES_ALL);
}

/* The parts of layers_ibl(). */
FN vec3 probe_layer_ibl_parts(Layers m, vec3 V, int energy, LayerTables t, LayerLight light)
{
    float NdotV = surface_NdotV(m.base, V);
    BoundaryIbl base = boundary_ibl_base(m, NdotV, t, energy);
    BoundaryIbl metal = boundary_ibl_metal(m, NdotV, t, energy);
    BoundaryIbl film = boundary_ibl_film(t.film_F_base, t, energy);
    BoundaryIbl mixed = mix_boundary(mix_boundary(base, metal, 0.3f), film, 0.4f);
    BoundaryIbl whole = boundary_ibl(m, NdotV, t, energy);
    LayeredRadiance r = layers_base_ibl(m, NdotV, t, light, energy);
    r = layers_sheen_ibl(m, t, light.sheen, energy, r);
    r = layers_clearcoat_ibl(m, V, light.clearcoat, r);
    return mixed.single + mixed.multiple + whole.single + whole.multiple + whole.below + r.front + r.back;
}

FN vec3 probe_layered(int which, vec2 u)
{
    Layers m = probe_layers(u);
    vec3 V = probe_V(u);
    int energy = ENERGY_GLTF;
    if (fract(u[1] * 8.0f) > 0.5f)
        energy = ENERGY_CONSERVING;
    LayerTables t = probe_layer_tables(m, V, energy, u);
    if (which == 58)
        return layers_brdf_cos(m, V, sel(fract(u[0] * 32.0f) > 0.5f, probe_L(u), -probe_L(u)), energy, t,
                               0.2f);
    if (which == 59)
        return probe_layer_parts(m, V, probe_L(u), energy, t);
    if (which == 60) {
        vec2 p = layers_dfg_point(m, V, energy) + layers_transmission_point(m, V, energy) +
                 layers_alpha(m, layers_transmission_alpha(m));
        vec3 r = layers_reflection(m, V) + layers_clearcoat_reflection(m, V) + layers_emission(m, V);
        if (has_layer(m, LAYER_SHEEN) || layers_is_inside(m) || layers_reads_anisotropic(m, energy))
            r += 1.0f;
        return r + vec3(p[0], p[1], layers_clearcoat_NdotV(m, V));
    }
    if (which == 61)
        return layers_punctual(m, probe_L(u), V, light_point(vec3(3.0f, 1.0f, 2.0f), vec3(100.0f), 0.0f),
                               energy, t, 0.2f);
    LayerLight light;
    light.specular = vec3(3.0f, 1.0f, 0.2f);
    light.irradiance_over_pi = vec3(0.5f, 0.7f, 1.0f);
    light.irradiance_back_over_pi = vec3(0.2f, 0.1f, 0.3f);
    light.clearcoat = vec3(1.0f, 2.0f, 3.0f);
    light.sheen = vec3(0.3f, 0.2f, 0.1f);
    light.transmitted = vec3(1.0f, 0.5f, 0.7f);
    return layers_ibl(m, V, t, light, energy) + probe_layer_ibl_parts(m, V, energy, t, light);
}

FN PhongMaterial probe_phong_material(float shininess)
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
FN vec3 probe_phong_lit(vec2 u)
{
    PhongRules r = phong_rules(int(u[0] * 4.0f));
    PhongMaterial m = probe_phong_material(64.0f * u[1]);
    vec3 P = vec3(4.0f * u[0] - 2.0f, 0.3f, -5.0f);
    vec3 V = normalize(-P);
    vec3 N = phong_normal(r, normalize(vec3(u[1] - 0.2f, 0.4f, 0.3f - u[0])), V, u[1] < 0.5f);
    mat3 view = basis_from_normal(probe_L(u));
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

/* Every type and mode. */
FN vec3 probe_phong_texture(vec2 u)
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

/* Every mode in both forms. */
FN vec3 probe_phong_fog(vec2 u)
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

FN vec3 probe_phong(int which, vec2 u)
{
    vec3 V = probe_V(u);
    vec3 L = probe_L(u);
    vec3 N = vec3(0.0f, 0.0f, 1.0f);
    float s = 0.5f + 128.0f * u[0];
    if (which == 63)
        return probe_phong_lit(u);
    if (which == 64) /* 1: with a driver's log2 near 1 a lobe is exact to 3e-6, absolutely */
        return 1.0f +
               phong_reflection(N, V, L, vec3(0.3f, 0.5f, 0.8f), vec3(1.0f, 0.5f, 0.2f), 128.0f * u[1]) +
               phong_view(phong_rules(PHONG_VIGNETTE), V) +
               vec3(phong_NdotH(N, V, L), phong_power(u[0] - 0.5f, 10.0f * u[1]), phong_halo(0.3f, u[0]));
    if (which == 65)
        return probe_phong_texture(u);
    if (which == 66) {
        vec2 uv = phong_sphere_map(normalize(vec3(u[0] - 0.5f, u[1] - 0.5f, 0.4f)), V);
        return vec3(uv[0], uv[1], 1.0f);
    }
    if (which == 67)
        return probe_phong_fog(u);
    return brdf_blinn_phong(vec3(0.04f, 0.5f, 1.0f), u[1], s) + phong_specular_from_F0(vec3(u[0]), s) +
           vec3(alpha_from_shininess(s), shininess_from_alpha(u[0] + 0.05f), D_BlinnPhong(u[1], s)) +
           vec3(blinn_phong_normalisation(s), blinn_phong_normalisation_linear(s), 0.0f);
}

FN vec3 probe_pixel(int which, vec2 u)
{
    if (which == 69) {
        vec2 p = sobol_point(uint(u[0] * 4096.0f), hash_uint(uint(u[1] * 4096.0f)));
        uint d =
            owen_scramble(sobol_second(reverse_bits(uint(u[1] * 4096.0f))), hash_uint(uint(u[0] * 4096.0f)));
        vec2 q = sobol_scrambled(sobol_order(sobol_shuffle(d, 77u), 0x1f050301u), d);
        return vec3(p[0] + q[0], p[1] + q[1], float(d >> 8u) * (1.0f / 16777216.0f));
    }
    int kind = which - 70;
    FilterSample s = sample_pixel_filter(kind, u);
    return vec3(s.offset[0], s.offset[1], s.weight) + pixel_filter(kind, 3.0f * u - 1.5f) +
           vec3(blackman_harris(2.0f * u[0]), blackman_harris_step(0.5f * u[0], 0.5f * u[1]),
                mitchell(2.0f * u[1])) +
           vec3(sample_blackman_harris(u[1]), sample_mitchell(u[0])[1], sample_mitchell_positive(u[1])) +
           vec3(sample_mitchell_negative(u[0]), 0.0f, 0.0f);
}

/* Surfaces of which some lobes are mirrors. */
FN Layers probe_path_layers(vec2 u)
{
    Layers m = probe_layers(u);
    if (fract(u[1] * 16.0f) < 0.3f) {
        m.base.alpha = 0.0f;
        m.clearcoat_roughness = 0.0f;
        m.anisotropy = 0.0f;
    }
    return layers_with_wavelength(m, 400.0f + 300.0f * u[0]);
}
FN vec3 probe_sampled(LayersSample s)
{
    float flags = sel(s.is_mirror, 1.0f, 0.0f) + sel(s.is_through, 2.0f, 0.0f) + sel(s.is_valid, 4.0f, 0.0f);
    return 2.0f + s.L + s.weight + vec3(flags, s.pdf * 0.1f, 0.0f);
}
FN vec3 probe_lobes(LayersLobes p)
{
    return vec3(p.clearcoat + 2.0f * p.sheen, p.specular + 2.0f * p.diffuse,
                p.transmission + 2.0f * p.diffuse_back);
}

/* The parts of layers_sample(). */
FN vec3 probe_path_parts(Layers m, LayersLobes p, vec3 V, vec2 u, int energy, LayerTables t)
{
    mat3 frame = layers_any_frame(m);
    vec3 L = normalize(probe_L(u));
    vec3 below = mirror_through(L, m.base.N);
    float mirrors =
        sel(layers_specular_is_mirror(m), 1.0f, 0.0f) + sel(layers_transmission_is_mirror(m), 2.0f, 0.0f) +
        sel(layers_clearcoat_is_mirror(m), 4.0f, 0.0f) + sel(is_mirror_alpha(vec2(u[0], 1e-5f)), 8.0f, 0.0f) +
        sel(is_mirror_refraction(vec2(1e-3f, 1e-5f), 1.0f + u[0]), 16.0f, 0.0f);
    BoundaryWeights b = layers_boundary_albedo(m, surface_NdotV(m.base, V), energy, t);
    return mul(frame, L) + view_above(m.base.N, -V) + layers_V_local(m, V) + b.specular + b.below +
           vec3(mirrors, float(layers_scattering_lobes(m)),
                layers_below_coat(m, V) * layers_below_sheen(m, t)) +
           vec3(layers_specular_pdf(m, V, m.base.N), layers_transmission_pdf(m, V, below),
                layers_clearcoat_pdf(m, V, L)) *
               0.1f +
           probe_lobes(lobes_normalised(p)) + probe_lobes(layers_lobes_plain(m, energy, t)) +
           lobe_excess(u[0]) + lobe_probability(u[1], 0.8f) +
           vec3(pdf_reflection(m.base.N, V, m.base.N, 0.3f),
                pdf_reflection_anisotropic(layers_V_local(m, V), vec3(0.0f, 0.0f, 1.0f), vec2(0.3f, 0.6f)),
                0.0f);
}

/* Both kinds of boundary of glass.h, in ENERGY_CONSERVING. */
FN vec3 probe_glass(Layers m, vec3 V, vec2 u)
{
    m.layers = m.layers | LAYER_TRANSMISSION;
    LayerTables t = probe_layer_tables(m, V, ENERGY_CONSERVING, u);
    ExactBoundary b = exact_boundary(m, t);
    vec3 point = layers_glass_point(m, V, ENERGY_CONSERVING);
    float exact =
        sel(layers_is_exact(m, ENERGY_CONSERVING), 1.0f, 0.0f) + sel(layers_is_coupled(m), 2.0f, 0.0f);
    float NdotV = surface_NdotV(m.base, V);
    BoundaryWeights w = layers_boundary_albedo_conserving(m, NdotV, t);
    BoundaryWeights g = layers_boundary_albedo_gltf(m, NdotV, t);
    return b.R + b.scale + b.through + point + layers_F_exact(m, 0.3f + 0.7f * u[0]) + w.specular +
           g.specular +
           vec3(exact + layers_fresnel_eta(m),
                w.through + g.through + layers_mirror_through(m, w, layers_V_local(m, V), -V, ENERGY_GLTF, t),
                layers_reflection_share(m, u[0])) +
           layers_glass_bound(vec3(u[0], 0.9f, 0.8f), vec2(0.5f, 0.2f), vec2(0.6f, 0.2f), vec2(0.3f, 0.2f),
                              m.eta) +
           layers_coupled_pdf(m, V, sel(u[0] > 0.5f, m.base.N, -V)) * 0.1f;
}
FN vec3 probe_boundary(vec2 u)
{
    float eta = sel(u[0] < 0.5f, 1.2f + u[1], 1.0f / (1.2f + u[1]));
    float c = 0.2f + 0.7f * u[1];
    GlassAlbedo s = glass_albedo_sample(uint(u[0] * 64.0f), 64u, 0.3f, c, eta);
    GlassAlbedo a = glass_albedo(0.1f, 0.8f, eta, 0.9f, vec3(0.1f + 0.3f * u[0], 0.95f, 0.8f));
    return F_boundary(vec3(0.04f, 0.1f, 0.2f), vec3(0.9f), c, eta) +
           integrate_glass(0.2f + 0.8f * u[0], 0.3f + 0.6f * u[1], 1.5f, 16u) +
           vec3(dielectric_weight(c, eta) + s.E + s.R, s.T + s.through, glass_compensation(a) + a.R + a.T) +
           smooth_glass(c, eta) + sel(is_total_reflection(c, eta), 1.0f, 0.0f);
}

FN vec3 probe_paths(int which, vec2 u)
{
    vec3 V = probe_V(u);
    float alpha = 0.2f + 0.6f * u[1];
    if (which == 80)
        return probe_boundary(u);
    if (which == 81)
        return probe_glass(probe_layers(u), V, u);
    if (which == 73) {
        WavelengthSample w = sample_wavelength(u[0]);
        return w.weight + vec3(w.wavelength_nm * 0.01f, float(w.channel), 0.0f);
    }
    if (which == 74)
        return 1.0f + sample_bounded_VNDF_GGX(u, V, alpha, 0.5f) +
               vec3(bounded_VNDF_k(V[2], alpha, 0.5f),
                    pdf_bounded_reflection(V, normalize(V + probe_L(u)), alpha, 0.5f), 0.0f);
    if (which == 75)
        return 1.0f + sample_sheen_rim(u, u[0], alpha) +
               vec3(sheen_rim_width(u[0], alpha), pdf_sheen_rim(u[1], u[0], alpha), 0.0f);
    Layers m = probe_path_layers(u);
    int energy = ENERGY_GLTF;
    if (fract(u[1] * 8.0f) > 0.5f)
        energy = ENERGY_CONSERVING;
    LayerTables t = probe_layer_tables(m, V, energy, u);
    LayersLobes p = layers_lobes(m, V, energy, t);
    if (which == 76)
        return probe_lobes(p) + layers_pdf(m, p, V, sel(u[0] > 0.5f, probe_L(u), -probe_L(u)));
    if (which == 77)
        return layers_scatter_cos(m, V, sel(u[0] > 0.5f, probe_L(u), -probe_L(u)), energy, t, 0.2f);
    if (which == 78)
        return probe_path_parts(m, p, V, u, energy, t);
    vec2 turned = vec2(u[1], u[0]);
    if (which == 79)
        return probe_sampled(layers_sample(m, p, V, fract(u[0] * 5.0f), turned, energy, t));
    p.clearcoat = 0.3f; /* each lobe is there */
    p.specular = 0.4f;
    p.transmission = 0.2f;
    return probe_sampled(layers_mirror(m, p, V, u[0] > 0.4f, energy, t)) + probe_sampled(no_sample(V)) +
           probe_sampled(layers_clearcoat_mirror(m, p, V)) + layers_draw_clearcoat(m, V, u) +
           layers_draw_sheen(m, V, u) + layers_draw_boundary(m, V, u[1], 0.5f, turned);
}

FN Atmosphere probe_air(vec2 u)
{
    Atmosphere a = atmosphere_earth(int(u[0] * 2.99f));
    return atmosphere_with_haze(a, haze_depth_from_turbidity(1.0f + 4.0f * u[1]), 0.6f, 0.9f, 0.7f);
}

/* A place and directions in the air: height, mu, that of the sun. */
FN vec3 probe_place(vec2 u)
{
    return vec3(0.1f + 60.0f * u[0] * u[0], 2.0f * u[1] - 1.0f, 1.8f * fract(7.0f * u[0]) - 0.9f);
}

FN vec3 probe_rays(vec2 u)
{
    vec3 p = probe_place(u);
    float t = 5.0f + 30.0f * u[1];
    float there = ray_height(p[0], p[1], t);
    return vec3(there + ray_mu(p[0], p[1], t, there), ray_mu_sun(p[0], t, p[2], 0.3f, there) + 2.0f,
                horizon_mu(p[0]) + 2.0f) +
           vec3(ray_to_top(p[0], p[1]) * 0.01f + height_square(p[0]) * 1e-5f,
                ray_share(3.0f, 8.0f) + sun_visibility(p[0], horizon_mu(p[0]) + 0.01f * (u[1] - 0.5f)),
                sel(p[1] < horizon_mu(p[0]) - 0.01f, ray_to_ground(p[0], p[1]) * 0.01f, 0.0f));
}

FN vec3 probe_sky_tables(int which, vec2 u)
{
    vec3 p = probe_place(u);
    vec2 column = column_table_place(p[0], p[1]);
    vec2 bounce = bounce_table_place(p[0], p[2]);
    if (which == 87)
        return vec3(column[0], column[1], table_share(table_coordinate(u[0], 32.0f), 32.0f)) + 1.0f +
               vec3(bounce[0], bounce[1], 0.0f);
    vec2 ray = column_table_ray(u);
    vec2 sun = bounce_table_ray(u);
    float angle = sky_view_zenith_angle(p[0], 2.0f * u[1] - 1.0f);
    return air_column(ray[0], 0.05f + 0.95f * u[1], 8) * 0.01f +
           vec3(ray[0] * 0.01f, ray[1] + 2.0f, sun[0] * 0.01f) +
           vec3(sun[1], angle + sky_view_row(p[0], 0.1f + 2.9f * u[0]), 3.0f) +
           vec3(sky_turned(u[0])[0] + sky_turned(u[0])[1], sky_turn(u[0] - 0.5f, 0.01f + u[1]),
                sky_row(u[0]) + sky_rise(u[1]));
}

FN vec3 probe_air_light(int which, vec2 u)
{
    Atmosphere a = probe_air(u);
    vec3 p = probe_place(u);
    vec3 density = air_density(p[0] * 0.3f);
    vec3 sun = table_sun(a, vec3(10.0f, 2.0f, 20.0f) * u[1], p[0], p[2]);
    AirField field = air_field(vec3(0.1f, 0.2f, 0.3f), vec3(-0.05f * u[0]), vec3(0.02f), vec3(0.1f * u[1]));
    float sunward = sunward_part(p[1], p[2], 0.9f * u[0]);
    AirLight s = air_light_step(a, air_light_none(), density, 2.0f, sun, field, p[1], sunward);
    s = air_light_step(a, s, density, 20.0f * u[0], sun, field, p[1], 0.5f);
    if (which == 89)
        return air_radiance(a, s, p[1]) + s.transmittance + air_field_rayleigh(field, p[1]) +
               air_field_haze(air_field_even(vec3(0.3f)), p[1], sunward, 0.7f) +
               air_path(air_extinction(a, density), 3.0f * u[1]) * 0.1f + air_path1(0.1f, u[0]) +
               haze_forward_share(a);
    AirBounce b = air_bounce_add(a, air_bounce_none(), s, p[1], sunward, p[2], sun, 0.5f);
    AirField all = air_bounce_field(b);
    return 1.0f + all.mean + all.P2 + all.up + all.sunward + legendre_P2(p[1]);
}

FN vec3 probe_sky(int which, vec2 u)
{
    Atmosphere a = probe_air(u);
    float turbidity = 2.0f + 6.0f * u[1];
    if (which >= 89)
        return probe_air_light(which, u);
    if (which >= 87)
        return probe_sky_tables(which, u);
    if (which == 86)
        return probe_rays(u);
    if (which == 85)
        return atmosphere_color(a, air_transmittance(a, vec3(20.0f, 3.0f, 30.0f) * u[0])) * 1e-5f +
               phase_rayleigh(u[1]) + 3.0f;
    PreethamSky s = preetham_sky(turbidity, 1.4f * u[0]);
    if (which == 84)
        return preetham_Yxy(s, 0.05f + 0.9f * u[1], 0.9f - 1.8f * u[0]) * vec3(1e-4f, 1.0f, 1.0f) +
               preetham_zenith(turbidity, 1.4f * u[0]) * vec3(1e-4f, 1.0f, 1.0f);
    return preetham_sun(a, turbidity, 1.5f * u[0]) + preetham_radiance(s, 0.3f, 0.5f) * 1e-4f +
           preetham_F(s, 0.5f, u[1]) + rec709_from_Yxy(vec3(1.0f, 0.3f + 0.1f * u[0], 0.33f));
}

/* A frame of a texture coordinate, of which one corner of the domain has none. */
FN ShadingFrame probe_texcoord_frame(vec2 u)
{
    vec2 uv1 = vec2(0.9f, 0.2f * u[0]);
    vec2 uv2 = sel(u[0] > 0.97f, uv1, vec2(0.1f * u[1], sel(u[1] > 0.5f, 0.7f, -0.7f)));
    return frame_from_texcoord(vec3(0.1f, 0.2f, 1.1f), vec3(1.0f, 0.3f * u[0], 0.1f), vec3(-0.2f, 0.9f, u[1]),
                               uv1, uv2, sel(u[0] > 0.5f, 1.0f, -1.0f));
}

FN vec3 probe_frame(ShadingFrame f)
{
    return f.T + f.B * 0.1f + f.N * 0.01f + vec3(sel(frame_has_tangent(f), 2.0f, 3.0f));
}

FN MaterialFactors probe_factors(vec2 u)
{
    MaterialFactors f;
    f.metallic = 0.7f;
    f.perceptual_roughness = 0.9f;
    f.ior = 1.0f + u[1];
    f.specular = 0.8f;
    f.specular_color = vec3(0.9f, 0.5f, 0.3f);
    f.glossiness = 0.6f;
    f.occlusion_strength = 0.5f;
    f.emissive = vec3(1.0f, 2.0f, 0.5f);
    return f;
}

FN vec3 probe_surface_sum(Surface s)
{
    return s.base_color + s.F0 + s.emissive * 0.1f +
           vec3(s.metallic, s.perceptual_roughness + s.alpha, s.occlusion * 0.5f + s.F90);
}

FN Layers probe_material_layers(vec2 u, vec3 texel)
{
    Layers m = layers_from_surface(
        surface_from_metallic_roughness(normalize(vec3(0.1f, 0.05f, 1.0f)), vec3(0.5f), 0.2f, u[1]));
    m = with_ior(m, 1.2f + u[0], u[1] > 0.5f);
    m = with_clearcoat(m, 0.7f, 0.9f, texel, texel);
    m = with_sheen(m, vec3(0.4f, 0.5f, 1.2f), 0.8f, texel, u[1]);
    m = with_iridescence(m, 0.9f, 1.4f, 100.0f, 400.0f, texel, texel);
    m = with_transmission(m, 0.6f, texel);
    m = with_diffuse_transmission(m, 0.5f, vec3(0.3f, 0.6f, 0.9f), u[0], texel);
    m = with_volume(m, 0.3f, texel, vec3(0.9f, 0.8f, 0.7f), 2.0f, 0.4f);
    m = with_scatter(m, vec3(0.2f, 0.5f, 1.4f), 0.3f);
    return with_anisotropy(m, anisotropy_strength(0.8f, texel), u[1], texel, probe_texcoord_frame(u));
}

FN vec3 probe_material(int which, vec2 u)
{
    vec3 texel = vec3(u[0], u[1], fract(3.0f * u[0] + u[1]));
    vec3 texel_or_white = sel(u[1] > 0.9f, vec3(1.0f), texel);
    vec3 N = normalize(vec3(0.1f, 0.05f, 1.0f));
    if (which == 91) {
        vec2 uv = texcoord_transform(u, vec3(0.5f, -0.2f, 0.1f), vec3(0.3f, 0.6f, 0.2f));
        int mode = int(u[0] * 2.99f);
        return material_base_color(vec3(0.5f, 0.6f, 0.7f), texel, vec3(0.9f, 0.8f, u[1])) +
               vec3(uv[0] + 1.0f, uv[1] + 1.0f, material_coverage(mode, 1.5f * u[1], 0.5f) + 1.0f);
    }
    vec3 n = normal_from_texel(texel_or_white, 0.7f);
    ShadingFrame tangents =
        frame_from_tangent(N * 1.1f, vec3(0.9f, 0.2f, 0.1f), -1.0f, sel(u[0] > 0.5f, 1.0f, -1.0f));
    if (which == 92)
        return probe_frame(tangents) + probe_frame(probe_texcoord_frame(u)) + frame_normal(tangents, n, N) +
               normalize_or(n, N) + 3.0f;
    MaterialFactors f = probe_factors(u);
    if (which == 93)
        return probe_surface_sum(material_surface(f, N, texel, texel, u[0], texel, u[1], texel)) +
               probe_surface_sum(material_surface_glossy(f, N, texel, texel, u[1], u[0], texel));
    Surface wide = surface_specular_aa(material_surface(f, N, texel, texel, u[0], texel, u[1], texel),
                                       vec3(0.1f * u[0], 0.0f, 0.2f), vec3(0.0f, 0.3f * u[1], 0.0f));
    if (which == 94)
        return probe_surface_sum(wide) + vec3(roughness_specular_aa(u[0], N * 0.1f, N * u[1]), 0.0f, 0.0f);
    Layers m = probe_material_layers(u, texel_or_white);
    vec2 turn = anisotropy_texel_direction(texel_or_white);
    return 2.0f + m.sheen_color + m.diffuse_transmission_color + m.attenuation_color + m.multiscatter_color +
           m.anisotropy_T * 0.5f + m.anisotropy_B * 0.1f +
           vec3(m.clearcoat + m.clearcoat_roughness + m.sheen_roughness, m.iridescence + m.iridescence_ior,
                m.iridescence_thickness_nm * 0.01f + m.transmission + m.diffuse_transmission) +
           vec3(m.thickness + m.attenuation_distance * 1e-6f, m.dispersion + m.scatter_anisotropy,
                m.ior + m.eta) +
           vec3(m.anisotropy + turn[0], float(m.layers) * 0.01f + turn[1], 0.0f);
}

FN vec3 probe_footprint(int which, vec2 u)
{
    vec2 size = vec2(512.0f, 300.0f);
    Footprint f = footprint_from_derivatives(size, vec2(0.001f + 0.02f * u[0], 0.004f * u[1]),
                                             vec2(-0.003f * u[1], 0.001f + 0.006f * u[0] * u[1]));
    if (which == 96)
        return vec3(sqrt(f.longest2), sqrt(f.major2) + sqrt(max(f.minor2, 0.0f) + 1.0f),
                    length(vec2(f.axis_u, f.axis_v)) / f.major2 + sel(footprint_is_finite(f), 1.0f, 2.0f));
    ProbeRow p = footprint_probes(f, 1.0f, 1.0f / size);
    return vec3(float(p.count), sqrt(p.width2), 1.0f + length(vec2(p.step_u, p.step_v) * size));
}

/* Each lobe by itself, as the columns of u have it. */
FN vec3 probe_alone(int which, vec2 u)
{
    vec3 V = probe_V(u);
    Layers m = probe_path_layers(u);
    int energy = ENERGY_GLTF;
    if (fract(u[1] * 8.0f) > 0.5f)
        energy = ENERGY_CONSERVING;
    LayerTables t = probe_layer_tables(m, V, energy, u);
    int lobe = int(u[0] * 4.99f);
    if (which == 98)
        return 1.0f + layers_ibl_alone(m, V, t, layer_light_of(vec3(0.5f, u[0], 1.0f)), energy, lobe);
    Light l = light_point(probe_L(u) * sel(u[1] > 0.3f, 2.0f, -2.0f), vec3(3.0f, 2.0f, 1.0f), 0.0f);
    return 1.0f + layers_punctual_alone(m, vec3(0.0f), V, l, energy, t, 0.2f, lobe) +
           layers_brdf_cos_alone(layers_without_diffuse(m), V, probe_L(u), energy, t, 0.2f, lobe) +
           vec3(schlick_GGX_over_smith(u[0], u[1], 0.5f), 0.0f, 0.0f);
}

/* A sea, seen from above. */
FN vec3 probe_up(vec3 v)
{
    return vec3(v[0], v[2], v[1]);
}
FN vec3 probe_slopes(vec2 u)
{
    return vec3(0.01f + 0.03f * u[0], 0.02f + 0.01f * u[1], 0.005f * u[0]);
}
FN vec3 probe_sea(int which, vec2 u)
{
    int normals = int(u[0] * 1.99f);
    vec3 C = probe_slopes(u);
    vec3 N = normal_from_slope(vec2(0.2f * u[0], -0.3f * u[1]));
    vec3 V = probe_up(probe_V(u));
    vec3 L = probe_up(probe_L(u));
    vec3 H = normalize(V + L);
    if (which == 100)
        return vec3(slope_density(normals, C, vec2(0.3f * u[1], -0.1f)),
                    D_slopes(normals, C, N, H) + D_sun(normals, C, sun_slopes(L, V), N, H),
                    1.0f + slope_variance(C, slope_from_normal(H)));
    if (which == 101)
        return vec3(Lambda_Beckmann(0.1f + 2.0f * u[0]), Lambda_GGX(0.1f + 2.0f * u[0]),
                    Lambda_slopes(normals, smith_a(C, N, V)) + erfcx(u[1]) +
                        tilts_seen(2.0f * u[1], 3.0f * u[0]) + slopes_seen(C, N, H, V) +
                        0.1f * inverse_normal(u[1]));
    if (which == 102)
        return vec3(V_slopes(normals, WATER_SMITH, C, N, N, V) + V_slopes(normals, WATER_SCALES, C, N, N, V),
                    V_slopes(normals, WATER_SCHLICK_KARIS, C, N, N, V),
                    glitter(normals, WATER_SCALES, C, N, L, V, u[1]) +
                        glitter_below(normals, C, N, L, -refract(-V, N, 0.75f), 1.34f));
    if (which == 103)
        return 4.0f + sample_slopes(u, C, N, V) + sun_slopes(L, V) * 1e4f +
               sun_slopes_about(L, L + N) * 1e4f +
               sun_density(normals, C * (1e-4f * u[1]), sun_slopes(L, V), vec2(0.002f * u[0], 0.001f)) *
                   1e-5f +
               slopes_from_roughness(u[1]) + roughness_from_slopes(C);
    if (which == 104) {
        vec2 pair = water_table_pair(water_table_place(u[0], 0.4f * u[1]));
        return vec3(pair[0], pair[1], water_mean_fresnel_fit(u[0], 0.3f * u[1], 1.34f)) + 0.1f;
    }
    if (which == 105)
        return raised_reflection(N, V, 0.3f * u[0]) + 2.0f +
               vec3(sigma_towards(C, N, V), roughness_from_spread(0.33f * u[1]), 0.0f);
    WaterMeans m =
        integrate_water_means(normals, int(u[1] * 1.99f), 0.05f + 0.9f * u[0], 0.05f + 0.3f * u[1], 1.34f, 6);
    if (which == 106)
        return vec3(m.fresnel, m.escape, 1.0f + m.lift);
    if (which == 107)
        return vec3(m.spread, m.below + 1.0f, m.elevation);
    if (which == 108)
        return vec3(glint_count(normals, C, sun_slopes(L, V), N, H, 5000.0f, 0.01f, u[0]) + 0.1f,
                    gamma_variate(1.0f + 9.0f * u[0], 4.0f * u[1] - 2.0f),
                    glint_uniform(glint_hash(uint(u[1] * 4096.0f))) +
                        glint_uniform(glint_hash2(uint(u[0] * 4096.0f), uint(u[1] * 4096.0f))));
    GlintCell cell = glint_cell(u * 7.3f, vec2(0.3f, 0.0113f + u[0]), 2.0f * u[1]);
    if (which == 109)
        return vec3(glint_uniform(cell.key), 5.0f + glint_normal(cell.key),
                    1.0f + glint_sum(cell.key, 12.0f * u[1]));
    vec2 place = glint_place(u - 0.3f);
    vec2 extent = glint_extent(place, 0.01f, 0.3f + u[1]);
    return vec3(5.0f + glint_image(cell, 77u) + place[1], extent[0] + extent[1] + cell.area,
                1.0f + glint_seen(vec2(3.0f, 4.0f), 0.3f, 0.7f, 2.0f + 100.0f * u[1], 3.7f, 0.02f) +
                    glint_variate(cell, 2.0f + 100.0f * u[1], 3.7f, 0.02f));
}

FN vec3 probe_water(int which, vec2 u)
{
    Water w;
    w.ior = 1.3f + 0.05f * u[0];
    w.absorption = vec3(0.33f, 0.06f, 0.02f + 0.1f * u[1]);
    w.scattering = vec3(0.09f, 0.11f, 0.14f);
    w.backscattering = vec3(0.002f, 0.003f, 0.005f);
    w.reflectance = vec3(0.0f, 0.006f, 0.024f);
    w.pure_share = vec3(0.01f, 0.02f, 0.03f);
    w.sky_reflectance = 0.06f;
    w.foam_albedo = 0.5f;
    w.normals = WATER_BECKMANN;
    w.masking = WATER_SCALES;
    w.is_schlick = int(u[1] * 1.99f);
    WaterPoint p;
    p.N = normal_from_slope(vec2(0.2f * u[0], -0.3f * u[1]));
    p.covariance = probe_slopes(u);
    p.foam = 0.2f * u[1];
    vec3 V = probe_up(probe_V(u));
    WaterLight light;
    light.L = probe_up(probe_L(u));
    light.sun_irradiance = vec3(5.0f, 4.0f, 3.0f);
    light.sky_irradiance = vec3(1.0f, 2.0f, 3.0f);
    light.sun_fresnel = 0.1f;
    light.downwelling = water_downwelling(w, light);
    if (which == 111) {
        vec3 d = water_refracted(w, -V, p.N);
        return d + 2.0f + water_sun(w, p, light, V) + water_sun_below(w, p, light, -d) +
               vec3(water_fresnel(w, u[0]), water_fresnel_inside(w, 0.7f + 0.3f * u[1]), 0.0f);
    }
    if (which == 112) {
        WaterBed bed;
        bed.albedo = vec3(0.5f, 0.4f, 0.3f);
        bed.mean_albedo = vec3(0.4f);
        bed.depth = 20.0f * u[0];
        bed.way = bed.depth * 1.2f;
        vec3 R = water_bed_reflectance(w, bed.mean_albedo, bed.depth);
        return water_from_bed(w, water_interreflected(w, light.downwelling, R), bed) + R +
               water_deep_reflectance(w) + water_slab(vec3(5.0f * u[1])) + water_internal_reflectance(w) +
               water_foam_below(w, light, R) + water_beam(w) + water_diffuse(w) + water_K_d(w) +
               water_from_deep(w, light.downwelling) + water_transmittance(w.absorption, u[1]);
    }
    if (which == 113)
        return water_single_scattering(w, light.sun_irradiance, u[0], 0.9f, 0.7f, 5.0f * u[1]) +
               water_phase(w, u[1]) + water_phase_pure(u[0]);
    if (which == 114)
        return water_forward(w, 2.0f * u[0] - 1.0f, u[1], 0.7f) + water_sunlit_slope(u[0], 0.1f * u[1]) +
               water_foam(w, light, p.N);
    vec3 down = -V;
    if (which == 115) {
        vec3 d = normalize(vec3(u[0] - 0.5f, 1.0f, u[1] - 0.3f));
        WaterWindow window = water_window(w, d, p.N);
        return window.mirrored + window.outside * 0.1f +
               vec3(2.0f + window.fresnel, 2.0f + window.gain, 2.0f) +
               water_inscatter(w, light.downwelling, 3.0f, down, 20.0f * u[1]) +
               water_mean_left(vec3(0.0f), down * u[0]) +
               water_sun_glow(w, water_beam_below(w, light), normalize(vec3(0.3f, 1.0f, 0.1f)), 2.0f, d,
                              10.0f * u[0]) +
               vec3(water_mean_left1(5.0f * u[0], 4.0f * u[1]), water_glow_phase1(9.0f * u[0], 0.1f, u[1]),
                    0.0f);
    }
    WaterMirror m = water_mirror(w, p, V, 0.9f, 0.95f, 0.1f * u[0], 0.3f * u[1]);
    vec3 before = before_shade(int(u[0] * 1.99f), int(u[1] * 2.99f), down, p.N, BEFORE_SUN_DIRECTION, u[0],
                               u[1], before_foam(u[0]), 1.33f, 0.3f);
    return m.R + m.perceptual_roughness + before_display(before) + before_sky(V) +
           before_highlight(1, p.N, V, light.L, 1.33f, 0.1f) +
           water_radiance(water_parts(w, p, light, m, vec3(1.0f, 2.0f, 3.0f), vec3(0.5f), light.downwelling));
}

FN Water probe_clear_water(vec2 u)
{
    Water w;
    w.ior = 1.34f;
    w.absorption = vec3(0.33f, 0.06f, 0.02f + 0.1f * u[1]);
    w.scattering = vec3(0.09f, 0.11f, 0.14f);
    w.backscattering = vec3(0.002f, 0.003f, 0.005f);
    w.reflectance = vec3(0.001f, 0.006f, 0.024f);
    w.pure_share = vec3(0.01f, 0.02f, 0.03f);
    w.sky_reflectance = 0.06f;
    w.foam_albedo = 0.5f;
    w.normals = WATER_BECKMANN;
    w.masking = WATER_SCALES;
    w.is_schlick = 0;
    return w;
}

FN vec3 probe_water_place(int which, vec2 u)
{
    Water w = probe_clear_water(u);
    WaterLight light;
    light.L = probe_up(probe_L(u));
    light.sun_irradiance = vec3(5.0f, 4.0f, 3.0f);
    light.sky_irradiance = vec3(1.0f, 2.0f, 3.0f);
    light.sun_fresnel = 0.1f;
    light.downwelling = water_downwelling(w, light);
    vec3 V = probe_up(probe_V(u));
    vec3 C = probe_slopes(u);
    vec3 D = vec3(0.3f * u[0], -0.2f * u[1], 0.1f);
    vec3 N = water_faced(wave_normal(vec2(0.4f * u[1], -0.3f), D), V);
    if (which == 117) {
        vec2 place =
            sel(abs(u[0] + u[1] - 1.0f) < 1e-3f, vec2(0.4f, 0.3f), u); /* its rhombus has an edge there */
        return wave_patch_weights(place) + wave_cubic_weights(u[0]) + N + water_seen_normal(C, N, V) +
               water_tilted(N, C, V) + 2.0f +
               vec3(water_seen_cosine(V, C), 0.0f, water_footprint(u[0], V[1] * u[1], 0.3f));
    }
    if (which == 118) {
        WaterMirror m;
        m.fresnel = 0.5f;
        m.escape = 0.8f;
        m.R = reflect(-V, N);
        m.perceptual_roughness = 0.2f;
        m.deviation = 0.1f + 0.2f * u[0];
        return vec3(1.0f + foam_share(0.6f * u[0] - 0.1f, 0.01f + 0.05f * u[1], 0.4f),
                    2.0f * water_foam_cover(0.5f * u[1], u[0]) + normal_below(3.0f * u[0] - 1.5f) +
                        foam_lace(0.05f + 0.9f * u[0], u[1], 0.3f),
                    water_passing(C, N, light.L) + wave_jacobian(D)) +
               water_mirror_passing(m, C, N).R * water_mirror_passing(m, C, N).escape;
    }
    vec3 down = water_refracted(w, -V, N);
    vec3 sunward = normalize(vec3(0.3f, 1.0f, 0.1f));
    if (which == 120) {
        vec3 beam = water_beam_below(w, light);
        return water_bed_returned(w, vec3(0.4f), 9.0f * u[0]) +
               water_bed_lit(water_focused(w, vec3(0.4f), light.downwelling, beam, sunward[1], 9.0f * u[0]),
                             3.0f * u[1], 0.5f + 0.5f * u[0]) +
               vec3(water_bed_footprint(w, N, V, down, C, u[0], 4.0f * u[1]),
                    caustic_cover(vec2(2.0f * u[0] - 1.0f, 0.1f)),
                    caustic_lod(9.0f * u[1]) + water_mirrored_spread(C));
    }
    vec3 low = normalize(vec3(-V[0], 0.05f + 0.3f * u[1], -V[2]));
    light.L = low;
    WaterCrest crest = water_crest_beam(w, light, 0.05f, 0.1f + u[1], 1.5f);
    vec3 back = normal_from_slope(vec2(low[0], low[2]) * 0.4f * u[0]);
    vec2 level = normalize(vec2(low[0], low[2]));
    vec3 into = water_refracted(w, -V, back);
    float way = water_crest_way(crest, level, into, 0.5f + u[0], 0.5f * u[1]);
    return water_crest(w, light, crest, back, V, into, u[0]) + 0.1f + 0.1f * way +
           water_crest_lit(w, crest, level, 0.3f * u[1], into, 1.4f * u[0]) +
           water_over_bed(w, light.downwelling, vec3(0.5f, 0.4f, 0.3f), vec3(0.4f, 0.4f, 0.2f), 9.0f * u[0],
                          0.1f * u[1], down) +
           0.1f * water_way_to_bed(9.0f * u[0], 0.1f * u[1], down) +
           0.1f * water_bed_depth(9.0f * u[0], 0.1f, u[1]) + water_land(light, vec3(0.5f), N) +
           water_through(w, light.downwelling, vec3(3.0f), sunward, vec3(1.0f), 2.0f * u[0], -V,
                         4.0f * u[1]) +
           water_surface_through(w, light.downwelling, vec3(3.0f), sunward, vec3(1.0f), vec3(2.0f),
                                 2.0f * u[0], -V, 4.0f * u[1]) +
           water_bed_below(w, light.downwelling, vec3(0.4f), u[0]) +
           water_bed_through(w, light.downwelling, vec3(2.0f), 9.0f * u[0]) +
           painted_water(light, N, V, 1.34f, 0.1f + u[0], painted_mirror(N, V)) +
           water_unscattered(w, 20.0f * u[1]);
}

FN vec3 probe_facets(int which, vec2 u)
{
    Water w = probe_clear_water(u);
    vec3 V = probe_up(probe_V(u));
    vec3 C = probe_slopes(u);
    vec3 N = water_faced(wave_normal(vec2(0.4f * u[1], -0.3f), vec3(0.3f * u[0], -0.2f * u[1], 0.1f)), V);
    FacetRange all = facets_seen(C, N, V);
    if (which == 121) {
        vec3 low = vec3(-1.0f, -0.5f, -9.0f);
        FacetRange r = facets_that_mirror(C, N, V, low, vec3(1.0f + u[0], 2.0f, -6.0f - u[1]));
        Facet f = facet_drawn(all, N, u);
        vec2 place = facet_place(r, N, f.m);
        return f.m + vec3(f.weight + facets_share(r), r.low[0] + r.high[1], 0.1f * (place[0] + place[1])) +
               10.0f;
    }
    if (which == 122) {
        vec3 low = vec3(-1.0f, 0.5f, -9.0f);
        FacetRange r = facets_that_bend(C, N, V, low, vec3(1.0f + u[0], 3.0f, -6.0f), w.ior);
        bool is_wide = is_wide_box(vec3(1.0f, 0.0f, 0.0f), vec3(0.9f - 0.1f * u[0], 0.0f, 0.0f));
        FacetRange part = facets_about(all, -u, u, is_wide);
        return facet_that_bends(V, normalize(vec3(0.3f, 0.5f + u[0], u[1])), w.ior) +
               vec3(part.low[0], part.high[1], window_roughness(r, C)) +
               vec3(r.low[0], r.high[1], facets_share(r)) + 10.0f;
    }
    Facet f = facet_of_window(all, N, V, water_critical_cosine(w), int(u[0] * float(WINDOW_FACETS) * 0.999f));
    return f.m * f.weight + window_light(w, water_window(w, V, N), C, N, vec3(3.0f), vec3(0.5f)) +
           vec3(min(window_rim(all, N, V, 0.6f, u[1]), 9.0f), min(window_middle(all), 9.0f),
                min(window_part(all, window_edge(all, 1), 1), 9.0f) + window_mean(u[0] - 1.0f, u[1] + 0.3f)) +
           10.0f;
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
    if (which < 46)
        return probe_sheen(which, u);
    if (which < 51)
        return probe_films(which, u);
    if (which < 58)
        return probe_transmission(which, u);
    if (which < 63)
        return probe_layered(which, u);
    if (which < 69)
        return probe_phong(which, u);
    if (which < 73)
        return probe_pixel(which, u);
    if (which < 83)
        return probe_paths(which, u);
    if (which < 91)
        return probe_sky(which, u);
    if (which < 96)
        return probe_material(which, u);
    if (which < 98)
        return probe_footprint(which, u);
    if (which < 100)
        return probe_alone(which, u);
    if (which < 111)
        return probe_sea(which, u);
    if (which < 117)
        return probe_water(which, u);
    if (which < 121)
        return probe_water_place(which, u);
    return probe_facets(which, u);
}
