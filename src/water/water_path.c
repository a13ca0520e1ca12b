/* water_path.c - see water_path.h. Reflection is F D G / (4 N.V), transmission Walter et al. 2007, equation
 * 21, with D of Gaussian slopes about those of N, and G of waves of all lengths (slopes_seen()). Seen from
 * below all is the same with both directions negated, so that the formulas see them above.
 *
 * Sampling draws a microfacet from those visible from V, chooses reflection or refraction by Fresnel's
 * equations, and tests whether other microfacets block the light: weights are then 1 or ratios of the
 * indices squared. Blocked light scatters at a second microfacet, so that no energy is lost. */
#include "water/water_path.h"

/* Refraction turns light by 1 - 1 / n of a slope; waves are a little steeper than Gaussian ones, and the
 * sun has a size. */
static const float SUN_SPREAD = 1.5f, MIN_SUN_SPREAD = 0.01f;

static const float MAX_DISTANCE_M = 1e4f; /* farther than one sees in any water */

/* With an ior this close to that of air, microfacets deflect light by less than directions can resolve. */
static const float MIN_BEND = 1e-4f;

/* Bits of a random number in [0, 1) as a seed. */
static uint seed_of(float u)
{
    return (uint)(u * 16777216.0f);
}

static float random_of(uint hash)
{
    return (float)(hash >> 8u) * (1.0f / 16777216.0f);
}

/* ---- a point of the surface ---- */

/* Covariance (xx, zz, xz) of the slopes that vertices do not show. */
static vec3 covariance(const path_surface_point *p)
{
    return vec3(p->values[0], p->values[1], p->values[2]);
}

static float foam_cover(const path_surface_point *p)
{
    return p->values[3];
}

static float ior_here(const water_path *w, const path_surface_point *p)
{
    return p->side > 0.0f ? 1.0f : w->water.ior;
}

static float ior_beyond(const water_path *w, const path_surface_point *p)
{
    return p->side > 0.0f ? w->water.ior : 1.0f;
}

/* Between equal indices there is no surface but its foam. */
static bool is_index_matched(const water_path *w)
{
    return w->water.ior < 1.0f + MIN_BEND;
}

/* Fresnel reflectance at a microfacet, on the side of V. */
static float reflectance(const water_path *w, const path_surface_point *p, float cosine)
{
    float c = clamp(cosine, 0.0f, 1.0f);
    return p->side > 0.0f ? water_fresnel(w->water, c) : water_fresnel_inside(w->water, c);
}

/* Factor of radiance that comes from the other side. */
static float radiance_gain(const water_path *w, const path_surface_point *p)
{
    float ratio = ior_here(w, p) / ior_beyond(w, p);
    return ratio * ratio;
}

/* Foam is a diffuser that absorbs nothing: what it does not reflect it transmits, as diffusely. Of light
 * in the water, 1 - (1 - albedo) / n^2 is reflected, so that in a closed box, with radiance n^2 below, it
 * shows 1. */
static float foam_reflectance(const water_path *w, const path_surface_point *p)
{
    float n = w->water.ior;
    return p->side > 0.0f ? w->water.foam_albedo : 1.0f - (1.0f - w->water.foam_albedo) / (n * n);
}

static bool intersect(const void *self, const shading_hit *h, const float triangle_normal[3], vec3 V,
                      path_surface_point *out)
{
    const water_path *w = self;
    const float *values = h->geometry->primitive->water;
    if (!values)
        return false;
    path_surface_point p = {.side = 1.0f};
    for (int corner = 0; corner < 3; corner++)
        for (int i = 0; i < SCENE_WATER_VALUES; i++)
            p.values[i] += h->weight[corner] * values[SCENE_WATER_VALUES * h->corner[corner] + (size_t)i];
    p.values[3] = clamp(p.values[3], 0.0f, 1.0f);
    p.Ng = normalize_or(load3(triangle_normal), vec3(0.0f, 1.0f, 0.0f));
    p.Ng = p.Ng[1] < 0.0f ? -p.Ng : p.Ng;
    p.side = dot(p.Ng, V) < 0.0f ? -1.0f : 1.0f;
    vec3 N = normalize_or(shading_hit_vec3(h, h->geometry->normals), p.Ng);
    p.N = water_faced(N, V * p.side);
    p.albedo = water_albedo(w->water, abs(dot(p.N, V)), foam_cover(&p), p.side < 0.0f);
    *out = p;
    return true;
}

