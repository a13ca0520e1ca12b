/* sea_look.glsl - the appearance of a place of the sea, in the physical and in the legacy styles: water_shade.c with the same
 * functions of the shader library. */
uniform highp sampler2D u_sea_means; /* means over microfacets: water_table.h */

/* Resting position of the water in the world, m. */
vec2 sea_world_rest(SeaPlace p)
{
    return p.rest + eye.xz;
}

/* fresnel, escape, lift, spread */
vec4 sea_means(float mu, float sigma)
{
    vec2 place = (water_table_place(mu, sigma) + 0.5) / vec2(WATER_TABLE_COLUMNS, WATER_TABLE_ROWS);
    return textureLod(u_sea_means, place, 0.0);
}

float sea_glints(SeaPlace p, Water w)
{
#ifdef HAS_GLINTS
    vec3 H = normalize(p.V + sea_sun.xyz);
    if (H.y <= 0.0 || p.moments.y <= 0.0)
        return 1.0;
    float width = p.footprint_m / sea_ray.y;
    float area = width * width / p.cosine;
    float lifetime = 1.0 / p.moments.y;
    float count = glint_count(w.normals, p.point.covariance, sun_slopes(sea_sun.xyz, p.V), p.point.N, H, p.moments.x, area, sea_downwelling.w / lifetime);
    return glint_seen(p.rest, width, p.cosine, count, sea_sky_irradiance.w, lifetime);
#else
    return 1.0;
#endif
}

vec3 sea_sun_seen(SeaPlace p, Water w, WaterLight light)
{
    if (light.L.y <= 0.0 || light.sun_irradiance.y <= 0.0)
        return vec3(0.0);
    vec3 sun = water_sun(w, p.point, light, p.V);
    return sun.y > 0.0 ? sun * (water_passing(p.resolved, p.point.N, light.L) * sea_glints(p, w)) : sun;
}

/* To an eye above the water. */
vec3 sea_shade(SeaHost host, SeaPlace p)
{
    Water w = host_water(host);
    WaterLight light = host_light(host);
    vec4 means = vec4(1.0, 1.0, 0.0, 0.0); /* of flat water */
    float NdotV = clamp(dot(p.point.N, p.V), 1e-4, 1.0);
    vec3 least = vec3(SLOPE_VARIANCE_MIN, SLOPE_VARIANCE_MIN, 0.0);
    float sigma = sigma_towards(p.point.covariance - least, p.point.N, p.V);
    if (sigma > 1e-6)
        means = sea_means(NdotV, sigma);
    WaterMirror m = water_mirror(w, p.point, p.V, means.x, means.y, means.z, means.w);
    m = water_mirror_passing(m, p.resolved, p.point.N);
    vec3 sky = sea_sky_reflected(m.R, m.perceptual_roughness);
    vec3 below = sea_from_below(host, p);
#ifdef HAS_MODEL
    vec3 P = p.d * p.t;
    vec4 mirrored = sea_model_reflected(P, p.V, p.point, w, host.random);
    if (mirrored.w > 0.0) {
        float share = min(mirrored.w / m.fresnel, 1.0);
        sky = sky * (1.0 - share) + mirrored.xyz * (share / mirrored.w);
    }
    SeaModel model = sea_model_below(P, water_refracted(w, -p.V, p.point.N));
    if (model.color.w > 0.0)
        below = mix(below, sea_model_through_water(model, P, w, light), model.color.w);
    light.sun_irradiance *= sea_touched(p.at.xz).y;
#endif
    return water_radiance(water_parts(w, p.point, light, m, sky, sea_sun_seen(p, w, light), below));
}

/* Water that an eye in it sees mirrored by microfacets of the mean normal m. */
vec3 sea_mirrored_below(SeaHost host, SeaPlace p, vec3 m)
{
    vec3 mirrored = reflect(p.d, m);
    if (mirrored.y > -1e-3)
        mirrored = normalize(vec3(mirrored.x, -1e-3, mirrored.z));
    return sea_seen_through_water(host, vec3(p.at.x, min(p.at.y, 0.0), p.at.z), mirrored, p.footprint_m, water_mirrored_spread(p.point.covariance));
}

/* What the microfacets show to it: the same as in water_shade.c. */
struct SeaMicrofacets
{
    vec3 window;
    float fresnel;
    vec3 mirrored;
};

