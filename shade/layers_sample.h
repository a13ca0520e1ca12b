/* layers_sample.h - sampling of the layered surface for path tracing: a lobe is chosen, a direction is drawn
 * from it, and the density is that of all lobes (one-sample multiple importance sampling, Veach 1997, section
 * 9.2.4), so that
 *   f |N.L| / pdf
 * is unbiased for any probabilities that are not 0 where the lobe is not.
 *
 * Specular (delta) lobes, too narrow to evaluate in single precision, are separate: they have a direction
 * and a weight but no density. Whether a lobe is specular depends on the surface only.
 *
 * A mapped normal may face away from the eye. Lobes then use the nearest V above the surface
 * (view_above()) for sampling, densities and evaluation alike; otherwise they would be sampled in one
 * place and evaluated in another. */
#ifndef SHADE_LAYERS_SAMPLE_H
#define SHADE_LAYERS_SAMPLE_H

/* Probabilities of the lobes; they add up to 1, or are all 0 if the surface reflects nothing to V. */
STRUCT(LayersLobes)
{
    float clearcoat;
    float sheen;
    float specular; /* reflection at the base's boundary, of dielectric and metal */
    float diffuse;
    float transmission; /* specular, through a thin wall or a volume's boundary */
    float diffuse_back;
};

/* A sampled direction. */
STRUCT(LayersSample)
{
    vec3 L;      /* unit */
    float pdf;   /* per sr, of all non-specular lobes; 0 for a specular one */
    vec3 weight; /* of a specular lobe: f |N.L| / pdf, its probability included; otherwise 0 */
    /* a specular (delta) lobe: no other technique has a density for L */
    bool is_delta;
    bool is_through; /* L is on the other side of the surface: N.L < 0 */
    bool is_valid;   /* false: the path ends here */
};

/* ---- single wavelengths ---- */

/* The surface at one wavelength: with its ior there and without dispersion. Its LUT values differ, too.
 * Dispersion 0 leaves eta unchanged. */
FN Layers layers_with_wavelength(Layers m, float wavelength_nm)
{
    if (has_layer(m, LAYER_DISPERSION) && m.dispersion > 0.0f) {
        float inner = sel(m.eta < 1.0f, 1.0f / m.eta, m.eta);
        float ior = dispersed_ior_at(inner, m.dispersion, wavelength_nm);
        m.eta = sel(m.eta < 1.0f, 1.0f / ior, ior);
    }
    m.layers = m.layers & ~LAYER_DISPERSION;
    return m;
}

/* ---- specular lobes ---- */

/* V, or the nearest direction above the surface. */
FN vec3 view_above(vec3 N, vec3 V)
{
    float NdotV = dot(N, V);
    if (NdotV >= NDOTV_MIN)
        return V;
    return normalize(V + N * (NDOTV_MIN - NdotV));
}

/* Whether a lobe of these widths is specular: not wider than the narrowest that is evaluated. There the
 * rounding of a direction, 6e-8, is 6e-4 of the width and changes D by about as much. */
FN bool is_delta_alpha(vec2 alpha)
{
    return max(alpha[0], alpha[1]) <= ALPHA_DELTA;
}

/* The same for refraction, which turns L by |1 - 1 / eta| times the microfacet's angle where reflection turns
 * it by 2: the width of the lobe in L decides. With equal or nearly equal iors light goes straight on however
 * rough the boundary is, and a half vector would be rounding noise. */
FN bool is_delta_refraction(vec2 alpha, float eta)
{
    return max(alpha[0], alpha[1]) * abs(eta - 1.0f) <= 2.0f * ALPHA_DELTA * eta;
}

FN bool layers_specular_is_delta(Layers m)
{
    if (!has_layer(m, LAYER_ANISOTROPY))
        return m.base.alpha <= ALPHA_DELTA;
    return is_delta_alpha(layers_alpha(m, m.base.alpha));
}
FN bool layers_transmission_is_delta(Layers m)
{
    vec2 alpha = layers_alpha(m, layers_transmission_alpha(m));
    if (has_layer(m, LAYER_VOLUME))
        return is_delta_refraction(alpha, m.eta);
    return is_delta_alpha(alpha);
}
FN bool layers_clearcoat_is_delta(Layers m)
{
    return alpha_from_roughness(m.clearcoat_roughness) <= ALPHA_DELTA;
}

