/* layers.h - parity cases: layered materials: evaluation, textures, sampling. */

/* ---- glass.h ---- */

FN vec3 case_glass_boundary(vec2 u)
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

/* A subset of the layers that comes with u. */
FN Layers parity_layers(vec2 u)
{
    Layers m = layers_from_surface(parity_surface(u));
    mat3 basis = basis_from_normal(m.base.N);
    m.layers = uint(u[0] * 1024.0f);
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
    m.diffuse_roughness = 0.2f + 0.8f * u[1];
    return m;
}

FN LayerTables parity_layer_tables(Layers m, vec3 V, int energy, vec2 u)
{
    return layer_tables(m, V, energy, vec2(0.6f, 0.2f * u[0]), 0.9f, 0.8f, 0.3f + u[1],
                        vec3(0.1f + 0.2f * u[0], 0.9f, 0.8f));
}

/* Both kinds of boundary of glass.h, in ENERGY_CONSERVING. */
FN vec3 parity_glass(Layers m, vec3 V, vec2 u)
{
    m.layers = m.layers | LAYER_TRANSMISSION;
    LayerTables t = parity_layer_tables(m, V, ENERGY_CONSERVING, u);
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
                w.through + g.through + layers_delta_through(m, w, layers_V_local(m, V), -V, ENERGY_GLTF, t),
                layers_reflection_share(m, u[0])) +
           layers_glass_bound(vec3(u[0], 0.9f, 0.8f), vec2(0.5f, 0.2f), vec2(0.6f, 0.2f), vec2(0.3f, 0.2f),
                              m.eta) +
           layers_coupled_pdf(m, V, sel(u[0] > 0.5f, m.base.N, -V)) * 0.1f;
}

FN vec3 case_glass_layers(vec2 u)
{
    vec3 V = parity_V(u);
    return parity_glass(parity_layers(u), V, u);
}

/* ---- layers.h ---- */

/* Energy modes in bands. */
FN int parity_energy(vec2 u)
{
    return sel(fract(u[1] * 8.0f) > 0.5f, ENERGY_CONSERVING, ENERGY_GLTF);
}

FN vec3 case_layers_brdf_cos(vec2 u)
{
    Layers m = parity_layers(u);
    vec3 V = parity_V(u);
    int energy = parity_energy(u);
    LayerTables t = parity_layer_tables(m, V, energy, u);
    return layers_brdf_cos(m, V, sel(fract(u[0] * 32.0f) > 0.5f, parity_L(u), -parity_L(u)), energy, t, 0.2f);
}

/* The parts of layers_brdf_cos(). */
FN vec3 parity_layer_parts(Layers m, vec3 V, vec3 L, int energy, LayerTables t)
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
           layers_rough_ibl(m, vec3(0.2f, 0.5f, 0.9f), NdotV, layer_light_of(vec3(0.5f)).rough) +
           layers_base_back_cos(m, V, -N, energy, t, LOBES_ALL) +
           layers_sheen_cos(m, V, N, energy, t, 0.3f, vec3(1.0f)) +
           layers_clearcoat_cos(m, V, N, energy, t, layers_base_cos(m, V, N, energy, t, LOBES_ALL),
                                LOBES_ALL);
}

FN vec3 case_layers_parts(vec2 u)
{
    Layers m = parity_layers(u);
    vec3 V = parity_V(u);
    int energy = parity_energy(u);
    LayerTables t = parity_layer_tables(m, V, energy, u);
    return parity_layer_parts(m, V, parity_L(u), energy, t);
}

FN vec3 case_layers_table_points(vec2 u)
{
    Layers m = parity_layers(u);
    vec3 V = parity_V(u);
    int energy = parity_energy(u);
    vec2 p = layers_dfg_point(m, V, energy) + layers_transmission_point(m, V, energy) +
             layers_alpha(m, layers_transmission_alpha(m));
    vec3 r =
        layers_reflection(m, V, energy) + layers_clearcoat_reflection(m, V, energy) + layers_emission(m, V);
    if (has_layer(m, LAYER_SHEEN) || layers_is_inside(m) || layers_reads_anisotropic(m, energy))
        r += 1.0f;
    if (layers_reads_anisotropic(m, energy))
        r += layers_anisotropic_lookup(m, V, int(u[1] * 15.99f)).L + 1.0f;
    return r + vec3(p[0], p[1], layers_clearcoat_NdotV(m, V));
}

