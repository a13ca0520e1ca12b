/* light.h - parity cases: color, random numbers, filters, lights and image-based lighting. */

/* ---- color.h ---- */

FN vec3 case_srgb(vec2 u)
{
    return srgb_from_linear(vec3(u[0], u[1], u[0] * 0.01f)) +
           linear_from_srgb(vec3(u[0], u[1], u[0] * 0.1f)) + srgb_from_linear1(u[1]) +
           linear_from_srgb1(u[0]);
}

FN vec3 case_primaries(vec2 u)
{
    vec3 hdr = vec3(8.0f * u[0], 8.0f * u[1], 1.0f);
    return rec709_from_xyz(xyz_from_rec709(hdr) + 1.0f) +
           rec709_from_rec2020(rec2020_from_rec709(hdr) + 1.0f) + luminance(hdr);
}

/* ---- sobol.h ---- */

FN vec3 case_sobol(vec2 u)
{
    vec2 p = sobol_point(uint(u[0] * 4096.0f), hash_uint(uint(u[1] * 4096.0f)));
    uint d = owen_scramble(sobol_second(reverse_bits(uint(u[1] * 4096.0f))), hash_uint(uint(u[0] * 4096.0f)));
    vec2 q = sobol_scrambled(sobol_order(sobol_shuffle(d, 77u), 0x1f050301u), d);
    return vec3(p[0] + q[0], p[1] + q[1],
                sobol_fraction(d) + sobol_scrambled_first(d, 5u) - sobol_scrambled_second(d, 5u));
}

/* ---- pixel_filter.h ---- */

FN vec3 parity_pixel_filter(int kind, vec2 u)
{
    FilterSample s = sample_pixel_filter(kind, u);
    return vec3(s.offset[0], s.offset[1], s.weight) + pixel_filter(kind, 3.0f * u - 1.5f) +
           vec3(blackman_harris(2.0f * u[0]), blackman_harris_step(0.5f * u[0], 0.5f * u[1]),
                mitchell(2.0f * u[1])) +
           vec3(sample_blackman_harris(u[1]), sample_mitchell(u[0])[1], sample_mitchell_positive(u[1])) +
           vec3(sample_mitchell_negative(u[0]), 0.0f, 0.0f);
}

FN vec3 case_filter_blackman_harris(vec2 u)
{
    return parity_pixel_filter(PIXEL_FILTER_BLACKMAN_HARRIS, u);
}

FN vec3 case_filter_box(vec2 u)
{
    return parity_pixel_filter(PIXEL_FILTER_BOX, u);
}

FN vec3 case_filter_mitchell(vec2 u)
{
    return parity_pixel_filter(PIXEL_FILTER_MITCHELL, u);
}

/* ---- footprint.h ---- */

#define PARITY_IMAGE_SIZE vec2(512.0f, 300.0f)

FN Footprint parity_footprint(vec2 u)
{
    return footprint_from_derivatives(PARITY_IMAGE_SIZE, vec2(0.001f + 0.02f * u[0], 0.004f * u[1]),
                                      vec2(-0.003f * u[1], 0.001f + 0.006f * u[0] * u[1]));
}

FN vec3 parity_probes(ProbeRow p)
{
    return vec3(float(p.count), sqrt(p.width2), 1.0f + length(vec2(p.step_u, p.step_v) * PARITY_IMAGE_SIZE));
}

FN vec3 case_footprint(vec2 u)
{
    Footprint f = parity_footprint(u);
    return vec3(sqrt(f.longest2), sqrt(f.major2) + sqrt(max(f.minor2, 0.0f) + 1.0f),
                length(vec2(f.axis_u, f.axis_v)) / f.major2 + sel(footprint_is_finite(f), 1.0f, 2.0f));
}

FN vec3 case_footprint_probes(vec2 u)
{
    return parity_probes(footprint_probes(parity_footprint(u), 1.0f, 1.0f / PARITY_IMAGE_SIZE));
}

FN vec3 case_footprint_one_probe(vec2 u)
{
    return parity_probes(footprint_probes_up_to(1, parity_footprint(u), 1.0f, 1.0f / PARITY_IMAGE_SIZE));
}

FN vec3 case_footprint_few_probes(vec2 u)
{
    return parity_probes(footprint_probes_up_to(3, parity_footprint(u), 1.0f, 1.0f / PARITY_IMAGE_SIZE));
}