/* Whether reflection and transmission share one microfacet, as both lobes of a volume's boundary do. The
 * microfacet's own Fresnel term then chooses between them, so no weight exceeds the albedo of the boundary; a
 * choice before sampling would give a totally reflecting microfacet the weight 1 / R. */
FN bool layers_is_coupled(Layers m)
{
    if (!has_layer(m, LAYER_TRANSMISSION) || !has_layer(m, LAYER_VOLUME))
        return false;
    return !layers_specular_is_delta(m) && !layers_transmission_is_delta(m);
}

/* LOBE_* of the non-specular lobes. */
FN uint layers_scattering_lobes(Layers m)
{
    uint lobes = 0u;
    if (!layers_specular_is_delta(m))
        lobes = lobes | LOBE_SPECULAR;
    if (has_layer(m, LAYER_TRANSMISSION) && !layers_transmission_is_delta(m))
        lobes = lobes | LOBE_TRANSMISSION;
    if (has_layer(m, LAYER_CLEARCOAT) && !layers_clearcoat_is_delta(m))
        lobes = lobes | LOBE_CLEARCOAT;
    return lobes;
}

/* ---- probabilities ---- */

/* Transmittance of coat and sheen. */
FN float layers_below_coat(Layers m, vec3 V)
{
    if (!has_layer(m, LAYER_CLEARCOAT))
        return 1.0f;
    return 1.0f - m.clearcoat * F_clearcoat(layers_clearcoat_NdotV(m, V));
}
FN float layers_below_sheen(Layers m, LayerTables t)
{
    if (!has_layer(m, LAYER_SHEEN))
        return 1.0f;
    return sheen_scaling(m.sheen_color, t.sheen_E);
}

/* Albedo and transmittance of the base's boundary towards V in ENERGY_CONSERVING, from the terms of its
 * weights. */
FN BoundaryWeights layers_boundary_albedo_conserving(Layers m, float NdotV, LayerTables t)
{
    BoundaryWeights w = boundary_weights_conserving(m, NdotV, NdotV, t);
    float E = t.dfg[0] + t.dfg[1];
    vec3 R_metal = specular_albedo(m.base.base_color, vec3(1.0f), t.dfg);
    vec3 R_base = specular_albedo(m.base.F0, vec3(m.base.F90), t.dfg);
    if (layers_is_exact(m, ENERGY_CONSERVING))
        R_base = exact_boundary(m, t).R;
    else if (layers_is_inside(m))
        R_base = layers_F_base(m, NdotV);
    if (has_layer(m, LAYER_IRIDESCENCE)) {
        R_base = mix(R_base, t.film_F_base * multiscatter_scale(t.film_F_base, E) * E, t.film_weight);
        R_metal = mix(R_metal, t.film_F_metal * multiscatter_scale(t.film_F_metal, E) * E, t.film_weight);
    }
    w.specular = mix(R_base, R_metal, m.base.metallic);
    if (!layers_transmission_is_delta(m))
        w.through = w.below;
    return w;
}

/* The same for ENERGY_GLTF, estimated. Inside a volume, weights belong to microfacets: some that face V
 * transmit where N.V is beyond the critical angle. */
FN BoundaryWeights layers_boundary_albedo_gltf(Layers m, float NdotV, LayerTables t)
{
    float E = t.dfg[0] + t.dfg[1];
    BoundaryWeights w = boundary_weights_gltf(m, NdotV, t);
    w.specular *= E;
    if (layers_is_inside(m))
        w.below = max(w.below, 0.3f * boundary_weights_gltf(m, 1.0f, t).below);
    if (layers_is_inside(m) || has_layer(m, LAYER_IRIDESCENCE))
        return w;
    vec3 F_base = m.base.F0 * t.dfg[0] + vec3(m.base.F90) * t.dfg[1];
    vec3 F_metal = m.base.base_color * t.dfg[0] + t.dfg[1];
    w.specular = mix(F_base, F_metal, m.base.metallic);
    w.below = (1.0f - m.base.metallic) * (1.0f - max3(F_base));
    if (!layers_transmission_is_delta(m))
        w.through = w.below;
    return w;
}

