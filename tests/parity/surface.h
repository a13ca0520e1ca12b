/* surface.h - parity cases: lobes, surfaces and their sampling. */

/* ---- brdf.h ---- */

FN vec3 case_D_GGX(vec2 u)
{
    float alpha = alpha_from_roughness(0.2f + 0.8f * u[1]);
    vec3 V = parity_V(u);
    vec3 L = parity_L(u);
    vec3 H = normalize(V + L);
    vec3 N = vec3(0.0f, 0.0f, 1.0f);
    float alpha_y = 1.2f - alpha;
    return vec3(D_GGX(u[0], alpha), D_GGX_stable(H[2], cross(N, H), alpha),
                D_GGX_anisotropic(H, alpha, alpha_y));
}

FN vec3 case_Smith_GGX(vec2 u)
{
    float alpha = alpha_from_roughness(0.2f + 0.8f * u[1]);
    return vec3(smith_root_GGX(u[0], alpha), Lambda_SmithGGX(u[0], alpha), G1_SmithGGX(u[0], alpha));
}

FN vec3 case_V_SmithGGX(vec2 u)
{
    float alpha = alpha_from_roughness(0.2f + 0.8f * u[1]);
    vec3 V = parity_V(u);
    vec3 L = parity_L(u);
    float alpha_y = 1.2f - alpha;
    return vec3(V_SmithGGX(u[0], 0.3f, alpha), V_SmithGGX_separable(u[0], 0.3f, alpha),
                V_SmithGGX_anisotropic(L, V, alpha, alpha_y));
}

FN vec3 case_V_SchlickGGX(vec2 u)
{
    float alpha = alpha_from_roughness(0.2f + 0.8f * u[1]);
    vec3 V = parity_V(u);
    float alpha_y = 1.2f - alpha;
    return vec3(V_SchlickGGX(u[0], 0.4f, k_ibl(alpha)), V_SchlickGGX(u[0], 0.4f, k_direct(u[1])),
                G1_SmithGGX_anisotropic(V, alpha, alpha_y));
}

FN vec3 case_multiscatter_turquin(vec2 u)
{
    vec3 F_mean = vec3(u[0], 0.04f, 1.0f);
    float E = 0.3f + 0.6f * u[1];
    return multiscatter_scale(F_mean, E) + multiscatter_scale_turquin(F_mean, E) * 0.1f;
}

FN vec3 case_multiscatter_kulla_conty(vec2 u)
{
    vec3 F_mean = vec3(u[0], 0.04f, 1.0f);
    float E = 0.3f + 0.6f * u[1];
    return multiscatter_scale_cycles(F_mean, E, E_avg_GGX(u[1])) + brdf_kulla_conty(F_mean, E, u[0], 0.6f) +
           brdf_lambert(F_mean);
}

/* ---- fresnel.h ---- */

FN vec3 case_F_Schlick(vec2 u)
{
    vec3 F0 = vec3(0.04f, u[1], 0.9f);
    return F_Schlick(F0, vec3(1.0f, 0.5f, 1.0f), u[0]) +
           vec3(schlick_weight(u[1]), F_Schlick1(0.1f, 1.0f, u[0]), 0.0f);
}

FN vec3 case_F_Schlick_SG(vec2 u)
{
    vec3 F0 = vec3(0.04f, u[1], 0.9f);
    return F_Schlick_SG(F0, u[0]) + F_avg(F0, vec3(1.0f)) * 0.1f;
}

FN vec3 case_F_Schlick_roughness(vec2 u)
{
    vec3 F0 = vec3(0.04f, u[1], 0.9f);
    return F_Schlick_roughness(F0, vec3(1.0f), u[1], u[0]);
}

FN vec3 case_F_dielectric(vec2 u)
{
    return vec3(F_dielectric(u[0], 1.1f + u[1]), F_dielectric(u[0], 1.0f / (1.1f + u[1])),
                F_dielectric_avg(1.0f + u[1]));
}