/* ---- light.h ---- */

FN vec3 case_spot_light(vec2 u)
{
    Surface s = parity_surface(u);
    vec3 V = parity_V(u);
    vec3 P = parity_L(u);
    vec3 position = vec3(3.0f, 1.0f + u[0], 2.0f);
    vec3 intensity = vec3(100.0f, 50.0f, 25.0f);
    vec2 dfg = vec2(0.6f, 0.1f);
    Light spot = light_spot(position, normalize(vec3(-3.0f, -1.0f, -2.0f)), intensity, 9.0f, 0.1f, 0.8f);
    return shade_punctual(s, P, V, spot, ENERGY_GLTF, dfg);
}

FN vec3 case_directional_light(vec2 u)
{
    Surface s = parity_surface(u);
    vec3 V = parity_V(u);
    vec3 P = parity_L(u);
    vec3 intensity = vec3(100.0f, 50.0f, 25.0f);
    vec2 dfg = vec2(0.6f, 0.1f);
    return shade_punctual(s, P, V, light_directional(normalize(vec3(0.2f, 0.1f, -1.0f)), intensity),
                          ENERGY_CONSERVING, dfg);
}

FN vec3 case_point_light(vec2 u)
{
    vec3 P = parity_L(u);
    vec3 position = vec3(3.0f, 1.0f + u[0], 2.0f);
    vec3 intensity = vec3(100.0f, 50.0f, 25.0f);
    LightSample l = light_illuminate(light_point(position, intensity, 20.0f * u[1] + 2.0f), P);
    return l.L + l.E * 0.01f + l.distance_m;
}

FN vec3 case_attenuation(vec2 u)
{
    return vec3(attenuation_range(8.0f * u[0], 6.0f), attenuation_ue4(8.0f * u[0], 6.0f),
                attenuation_filament(8.0f * u[0], 0.0f));
}

FN vec3 case_range_and_cone(vec2 u)
{
    return vec3(range_window(u[0] * 40.0f, 5.0f), spot_cone(u[0], 3.0f, -1.0f), spot_cone(u[1], 0.0f, 1.0f));
}

/* ---- area_light.h ---- */

FN vec3 case_shade_sphere(vec2 u)
{
    Surface s = parity_surface(u);
    vec3 V = parity_V(u);
    vec3 P = parity_L(u);
    vec3 center = vec3(2.0f, -1.0f, 1.5f);
    vec2 dfg = vec2(0.6f, 0.1f);
    return shade_sphere(s, P, V, center, 0.8f * u[0], vec3(10.0f, 5.0f, 1.0f), ENERGY_GLTF, dfg);
}

FN vec3 case_shade_sphere_widened(vec2 u)
{
    Surface s = parity_surface(u);
    vec3 V = parity_V(u);
    vec3 P = parity_L(u);
    vec3 center = vec3(2.0f, -1.0f, 1.5f);
    vec2 dfg = vec2(0.6f, 0.1f);
    return shade_sphere_widened(s, P, V, center, 0.8f * u[0], vec3(10.0f, 5.0f, 1.0f), ENERGY_CONSERVING,
                                dfg);
}

FN vec3 case_representative_point_tube(vec2 u)
{
    vec3 V = parity_V(u);
    vec3 P = parity_L(u);
    vec3 center = vec3(2.0f, -1.0f, 1.5f);
    RepresentativePoint p = representative_point_tube(center, P * 3.0f + 1.0f, V, 0.1f, 0.2f + 0.5f * u[1]);
    return p.L + p.normalisation;
}

FN vec3 case_representative_point_sphere(vec2 u)
{
    vec3 V = parity_V(u);
    vec3 center = vec3(2.0f, -1.0f, 1.5f);
    RepresentativePoint p = representative_point_sphere(center, V, 0.5f, 0.2f + 0.5f * u[1]);
    return p.L * p.normalisation;
}

FN vec3 case_irradiance(vec2 u)
{
    vec3 V = parity_V(u);
    vec3 P = parity_L(u);
    vec3 center = vec3(2.0f, -1.0f, 1.5f);
    /* 0.1: a sphere that sets is the small difference of numbers near 1, exact to 2e-6 absolutely */
    return vec3(0.1f + sphere_irradiance(2.0f * u[0] - 1.0f, 0.2f + 0.7f * u[1]),
                line_irradiance(V, center, P + 0.5f), widened_alpha(u[0], 0.3f, 2.0f, 3.0f));
}