FN vec3 case_layers_punctual(vec2 u)
{
    Layers m = parity_layers(u);
    vec3 V = parity_V(u);
    int energy = parity_energy(u);
    LayerTables t = parity_layer_tables(m, V, energy, u);
    return layers_punctual(m, parity_L(u), V, light_point(vec3(3.0f, 1.0f, 2.0f), vec3(100.0f), 0.0f), energy,
                           t, 0.2f);
}

/* The parts of layers_ibl(). */
FN vec3 parity_layer_ibl_parts(Layers m, vec3 V, int energy, LayerTables t, LayerLight light)
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

FN vec3 case_layers_ibl(vec2 u)
{
    Layers m = parity_layers(u);
    vec3 V = parity_V(u);
    int energy = parity_energy(u);
    LayerTables t = parity_layer_tables(m, V, energy, u);
    LayerLight light;
    light.specular = vec3(3.0f, 1.0f, 0.2f);
    light.irradiance_over_pi = vec3(0.5f, 0.7f, 1.0f);
    light.irradiance_back_over_pi = vec3(0.2f, 0.1f, 0.3f);
    light.clearcoat = vec3(1.0f, 2.0f, 3.0f);
    light.sheen = vec3(0.3f, 0.2f, 0.1f);
    light.transmitted = vec3(1.0f, 0.5f, 0.7f);
    light.rough.single = vec3(0.4f, 0.8f, 0.9f);
    light.rough.multiple = vec3(0.6f, 0.7f, 0.8f);
    light.rough_back = light.rough;
    return layers_ibl(m, V, t, light, energy) + parity_layer_ibl_parts(m, V, energy, t, light);
}

/* ---- layers_lobes.h ---- */

/* Surfaces of which some lobes are mirrors. */
FN Layers parity_path_layers(vec2 u)
{
    Layers m = parity_layers(u);
    if (fract(u[1] * 16.0f) < 0.3f) {
        m.base.alpha = 0.0f;
        m.clearcoat_roughness = 0.0f;
        m.anisotropy = 0.0f;
    }
    return layers_with_wavelength(m, 400.0f + 300.0f * u[0]);
}

FN vec3 case_layers_ibl_alone(vec2 u)
{
    vec3 V = parity_V(u);
    Layers m = parity_path_layers(u);
    int energy = parity_energy(u);
    LayerTables t = parity_layer_tables(m, V, energy, u);
    int lobe = int(u[0] * 4.99f);
    return 1.0f + layers_ibl_alone(m, V, t, layer_light_of(vec3(0.5f, u[0], 1.0f)), energy, lobe);
}

FN vec3 case_layers_punctual_alone(vec2 u)
{
    vec3 V = parity_V(u);
    Layers m = parity_path_layers(u);
    int energy = parity_energy(u);
    LayerTables t = parity_layer_tables(m, V, energy, u);
    int lobe = int(u[0] * 4.99f);
    Light l = light_point(parity_L(u) * sel(u[1] > 0.3f, 2.0f, -2.0f), vec3(3.0f, 2.0f, 1.0f), 0.0f);
    return 1.0f + layers_punctual_alone(m, vec3(0.0f), V, l, energy, t, 0.2f, lobe) +
           layers_brdf_cos_alone(layers_without_diffuse(m), V, parity_L(u), energy, t, 0.2f, lobe) +
           vec3(schlick_GGX_over_smith(u[0], u[1], 0.5f), 0.0f, 0.0f);
}

/* ---- material.h ---- */