FN vec3 case_F_conductor(vec2 u)
{
    return F_conductor(u[0], vec3(0.2f, 1.5f, 0.1f + u[1]), vec3(3.9f, 7.6f, 2.0f));
}

FN vec3 case_F0_from_ior(vec2 u)
{
    return vec3(F0_from_ior(1.0f + u[0]), ior_from_F0(0.9f * u[0]), F_conductor1(u[0], 1.0f, u[1]));
}

/* ---- sampling.h ---- */

FN vec3 case_hammersley(vec2 u)
{
    vec2 h = hammersley(uint(u[0] * 4096.0f), 4096u);
    return vec3(h[0], h[1], radical_inverse(uint(u[1] * 1e6f)));
}

FN vec3 case_sample_D_GGX(vec2 u)
{
    float alpha = alpha_from_roughness(0.2f + 0.8f * u[1]);
    return mul(basis_from_normal(parity_L(u)), sample_D_GGX(u, alpha));
}

FN vec3 case_sample_cosine(vec2 u)
{
    return mul(transpose(basis_from_normal(-parity_L(u))), sample_cosine(u));
}

FN vec3 case_sample_VNDF_GGX(vec2 u)
{
    float alpha = alpha_from_roughness(0.2f + 0.8f * u[1]);
    vec3 V = parity_V(u);
    return sample_VNDF_GGX(u, V, alpha, 0.5f);
}

FN vec3 case_pdf(vec2 u)
{
    float alpha = alpha_from_roughness(0.2f + 0.8f * u[1]);
    vec3 V = parity_V(u);
    vec3 H = normalize(V + parity_L(u));
    return vec3(pdf_D_GGX(u[0], alpha), pdf_VNDF_GGX(V, H, alpha, 0.5f), pdf_cosine(u[0] - 0.3f));
}

FN vec3 case_sample_bounded_VNDF(vec2 u)
{
    vec3 V = parity_V(u);
    float alpha = 0.2f + 0.6f * u[1];
    return 1.0f + sample_bounded_VNDF_GGX(u, V, alpha, 0.5f) +
           vec3(bounded_VNDF_k(V[2], alpha, 0.5f),
                pdf_bounded_reflection(V, normalize(V + parity_L(u)), alpha, 0.5f), 0.0f);
}

/* ---- surface.h ---- */

FN vec3 case_surface_brdf_cos(vec2 u)
{
    Surface s = parity_surface(u);
    vec3 V = parity_V(u);
    vec3 L = parity_L(u);
    return surface_brdf_cos(s, V, L);
}

FN vec3 case_surface_brdf_cos_energy(vec2 u)
{
    Surface s = parity_surface(u);
    vec3 V = parity_V(u);
    vec3 L = parity_L(u);
    vec2 dfg = vec2(0.7f, 0.3f * u[0]);
    return surface_brdf_cos_energy(s, V, L, ENERGY_CONSERVING, dfg);
}

FN vec3 case_surface_lobes_cos(vec2 u)
{
    Surface s = parity_surface(u);
    vec3 V = parity_V(u);
    vec3 L = parity_L(u);
    vec2 dfg = vec2(0.7f, 0.3f * u[0]);
    SurfaceLobes lobes = surface_lobes_cos(s, V, L, ENERGY_GLTF, dfg);
    return lobes.specular - lobes.diffuse;
}

FN vec3 case_specular_albedo(vec2 u)
{
    Surface s = parity_surface(u);
    vec2 dfg = vec2(0.7f, 0.3f * u[0]);
    return specular_albedo(s.F0, vec3(s.F90), dfg) + dielectric_F0(u[0], u[1], vec3(2.0f, 1.0f, 0.5f));
}