FN BoundaryWeights layers_boundary_albedo(Layers m, float NdotV, int energy, LayerTables t)
{
    if (energy == ENERGY_CONSERVING)
        return layers_boundary_albedo_conserving(m, NdotV, t);
    return layers_boundary_albedo_gltf(m, NdotV, t);
}

/* Probability of a lobe with this fraction of the sum: at least 0.05 if above 0. */
FN float lobe_excess(float share)
{
    return max(share - 0.05f, 0.0f);
}
FN float lobe_probability(float share, float scale)
{
    return sel(share > 0.0f, 0.05f + lobe_excess(share) * scale, 0.0f);
}

/* Probabilities proportional to albedos, but none below 0.05, taken from the larger ones. Without such small
 * lobes the sample weight is the total albedo. */
FN LayersLobes lobes_normalised(LayersLobes w)
{
    float sum = w.clearcoat + w.sheen + w.specular + w.diffuse + w.transmission + w.diffuse_back;
    float inverse = sel(sum > 0.0f, 1.0f / max(sum, 1e-30f), 0.0f);
    w.clearcoat *= inverse;
    w.sheen *= inverse;
    w.specular *= inverse;
    w.diffuse *= inverse;
    w.transmission *= inverse;
    w.diffuse_back *= inverse;
    float count = sel(w.clearcoat > 0.0f, 1.0f, 0.0f) + sel(w.sheen > 0.0f, 1.0f, 0.0f) +
                  sel(w.specular > 0.0f, 1.0f, 0.0f) + sel(w.diffuse > 0.0f, 1.0f, 0.0f) +
                  sel(w.transmission > 0.0f, 1.0f, 0.0f) + sel(w.diffuse_back > 0.0f, 1.0f, 0.0f);
    float excess = lobe_excess(w.clearcoat) + lobe_excess(w.sheen) + lobe_excess(w.specular) +
                   lobe_excess(w.diffuse) + lobe_excess(w.transmission) + lobe_excess(w.diffuse_back);
    float scale = (1.0f - 0.05f * count) / max(excess, 1e-6f);
    LayersLobes p;
    p.clearcoat = lobe_probability(w.clearcoat, scale);
    p.sheen = lobe_probability(w.sheen, scale);
    p.specular = lobe_probability(w.specular, scale);
    p.diffuse = lobe_probability(w.diffuse, scale);
    p.transmission = lobe_probability(w.transmission, scale);
    p.diffuse_back = lobe_probability(w.diffuse_back, scale);
    return p;
}

/* lobes_normalised() for the two lobes of a surface without layers. */
FN LayersLobes layers_lobes_plain(Layers m, int energy, LayerTables t)
{
    vec3 R_base = m.base.F0 * t.dfg[0] + vec3(m.base.F90) * t.dfg[1];
    vec3 R_metal = m.base.base_color * t.dfg[0] + t.dfg[1];
    if (energy == ENERGY_CONSERVING) {
        float E = t.dfg[0] + t.dfg[1];
        R_base *= multiscatter_scale(F_avg(m.base.F0, vec3(m.base.F90)), E);
        R_metal *= multiscatter_scale(F_avg(m.base.base_color, vec3(1.0f)), E);
    }
    float specular = max3(mix(R_base, R_metal, m.base.metallic));
    float diffuse = (1.0f - m.base.metallic) * max(1.0f - max3(R_base), 0.0f) * max3(m.base.base_color);
    float share = specular / max(specular + diffuse, 1e-30f);
    if (specular > 0.0f && diffuse > 0.0f)
        share = clamp(share, 0.05f, 0.95f);
    LayersLobes p;
    p.clearcoat = 0.0f;
    p.sheen = 0.0f;
    p.specular = share;
    p.diffuse = sel(diffuse > 0.0f, 1.0f - share, 0.0f);
    p.transmission = 0.0f;
    p.diffuse_back = 0.0f;
    return p;
}

/* The largest channel represents the lobe, so that no channel's weight exceeds the lobe's albedo by much,
 * whatever its color. V unit, towards the eye. */