/* ---- BSDF ---- */

/* Whether L leaves the surface on the side of V. */
static bool is_reflected(const path_surface_point *p, vec3 L)
{
    return dot(p->N, L) * p->side > 0.0f;
}

/* Whether L is on the same side of the shading normal and of the triangle. */
static bool is_consistent(const path_surface_point *p, vec3 L)
{
    return dot(p->N, L) * dot(p->Ng, L) > 0.0f;
}

static float brdf_value(const water_path *w, const path_surface_point *p, vec3 V, vec3 L)
{
    vec3 C = covariance(p), v = V * p->side, l = L * p->side;
    vec3 m = normalize(v + l);
    float l_N = dot(l, p->N);
    if (!(l_N > 0.0f) || !(dot(v, p->N) > 0.0f) || !(m[1] > 0.0f))
        return 0.0f;
    float D = D_slopes(WATER_BECKMANN, C, p->N, m);
    return D * V_slopes(WATER_BECKMANN, WATER_SCALES, C, p->N, l, v) * l_N * reflectance(w, p, dot(v, m));
}

static float btdf_value(const water_path *w, const path_surface_point *p, vec3 V, vec3 L)
{
    if (is_index_matched(w))
        return 0.0f;
    float here = ior_here(w, p), beyond = ior_beyond(w, p);
    vec3 C = covariance(p), h = V * here + L * beyond;
    vec3 m = normalize_or(h[1] < 0.0f ? -h : h, p->N);
    vec3 v = V * p->side, l = L * -p->side; /* both as if above */
    float v_m = dot(v, m), l_m = dot(l, m), v_N = dot(v, p->N);
    if (!(v_m > 0.0f) || !(l_m > 0.0f) || !(v_N > 0.0f) || !(dot(l, p->N) > 0.0f))
        return 0.0f;
    float D = D_slopes(WATER_BECKMANN, C, p->N, m);
    float G = slopes_seen(C, p->N, m, v) * slopes_seen(C, p->N, m, l);
    float t = here * v_m - beyond * l_m;
    float t2 = max(t * t, 1e-12f);
    return (1.0f - reflectance(w, p, v_m)) * D * G * v_m * l_m * here * here / (v_N * t2);
}

static vec3 eval(const void *self, const path_surface_point *p, vec3 V, vec3 L, float *pdf)
{
    const water_path *w = self;
    *pdf = 0.0f;
    if (!is_consistent(p, L))
        return vec3(0.0f);
    bool is_back = is_reflected(p, L);
    float cosine = abs(dot(p->N, L)) * INV_PI, share = foam_reflectance(w, p);
    float foam = is_back ? share * cosine : (1.0f - share) * cosine * radiance_gain(w, p);
    float water = is_back ? brdf_value(w, p, V, L) : btdf_value(w, p, V, L);
    float value = mix(water, foam, foam_cover(p));
    *pdf = is_back ? value : value / radiance_gain(w, p);
    return vec3(value);
}

/* Completes a sample whose direction is known. */
static void weigh(const water_path *w, const path_surface_point *p, vec3 V, bsdf_sample *s)
{
    vec3 f = eval(w, p, V, s->L, &s->pdf);
    s->weight = vec3(s->pdf > 0.0f ? f[0] / s->pdf : 0.0f);
}

static bsdf_sample sample_foam(const water_path *w, const path_surface_point *p, vec3 V, float u_lobe, vec2 u)
{
    vec3 d = mul(basis_from_normal(p->N), sample_cosine(u));
    bool is_back = u_lobe < foam_reflectance(w, p);
    bsdf_sample out = {.L = is_back ? d * p->side : d * -p->side, .is_transmission = !is_back};
    weigh(w, p, V, &out);
    return out;
}

