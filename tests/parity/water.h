/* water.h - parity cases: a sea from above and from below. */

/* ---- water_surface.h ---- */

/* A sea, seen from above. */
FN vec3 parity_up(vec3 v)
{
    return vec3(v[0], v[2], v[1]);
}

FN vec3 parity_slopes(vec2 u)
{
    return vec3(0.01f + 0.03f * u[0], 0.02f + 0.01f * u[1], 0.005f * u[0]);
}

FN vec3 case_slope_density(vec2 u)
{
    int normals = int(u[0] * 1.99f);
    vec3 C = parity_slopes(u);
    vec3 N = normal_from_slope(vec2(0.2f * u[0], -0.3f * u[1]));
    vec3 V = parity_up(parity_V(u));
    vec3 L = parity_up(parity_L(u));
    vec3 H = normalize(V + L);
    return vec3(slope_density(normals, C, vec2(0.3f * u[1], -0.1f)),
                D_slopes(normals, C, N, H) + D_sun(normals, C, sun_slopes(L, V), N, H),
                1.0f + slope_variance(C, slope_from_normal(H)));
}

FN vec3 case_slope_shadowing(vec2 u)
{
    int normals = int(u[0] * 1.99f);
    vec3 C = parity_slopes(u);
    vec3 N = normal_from_slope(vec2(0.2f * u[0], -0.3f * u[1]));
    vec3 V = parity_up(parity_V(u));
    vec3 L = parity_up(parity_L(u));
    vec3 H = normalize(V + L);
    return vec3(Lambda_Beckmann(0.1f + 2.0f * u[0]), Lambda_GGX(0.1f + 2.0f * u[0]),
                Lambda_slopes(normals, smith_a(C, N, V)) + erfcx(u[1]) +
                    tilts_seen(2.0f * u[1], 3.0f * u[0]) + slopes_seen(C, N, H, V) +
                    0.1f * inverse_normal(u[1]));
}

FN vec3 case_slope_visibility(vec2 u)
{
    int normals = int(u[0] * 1.99f);
    vec3 C = parity_slopes(u);
    vec3 N = normal_from_slope(vec2(0.2f * u[0], -0.3f * u[1]));
    vec3 V = parity_up(parity_V(u));
    vec3 L = parity_up(parity_L(u));
    return vec3(V_slopes(normals, WATER_SMITH, C, N, N, V) + V_slopes(normals, WATER_SCALES, C, N, N, V),
                V_slopes(normals, WATER_SCHLICK_KARIS, C, N, N, V),
                glitter(normals, WATER_SCALES, C, N, L, V, u[1]) +
                    glitter_below(normals, C, N, L, -refract(-V, N, 0.75f), 1.34f));
}

FN vec3 case_sample_slopes(vec2 u)
{
    int normals = int(u[0] * 1.99f);
    vec3 C = parity_slopes(u);
    vec3 N = normal_from_slope(vec2(0.2f * u[0], -0.3f * u[1]));
    vec3 V = parity_up(parity_V(u));
    vec3 L = parity_up(parity_L(u));
    return 4.0f + sample_slopes(u, C, N, V) + sun_slopes(L, V) * 1e4f + sun_slopes_about(L, L + N) * 1e4f +
           sun_density(normals, C * (1e-4f * u[1]), sun_slopes(L, V), vec2(0.002f * u[0], 0.001f)) * 1e-5f +
           slopes_from_roughness(u[1]) + roughness_from_slopes(C);
}

FN vec3 case_raised_reflection(vec2 u)
{
    vec3 C = parity_slopes(u);
    vec3 N = normal_from_slope(vec2(0.2f * u[0], -0.3f * u[1]));
    vec3 V = parity_up(parity_V(u));
    return raised_reflection(N, V, 0.3f * u[0]) + 2.0f +
           vec3(sigma_towards(C, N, V), roughness_from_spread(0.33f * u[1]), 0.0f);
}

/* ---- water_means.h ---- */

FN vec3 case_water_table(vec2 u)
{
    vec2 pair = water_table_pair(water_table_place(u[0], 0.4f * u[1]));
    return vec3(pair[0], pair[1], water_mean_fresnel_fit(u[0], 0.3f * u[1], 1.34f)) + 0.1f;
}

