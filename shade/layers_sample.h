/* layers_sample.h - the layered surface for paths: one lobe is chosen, a direction is drawn from it, and the density is
 * that of all lobes together (one-sample multiple importance sampling, Veach 1997, section 9.2.4), so that
 *     f |N.L| / pdf
 * is right whatever the probabilities, as long as none is 0 where its lobe is not.
 *
 * Mirrors, lobes too narrow to be evaluated in single precision, stand beside that: they have a direction, no density,
 * and a weight of their own. What is a mirror depends on the surface alone.
 *
 * A mapped normal may turn away from the eye. Lobes then take the nearest V that is above it (view_above()), for
 * drawing, densities and values alike: with the V that is below, they would be drawn in one place and be in another. */
#ifndef SHADE_LAYERS_SAMPLE_H
#define SHADE_LAYERS_SAMPLE_H

/* Probabilities of the lobes; they add up to 1, or are all 0 where the surface sends nothing to V. */
STRUCT(LayersLobes)
{
    float clearcoat;
    float sheen;
    float specular; /* reflection at the base's boundary, of dielectric and metal */
    float diffuse;
    float transmission; /* specular, through a thin wall or a volume's boundary */
    float diffuse_back;
};

/* A direction to go on in. */
STRUCT(LayersSample)
{
    vec3 L;      /* unit */
    float pdf;   /* per sr, of all lobes that are not mirrors; of a mirror 0 */
    vec3 weight; /* of a mirror: f |N.L| / pdf, with the probability of its choice in it; else 0 */
    /* the lobe is too narrow to be evaluated: no other way of finding L has a density for it */
    bool is_mirror;
    bool is_through; /* L is on the other side of the surface: N.L < 0 */
    bool is_valid;   /* false: the path ends here */
};

/* ---- one of many wavelengths ---- */

/* The surface for light of one wavelength: with the ior that it has there, and without dispersion. Its tables are other
 * ones, too. Dispersion 0 leaves eta as it is. */
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

/* ---- mirrors ---- */

/* V, or the nearest direction to it that is not below the surface. */
FN vec3 view_above(vec3 N, vec3 V)
{
    float NdotV = dot(N, V);
    if (NdotV >= NDOTV_MIN)
        return V;
    return normalize(V + N * (NDOTV_MIN - NdotV));
}

/* Whether a lobe of these widths is a mirror: not wider than the narrowest that is evaluated. There a direction's
 * rounding, 6e-8, is 6e-4 of the width, and moves D by about as much. */
FN bool is_mirror_alpha(vec2 alpha)
{
    return max(alpha[0], alpha[1]) <= ALPHA_MIRROR;
}

/* The same for refraction, which turns L by |1 - 1 / eta| times the microfacet's angle where reflection turns it by 2:
 * what counts is how wide the lobe is in L. With the ior of both sides equal or nearly so, light goes straight on
 * however rough the boundary is, and a half vector would be rounding and nothing else. */
FN bool is_mirror_refraction(vec2 alpha, float eta)
{
    return max(alpha[0], alpha[1]) * abs(eta - 1.0f) <= 2.0f * ALPHA_MIRROR * eta;
}

FN bool layers_specular_is_mirror(Layers m)
{
    if (!has_layer(m, LAYER_ANISOTROPY))
        return m.base.alpha <= ALPHA_MIRROR;
    return is_mirror_alpha(layers_alpha(m, m.base.alpha));
}
FN bool layers_transmission_is_mirror(Layers m)
{
    vec2 alpha = layers_alpha(m, layers_transmission_alpha(m));
    if (has_layer(m, LAYER_VOLUME))
        return is_mirror_refraction(alpha, m.eta);
    return is_mirror_alpha(alpha);
}
FN bool layers_clearcoat_is_mirror(Layers m)
{
    return alpha_from_roughness(m.clearcoat_roughness) <= ALPHA_MIRROR;
}

/* Whether reflection and transmission start from one microfacet: both are lobes of a volume's boundary. Which of the two
 * it is to be is then chosen by the microfacet's own Fresnel term, so that no weight is more than what the boundary
 * returns; chosen before, a microfacet that reflects all would weigh 1 / R. */
