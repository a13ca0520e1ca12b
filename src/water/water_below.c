/* water_below.c - see water_below.h. Light of a place that is seen through water is weakened by absorption and by all scattering; what
 * is scattered into the ray comes from the light that goes down, and from the sun's beam. */
#include <math.h>

#include "water/water_below.h"

static const float FAR_M = 1e4f; /* farther than any water lets see */

static float depth_of(const double P[3])
{
    return (float)fmax(-P[1], 0.0);
}

vec3 water_model_behind_water(const water_setup *s, const model_hit *hit, const double P[3], vec3 d)
{
    vec3 down = water_transmittance(water_K_d(s->water), max(-hit->P[1], 0.0f));
    vec3 L = water_model_radiance(&s->model, hit, s->light.L) * down;
    return water_through(s->water, s->light.downwelling, s->beam, s->sunward, L, depth_of(P), d,
                         (float)hit->distance_m);
}

float water_way_to_bed_below(const water_setup *s, const double P[3], vec3 d)
{
    const facet_sea_bed *bed = &s->sea->desc.bed;
    if (!water_has_bed(s))
        return FAR_M;
    double closing = water_bed_rise(bed, d) - (double)d[1];
    double above = P[1] - water_bed_height(bed, P[0], P[2]);
    if (above <= 0.0)
        return 0.0f;
    return closing > 1e-9 ? (float)fmin(above / closing, (double)FAR_M) : FAR_M;
}

vec3 water_seen_through_water(const water_setup *s, const double P[3], vec3 d, float width_m, float spread)
{
    float x = water_way_to_bed_below(s, P, d), z = depth_of(P);
    vec3 ground = vec3(0.0f);
    if (x < FAR_M) {
        float depth = max(z - x * d[1], 0.0f);
        vec3 light = water_light_over_bed(s, depth);
        vec3 mean = water_bed_below(s->water, light, water_bed_albedo(&s->sea->desc.bed), depth);
        float width = (width_m + spread * x) * inversesqrt(clamp(-d[1], 0.05f, 1.0f));
        vec3 bed = mean;
        if (water_has_light_on_bed(s)) {
            bed = mean * water_bed_lit_at(s, P, d, x, width);
            mean = mean * water_bed_lit_at(s, P, d, x, max(width, 0.25f * x));
        }
        ground = water_bed_through(s->water, bed, mean, x);
    }
    /* a ray that goes up for ever leaves water that would shine as it does near the surface */
    float reach = d[1] > 1e-4f ? min(x, z / d[1]) : x;
    return ground +
           water_through(s->water, s->light.downwelling, s->beam, s->sunward, vec3(0.0f), z, d, reach);
}

/* lx on a horizontal plane that looks down, just below the surface. */
static vec3 upwelling(const water_setup *s, const double P[3])
{
    const facet_sea_bed *bed = &s->sea->desc.bed;
    float depth = (float)fmax(P[1] - water_bed_height(bed, P[0], P[2]), 0.0);
    vec3 R = water_has_bed(s) ? water_bed_reflectance(s->water, water_bed_albedo(bed), depth)
                              : water_deep_reflectance(s->water);
    return R * water_interreflected(s->water, s->light.downwelling, R);
}

/* Water as it is mirrored by facets of the mean normal m. */
static vec3 mirrored_from_below(const water_setup *s, const water_place *p, vec3 d, vec3 m)
{
    vec3 mirrored = reflect(d, m);
    if (mirrored[1] > -1e-3f)
        mirrored = normalize(vec3(mirrored[0], -1e-3f, mirrored[2]));
    const double below[3] = {p->P[0], fmin(p->P[1], 0.0), p->P[2]};
    return water_seen_through_water(s, below, mirrored, p->footprint_m,
                                    water_mirrored_spread(p->point.covariance));
}

/* What the facets show. */
typedef struct facets_light {
    vec3 window;   /* radiance of the sky, through Snell's window */
    float fresnel; /* share of light that they mirror */
    vec3 mirrored; /* radiance of the water where they do */
} facets_light;

/* upwards: radiance of what goes up below the surface. The window has a rim, and so each facet its own sky; water is much the same in
 * all mirrors. */
static facets_light facets_from_below(const water_setup *s, const water_place *p, vec3 d, vec3 upwards)
{
    vec3 C = p->point.covariance, N = p->point.N, mirrors = vec3(0.0f);
    FacetRange all = facets_seen(C, N, d);
    bool is_sharp = all.along < WINDOW_SHARP;
    float critical = water_critical_cosine(s->water), share = 0.0f;
    float roughness = window_roughness(all, C);
    facets_light L = {.window = vec3(0.0f), .mirrored = vec3(0.0f)};
    for (int k = 0; k < (is_sharp ? 1 : WINDOW_FACETS); k++) {
        Facet f = {water_seen_normal(C, N, d), 1.0f};
        if (!is_sharp)
            f = facet_of_window(all, N, d, critical, k);
        WaterWindow window = water_window(s->water, d, f.m);
        share += f.weight;
        L.fresnel += f.weight * window.fresnel;
        mirrors = mirrors + f.m * (f.weight * window.fresnel);
        if (f.weight <= 0.0f || window.fresnel >= 1.0f)
            continue;
        vec3 sky = water_sky_reflected(&s->sky, window.outside, roughness);
        L.window = L.window + window_light(s->water, window, p->slopes.resolved, N, sky, upwards) * f.weight;
    }
    if (L.fresnel > 0.0f)
        L.mirrored = mirrored_from_below(s, p, d, normalize(mirrors));
    L.window = L.window * (1.0f / share);
    L.fresnel *= 1.0f / share;
    return L;
}

/* Radiance of something else than sky and water, which is seen as sharply as it is without a surface; *wide: what is left of both. */
static vec3 found_in(const facets_light *L, const water_findings_below *found, vec3 *wide)
{
    float share = found->covered > L->fresnel ? L->fresnel / found->covered : 1.0f; /* both are by chance */
    *wide = max(L->window - found->hidden, 0.0f) + L->mirrored * (L->fresnel - share * found->covered);
    return found->through + found->mirrored * share;
}

vec3 water_shade_from_below(const water_setup *s, const water_place *p, const water_findings_below *found,
                            const double E[3], vec3 d, float x)
{
    vec3 up = upwelling(s, p->P);
    facets_light facets = facets_from_below(s, p, d, up * INV_PI);
    vec3 L = facets.window + facets.mirrored * facets.fresnel;
    vec3 sharp = water_sun_below(s->water, p->point, s->light, d) *
                 water_passing(p->slopes.resolved, p->point.N, s->light.L);
    if (s->model.is_there)
        sharp = sharp * found->sun + found_in(&facets, found, &L);
    if (p->point.foam > 0.0f)
        L = mix(L, water_foam_below(s->water, s->light, up), p->point.foam);
    return water_surface_through(s->water, s->light.downwelling, s->beam, s->sunward, L,
                                 sharp * (1.0f - p->point.foam), depth_of(E), d, x);
}
