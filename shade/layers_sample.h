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
    bool
        is_mirror; /* the lobe is too narrow to be evaluated: no other way of finding L has a density for it */
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

/* Albedo estimates of the base's boundary towards V: what it reflects, and what goes below. Inside a volume, glTF's
 * weights are those of each microfacet: some that face V let light out where N.V is beyond the critical angle. */
FN BoundaryWeights layers_boundary_albedo(Layers m, float NdotV, int energy, LayerTables t)
{
    BoundaryWeights w;
    float E = t.dfg[0] + t.dfg[1];
    if (energy == ENERGY_CONSERVING) {
        w = boundary_weights(m, NdotV, NdotV, energy, t);
        w.specular *= E;
        return w;
    }
    if (layers_is_inside(m) || has_layer(m, LAYER_IRIDESCENCE)) {
        w = boundary_weights(m, NdotV, NdotV, energy, t);
        w.specular *= E;
        if (!layers_transmission_is_mirror(m) || has_layer(m, LAYER_DIFFUSE_TRANSMISSION) ||
            m.transmission < 1.0f)
            w.below = max(w.below, boundary_weights(m, NdotV, 1.0f, energy, t).below * 0.3f);
        return w;
    }
    vec3 F_base = m.base.F0 * t.dfg[0] + vec3(m.base.F90) * t.dfg[1];
    vec3 F_metal = m.base.base_color * t.dfg[0] + t.dfg[1];
    w.specular = mix(F_base, F_metal, m.base.metallic);
    w.below = (1.0f - m.base.metallic) * (1.0f - max3(F_base));
    return w;
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

/* The largest channel stands for the lobe: then no channel's weight exceeds what the lobe returns by much, whatever its
 * color. V unit, towards the eye. */
FN LayersLobes layers_lobes(Layers m, vec3 V, int energy, LayerTables t)
{
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
    w.transmission = below * max3(share.specular);
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
    vec3 V_local = vec3(sqrt((1.0f - NdotV) * (1.0f + NdotV)), 0.0f, NdotV);
    return D_GGX_stable(clamp(dot(N, H), 0.0f, 1.0f), cross(N, H), alpha) /
           (2.0f * (bounded_VNDF_k(V_local, alpha, alpha) * NdotV + smith_root_GGX(NdotV, alpha)));
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
    if (p.specular > 0.0f && NdotL > 0.0f && !layers_specular_is_mirror(m))
        pdf += p.specular * layers_specular_pdf(m, V, L);
    if (m.layers == 0u)
        return pdf;
    pdf += p.diffuse_back * pdf_cosine(-NdotL);
    if (p.sheen > 0.0f)
        pdf += p.sheen * pdf_sheen_rim(NdotL, surface_NdotV(m.base, V), sheen_alpha(m.sheen_roughness));
    if (p.transmission > 0.0f && NdotL < 0.0f && !layers_transmission_is_mirror(m))
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

/* Weight of a mirror and its direction; the zero vector: there is none. */
FN LayersSample mirror_sample(Layers m, vec3 L, vec3 weight)
{
    LayersSample s = no_sample(L);
    s.weight = weight;
    s.is_mirror = true;
    s.is_through = dot(m.base.N, L) < 0.0f;
    s.is_valid = max3(weight) > 0.0f && dot(L, L) > 0.5f;
    return s;
}

/* A direction of which the density is all that is left to say. */
FN LayersSample scattered_sample(Layers m, LayersLobes p, vec3 V_eye, vec3 L)
{
    LayersSample s = no_sample(L);
    if (dot(L, L) < 0.5f)
        return s;
    s.pdf = layers_pdf(m, p, V_eye, L);
    s.is_through = dot(m.base.N, L) < 0.0f;
    s.is_valid = s.pdf > 0.0f;
    return s;
}

/* Columns: the axes of layers_to_any_frame(). */
FN mat3 layers_any_frame(Layers m)
{
    if (has_layer(m, LAYER_ANISOTROPY))
        return mat3(m.anisotropy_T, m.anisotropy_B, m.base.N);
    return basis_from_normal(m.base.N);
}

FN LayersSample layers_sample_clearcoat(Layers m, LayersLobes p, vec3 V_eye, vec2 u)
{
    vec3 N = m.clearcoat_N;
    vec3 V = view_above(N, V_eye);
    if (layers_clearcoat_is_mirror(m))
        return mirror_sample(m, normalize(reflect(-V, N)),
                             vec3((1.0f - layers_below_coat(m, V)) / p.clearcoat));
    float alpha = alpha_from_roughness(m.clearcoat_roughness);
    mat3 frame = basis_from_normal(N);
    vec3 v = mul(transpose(frame), V);
    vec3 L = reflect(-v, sample_bounded_VNDF_GGX(u, v, alpha, alpha));
    return scattered_sample(m, p, V_eye, sel(L[2] > 0.0f, normalize(mul(frame, L)), vec3(0.0f)));
}

/* Mirrors: the boundary weights are those of N.V, the microfacet's cosine there. */
FN LayersSample layers_sample_specular(Layers m, LayersLobes p, vec3 V_eye, vec2 u, int energy, LayerTables t)
{
    vec3 V = view_above(m.base.N, V_eye);
    if (layers_specular_is_mirror(m)) {
        float NdotV = surface_NdotV(m.base, V);
        vec3 F = boundary_weights(m, NdotV, NdotV, energy, t).specular;
        float above = layers_below_coat(m, V_eye) * layers_below_sheen(m, t);
        return mirror_sample(m, normalize(reflect(-V, m.base.N)), F * (above / p.specular));
    }
    vec2 alpha = layers_alpha(m, m.base.alpha);
    mat3 frame = layers_any_frame(m);
    vec3 v = mul(transpose(frame), V);
    v[2] = max(v[2], NDOTV_MIN);
    vec3 L = reflect(-v, sample_bounded_VNDF_GGX(u, v, alpha[0], alpha[1]));
    return scattered_sample(m, p, V_eye, sel(L[2] > 0.0f, normalize(mul(frame, L)), vec3(0.0f)));
}

/* Straight on through a thin wall, refracted by a volume's boundary; the lobe's own loss where glTF's has one. */
FN LayersSample layers_transmission_mirror(Layers m, LayersLobes p, vec3 V_eye, int energy, LayerTables t)
{
    vec3 V = view_above(m.base.N, V_eye);
    float NdotV = surface_NdotV(m.base, V);
    vec2 alpha = layers_alpha(m, layers_transmission_alpha(m));
    vec3 L = -V_eye;
    if (has_layer(m, LAYER_VOLUME) && m.eta != 1.0f)
        L = refract_or_zero(-V, m.base.N, m.eta);
    vec3 l = layers_to_any_frame(m, L);
    l[2] = -max(abs(l[2]), NDOTV_MIN);
    float lobe = 1.0f;
    if (has_layer(m, LAYER_VOLUME))
        lobe = weight_VNDF_GGX(layers_V_local(m, V), l, alpha[0], alpha[1]);
    float above = layers_below_coat(m, V_eye) * layers_below_sheen(m, t);
    float below = boundary_weights(m, NdotV, NdotV, energy, t).below;
    LayersSample s = mirror_sample(m, L, below_shares(m).specular * (below * lobe * above / p.transmission));
    s.is_through = true;
    return s;
}

FN LayersSample layers_sample_transmission(Layers m, LayersLobes p, vec3 V_eye, vec2 u, int energy,
                                           LayerTables t)
{
    if (layers_transmission_is_mirror(m))
        return layers_transmission_mirror(m, p, V_eye, energy, t);
    vec2 alpha = layers_alpha(m, layers_transmission_alpha(m));
    mat3 frame = layers_any_frame(m);
    vec3 v = mul(transpose(frame), view_above(m.base.N, V_eye));
    v[2] = max(v[2], NDOTV_MIN);
    TransmissionSample through;
    if (has_layer(m, LAYER_VOLUME))
        through = sample_transmission(u, v, alpha[0], alpha[1], m.eta);
    else
        through = sample_thin_wall(u, v, alpha[0], alpha[1]);
    return scattered_sample(m, p, V_eye,
                            sel(through.pdf > 0.0f, normalize(mul(frame, through.L)), vec3(0.0f)));
}

/* L for u_lobe and u, uniform in [0, 1). A surface that disperses (LAYER_DISPERSION) is to be given one ior first:
 * layers_with_wavelength(). */
FN LayersSample layers_sample(Layers m, LayersLobes p, vec3 V, float u_lobe, vec2 u, int energy,
                              LayerTables t)
{
    float x = u_lobe - p.diffuse;
    if (x < 0.0f)
        return scattered_sample(m, p, V, mul(basis_from_normal(m.base.N), sample_cosine(u)));
    x -= p.specular;
    if (x < 0.0f)
        return layers_sample_specular(m, p, V, u, energy, t);
    x -= p.transmission;
    if (x < 0.0f)
        return layers_sample_transmission(m, p, V, u, energy, t);
    x -= p.clearcoat;
    if (x < 0.0f)
        return layers_sample_clearcoat(m, p, V, u);
    x -= p.diffuse_back;
    if (x < 0.0f)
        return scattered_sample(m, p, V, mul(basis_from_normal(-m.base.N), sample_cosine(u)));
    if (p.sheen > 0.0f)
        return scattered_sample(
            m, p, V,
            mul(basis_from_normal(m.base.N),
                sample_sheen_rim(u, surface_NdotV(m.base, V), sheen_alpha(m.sheen_roughness))));
    return no_sample(m.base.N);
}

#endif