FN vec3 case_base_color(vec2 u)
{
    vec3 texel = vec3(u[0], u[1], fract(3.0f * u[0] + u[1]));
    vec2 uv = texcoord_transform(u, vec3(0.5f, -0.2f, 0.1f), vec3(0.3f, 0.6f, 0.2f));
    int mode = int(u[0] * 2.99f);
    return material_base_color(vec3(0.5f, 0.6f, 0.7f), texel, vec3(0.9f, 0.8f, u[1])) +
           vec3(uv[0] + 1.0f, uv[1] + 1.0f, material_coverage(mode, 1.5f * u[1], 0.5f) + 1.0f);
}

/* A frame of a texture coordinate, of which one corner of the domain has none. */
FN ShadingFrame parity_texcoord_frame(vec2 u)
{
    vec2 uv1 = vec2(0.9f, 0.2f * u[0]);
    vec2 uv2 = sel(u[0] > 0.97f, uv1, vec2(0.1f * u[1], sel(u[1] > 0.5f, 0.7f, -0.7f)));
    return frame_from_texcoord(vec3(0.1f, 0.2f, 1.1f), vec3(1.0f, 0.3f * u[0], 0.1f), vec3(-0.2f, 0.9f, u[1]),
                               uv1, uv2, sel(u[0] > 0.5f, 1.0f, -1.0f));
}

FN vec3 parity_frame(ShadingFrame f)
{
    return f.T + f.B * 0.1f + f.N * 0.01f + vec3(sel(frame_has_tangent(f), 2.0f, 3.0f));
}

FN vec3 case_shading_frames(vec2 u)
{
    vec3 texel = vec3(u[0], u[1], fract(3.0f * u[0] + u[1]));
    vec3 texel_or_white = sel(u[1] > 0.9f, vec3(1.0f), texel);
    vec3 N = normalize(vec3(0.1f, 0.05f, 1.0f));
    vec3 n = normal_from_texel(texel_or_white, 0.7f);
    ShadingFrame tangents =
        frame_from_tangent(N * 1.1f, vec3(0.9f, 0.2f, 0.1f), -1.0f, sel(u[0] > 0.5f, 1.0f, -1.0f));
    float mirror = sel(u[0] > 0.75f, -1.0f, sel(u[0] < 0.02f, 0.0f, 1.0f));
    ShadingFrame turned = frame_transformed(tangents, vec3(cos(u[1]), 2.0f * sin(u[1]), 0.1f) * mirror,
                                            vec3(-sin(u[1]), 2.0f * cos(u[1]), 0.2f));
    return parity_frame(tangents) + parity_frame(parity_texcoord_frame(u)) + parity_frame(turned) +
           frame_normal(tangents, n, N) + normalize_or(n, N) + 5.0f;
}

FN MaterialFactors parity_factors(vec2 u)
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

FN vec3 parity_surface_sum(Surface s)
{
    return s.base_color + s.F0 + s.emissive * 0.1f +
           vec3(s.metallic, s.perceptual_roughness + s.alpha, s.occlusion * 0.5f + s.F90);
}

FN vec3 case_material_surface(vec2 u)
{
    vec3 texel = vec3(u[0], u[1], fract(3.0f * u[0] + u[1]));
    vec3 N = normalize(vec3(0.1f, 0.05f, 1.0f));
    MaterialFactors f = parity_factors(u);
    return parity_surface_sum(material_surface(f, N, texel, texel, u[0], texel, u[1], texel)) +
           parity_surface_sum(material_surface_glossy(f, N, texel, texel, u[1], u[0], texel));
}

FN Layers parity_material_layers(vec2 u, vec3 texel)
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
    m = with_diffuse_roughness(m, 0.9f, texel);
    return with_anisotropy(m, anisotropy_strength(0.8f, texel), u[1], texel, parity_texcoord_frame(u));
}