FN vec3 case_metallic_roughness(vec2 u)
{
    Surface s = parity_surface(u);
    vec3 V = parity_V(u);
    vec3 L = parity_L(u);
    Surface plain = surface_from_metallic_roughness(V, vec3(u[0], u[1], 0.5f), u[0], u[1]);
    return face_forward(plain.N, L, vec3(0.0f, 1.0f, 0.0f)) * max3(plain.base_color) + surface_NdotV(s, V) +
           s.occlusion + s.emissive + plain.F0;
}

/* ---- diffuse.h, diffuse_sample.h ---- */

FN vec3 case_diffuse_brdf(vec2 u)
{
    vec3 rho = vec3(u[0], 0.5f, u[1]);
    float r = fract(3.0f * u[0] + u[1]);
    return 0.1f + brdf_eon(rho, r, 0.1f + 0.9f * u[0], 0.1f + 0.9f * u[1], 2.0f * u[0] - 1.0f) +
           eon_reflected(rho, u[1], r, vec3(0.5f, 1.0f, 2.0f), vec3(1.0f, 0.7f, 0.2f)) +
           eon_multiple(rho, r) + vec3(eon_scale(r), eon_shape(u[0]), eon_lost(u[1]) + eon_albedo(u[0], r));
}

FN vec3 case_diffuse_light(vec2 u)
{
    vec3 up = vec3(1.0f, u[0], u[1]);
    DiffuseLight d =
        diffuse_light(up, vec3(0.3f), up * 0.9f, up * 0.4f, vec3(0.5f), vec3(u[1]), up, vec3(u[0]));
    return 0.1f + eon_single_light(d, u[0], u[1]) + eon_multiple_light(d);
}

FN vec3 case_diffuse_sample(vec2 u)
{
    float r = fract(3.0f * u[0] + u[1]);
    float NdotV = 0.1f + 0.9f * u[1];
    vec3 L = normalize(vec3(u[0] - 0.5f, u[1] - 0.5f, 0.4f));
    EonTransform t = eon_transform(NdotV, r);
    mat3 frame = basis_from_view(normalize(vec3(0.1f, 0.3f, 1.0f)), L);
    return 2.0f + sample_eon(vec2(u[1], u[0]), NdotV, r) + mul(frame, L) +
           vec3(pdf_eon(L, NdotV, r), eon_uniform_probability(NdotV, r), eon_clipped_share(t)) +
           vec3(t.a + t.b, t.c, t.d);
}

/* ---- sheen.h ---- */

FN vec3 case_D_Charlie(vec2 u)
{
    float r = 0.3f + 0.7f * u[1];
    float alpha = sheen_alpha(r);
    return vec3(D_Charlie(u[0], alpha), Lambda_Charlie(u[0], alpha) * 0.01f, V_Charlie(u[0], 0.4f, alpha)) +
           vec3(brdf_sheen(u[0], 0.3f, 0.4f, alpha), V_Neubelt(u[0], 0.3f), pdf_D_Charlie(u[0], alpha)) +
           sheen_lambda_curve(u[0], alpha) * 0.1f;
}

FN vec3 case_sheen_albedo(vec2 u)
{
    float r = 0.3f + 0.7f * u[1];
    return 0.1f + vec3(sheen_albedo_sample(uint(u[0] * 64.0f), 64u, r, u[1]),
                       integrate_sheen_albedo(r, u[0], 16u),
                       sheen_scaling(vec3(0.3f, 0.7f, 0.1f), u[0] * 2.0f));
}

FN vec3 case_sheen_ltc(vec2 u)
{
    vec3 V = normalize(vec3(0.6f, 0.0f, 0.2f + u[0]));
    vec3 L = parity_L(u);
    float r = 0.3f + 0.7f * u[1];
    float alpha = sheen_alpha(r);
    vec2 t = sheen_ltc_transform(u[0], r);
    PrefilterSample p = prefilter_sheen_sample(uint(u[0] * 64.0f), 64u, alpha, normalize(L));
    return 3.0f + sample_sheen_ltc(u, V, r) + p.L * p.weight + p.pdf +
           vec3(pdf_sheen_ltc(V, L, r), sheen_ltc_albedo(u[0], r), t[0] + t[1]);
}