FN vec3 case_mean_fresnel(vec2 u)
{
    int normals = int(u[0] * 1.99f);
    WaterMeans m =
        integrate_water_means(normals, int(u[1] * 1.99f), 0.05f + 0.9f * u[0], 0.05f + 0.3f * u[1], 1.34f, 6);
    return vec3(m.fresnel, m.escape, 1.0f + m.lift);
}

FN vec3 case_mean_spread(vec2 u)
{
    int normals = int(u[0] * 1.99f);
    WaterMeans m =
        integrate_water_means(normals, int(u[1] * 1.99f), 0.05f + 0.9f * u[0], 0.05f + 0.3f * u[1], 1.34f, 6);
    return vec3(m.spread, m.below + 1.0f, m.elevation);
}

/* ---- glint.h ---- */

FN vec3 case_glint_count(vec2 u)
{
    int normals = int(u[0] * 1.99f);
    vec3 C = parity_slopes(u);
    vec3 N = normal_from_slope(vec2(0.2f * u[0], -0.3f * u[1]));
    vec3 V = parity_up(parity_V(u));
    vec3 L = parity_up(parity_L(u));
    vec3 H = normalize(V + L);
    return vec3(glint_count(normals, C, sun_slopes(L, V), N, H, 5000.0f, 0.01f, u[0]) + 0.1f,
                gamma_variate(1.0f + 9.0f * u[0], 4.0f * u[1] - 2.0f),
                glint_uniform(glint_hash(uint(u[1] * 4096.0f))) +
                    glint_uniform(glint_hash2(uint(u[0] * 4096.0f), uint(u[1] * 4096.0f))));
}

FN vec3 case_glint_cell(vec2 u)
{
    GlintCell cell = glint_cell(u * 7.3f, vec2(0.3f, 0.0113f + u[0]), 2.0f * u[1]);
    return vec3(glint_uniform(cell.key), 5.0f + glint_normal(cell.key),
                1.0f + glint_sum(cell.key, 12.0f * u[1]));
}

FN vec3 case_glint_seen(vec2 u)
{
    GlintCell cell = glint_cell(u * 7.3f, vec2(0.3f, 0.0113f + u[0]), 2.0f * u[1]);
    vec2 place = glint_place(u - 0.3f);
    vec2 extent = glint_extent(place, 0.01f, 0.3f + u[1]);
    return vec3(5.0f + glint_image(cell, 77u) + place[1], extent[0] + extent[1] + cell.area,
                1.0f + glint_seen(vec2(3.0f, 4.0f), 0.3f, 0.7f, 2.0f + 100.0f * u[1], 3.7f, 0.02f) +
                    glint_variate(cell, 2.0f + 100.0f * u[1], 3.7f, 0.02f));
}

/* ---- water.h ---- */

FN Water parity_sea_water(vec2 u)
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
    return w;
}

FN WaterPoint parity_water_point(vec2 u)
{
    WaterPoint p;
    p.N = normal_from_slope(vec2(0.2f * u[0], -0.3f * u[1]));
    p.covariance = parity_slopes(u);
    p.foam = 0.2f * u[1];
    return p;
}

FN WaterLight parity_water_light(Water w, vec2 u)
{
    WaterLight light;
    light.L = parity_up(parity_L(u));
    light.sun_irradiance = vec3(5.0f, 4.0f, 3.0f);
    light.sky_irradiance = vec3(1.0f, 2.0f, 3.0f);
    light.sun_fresnel = 0.1f;
    light.downwelling = water_downwelling(w, light);
    return light;
}

FN vec3 case_water_refraction(vec2 u)
{
    Water w = parity_sea_water(u);
    WaterPoint p = parity_water_point(u);
    vec3 V = parity_up(parity_V(u));
    WaterLight light = parity_water_light(w, u);
    vec3 d = water_refracted(w, -V, p.N);
    return d + 2.0f + water_sun(w, p, light, V) + water_sun_below(w, p, light, -d) +
           vec3(water_fresnel(w, u[0]), water_fresnel_inside(w, 0.7f + 0.3f * u[1]), 0.0f);
}