/* L, mirrored to the given side of the triangle where it is on the other one. */
static vec3 kept_on(const path_surface_point *p, vec3 L, float side)
{
    float c = dot(L, p->Ng);
    return c * side > 0.0f ? L : normalize(L - p->Ng * (2.0f * c - side * 1e-4f));
}

/* Scattering of light that leaves a microfacet along L and is blocked by others: one of those visible from
 * there is sampled. */
static bsdf_sample sample_second_facet(const water_path *w, const path_surface_point *p, vec3 L,
                                       bool is_transmission, vec2 u)
{
    bsdf_sample out = {
        .weight = vec3(1.0f), .is_specular = true, .excludes_sun = true, .is_transmission = is_transmission};
    vec3 l = L * p->side;
    if (is_transmission) { /* blocked by other crests: it goes on as if it were not */
        out.L = kept_on(p, L, -p->side);
        out.weight = vec3(radiance_gain(w, p));
        return out;
    }
    vec3 v = vec3(-l[0], abs(l[1]), -l[2]);
    vec3 m = sample_slopes(u, covariance(p), p->N, v);
    float c = dot(v, m);
    out.is_transmission = random_of(hash_uint(seed_of(u[0]) ^ 0x9e3779b9u)) >= reflectance(w, p, c);
    vec3 d = out.is_transmission ? refract(-v, m, ior_here(w, p) / ior_beyond(w, p)) : reflect(-v, m);
    out.L = kept_on(p, d * p->side, out.is_transmission ? -p->side : p->side);
    out.weight = vec3(out.is_transmission ? radiance_gain(w, p) : 1.0f);
    return out;
}

static bsdf_sample sample_water(const water_path *w, const path_surface_point *p, vec3 V, float u_lobe,
                                vec2 u)
{
    if (is_index_matched(w))
        return (bsdf_sample){.L = kept_on(p, -V, -p->side),
                             .weight = vec3(1.0f),
                             .is_specular = true,
                             .is_transmission = true};
    vec3 C = covariance(p), v = V * p->side;
    vec3 m = sample_slopes(u, C, p->N, v);
    uint seed = hash_uint(seed_of(u_lobe) ^ hash_uint(seed_of(u[0]) + hash_uint(seed_of(u[1]))));
    float u_fresnel = (u_lobe - foam_cover(p)) / (1.0f - foam_cover(p));
    bool is_back = u_fresnel < reflectance(w, p, dot(v, m));
    bsdf_sample out = {.is_transmission = !is_back};
    vec3 l = is_back ? reflect(-v, m) : refract(-v, m, ior_here(w, p) / ior_beyond(w, p));
    out.L = l * p->side;
    bool is_out = is_reflected(p, out.L) == is_back && is_consistent(p, out.L);
    if (!is_out || random_of(seed) >= slopes_seen(C, p->N, m, is_back ? l : -l))
        return sample_second_facet(w, p, out.L, !is_back,
                                   vec2(random_of(hash_uint(seed + 1u)), random_of(hash_uint(seed + 2u))));
    weigh(w, p, V, &out);
    return out;
}

static bool sample(const void *self, const path_surface_point *p, vec3 V, float u_lobe, vec2 u,
                   bsdf_sample *out)
{
    float foam = foam_cover(p);
    *out = u_lobe < foam ? sample_foam(self, p, V, u_lobe / foam, u) : sample_water(self, p, V, u_lobe, u);
    return out->weight[0] > 0.0f;
}

/* ---- the water below ---- */

float water_path_depth(const water_path *w, vec3 P)
{
    float x = P[0] - w->center[0], z = P[2] - w->center[1];
    return max(-(P[1] + w->fall * (x * x + z * z)), 0.0f);
}

static vec3 transmittance(const void *self, float distance_m)
{
    const water_path *w = self;
    vec3 k = max(water_diffuse(w->water), 1e-9f);
    return distance_m < 1e9f ? water_transmittance(k, distance_m) : vec3(0.0f);
}

