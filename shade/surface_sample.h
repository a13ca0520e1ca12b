/* surface_sample.h - sampling of the surface without layers (surface.h) for path tracing: as layers_sample.h
 * does it, with value and density in one pass over terms that depend on V alone. */
#ifndef SHADE_SURFACE_SAMPLE_H
#define SHADE_SURFACE_SAMPLE_H

/* Terms of one V, for all directions that are evaluated or sampled there. */
STRUCT(SurfaceLobesAtV)
{
    vec3 V; /* view_above() */
    float NdotV;
    float alpha;     /* GGX width that is evaluated */
    bool is_delta;   /* the specular lobe is specular: neither evaluated nor drawn here */
    vec3 F0;         /* weight of D V at V.H = 1, and its rise to V.H = 0, both with metallic mixed in */
    vec3 F_rise;     /* and multiple scattering compensated */
    vec3 base;       /* diffuse BRDF below the boundary, 1/sr; ENERGY_CONSERVING: weighted */
    float p_diffuse; /* probabilities of the lobes */
    float pdf_per_D; /* density of specular samples over D, times their probability */
};

/* f |N.L| in 1/sr and its density per sr. */
STRUCT(SurfaceValue)
{
    vec3 f;
    float pdf;
};

/* p_specular, p_diffuse: of layers_lobes(). dfg as for surface_lobes_cos(). */
FN SurfaceLobesAtV surface_lobes_at(Surface s, vec3 V_eye, float p_specular, float p_diffuse, int energy,
                                    vec2 dfg)
{
    SurfaceLobesAtV t;
    vec3 F90 = vec3(s.F90);
    vec3 base_scale = vec3(1.0f);
    vec3 metal_scale = vec3(1.0f);
    float below = 1.0f - s.metallic;
    if (energy == ENERGY_CONSERVING) {
        float E = dfg[0] + dfg[1];
        base_scale = multiscatter_scale(F_avg(s.F0, F90), E);
        metal_scale = multiscatter_scale(F_avg(s.base_color, vec3(1.0f)), E);
        below *= 1.0f - max3((s.F0 * dfg[0] + F90 * dfg[1]) * base_scale);
    }
    t.V = view_above(s.N, V_eye);
    t.NdotV = surface_NdotV(s, t.V);
    t.alpha = max(s.alpha, ALPHA_DELTA);
    t.is_delta = s.alpha <= ALPHA_DELTA;
    t.F0 = mix(s.F0 * base_scale, s.base_color * metal_scale, s.metallic);
    t.F_rise = mix((F90 - s.F0) * base_scale, (1.0f - s.base_color) * metal_scale, s.metallic);
    t.base = brdf_lambert(s.base_color) * below;
    t.p_diffuse = p_diffuse;
    float k = bounded_VNDF_k(t.NdotV, t.alpha, t.alpha);
    t.pdf_per_D = 0.5f * p_specular / (k * t.NdotV + smith_root_GGX(t.NdotV, t.alpha));
    if (t.is_delta)
        t.pdf_per_D = 0.0f;
    return t;
}

/* layers_scatter_cos() and layers_pdf(). */
FN SurfaceValue surface_value(Surface s, SurfaceLobesAtV t, vec3 L, int energy)
{
    SurfaceValue x;
    x.f = vec3(0.0f);
    float NdotL = dot(s.N, L);
    x.pdf = t.p_diffuse * pdf_cosine(NdotL);
    vec3 sum = t.V + L;
    float sum2 = dot(sum, sum);
    if (NdotL <= 0.0f || sum2 < 1e-12f)
        return x;
    NdotL = min(NdotL, 1.0f);
    float inverse = inversesqrt(sum2);
    float rise = schlick_weight(min(0.5f * sum2 * inverse, 1.0f));
    x.f = t.base;
    if (energy == ENERGY_GLTF)
        x.f *= 1.0f - max3(s.F0 + (vec3(s.F90) - s.F0) * rise);
    if (!t.is_delta) {
        vec3 H = sum * inverse;
        float D = D_GGX_stable(clamp(dot(s.N, H), 0.0f, 1.0f), cross(s.N, H), t.alpha);
        x.f += (t.F0 + t.F_rise * rise) * (D * V_SmithGGX(NdotL, t.NdotV, t.alpha));
        x.pdf += D * t.pdf_per_D;
    }
    x.f *= NdotL;
    return x;
}

/* A direction of the lobe that u_lobe in [0, 1) chooses; the zero vector if it gives none, or is specular. */
FN vec3 surface_draw(Surface s, SurfaceLobesAtV t, float u_lobe, vec2 u)
{
    mat3 frame = basis_from_normal(s.N);
    if (u_lobe < t.p_diffuse)
        return mul(frame, sample_cosine(u));
    if (t.is_delta)
        return vec3(0.0f);
    vec3 v = mul(transpose(frame), t.V);
    v[2] = max(v[2], NDOTV_MIN);
    vec3 L = reflect(-v, sample_bounded_VNDF_GGX(u, v, t.alpha, t.alpha));
    return sel(L[2] > 0.0f, normalize(mul(frame, L)), vec3(0.0f));
}

#endif