FN vec3 case_water_bed(vec2 u)
{
    Water w = parity_sea_water(u);
    WaterLight light = parity_water_light(w, u);
    WaterBed bed;
    bed.albedo = vec3(0.5f, 0.4f, 0.3f);
    bed.mean_albedo = vec3(0.4f);
    bed.depth = 20.0f * u[0];
    bed.path_length = bed.depth * 1.2f;
    vec3 R = water_bed_reflectance(w, bed.mean_albedo, bed.depth);
    return water_from_bed(w, water_interreflected(w, light.downwelling, R), bed) + R +
           water_deep_reflectance(w) + water_slab(vec3(5.0f * u[1])) + water_internal_reflectance(w) +
           water_foam_below(w, light, R) + water_beam(w) + water_diffuse(w) + water_K_d(w) +
           water_from_deep(w, light.downwelling) + water_transmittance(w.absorption, u[1]);
}

FN vec3 case_single_scattering(vec2 u)
{
    Water w = parity_sea_water(u);
    WaterLight light = parity_water_light(w, u);
    return water_single_scattering(w, light.sun_irradiance, u[0], 0.9f, 0.7f, 5.0f * u[1]) +
           water_phase(w, u[1]) + water_phase_pure(u[0]);
}

FN vec3 case_forward_scattering(vec2 u)
{
    Water w = parity_sea_water(u);
    WaterPoint p = parity_water_point(u);
    WaterLight light = parity_water_light(w, u);
    return water_forward(w, 2.0f * u[0] - 1.0f, u[1], 0.7f) + water_sunlit_slope(u[0], 0.1f * u[1]) +
           water_foam(w, light, p.N);
}

FN vec3 case_snells_window(vec2 u)
{
    Water w = parity_sea_water(u);
    WaterPoint p = parity_water_point(u);
    vec3 V = parity_up(parity_V(u));
    WaterLight light = parity_water_light(w, u);
    vec3 down = -V;
    vec3 d = normalize(vec3(u[0] - 0.5f, 1.0f, u[1] - 0.3f));
    WaterWindow window = water_window(w, d, p.N);
    return window.reflected + window.outside * 0.1f + vec3(2.0f + window.fresnel, 2.0f + window.gain, 2.0f) +
           water_inscatter(w, light.downwelling, 3.0f, down, 20.0f * u[1]) +
           water_mean_transmittance(vec3(0.0f), down * u[0]) +
           water_sun_inscatter(w, water_beam_below(w, light), normalize(vec3(0.3f, 1.0f, 0.1f)), 2.0f, d,
                               10.0f * u[0]) +
           vec3(water_mean_transmittance1(5.0f * u[0], 4.0f * u[1]),
                water_inscatter_phase1(9.0f * u[0], 0.1f, u[1]), 0.0f);
}

/* ---- water_place.h ---- */

FN vec3 case_wave_patch(vec2 u)
{
    vec3 V = parity_up(parity_V(u));
    vec3 C = parity_slopes(u);
    vec3 D = vec3(0.3f * u[0], -0.2f * u[1], 0.1f);
    vec3 N = water_faced(wave_normal(vec2(0.4f * u[1], -0.3f), D), V);
    vec2 place =
        sel(abs(u[0] + u[1] - 1.0f) < 1e-3f, vec2(0.4f, 0.3f), u); /* its rhombus has an edge there */
    return wave_patch_weights(place) + wave_cubic_weights(u[0]) + N + water_seen_normal(C, N, V) +
           water_tilted(N, C, V) + 2.0f +
           vec3(water_seen_cosine(V, C), 0.0f, water_footprint(u[0], V[1] * u[1], 0.3f));
}

FN Water parity_clear_water(vec2 u)
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

FN vec3 case_water_foam_cover(vec2 u)
{
    Water w = parity_clear_water(u);
    WaterLight light = parity_water_light(w, u);
    vec3 V = parity_up(parity_V(u));
    vec3 C = parity_slopes(u);
    vec3 D = vec3(0.3f * u[0], -0.2f * u[1], 0.1f);
    vec3 N = water_faced(wave_normal(vec2(0.4f * u[1], -0.3f), D), V);
    WaterSpecular m;
    m.fresnel = 0.5f;
    m.escape = 0.8f;
    m.R = reflect(-V, N);
    m.perceptual_roughness = 0.2f;
    m.deviation = 0.1f + 0.2f * u[0];
    return vec3(1.0f + foam_share(0.6f * u[0] - 0.1f, 0.01f + 0.05f * u[1], 0.4f),
                2.0f * water_foam_cover(0.5f * u[1], u[0]) + normal_below(3.0f * u[0] - 1.5f) +
                    foam_lace(0.05f + 0.9f * u[0], u[1], 0.3f),
                water_visibility(C, N, light.L) + wave_jacobian(D)) +
           water_specular_masked(m, C, N).R * water_specular_masked(m, C, N).escape;
}