static vec3 sun_transmittance(const void *self, float distance_m)
{
    const water_path *w = self;
    return water_unscattered(w->water, min(distance_m, MAX_DISTANCE_M));
}

/* Deep water seen from above emits alike in all directions, as R_rs has it: water_inscatter() times (K
 * |d.y| + a + b_b) over what it is straight down. A camera in the water sees the preview's radiance. Above
 * the level nothing is emitted. Indirectly, light on its way back to the bed was scattered out of light
 * that goes up, R times as much as goes down. */
static vec3 emission(const void *self, vec3 P, vec3 D, float distance_m, bool is_indirect)
{
    const water_path *path = self;
    const Water w = path->water;
    float z = water_path_depth(path, P), x = min(distance_m, D[1] > 1e-4f ? z / D[1] : MAX_DISTANCE_M);
    vec3 diffuse = water_inscatter(w, path->downwelling, z, D, x);
    if (is_indirect)
        return diffuse * water_deep_reflectance(w);
    if (!path->is_below && D[1] < 0.0f)
        diffuse *= (water_diffuse(w) - water_K_d(w) * D[1]) / max(water_diffuse(w) + water_K_d(w), 1e-9f);
    return diffuse + water_sun_inscatter(w, path->beam, path->sunward, z, D, x);
}

/* Points of a plane across sunward, at a distance of 1, by a normal distribution. */
static vec3 sun_sample(const void *self, vec2 u)
{
    const water_path *w = self;
    float r = w->sun_spread * sqrt(-2.0f * log(max(1.0f - u[0], 1e-7f)));
    float phi = 2.0f * PI * u[1];
    return normalize(mul(basis_from_normal(w->sunward), vec3(r * cos(phi), r * sin(phi), 1.0f)));
}

static float sun_pdf(const void *self, vec3 L)
{
    const water_path *w = self;
    float c = dot(L, w->sunward);
    if (!(c > 1e-3f))
        return 0.0f;
    float variance = w->sun_spread * w->sun_spread, t2 = max(1.0f / (c * c) - 1.0f, 0.0f);
    return exp(-0.5f * t2 / variance) * (0.5f * INV_PI / variance) / (c * c * c);
}

/* ---- what the camera sees ---- */

static vec3 background(const void *self, vec3 D)
{
    const water_path *w = self;
    return water_sky_seen(w->sky, D);
}

static vec3 through_air(const void *self, vec3 D, float distance_m, float height_m, vec3 radiance)
{
    const water_path *w = self;
    water_air air = water_sky_air(w->sky, D, distance_m, height_m);
    return radiance * air.transmittance + air.light;
}

/* ---- all ---- */

water_path water_path_make(const water_setup *s)
{
    const slope_covariance *total = &s->sea->slopes.total;
    float bend = 1.0f - 1.0f / s->water.ior;
    water_path p = {.water = s->water,
                    .downwelling = s->light.downwelling,
                    .beam = s->beam,
                    .sunward = s->sunward,
                    .is_below = s->is_below,
                    .center = {s->camera.origin[0], s->camera.origin[2]},
                    .fall = (float)s->march.fall,
                    .sky = &s->sky};
    if (s->sky.L[1] > 0.0f && s->sky.sun_irradiance[1] > 0.0f)
        p.sun_spread = SUN_SPREAD * bend * sqrt(0.5f * (total->xx + total->zz)) + MIN_SUN_SPREAD;
    return p;
}

path_surface water_path_surface(const water_path *w)
{
    _Static_assert((int)PATH_SURFACE_VALUES >= (int)SCENE_WATER_VALUES, "room for a vertex's values");
    return (path_surface){.self = w,
                          .intersect = intersect,
                          .eval = eval,
                          .sample = sample,
                          .has_camera = w->is_below,
                          .transmittance = transmittance,
                          .sun_transmittance = sun_transmittance,
                          .emission = emission,
                          .has_sun = w->sun_spread > 0.0f,
                          .sun_sample = sun_sample,
                          .sun_pdf = sun_pdf,
                          .background = background,
                          .through_air = through_air};
}