FN bool layers_is_coupled(Layers m)
{
    if (!has_layer(m, LAYER_TRANSMISSION) || !has_layer(m, LAYER_VOLUME))
        return false;
    return !layers_specular_is_mirror(m) && !layers_transmission_is_mirror(m);
}

/* LOBE_* of the lobes that are not mirrors. */
FN uint layers_scattering_lobes(Layers m)
{
    uint lobes = 0u;
    if (!layers_specular_is_mirror(m))
        lobes = lobes | LOBE_SPECULAR;
    if (has_layer(m, LAYER_TRANSMISSION) && !layers_transmission_is_mirror(m))
        lobes = lobes | LOBE_TRANSMISSION;
    if (has_layer(m, LAYER_CLEARCOAT) && !layers_clearcoat_is_mirror(m))
        lobes = lobes | LOBE_CLEARCOAT;
    return lobes;
}

/* ---- probabilities ---- */

/* What coat and sheen leave of the base's light. */
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

/* What the base's boundary returns towards V and what goes below it, ENERGY_CONSERVING: the numbers with which its
 * weights are made. */
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
    if (!layers_transmission_is_mirror(m))
        w.through = w.below;
    return w;
}

/* The same of ENERGY_GLTF, by estimates. Inside a volume, its weights are those of each microfacet: some that face V
 * let light out where N.V is beyond the critical angle. */
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
    if (!layers_transmission_is_mirror(m))
        w.through = w.below;
    return w;
}

FN BoundaryWeights layers_boundary_albedo(Layers m, float NdotV, int energy, LayerTables t)
{
    if (energy == ENERGY_CONSERVING)
        return layers_boundary_albedo_conserving(m, NdotV, t);
    return layers_boundary_albedo_gltf(m, NdotV, t);
}

/* p in place of its share of a sum: at least 0.05 where it is above 0. */
FN float lobe_excess(float share)
{
    return max(share - 0.05f, 0.0f);
}
FN float lobe_probability(float share, float scale)
{
    return sel(share > 0.0f, 0.05f + lobe_excess(share) * scale, 0.0f);
}

/* From albedos to probabilities: in proportion, but none below 0.05, which the larger ones give; where none is smaller
 * the probabilities are the albedos' shares, and weights are the albedo itself. */
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

/* lobes_normalised() for two lobes: a surface without layers. */
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

/* The largest channel stands for the lobe: then no channel's weight exceeds what the lobe returns by much, whatever its
 * color. V unit, towards the eye. */
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

/* Of a reflection by sample_bounded_VNDF_GGX() of one width, per sr; V above N. */
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

/* The same of two widths, in the lobe's frame. */
FN float pdf_reflection_anisotropic(vec3 V, vec3 L, vec2 alpha)
{
    vec3 sum = V + L;
    float sum2 = dot(sum, sum);
    if (L[2] <= 0.0f || sum2 < 1e-12f)
        return 0.0f;
    return pdf_bounded_reflection(V, sum * inversesqrt(sum2), alpha[0], alpha[1]);
}

/* Probability that the microfacet at V.H of a coupled boundary is used to reflect, the rest being to transmit: as the
 * two are bright, by Fresnel's equations in either energy mode. A film may reflect any share. */
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

/* V as the base's lobes see it, in their frame. */
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
    return pdf_reflection(m.base.N, V, L, max(m.base.alpha, ALPHA_MIRROR));
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

/* Of both lobes of a coupled boundary. */
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

/* Density per sr with which layers_sample() draws L by lobes that are not mirrors. */
FN float layers_pdf(Layers m, LayersLobes p, vec3 V_eye, vec3 L)
{
    vec3 V = view_above(m.base.N, V_eye);
    float NdotL = dot(m.base.N, L);
    float pdf = p.diffuse * pdf_cosine(NdotL);
    bool is_coupled = layers_is_coupled(m);
    if (p.specular > 0.0f && NdotL > 0.0f && !is_coupled && !layers_specular_is_mirror(m))
        pdf += p.specular * layers_specular_pdf(m, V, L);
    if (m.layers == 0u)
        return pdf;
    if (is_coupled)
        pdf += (p.specular + p.transmission) * layers_coupled_pdf(m, V, L);
    pdf += p.diffuse_back * pdf_cosine(-NdotL);
    if (p.sheen > 0.0f)
        pdf += p.sheen * pdf_sheen_rim(NdotL, surface_NdotV(m.base, V), sheen_alpha(m.sheen_roughness));
    if (p.transmission > 0.0f && NdotL < 0.0f && !is_coupled && !layers_transmission_is_mirror(m))
        pdf += p.transmission * layers_transmission_pdf(m, V, L);
    if (p.clearcoat > 0.0f && !layers_clearcoat_is_mirror(m))
        pdf += p.clearcoat * layers_clearcoat_pdf(m, V_eye, L);
    return pdf;
}