FN vec3 case_material_layers(vec2 u)
{
    vec3 texel = vec3(u[0], u[1], fract(3.0f * u[0] + u[1]));
    vec3 texel_or_white = sel(u[1] > 0.9f, vec3(1.0f), texel);
    Layers m = parity_material_layers(u, texel_or_white);
    vec2 turn = anisotropy_texel_direction(texel_or_white);
    return 2.0f + m.sheen_color + m.diffuse_transmission_color + m.attenuation_color + m.multiscatter_color +
           m.anisotropy_T * 0.5f + m.anisotropy_B * 0.1f +
           vec3(m.clearcoat + m.clearcoat_roughness + m.sheen_roughness, m.iridescence + m.iridescence_ior,
                m.iridescence_thickness_nm * 0.01f + m.transmission + m.diffuse_transmission) +
           vec3(m.thickness + m.attenuation_distance * 1e-6f,
                m.dispersion + m.scatter_anisotropy + m.diffuse_roughness, m.ior + m.eta) +
           vec3(m.anisotropy + turn[0], float(m.layers) * 0.01f + turn[1], 0.0f);
}

/* ---- specular_aa.h ---- */

FN vec3 case_specular_aa(vec2 u)
{
    vec3 texel = vec3(u[0], u[1], fract(3.0f * u[0] + u[1]));
    vec3 N = normalize(vec3(0.1f, 0.05f, 1.0f));
    MaterialFactors f = parity_factors(u);
    Surface wide = surface_specular_aa(material_surface(f, N, texel, texel, u[0], texel, u[1], texel),
                                       vec3(0.1f * u[0], 0.0f, 0.2f), vec3(0.0f, 0.3f * u[1], 0.0f));
    return parity_surface_sum(wide) + vec3(roughness_specular_aa(u[0], N * 0.1f, N * u[1]), 0.0f, 0.0f);
}

FN vec3 case_backdrop(vec2 u)
{
    vec3 T = vec3(u[0], u[1], fract(u[0] + 2.0f * u[1]));
    return vec3(1.0f + backdrop_passes(T)) +
           backdrop_radiance(T, T * 0.7f, vec3(0.2f, 0.9f, u[1]), u[0] > 0.5f);
}

/* ---- ground.h ---- */

FN vec3 case_ground_fade(vec2 u)
{
    return 1.0f + vec3(ground_fade(u), ground_fade(u * 0.125f), ground_fade(vec2(u[1], 0.5f)));
}

/* ---- layers_sample.h ---- */

FN vec3 parity_lobes(LayersLobes p)
{
    return vec3(p.clearcoat + 2.0f * p.sheen, p.specular + 2.0f * p.diffuse,
                p.transmission + 2.0f * p.diffuse_back);
}

FN vec3 case_layers_pdf(vec2 u)
{
    vec3 V = parity_V(u);
    Layers m = parity_path_layers(u);
    int energy = parity_energy(u);
    LayerTables t = parity_layer_tables(m, V, energy, u);
    LayersLobes p = layers_lobes(m, V, energy, t);
    return parity_lobes(p) + layers_pdf(m, p, V, sel(u[0] > 0.5f, parity_L(u), -parity_L(u)));
}

FN vec3 case_layers_scatter_cos(vec2 u)
{
    vec3 V = parity_V(u);
    Layers m = parity_path_layers(u);
    int energy = parity_energy(u);
    LayerTables t = parity_layer_tables(m, V, energy, u);
    return layers_scatter_cos(m, V, sel(u[0] > 0.5f, parity_L(u), -parity_L(u)), energy, t, 0.2f);
}

