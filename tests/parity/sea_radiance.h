/* sea_radiance.h - parity cases: a sea's color over look-ups in closed form. */

/* ---- sea_radiance.h ---- */

FN SeaHost parity_sea(vec2 u, bool is_below, bool has_bed, bool has_model)
{
    SeaHost host;
    host.u = u;
    host.is_below = is_below;
    host.has_bed = has_bed;
    host.has_model = has_model;
    return host;
}

/* V: to the eye; above the water or below it. */
FN SeaPlace parity_sea_place(vec2 u, vec3 V)
{
    SeaPlace p;
    p.P.at = vec3(0.3f, 0.4f * u[0] - 0.3f, -0.2f);
    p.V = V;
    p.point = parity_water_point(u);
    p.slopes.resolved = vec3(0.01f, 0.008f, 0.001f);
    p.slopes.curvature = 5000.0f;
    p.slopes.rate = 40.0f;
    p.footprint_m = 0.01f + 0.02f * u[0];
    p.pixel_m = 2.0f * p.footprint_m;
    p.height_m = 0.4f * u[0];
    p.cosine = 0.4f + 0.5f * u[1];
    return p;
}

FN vec3 parity_sea_d(vec2 u)
{
    return normalize(vec3(0.3f * u[0] - 0.15f, 0.5f + 0.4f * u[1], -0.6f));
}

FN vec3 case_sea_light_on_bed(vec2 u)
{
    SeaHost host = parity_sea(u, false, true, false);
    SeaPlace p = parity_sea_place(u, parity_up(parity_V(u)));
    vec3 down = water_refracted(host_water(host), -p.V, p.point.N);
    return sea_light_over_bed(host, 5.0f * u[0]) + sea_bed_lit(host, p.P, down, 4.0f * u[1], u[0]) +
           sea_over_bed(host, 6.0f * u[1], down, vec3(0.9f), vec3(0.8f)) + sea_from_below(host, p) +
           sea_seen_through_water(host, host_sunk(p.P), down, u[0], 0.1f);
}

FN vec3 case_sea_from_above(vec2 u)
{
    SeaHost host = parity_sea(u, false, u[0] > 0.5f, false);
    SeaPlace p = parity_sea_place(u, parity_up(parity_V(u)));
    WaterSpecular m = sea_specular(host, p);
    return 2.0f + sea_shade(host, p) + 0.1f * m.R + m.fresnel + 0.01f * sea_glints(host, p) +
           sea_sun_reflected(host, p, host_light(host)) + sea_legacy(host, p, -p.V) + sea_painted(host, p);
}

FN vec3 case_sea_model_from_above(vec2 u)
{
    SeaHost host = parity_sea(u, false, true, true);
    SeaPlace p = parity_sea_place(u, normalize(vec3(0.2f * u[0], 0.3f + 0.2f * u[1], 0.8f)));
    SeaFound found = sea_find_above(host, p);
    SeaFound nothing = sea_found_nothing(host, p);
    vec3 d = normalize(vec3(0.0f, -0.5f, -0.8f));
    FacetHit hit = host_model_hit(host, p, d, true, true);
    return sea_shade(host, p) + found.reflected + found.covered + nothing.sun +
           sea_model_from_below(host, p, hit) +
           sea_model_behind_water(host, vec3(1.0f), -u[0], u[1], d, 3.0f * u[0]);
}

FN vec3 case_sea_from_below(vec2 u)
{
    SeaHost host = parity_sea(u, true, u[0] > 0.5f, false);
    vec3 d = parity_sea_d(u);
    SeaPlace p = parity_sea_place(u, -d);
    SeaMicrofacets facets = sea_microfacets_below(host, p, d, vec3(0.2f));
    return sea_shade_below(host, p, d, 3.0f, 2.0f) + facets.window + sea_upwelling(host, p) +
           sea_reflected_below(host, p, d, p.point.N);
}

FN vec3 case_sea_model_from_below(vec2 u)
{
    SeaHost host = parity_sea(u, true, true, true);
    vec3 d = parity_sea_d(u);
    SeaPlace p = parity_sea_place(u, -d);
    SeaFound found = sea_find_below(host, p, d);
    SeaFound one = sea_found_nothing(host, p);
    Facet f;
    f.m = normalize(vec3(0.05f, 1.0f, 0.1f));
    f.weight = 0.5f;
    one = sea_add_reflection(host, p, d, f, true, one);
    one = sea_add_transmission(host, p, d, f, false, 0.1f, one);
    FacetRange all = facets_seen(p.point.covariance, p.point.N, d);
    SeaFound sampled =
        sea_sample_facets(host, p, d, all, p.point.N, f.m, false, 0.0f, sea_found_nothing(host, p));
    return sea_shade_below(host, p, d, 3.0f, 2.0f) + found.through + found.hidden + found.reflected +
           one.through + one.reflected + sampled.reflected;
}