FN vec3 case_sheen_rim(vec2 u)
{
    float alpha = 0.2f + 0.6f * u[1];
    return 1.0f + sample_sheen_rim(u, u[0], alpha) +
           vec3(sheen_rim_width(u[0], alpha), pdf_sheen_rim(u[1], u[0], alpha), 0.0f);
}

/* ---- clearcoat.h ---- */

FN vec3 case_clearcoat(vec2 u)
{
    vec3 V = normalize(vec3(0.6f, 0.0f, 0.2f + u[0]));
    vec3 L = parity_L(u);
    float r = 0.3f + 0.7f * u[1];
    float alpha = sheen_alpha(r);
    return 0.5f + sample_D_Charlie(u, alpha) + clearcoat_lobe_cos(parity_V(u), u[0], V, L, alpha) +
           F_clearcoat(u[0]);
}

/* ---- anisotropy.h ---- */

FN vec3 case_anisotropic_reflection(vec2 u)
{
    vec3 V = parity_V(u);
    vec3 L = parity_L(u);
    vec3 N = vec3(0.0f, 0.0f, 1.0f);
    vec2 d = anisotropy_direction(u + 0.1f, u[0]);
    return anisotropic_reflection(N, vec3(d[0], d[1], 0.0f), V, u[0], u[1]) +
           to_frame(L, vec3(d[0], d[1], 0.0f), vec3(-d[1], d[0], 0.0f), N);
}

FN vec3 case_anisotropic_lookup(vec2 u)
{
    int k = int(u[0] * 15.99f);
    AnisotropicLookup s =
        anisotropic_lookup(k, parity_V(u), anisotropic_alpha(0.05f + 0.4f * u[1], u[0]), u[1]);
    return s.L + 2.0f + vec3(s.perceptual_roughness, s.weight, 0.0f);
}

FN vec3 case_anisotropic_table(vec2 u)
{
    vec3 V = parity_V(u);
    vec3 L = parity_L(u);
    vec2 a = anisotropic_alpha(0.1f + 0.4f * u[0], u[1]);
    vec2 p = anisotropic_table_point(V, a);
    vec2 q = anisotropic_table_bound(vec2(0.5f, 0.2f * u[0]), V, a);
    return vec3(p[0] + q[0] + anisotropic_grazing_share(V, a), p[1] + q[1],
                alpha_specular_aa(u[0], V * 0.1f, L * u[1]));
}

/* ---- iridescence.h ---- */

FN vec3 case_F_iridescent(vec2 u)
{
    return F_iridescent(1.1f + u[1], 800.0f * u[0], vec3(0.04f, 0.3f, 1.0f), 0.2f + 0.7f * u[1]) + 0.01f +
           film_fade(0.03f * u[0]);
}

FN vec3 case_film_series(vec2 u)
{
    return 5.0f + film_sensitivity(800.0f * u[0], vec3(0.0f, PI, 2.0f)) +
           film_base_ior(vec3(0.04f, u[0], 0.5f)) +
           film_base_reflectance(1.3f, vec3(1.5f, 2.0f, 1.1f), u[1]) +
           film_series(0.1f, vec3(u[0], u[1], 0.5f), 100.0f, vec3(1.0f)) +
           film_gaussian(5e-13f, 1.6e6f, 4.3e9f, u[0] * 1e-6f, u[1]);
}

/* ---- dispersion.h ---- */

FN vec3 case_sample_wavelength(vec2 u)
{
    WavelengthSample w = sample_wavelength(u[0]);
    return w.weight + vec3(w.wavelength_nm * 0.01f, float(w.channel), 0.0f);
}

/* ---- transmission.h ---- */