/* ---- water_crest.h ---- */

FN vec3 case_water_crest(vec2 u)
{
    Water w = parity_clear_water(u);
    WaterLight light = parity_water_light(w, u);
    vec3 V = parity_up(parity_V(u));
    vec3 D = vec3(0.3f * u[0], -0.2f * u[1], 0.1f);
    vec3 N = water_faced(wave_normal(vec2(0.4f * u[1], -0.3f), D), V);
    vec3 down = water_refracted(w, -V, N);
    vec3 sunward = normalize(vec3(0.3f, 1.0f, 0.1f));
    vec3 low = normalize(vec3(-V[0], 0.05f + 0.3f * u[1], -V[2]));
    light.L = low;
    WaterCrest crest = water_crest_beam(w, light, 0.05f, 0.1f + u[1], 1.5f);
    vec3 back = normal_from_slope(vec2(low[0], low[2]) * 0.4f * u[0]);
    vec2 level = normalize(vec2(low[0], low[2]));
    vec3 into = water_refracted(w, -V, back);
    float path = water_crest_path_length(crest, level, into, 0.5f + u[0], 0.5f * u[1]);
    return water_crest(w, light, crest, back, V, into, u[0]) + 0.1f + 0.1f * path +
           water_crest_lit(w, crest, level, 0.3f * u[1], into, 1.4f * u[0]) +
           water_over_bed(w, light.downwelling, vec3(0.5f, 0.4f, 0.3f), vec3(0.4f, 0.4f, 0.2f), 9.0f * u[0],
                          0.1f * u[1], down) +
           0.1f * water_distance_to_bed(9.0f * u[0], 0.1f * u[1], down) +
           0.1f * water_bed_depth(9.0f * u[0], 0.1f, u[1]) + water_land(light, vec3(0.5f), N) +
           water_through(w, light.downwelling, vec3(3.0f), sunward, vec3(1.0f), 2.0f * u[0], -V,
                         4.0f * u[1]) +
           water_surface_through(w, light.downwelling, vec3(3.0f), sunward, vec3(1.0f), vec3(2.0f),
                                 2.0f * u[0], -V, 4.0f * u[1]) +
           water_bed_below(w, light.downwelling, vec3(0.4f), u[0]) +
           water_bed_through(w, light.downwelling, vec3(2.0f), 9.0f * u[0]) +
           painted_water(light, N, V, 1.34f, 0.1f + u[0], painted_reflection(N, V)) +
           water_unscattered(w, 20.0f * u[1]);
}

/* ---- water_facets.h ---- */

FN vec3 case_facets_that_reflect(vec2 u)
{
    vec3 V = parity_up(parity_V(u));
    vec3 C = parity_slopes(u);
    vec3 N = water_faced(wave_normal(vec2(0.4f * u[1], -0.3f), vec3(0.3f * u[0], -0.2f * u[1], 0.1f)), V);
    FacetRange all = facets_seen(C, N, V);
    vec3 low = vec3(-1.0f, -0.5f, -9.0f);
    FacetRange r = facets_that_reflect(C, N, V, low, vec3(1.0f + u[0], 2.0f, -6.0f - u[1]));
    Facet f = facet_drawn(all, N, u);
    vec2 place = facet_place(r, N, f.m);
    return f.m + vec3(f.weight + facets_share(r), r.low[0] + r.high[1], 0.1f * (place[0] + place[1])) + 10.0f;
}

FN vec3 case_facets_that_refract(vec2 u)
{
    Water w = parity_clear_water(u);
    vec3 V = parity_up(parity_V(u));
    vec3 C = parity_slopes(u);
    vec3 N = water_faced(wave_normal(vec2(0.4f * u[1], -0.3f), vec3(0.3f * u[0], -0.2f * u[1], 0.1f)), V);
    FacetRange all = facets_seen(C, N, V);
    vec3 low = vec3(-1.0f, 0.5f, -9.0f);
    FacetRange r = facets_that_refract(C, N, V, low, vec3(1.0f + u[0], 3.0f, -6.0f), w.ior);
    bool is_wide = is_wide_box(vec3(1.0f, 0.0f, 0.0f), vec3(0.9f - 0.1f * u[0], 0.0f, 0.0f));
    FacetRange part = facets_about(all, -u, u, is_wide);
    return facet_that_refracts(V, normalize(vec3(0.3f, 0.5f + u[0], u[1])), w.ior) +
           vec3(part.low[0], part.high[1], window_roughness(r, C)) +
           vec3(r.low[0], r.high[1], facets_share(r)) + 10.0f;
}