/* ---- ibl.h ---- */

FN vec3 case_specular_ibl_sample(vec2 u)
{
    Surface s = parity_surface(u);
    vec3 V = parity_V(u);
    float r = 0.2f + 0.8f * u[1];
    uint i = uint(u[0] * 64.0f);
    SpecularSample t = specular_ibl_sample(i, 64u, s.F0, vec3(1.0f), r, s.N, V);
    return t.L + t.weight + t.pdf * 0.1f;
}

FN vec3 case_prefilter_sample(vec2 u)
{
    vec3 V = parity_V(u);
    float r = 0.2f + 0.8f * u[1];
    uint i = uint(u[0] * 64.0f);
    PrefilterSample t = prefilter_sample(i, 64u, r, V);
    return t.L * (t.weight + 0.1f) + prefilter_lod(t.pdf, 64u, 1e-4f);
}

FN vec3 case_dfg_sample(vec2 u)
{
    float r = 0.2f + 0.8f * u[1];
    uint i = uint(u[0] * 64.0f);
    vec2 a = dfg_sample_k(i, 64u, r, u[0], 0.3f);
    vec2 b = dfg_sample(i, 64u, r, u[0]);
    return vec3(a[0] + a[1], b[0], b[1]) + dfg_sample_karis(i, 64u, r, u[0])[0];
}

FN vec3 case_integrate_dfg(vec2 u)
{
    float r = 0.2f + 0.8f * u[1];
    vec2 a = integrate_dfg(r, u[0], 16u);
    vec2 b = integrate_dfg_karis(r, u[0], 16u);
    return vec3(a[0], a[1], b[0] + b[1]);
}

FN vec3 case_multiscatter_ibl(vec2 u)
{
    Surface s = parity_surface(u);
    vec2 dfg = vec2(0.5f + 0.3f * u[0], 0.2f * u[1]);
    MultiScatter m = multiscatter_ibl(s.F0, s.F0, vec3(1.0f), dfg);
    return m.single + m.multiple + approximate_specular_ibl(s.F0, vec3(1.0f), vec3(2.0f), dfg);
}

FN vec3 case_surface_reflection(vec2 u)
{
    Surface s = parity_surface(u);
    vec3 V = parity_V(u);
    int energy = sel(u[1] > 0.2f, ENERGY_CONSERVING, ENERGY_GLTF);
    vec3 coat = specular_reflection(s.N, V, u[0], u[1], ENERGY_CONSERVING);
    return surface_reflection(s, V, energy) + coat +
           vec3(2.0f + reflection_bend(u[1], u[0], 0.3f), 2.0f, 2.0f + surface_facing_reflectance(s));
}

FN vec3 case_surface_ibl(vec2 u)
{
    Surface s = parity_surface(u);
    vec3 V = parity_V(u);
    vec2 dfg = vec2(0.5f + 0.3f * u[0], 0.2f * u[1]);
    int energy = sel(u[1] > 0.5f, ENERGY_CONSERVING, ENERGY_GLTF);
    return surface_ibl(s, surface_NdotV(s, V), dfg, vec3(3.0f, 1.0f, 0.2f), vec3(0.5f, 0.7f, 1.0f), energy);
}

FN vec3 case_ambient_interreflection(vec2 u)
{
    return ambient_interreflection(u[0], vec3(u[1], 0.5f, 1.0f - u[1]));
}

/* ---- tonemap.h ---- */

FN vec3 case_tonemap(vec2 u)
{
    return tonemap(int(u[0] * 8.0f), vec3(4.0f * u[0], 4.0f * u[1], 1.0f));
}

FN vec3 case_tonemap_curves(vec2 u)
{
    vec3 hdr = vec3(8.0f * u[0], 8.0f * u[1], 1.0f);
    return tonemap_reinhard(hdr) + tonemap_reinhard_extended(hdr, 4.0f) + tonemap_hable(hdr) +
           hable_curve(hdr) + tonemap_aces_narkowicz(hdr) + tonemap_aces(hdr) + tonemap_pbr_neutral(hdr) +
           agx_contrast(vec3(u[0], u[1], 0.5f)) + tonemap_agx(hdr);
}