/* upwards: upward radiance below the surface. */
SeaMicrofacets sea_microfacets_below(SeaHost host, SeaPlace p, Water w, vec3 upwards)
{
    vec3 C = p.point.covariance;
    vec3 N = p.point.N;
    FacetRange all = facets_seen(C, N, p.d);
    bool is_sharp = all.along < WINDOW_SHARP;
    float roughness = window_roughness(all, C);
    SeaMicrofacets L = SeaMicrofacets(vec3(0.0), 0.0, vec3(0.0));
    vec3 mirrors = vec3(0.0);
    float share = 0.0;
    int k = 0;
    do {
        Facet f = facet_of_window(all, N, p.d, water_critical_cosine(w), k);
        if (is_sharp)
            f = Facet(water_seen_normal(C, N, p.d), 1.0);
        WaterWindow window = water_window(w, p.d, f.m);
        share += f.weight;
        L.fresnel += f.weight * window.fresnel;
        mirrors += f.m * (f.weight * window.fresnel);
        if (f.weight > 0.0 && window.fresnel < 1.0)
            L.window += window_light(w, window, p.resolved, N, sea_sky_reflected(window.outside, roughness), upwards) * f.weight;
        k++;
    } while (k < WINDOW_FACETS && !is_sharp);
    if (L.fresnel > 0.0)
        L.mirrored = sea_mirrored_below(host, p, normalize(mirrors));
    L.window /= share;
    L.fresnel /= share;
    return L;
}

/* To an eye in the water. */
vec3 sea_shade_below(SeaHost host, SeaPlace p)
{
    Water w = host_water(host);
    WaterLight light = host_light(host);
#ifdef HAS_BED
    vec3 R = water_bed_reflectance(w, sea_bed.xyz, max(p.at.y + sea_bed.w - dot(sea_bed_slope.xy, p.at.xz), 0.0));
#else
    vec3 R = water_deep_reflectance(w);
#endif
    vec3 upwelling = R * water_interreflected(w, light.downwelling, R);
    SeaMicrofacets facets = sea_microfacets_below(host, p, w, upwelling * INV_PI);
    vec3 L = facets.window + facets.mirrored * facets.fresnel;
    vec3 sharp = water_sun_below(w, p.point, light, p.d) * water_passing(p.resolved, p.point.N, light.L);
#if defined(HAS_MODEL) && defined(IS_BELOW)
    SeaFound found = sea_find_below(host, p, host.random);
    float share = found.covered > facets.fresnel ? facets.fresnel / found.covered : 1.0;
    L = max(facets.window - found.hidden, 0.0) + facets.mirrored * (facets.fresnel - share * found.covered);
    sharp = sharp * sea_touched(p.at.xz).y + found.through + found.mirrored * share;
#endif
    vec3 foam = water_foam_below(w, light, upwelling);
    return water_surface_through(w, light.downwelling, sea_beam.xyz, sea_sunward.xyz, mix(L, foam, p.point.foam),
                                 sharp * (1.0 - p.point.foam), max(-sea_eye.x, 0.0), p.d, p.t);
}

/* The legacy styles, in display values. */
vec3 sea_legacy(SeaPlace p)
{
    vec2 slope = slope_from_normal(p.point.N);
    float sparkle = 0.0;
    if (sea_look.w != 0) /* white noise fixed to the water, about one cell in ten */
        sparkle = glint_uniform(glint_cell(sea_world_rest(p), vec2(p.footprint_m), 1.0).key) > 0.9 ? 1.0 : 0.0;
    float foam = sea_look.z != 0 ? before_foam(length(slope)) : 0.0;
    return before_shade(sea_look.y, sea_look.x, p.d, p.point.N, sea_sun.xyz, p.at.y, sparkle, foam, sea_absorption.w, sea_bed_slope.z);
}

/* Stage 3: the sky in a mirror of Schlick's reflectance, the sun in GGX of one roughness, and a diffuse base color
 * below. */
vec3 sea_painted(SeaHost host, SeaPlace p)
{
    vec3 sky = sea_sky_reflected(painted_mirror(p.point.N, p.V), sea_bed_slope.z);
    return painted_water(host_light(host), p.point.N, p.V, sea_absorption.w, sea_bed_slope.z, sky);
}