FN LayersLobes layers_lobes(Layers m, vec3 V, int energy, LayerTables t)
{
    if (m.layers == 0u)
        return layers_lobes_plain(m, energy, t);
    float NdotV = surface_NdotV(m.base, V);
    float coat_left = layers_below_coat(m, V);
    float left = coat_left * layers_below_sheen(m, t);
    BoundaryWeights b = layers_boundary_albedo(m, NdotV, energy, t);
    LayersLobes w;
    w.clearcoat = 1.0f - coat_left;
    w.sheen = 0.0f;
    if (has_layer(m, LAYER_SHEEN))
        w.sheen = coat_left * min(max3(m.sheen_color) * t.sheen_E, 1.0f);
    w.specular = left * max3(b.specular);
    float below = left * b.below;
    w.transmission = 0.0f;
    w.diffuse_back = 0.0f;
    if ((m.layers & (LAYER_TRANSMISSION | LAYER_DIFFUSE_TRANSMISSION)) == 0u) {
        w.diffuse = below * max3(m.base.base_color);
        return lobes_normalised(w);
    }
    BelowShares share = below_shares(m);
    w.diffuse = below * max3(share.diffuse);
    w.transmission = left * b.through * max3(share.specular);
    vec3 back = share.diffuse_back;
    if (has_layer(m, LAYER_VOLUME))
        back *= volume_transmittance(m.attenuation_color, m.attenuation_distance, m.thickness);
    w.diffuse_back = below * max3(back);
    return lobes_normalised(w);
}

/* ---- densities ---- */

/* Density per sr of a reflection by sample_bounded_VNDF_GGX() of one width; V above N. */
FN float pdf_reflection(vec3 N, vec3 V, vec3 L, float alpha)
{
    vec3 sum = V + L;
    float sum2 = dot(sum, sum);
    if (dot(N, L) <= 0.0f || sum2 < 1e-12f)
        return 0.0f;
    vec3 H = sum * inversesqrt(sum2);
    float NdotV = clamp(dot(N, V), NDOTV_MIN, 1.0f);
    return D_GGX_stable(clamp(dot(N, H), 0.0f, 1.0f), cross(N, H), alpha) /
           (2.0f * (bounded_VNDF_k(NdotV, alpha, alpha) * NdotV + smith_root_GGX(NdotV, alpha)));
}

/* The same with two widths, in the frame of the lobe. */
FN float pdf_reflection_anisotropic(vec3 V, vec3 L, vec2 alpha)
{
    vec3 sum = V + L;
    float sum2 = dot(sum, sum);
    if (L[2] <= 0.0f || sum2 < 1e-12f)
        return 0.0f;
    return pdf_bounded_reflection(V, sum * inversesqrt(sum2), alpha[0], alpha[1]);
}

/* Probability of reflection, rather than transmission, at a microfacet of a coupled boundary at V.H:
 * proportional to their albedos, by Fresnel's equations in either energy mode. A film may reflect any
 * fraction. */
FN float layers_reflection_share(Layers m, float VdotH)
{
    vec3 F = layers_F_base(m, VdotH);
    if (m.ior >= 1.0f)
        F = layers_F_exact(m, VdotH);
    vec3 F_metal = F_Schlick(m.base.base_color, vec3(1.0f), VdotH);
    float r = max3(mix(F, F_metal, m.base.metallic));
    float s = (1.0f - m.base.metallic) * (1.0f - max3(F)) * m.transmission * max3(m.base.base_color);
    float least = sel(has_layer(m, LAYER_IRIDESCENCE), 0.3f, 0.02f);
    if (s <= 0.0f)
        return 1.0f;
    return clamp(r / (r + s), least, 1.0f - least);
}

/* V above the base, in the frame of its lobes. */
FN vec3 layers_V_local(Layers m, vec3 V)
{
    vec3 v = layers_to_any_frame(m, V);
    v[2] = max(v[2], NDOTV_MIN);
    return v;
}

FN float layers_specular_pdf(Layers m, vec3 V, vec3 L)
{
    if (has_layer(m, LAYER_ANISOTROPY))
        return pdf_reflection_anisotropic(layers_V_local(m, V), layers_to_frame(m, L),
                                          layers_alpha(m, m.base.alpha));
    return pdf_reflection(m.base.N, V, L, max(m.base.alpha, ALPHA_DELTA));
}

FN float layers_transmission_pdf(Layers m, vec3 V, vec3 L)
{
    vec3 v = layers_V_local(m, V);
    vec3 l = layers_to_any_frame(m, L);
    vec2 alpha = layers_alpha(m, layers_transmission_alpha(m));
    if (has_layer(m, LAYER_VOLUME))
        return pdf_transmission(v, l, alpha[0], alpha[1], m.eta);
    return pdf_thin_wall(v, l, alpha[0], alpha[1]);
}