FN vec3 case_facets_of_window(vec2 u)
{
    Water w = parity_clear_water(u);
    vec3 V = parity_up(parity_V(u));
    vec3 C = parity_slopes(u);
    vec3 N = water_faced(wave_normal(vec2(0.4f * u[1], -0.3f), vec3(0.3f * u[0], -0.2f * u[1], 0.1f)), V);
    FacetRange all = facets_seen(C, N, V);
    Facet f =
        facet_of_window(all, C, N, V, water_critical_cosine(w), int(u[0] * float(WINDOW_FACETS) * 0.999f));
    FacetRange around = facets_of_corners(all, N, V, vec3(0.0f, 0.3f, -0.95f), vec3(-1.0f, 0.5f, -9.0f),
                                          vec3(1.0f + u[0], 3.0f, -6.0f), 0.0f);
    f.weight += sel(is_window_sharp(all), 1.0f, 0.0f) + 0.1f * around.high[0];
    return f.m * f.weight + window_light(w, water_window(w, V, N), C, N, vec3(3.0f), vec3(0.5f)) +
           vec3(min(window_rim(all, N, V, 0.6f, u[1]), 9.0f), min(window_middle(all), 9.0f),
                min(window_part(all, window_edge(all, 1), 1), 9.0f) + window_mean(u[0] - 1.0f, u[1] + 0.3f)) +
           10.0f;
}

/* ---- water_caustic.h ---- */

FN vec3 case_water_caustic(vec2 u)
{
    Water w = parity_clear_water(u);
    WaterLight light = parity_water_light(w, u);
    vec3 V = parity_up(parity_V(u));
    vec3 C = parity_slopes(u);
    vec3 D = vec3(0.3f * u[0], -0.2f * u[1], 0.1f);
    vec3 N = water_faced(wave_normal(vec2(0.4f * u[1], -0.3f), D), V);
    vec3 down = water_refracted(w, -V, N);
    vec3 sunward = normalize(vec3(0.3f, 1.0f, 0.1f));
    vec3 beam = water_beam_below(w, light);
    return water_bed_returned(w, vec3(0.4f), 9.0f * u[0]) +
           water_bed_lit(water_focused(w, vec3(0.4f), light.downwelling, beam, sunward[1], 9.0f * u[0]),
                         3.0f * u[1], 0.5f + 0.5f * u[0]) +
           vec3(water_bed_footprint(w, N, V, down, C, u[0], 4.0f * u[1]),
                caustic_cover(vec2(2.0f * u[0] - 1.0f, 0.1f)),
                caustic_lod(9.0f * u[1]) + water_reflection_spread(C));
}

/* ---- water_legacy.h ---- */

FN vec3 case_water_legacy(vec2 u)
{
    Water w = parity_sea_water(u);
    WaterPoint p = parity_water_point(u);
    vec3 V = parity_up(parity_V(u));
    WaterLight light = parity_water_light(w, u);
    vec3 down = -V;
    WaterSpecular m = water_specular(w, p, V, 0.9f, 0.95f, 0.1f * u[0], 0.3f * u[1]);
    vec3 before =
        water_legacy_shade(int(u[0] * 1.99f), int(u[1] * 2.99f), down, p.N, WATER_LEGACY_SUN_DIRECTION, u[0],
                           u[1], water_legacy_foam(u[0]), 1.33f, 0.3f);
    return m.R + m.perceptual_roughness + water_legacy_display(before) + water_legacy_linear(before) +
           water_legacy_sky(V) + water_legacy_highlight(1, p.N, V, light.L, 1.33f, 0.1f) +
           water_radiance(water_parts(w, p, light, m, vec3(1.0f, 2.0f, 3.0f), vec3(0.5f), light.downwelling));
}