/* The parts of layers_sample(). */
FN vec3 parity_path_parts(Layers m, LayersLobes p, vec3 V, vec2 u, int energy, LayerTables t)
{
    mat3 frame = layers_any_frame(m);
    vec3 L = normalize(parity_L(u));
    vec3 below = mirror_through(L, m.base.N);
    float mirrors =
        sel(layers_specular_is_delta(m), 1.0f, 0.0f) + sel(layers_transmission_is_delta(m), 2.0f, 0.0f) +
        sel(layers_clearcoat_is_delta(m), 4.0f, 0.0f) + sel(is_delta_alpha(vec2(u[0], 1e-5f)), 8.0f, 0.0f) +
        sel(is_delta_refraction(vec2(1e-3f, 1e-5f), 1.0f + u[0]), 16.0f, 0.0f);
    BoundaryWeights b = layers_boundary_albedo(m, surface_NdotV(m.base, V), energy, t);
    return mul(frame, L) + view_above(m.base.N, -V) + layers_V_local(m, V) + b.specular + b.below +
           vec3(mirrors, float(layers_scattering_lobes(m)),
                layers_below_coat(m, V) * layers_below_sheen(m, t)) +
           vec3(layers_specular_pdf(m, V, m.base.N), layers_transmission_pdf(m, V, below),
                layers_clearcoat_pdf(m, V, L)) *
               0.1f +
           parity_lobes(lobes_normalised(p)) + parity_lobes(layers_lobes_plain(m, energy, t)) +
           lobe_excess(u[0]) + lobe_probability(u[1], 0.8f) +
           vec3(pdf_reflection(m.base.N, V, m.base.N, 0.3f),
                pdf_reflection_anisotropic(layers_V_local(m, V), vec3(0.0f, 0.0f, 1.0f), vec2(0.3f, 0.6f)),
                0.0f);
}

FN vec3 case_layers_sample_parts(vec2 u)
{
    vec3 V = parity_V(u);
    Layers m = parity_path_layers(u);
    int energy = parity_energy(u);
    LayerTables t = parity_layer_tables(m, V, energy, u);
    LayersLobes p = layers_lobes(m, V, energy, t);
    return parity_path_parts(m, p, V, u, energy, t);
}

FN vec3 parity_sampled(LayersSample s)
{
    float flags = sel(s.is_delta, 1.0f, 0.0f) + sel(s.is_through, 2.0f, 0.0f) + sel(s.is_valid, 4.0f, 0.0f);
    return 2.0f + s.L + s.weight + vec3(flags, s.pdf * 0.1f, 0.0f);
}

FN vec3 case_layers_sample(vec2 u)
{
    vec3 V = parity_V(u);
    Layers m = parity_path_layers(u);
    int energy = parity_energy(u);
    LayerTables t = parity_layer_tables(m, V, energy, u);
    LayersLobes p = layers_lobes(m, V, energy, t);
    vec2 turned = vec2(u[1], u[0]);
    return parity_sampled(layers_sample(m, p, V, fract(u[0] * 5.0f), turned, energy, t));
}

FN vec3 case_layers_sample_delta(vec2 u)
{
    vec3 V = parity_V(u);
    Layers m = parity_path_layers(u);
    int energy = parity_energy(u);
    LayerTables t = parity_layer_tables(m, V, energy, u);
    LayersLobes p = layers_lobes(m, V, energy, t);
    vec2 turned = vec2(u[1], u[0]);
    p.clearcoat = 0.3f; /* each lobe is there */
    p.specular = 0.4f;
    p.transmission = 0.2f;
    return parity_sampled(layers_sample_delta(m, p, V, u[0] > 0.4f, energy, t)) +
           parity_sampled(no_sample(V)) + parity_sampled(layers_sample_delta_clearcoat(m, p, V)) +
           layers_draw_clearcoat(m, V, u) + layers_draw_sheen(m, V, u) +
           layers_draw_diffuse(m, view_above(m.base.N, V), u) +
           layers_diffuse_pdf(m, view_above(m.base.N, V), m.base.N, 1.0f) +
           layers_draw_boundary(m, V, u[1], 0.5f, turned);
}

/* ---- surface_sample.h ---- */

FN vec3 case_surface_sample(vec2 u)
{
    vec3 V = parity_V(u);
    Surface s = parity_path_layers(u).base;
    int energy = parity_energy(u);
    SurfaceLobesAtV t = surface_lobes_at(s, V, 0.4f, 0.6f, energy, vec2(0.8f, 0.1f));
    SurfaceValue x = surface_value(s, t, parity_L(u), energy);
    return 2.0f + x.f + x.pdf * 0.1f + surface_draw(s, t, fract(u[0] * 5.0f), vec2(u[1], u[0]));
}