/* For both lobes of a coupled boundary. */
FN float layers_coupled_pdf(Layers m, vec3 V, vec3 L)
{
    vec3 v = layers_V_local(m, V);
    vec3 l = layers_to_any_frame(m, L);
    vec2 alpha = layers_alpha(m, m.base.alpha);
    if (l[2] < 0.0f) {
        float q = layers_reflection_share(m, transmission_VdotH(v, l, m.eta));
        return pdf_transmission(v, l, alpha[0], alpha[1], m.eta) * (1.0f - q);
    }
    vec3 sum = v + l;
    float sum2 = dot(sum, sum);
    if (l[2] == 0.0f || sum2 < 1e-12f)
        return 0.0f;
    vec3 H = sum * inversesqrt(sum2);
    float VdotH = dot(v, H);
    return pdf_VNDF_GGX(v, H, alpha[0], alpha[1]) / (4.0f * VdotH) * layers_reflection_share(m, VdotH);
}

FN float layers_clearcoat_pdf(Layers m, vec3 V, vec3 L)
{
    return pdf_reflection(m.clearcoat_N, view_above(m.clearcoat_N, V), L,
                          alpha_from_roughness(m.clearcoat_roughness));
}

/* Of diffuse reflection, or of diffuse transmission with V and L mirrored; V above N. */
FN float layers_diffuse_pdf(Layers m, vec3 V, vec3 L, float NdotL)
{
    if (!has_layer(m, LAYER_DIFFUSE_ROUGHNESS))
        return pdf_cosine(NdotL);
    vec3 l = mul(transpose(basis_from_view(m.base.N, V)), L);
    l[2] = NdotL;
    return pdf_eon(l, surface_NdotV(m.base, V), m.diffuse_roughness);
}

/* Density per sr of L in layers_sample(), for the non-specular lobes. */
FN float layers_pdf(Layers m, LayersLobes p, vec3 V_eye, vec3 L)
{
    vec3 V = view_above(m.base.N, V_eye);
    float NdotL = dot(m.base.N, L);
    float pdf = p.diffuse * layers_diffuse_pdf(m, V, L, NdotL);
    bool is_coupled = layers_is_coupled(m);
    if (p.specular > 0.0f && NdotL > 0.0f && !is_coupled && !layers_specular_is_delta(m))
        pdf += p.specular * layers_specular_pdf(m, V, L);
    if (m.layers == 0u)
        return pdf;
    if (is_coupled)
        pdf += (p.specular + p.transmission) * layers_coupled_pdf(m, V, L);
    pdf += p.diffuse_back * layers_diffuse_pdf(m, V, L, -NdotL);
    if (p.sheen > 0.0f)
        pdf += p.sheen * pdf_sheen_rim(NdotL, surface_NdotV(m.base, V), sheen_alpha(m.sheen_roughness));
    if (p.transmission > 0.0f && NdotL < 0.0f && !is_coupled && !layers_transmission_is_delta(m))
        pdf += p.transmission * layers_transmission_pdf(m, V, L);
    if (p.clearcoat > 0.0f && !layers_clearcoat_is_delta(m))
        pdf += p.clearcoat * layers_clearcoat_pdf(m, V_eye, L);
    return pdf;
}

/* ---- values ---- */

/* layers_brdf_cos() of the non-specular lobes, whose density is layers_pdf(). */
FN vec3 layers_scatter_cos(Layers m, vec3 V_eye, vec3 L, int energy, LayerTables t, float sheen_E_L)
{
    uint lobes = layers_scattering_lobes(m);
    vec3 V = view_above(m.base.N, V_eye);
    vec3 f = layers_base_cos(m, V, L, energy, t, lobes);
    if (has_layer(m, LAYER_SHEEN))
        f = layers_sheen_cos(m, V, L, energy, t, sheen_E_L, f);
    if (has_layer(m, LAYER_CLEARCOAT))
        f = layers_clearcoat_cos(m, view_above(m.clearcoat_N, V_eye), L, energy, t, f, lobes);
    return f;
}

/* ---- samples ---- */