/* ---- values ---- */

/* layers_brdf_cos() of all lobes that are not mirrors: what layers_pdf() is the density for. */
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
    s.is_mirror = false;
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

/* Draws: directions L in world space; the zero vector where the lobe gives none. */

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

/* One of the two lobes of the base's boundary that are not mirrors, transmission above u_side = p_specular; of a coupled
 * boundary both, and the microfacet decides. V above N. */
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

/* What goes through a boundary whose refraction is a mirror. Where that is because the ior of both sides is nearly equal,
 * all microfacets of a rough boundary let light go straight on: glTF's term is that of their mean, by the split sum, less
 * what G2 takes; conserving it is all that is not reflected. V and L in the base's frame. */
FN float layers_mirror_through(Layers m, BoundaryWeights b, vec3 V, vec3 L, int energy, LayerTables t)
{
    bool is_smooth = layers_specular_is_mirror(m);
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

/* Mirrors: their boundary weights are those of N.V, the microfacet's cosine there. */
FN LayersSample layers_mirror(Layers m, LayersLobes p, vec3 V_eye, bool is_through, int energy, LayerTables t)
{
    vec3 V = view_above(m.base.N, V_eye);
    float NdotV = surface_NdotV(m.base, V);
    float above = layers_below_coat(m, V_eye) * layers_below_sheen(m, t);
    BoundaryWeights b = boundary_weights(m, NdotV, NdotV, energy, t);
    LayersSample s = no_sample(normalize(reflect(-V, m.base.N)));
    s.is_mirror = true;
    s.is_through = is_through;
    if (!is_through) {
        s.weight = b.specular * (above / p.specular);
        s.is_valid = max3(s.weight) > 0.0f;
        return s;
    }
    s.L = -V_eye;
    if (has_layer(m, LAYER_VOLUME) && m.eta != 1.0f)
        s.L = refract_or_zero(-V, m.base.N, m.eta);
    float through = layers_mirror_through(m, b, layers_V_local(m, V), layers_to_any_frame(m, s.L), energy, t);
    s.weight = below_shares(m).specular * (through * above / p.transmission);
    s.is_valid = max3(s.weight) > 0.0f && dot(s.L, s.L) > 0.5f;
    return s;
}

FN LayersSample layers_clearcoat_mirror(Layers m, LayersLobes p, vec3 V)
{
    vec3 N = m.clearcoat_N;
    LayersSample s = no_sample(normalize(reflect(-view_above(N, V), N)));
    s.weight = vec3((1.0f - layers_below_coat(m, V)) / p.clearcoat);
    s.is_mirror = true;
    s.is_through = dot(m.base.N, s.L) < 0.0f;
    s.is_valid = s.weight[0] > 0.0f;
    return s;
}

/* L for u_lobe and u, uniform in [0, 1). A surface that disperses (LAYER_DISPERSION) is to be given one ior first, and
 * the tables for it: layers_with_wavelength(). */
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
        L = mul(basis_from_normal(m.base.N), sample_cosine(u));
    } else if (y < 0.0f) {
        bool is_through = x >= p.specular;
        if (layers_is_coupled(m))
            L = layers_draw_boundary(m, V, x / boundary, 0.0f, u);
        else if ((is_through && layers_transmission_is_mirror(m)) ||
                 (!is_through && layers_specular_is_mirror(m)))
            return layers_mirror(m, p, V_eye, is_through, energy, t);
        else
            L = layers_draw_boundary(m, V, x, p.specular, u);
    } else if (z < 0.0f) {
        L = -mul(basis_from_normal(m.base.N), sample_cosine(u));
    } else if (z < p.clearcoat) {
        if (layers_clearcoat_is_mirror(m))
            return layers_clearcoat_mirror(m, p, V_eye);
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