FN vec3 case_refraction(vec2 u)
{
    vec3 V = parity_V(u);
    vec3 L = mirror_through(parity_L(u), vec3(0.0f, 0.0f, 1.0f));
    float eta = sel(u[0] < 0.5f, 1.5f, 0.7f);
    return refract_or_zero(-V, vec3(0.0f, 0.0f, 1.0f), 1.2f + u[1]) + half_vector_transmission(V, L, eta) +
           F_Schlick_boundary(vec3(0.04f), vec3(1.0f), 0.8f + 0.2f * u[0], 1.0f / 1.3f);
}

FN vec3 case_environment_behind(vec2 u)
{
    float alpha2 = u[0] * 2e-5f;
    float blur = sel(u[1] < 0.5f, 0.0f, u[1]);
    return scattered_ambient(vec3(1.0f, 2.0f, 3.0f), vec3(u[0]), 2.0f * u[1] - 1.0f) +
           vec3(environment_blur(alpha2, blur), sel(environment_is_sharp(alpha2, blur), 1.0f, 0.0f),
                refracted_alpha(u[0], 0.5f + u[1]));
}

FN vec3 case_btdf_GGX(vec2 u)
{
    vec3 V = parity_V(u);
    vec3 L = mirror_through(parity_L(u), vec3(0.0f, 0.0f, 1.0f));
    float alpha = 0.2f + 0.6f * u[1];
    return vec3(btdf_GGX_cos(V, L, alpha, 0.5f, 1.5f), pdf_transmission(V, L, alpha, 0.5f, 1.5f),
                transmission_jacobian(u[0], -u[1], 1.7f));
}

FN vec3 case_sample_transmission(vec2 u)
{
    vec3 V = parity_V(u);
    float alpha = 0.2f + 0.6f * u[1];
    TransmissionSample t = sample_transmission(u, V, alpha, 0.5f, 1.5f);
    return 2.0f + t.L + vec3(t.VdotH, t.weight, t.pdf * 0.1f);
}

FN vec3 case_thin_wall(vec2 u)
{
    vec3 V = parity_V(u);
    vec3 L = mirror_through(parity_L(u), vec3(0.0f, 0.0f, 1.0f));
    float alpha = 0.2f + 0.6f * u[1];
    return vec3(thin_wall_cos(V, L, alpha, 0.5f), pdf_thin_wall(V, L, alpha, 0.5f),
                thin_wall_alpha(alpha, 1.0f + u[0]) + weight_VNDF_GGX(V, L, alpha, 0.5f));
}

FN vec3 case_sample_thin_wall(vec2 u)
{
    vec3 V = parity_V(u);
    float alpha = 0.2f + 0.6f * u[1];
    TransmissionSample t = sample_thin_wall(u, V, alpha, 0.5f);
    return 2.0f + t.L + vec3(t.VdotH, t.weight, t.pdf * 0.1f);
}

/* ---- volume.h ---- */

FN vec3 case_volume(vec2 u)
{
    return volume_transmittance(vec3(0.5f, 0.9f, 0.0f), 2.0f, 5.0f * u[0]) +
           volume_extinction(vec3(0.5f, u[0], u[1]), 3.0f) + single_scatter_albedo(vec3(u[0], u[1], 0.3f)) +
           single_scatter_albedo1(u[0]);
}

FN vec3 case_phase_and_dispersion(vec2 u)
{
    vec3 V = parity_V(u);
    return sample_phase_HG(u, V, 0.7f) + vec3(phase_HG(2.0f * u[0] - 1.0f, 0.6f),
                                              dispersed_ior(1.5f, u[0], 0),
                                              dispersed_ior_at(1.5f, u[0], 400.0f + 300.0f * u[1]));
}

/* ---- specular_glossiness.h ---- */

FN vec3 case_specular_glossiness(vec2 u)
{
    vec3 N = vec3(0.0f, 0.0f, 1.0f);
    Surface s = surface_from_specular_glossiness(N, vec3(u[0], 0.5f, 0.2f), vec3(0.2f, u[1], 0.3f), u[0],
                                                 1.0f, vec3(0.1f));
    return s.base_color + s.F0 + s.alpha + s.emissive;
}