FN LayersSample no_sample(vec3 L)
{
    LayersSample s;
    s.L = L;
    s.pdf = 0.0f;
    s.weight = vec3(0.0f);
    s.is_delta = false;
    s.is_through = false;
    s.is_valid = false;
    return s;
}

/* Columns: the axes of layers_to_any_frame(). */
FN mat3 layers_any_frame(Layers m)
{
    if (has_layer(m, LAYER_ANISOTROPY))
        return mat3(m.anisotropy_T, m.anisotropy_B, m.base.N);
    return basis_from_normal(m.base.N);
}

/* Sampled directions L in world space; the zero vector if the lobe gives none. */

/* On the side of V, which is above N. */
FN vec3 layers_draw_diffuse(Layers m, vec3 V, vec2 u)
{
    if (!has_layer(m, LAYER_DIFFUSE_ROUGHNESS))
        return mul(basis_from_normal(m.base.N), sample_cosine(u));
    return mul(basis_from_view(m.base.N, V), sample_eon(u, surface_NdotV(m.base, V), m.diffuse_roughness));
}

FN vec3 layers_draw_clearcoat(Layers m, vec3 V, vec2 u)
{
    float alpha = alpha_from_roughness(m.clearcoat_roughness);
    mat3 frame = basis_from_normal(m.clearcoat_N);
    vec3 v = mul(transpose(frame), view_above(m.clearcoat_N, V));
    v[2] = max(v[2], NDOTV_MIN);
    vec3 L = reflect(-v, sample_bounded_VNDF_GGX(u, v, alpha, alpha));
    return sel(L[2] > 0.0f, normalize(mul(frame, L)), vec3(0.0f));
}

FN vec3 layers_draw_sheen(Layers m, vec3 V, vec2 u)
{
    vec3 L = sample_sheen_rim(u, surface_NdotV(m.base, V), sheen_alpha(m.sheen_roughness));
    return mul(basis_from_normal(m.base.N), L);
}

/* One of the two non-specular lobes of the base's boundary, transmission for u_side above p_specular; at a
 * coupled boundary the microfacet decides. V above N. */
FN vec3 layers_draw_boundary(Layers m, vec3 V, float u_side, float p_specular, vec2 u)
{
    bool is_coupled = layers_is_coupled(m);
    bool is_through = u_side >= p_specular;
    mat3 frame = layers_any_frame(m);
    vec3 v = mul(transpose(frame), V);
    v[2] = max(v[2], NDOTV_MIN);
    vec2 alpha = layers_alpha(m, m.base.alpha);
    if (is_through && !is_coupled)
        alpha = layers_alpha(m, layers_transmission_alpha(m));
    vec3 H;
    if (is_through || is_coupled)
        H = sample_VNDF_GGX(u, v, alpha[0], alpha[1]);
    else
        H = sample_bounded_VNDF_GGX(u, v, alpha[0], alpha[1]);
    if (is_coupled)
        is_through = u_side >= layers_reflection_share(m, clamp(dot(v, H), 0.0f, 1.0f));
    vec3 L = reflect(-v, H);
    if (!is_through)
        return sel(L[2] > 0.0f, normalize(mul(frame, L)), vec3(0.0f));
    if (has_layer(m, LAYER_VOLUME))
        L = refract_or_zero(-v, H, m.eta);
    else
        L[2] = -L[2];
    return sel(L[2] < 0.0f, normalize(mul(frame, L)), vec3(0.0f));
}

/* Transmittance of a boundary with specular refraction. If it is specular because the iors are nearly equal,
 * all microfacets of a rough boundary transmit straight on: glTF's term is their mean, by the split sum, less
 * the masking G2; the conserving one is all that is not reflected. V and L in the base's frame. */
FN float layers_delta_through(Layers m, BoundaryWeights b, vec3 V, vec3 L, int energy, LayerTables t)
{
    bool is_smooth = layers_specular_is_delta(m);
    if (energy == ENERGY_CONSERVING)
        return sel(is_smooth, b.through, b.below);
    if (!has_layer(m, LAYER_VOLUME))
        return b.through;
    vec2 alpha = layers_alpha(m, m.base.alpha);
    float lobe = weight_VNDF_GGX(V, vec3(L[0], L[1], max(abs(L[2]), NDOTV_MIN)), alpha[0], alpha[1]);
    if (is_smooth || has_layer(m, LAYER_IRIDESCENCE))
        return b.through * lobe;
    vec3 F = (m.base.F0 * t.dfg[0] + vec3(m.base.F90) * t.dfg[1]) / max(t.dfg[0] + t.dfg[1], 1e-3f);
    return (1.0f - m.base.metallic) * max(1.0f - max3(F), 0.0f) * lobe;
}

/* Specular lobes: their boundary weights are those of N.V, the cosine of the microfacet. */
FN LayersSample layers_sample_delta(Layers m, LayersLobes p, vec3 V_eye, bool is_through, int energy,
                                    LayerTables t)
{
    vec3 V = view_above(m.base.N, V_eye);
    float NdotV = surface_NdotV(m.base, V);
    float above = layers_below_coat(m, V_eye) * layers_below_sheen(m, t);
    BoundaryWeights b = boundary_weights(m, NdotV, NdotV, energy, t);
    LayersSample s = no_sample(normalize(reflect(-V, m.base.N)));
    s.is_delta = true;
    s.is_through = is_through;
    if (!is_through) {
        s.weight = b.specular * (above / p.specular);
        s.is_valid = max3(s.weight) > 0.0f;
        return s;
    }
    s.L = -V_eye;
    if (has_layer(m, LAYER_VOLUME) && m.eta != 1.0f)
        s.L = refract_or_zero(-V, m.base.N, m.eta);
    float through = layers_delta_through(m, b, layers_V_local(m, V), layers_to_any_frame(m, s.L), energy, t);
    s.weight = below_shares(m).specular * (through * above / p.transmission);
    s.is_valid = max3(s.weight) > 0.0f && dot(s.L, s.L) > 0.5f;
    return s;
}

FN LayersSample layers_sample_delta_clearcoat(Layers m, LayersLobes p, vec3 V)
{
    vec3 N = m.clearcoat_N;
    LayersSample s = no_sample(normalize(reflect(-view_above(N, V), N)));
    s.weight = vec3((1.0f - layers_below_coat(m, V)) / p.clearcoat);
    s.is_delta = true;
    s.is_through = dot(m.base.N, s.L) < 0.0f;
    s.is_valid = s.weight[0] > 0.0f;
    return s;
}

/* Samples L from u_lobe and u, uniform in [0, 1). For a dispersive surface (LAYER_DISPERSION) first choose a
 * wavelength: layers_with_wavelength(), with LUT values of that ior. */
FN LayersSample layers_sample(Layers m, LayersLobes p, vec3 V_eye, float u_lobe, vec2 u, int energy,
                              LayerTables t)
{
    vec3 V = view_above(m.base.N, V_eye);
    vec3 L = vec3(0.0f);
    float boundary = p.specular + p.transmission;
    float x = u_lobe - p.diffuse;
    float y = x - boundary;
    float z = y - p.diffuse_back;
    if (x < 0.0f) {
        L = layers_draw_diffuse(m, V, u);
    } else if (y < 0.0f) {
        bool is_through = x >= p.specular;
        if (layers_is_coupled(m))
            L = layers_draw_boundary(m, V, x / boundary, 0.0f, u);
        else if ((is_through && layers_transmission_is_delta(m)) ||
                 (!is_through && layers_specular_is_delta(m)))
            return layers_sample_delta(m, p, V_eye, is_through, energy, t);
        else
            L = layers_draw_boundary(m, V, x, p.specular, u);
    } else if (z < 0.0f) {
        L = -mul(basis_from_normal(m.base.N), sample_cosine(u));
        if (has_layer(m, LAYER_DIFFUSE_ROUGHNESS))
            L = mirror_through(layers_draw_diffuse(m, V, u), m.base.N);
    } else if (z < p.clearcoat) {
        if (layers_clearcoat_is_delta(m))
            return layers_sample_delta_clearcoat(m, p, V_eye);
        L = layers_draw_clearcoat(m, V_eye, u);
    } else if (p.sheen > 0.0f) {
        L = layers_draw_sheen(m, V, u);
    }
    LayersSample s = no_sample(L);
    if (dot(L, L) < 0.5f)
        return s;
    s.pdf = layers_pdf(m, p, V_eye, L);
    s.is_through = dot(m.base.N, L) < 0.0f;
    s.is_valid = s.pdf > 0.0f;
    return s;
}

#endif
