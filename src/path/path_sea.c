/* path_sea.c - see path_sea.h. Reflection is F D G / (4 N.V), transmission Walter et al. 2007, equation 21, D of Gaussian slopes about
 * those of N and G of waves of all lengths (slopes_seen()). From below all is the same with both directions turned around, so that formulas see them above.
 *
 * A facet is drawn from those that V sees, then what it does by Fresnel's equations, then whether other facets let the light
 * pass: sampling is as likely as what it finds is bright, and all weights are 1 or ratios of the index squared. What does not pass
 * meets a second facet, and its light is not lost. */
#include "path/path_sea.h"

static const float FARTHEST = 1e4f; /* m, more than any water lets see */

/* Of what is so near to the index of air, facets turn light by less than directions are told apart. */
static const float LEAST_BEND = 1e-4f;

/* Bits of a number in [0, 1) as seed. */
static uint bits_of(float u)
{
    return (uint)(u * 16777216.0f);
}

static float number_of(uint h)
{
    return (float)(h >> 8u) * (1.0f / 16777216.0f);
}

path_sea_point path_sea_point_make(const path_sea *sea, const shading_hit *h, const float triangle_normal[3],
                                   vec3 V)
{
    const float *values = h->geometry->primitive->water;
    float v[SCENE_WATER_VALUES] = {0.0f};
    for (int corner = 0; corner < 3; corner++)
        for (int i = 0; i < SCENE_WATER_VALUES; i++)
            v[i] += h->weight[corner] * values[SCENE_WATER_VALUES * h->corner[corner] + (size_t)i];
    path_sea_point p = {.sea = sea, .C = vec3(v[0], v[1], v[2]), .foam = clamp(v[3], 0.0f, 1.0f)};
    p.Ng = normalize_or(load3(triangle_normal), vec3(0.0f, 1.0f, 0.0f));
    p.Ng = p.Ng[1] < 0.0f ? -p.Ng : p.Ng;
    p.side = dot(p.Ng, V) < 0.0f ? -1.0f : 1.0f;
    vec3 N = normalize_or(shading_hit_vec3(h, h->geometry->normals), p.Ng);
    p.N = water_faced(N, V * p.side);
    return p;
}

/* ---- facets ---- */

static float index_here(const path_sea_point *p)
{
    return p->side > 0.0f ? 1.0f : p->sea->water.ior;
}

static float index_beyond(const path_sea_point *p)
{
    return p->side > 0.0f ? p->sea->water.ior : 1.0f;
}

/* Whether there is no surface but its foam. */
static bool is_straight(const path_sea_point *p)
{
    return p->sea->water.ior < 1.0f + LEAST_BEND;
}

/* Reflectance for light that meets a facet at a cosine, on the side of V. */
static float reflectance(const path_sea_point *p, float cosine)
{
    float c = clamp(cosine, 0.0f, 1.0f);
    return p->side > 0.0f ? water_fresnel(p->sea->water, c) : water_fresnel_inside(p->sea->water, c);
}

/* Whether L leaves the surface on the side of V. */
static bool is_reflected(const path_sea_point *p, vec3 L)
{
    return dot(p->N, L) * p->side > 0.0f;
}

/* Whether it does so for the triangle, too. */
static bool is_consistent(const path_sea_point *p, vec3 L)
{
    return dot(p->N, L) * dot(p->Ng, L) > 0.0f;
}

static float reflect_value(const path_sea_point *p, vec3 V, vec3 L)
{
    vec3 v = V * p->side, l = L * p->side;
    vec3 m = normalize(v + l);
    float l_N = dot(l, p->N);
    if (!(l_N > 0.0f) || !(dot(v, p->N) > 0.0f) || !(m[1] > 0.0f))
        return 0.0f;
    float D = D_slopes(WATER_BECKMANN, p->C, p->N, m);
    return D * V_slopes(WATER_BECKMANN, WATER_SCALES, p->C, p->N, l, v) * l_N * reflectance(p, dot(v, m));
}

static float transmit_value(const path_sea_point *p, vec3 V, vec3 L)
{
    if (is_straight(p))
        return 0.0f;
    float here = index_here(p), beyond = index_beyond(p);
    vec3 h = V * here + L * beyond;
    vec3 m = normalize_or(h[1] < 0.0f ? -h : h, p->N);
    vec3 v = V * p->side, l = L * -p->side; /* both as if above */
    float v_m = dot(v, m), l_m = dot(l, m), v_N = dot(v, p->N);
    if (!(v_m > 0.0f) || !(l_m > 0.0f) || !(v_N > 0.0f) || !(dot(l, p->N) > 0.0f))
        return 0.0f;
    float D = D_slopes(WATER_BECKMANN, p->C, p->N, m);
    float G = slopes_seen(p->C, p->N, m, v) * slopes_seen(p->C, p->N, m, l);
    float t = here * v_m - beyond * l_m;
    float t2 = max(t * t, 1e-12f);
    return (1.0f - reflectance(p, v_m)) * D * G * v_m * l_m * here * here / (v_N * t2);
}

/* ---- foam ---- */

/* A diffuser that absorbs nothing: what it does not reflect goes through, as diffusely. Of light in the water, 1 - (1 - albedo) / n^2 comes
 * back, so that in a closed box, with n^2 below, it shows 1. */
static float foam_reflectance(const path_sea_point *p)
{
    float n = p->sea->water.ior;
    return p->side > 0.0f ? p->sea->water.foam_albedo : 1.0f - (1.0f - p->sea->water.foam_albedo) / (n * n);
}

/* ---- all ---- */

/* Of radiance that comes from the other side. */
static float gain(const path_sea_point *p)
{
    float ratio = index_here(p) / index_beyond(p);
    return ratio * ratio;
}

vec3 path_sea_scatter(const path_sea_point *p, vec3 V, vec3 L, float *pdf)
{
    *pdf = 0.0f;
    if (!is_consistent(p, L))
        return vec3(0.0f);
    bool is_back = is_reflected(p, L);
    float cosine = abs(dot(p->N, L)) * INV_PI, share = foam_reflectance(p);
    float foam = is_back ? share * cosine : (1.0f - share) * cosine * gain(p);
    float water = is_back ? reflect_value(p, V, L) : transmit_value(p, V, L);
    float value = mix(water, foam, p->foam);
    *pdf = is_back ? value : value / gain(p);
    return vec3(value);
}

static path_sea_direction sample_foam(const path_sea_point *p, vec3 V, float u_lobe, vec2 u)
{
    vec3 d = mul(basis_from_normal(p->N), sample_cosine(u));
    bool is_back = u_lobe < foam_reflectance(p);
    path_sea_direction out = {.L = is_back ? d * p->side : d * -p->side, .is_through = !is_back};
    vec3 f = path_sea_scatter(p, V, out.L, &out.pdf);
    out.weight = out.pdf > 0.0f ? f[0] / out.pdf : 0.0f;
    return out;
}

/* To the side of the triangle that it is to be on. */
static vec3 kept_on(const path_sea_point *p, vec3 L, float side)
{
    float c = dot(L, p->Ng);
    return c * side > 0.0f ? L : normalize(L - p->Ng * (2.0f * c - side * 1e-4f));
}

/* Light that leaves a facet along L and does not pass the others: one of them is drawn from those that it sees. */
static path_sea_direction second_facet(const path_sea_point *p, vec3 L, bool is_through, vec2 u)
{
    path_sea_direction out = {.weight = 1.0f, .is_second = true, .is_through = is_through};
    vec3 l = L * p->side;
    if (is_through) { /* hidden by other crests: it goes on as if it were not */
        out.L = kept_on(p, L, -p->side);
        out.weight = gain(p);
        return out;
    }
    vec3 v = vec3(-l[0], abs(l[1]), -l[2]);
    vec3 m = sample_slopes(u, p->C, p->N, v);
    float c = dot(v, m);
    out.is_through = number_of(hash_uint(bits_of(u[0]) ^ 0x9e3779b9u)) >= reflectance(p, c);
    vec3 d = out.is_through ? refract(-v, m, index_here(p) / index_beyond(p)) : reflect(-v, m);
    out.L = kept_on(p, d * p->side, out.is_through ? -p->side : p->side);
    out.weight = out.is_through ? gain(p) : 1.0f;
    return out;
}

path_sea_direction path_sea_sample(const path_sea_point *p, vec3 V, float u_lobe, vec2 u)
{
    if (u_lobe < p->foam)
        return sample_foam(p, V, u_lobe / p->foam, u);
    if (is_straight(p))
        return (path_sea_direction){
            .L = kept_on(p, -V, -p->side), .weight = 1.0f, .is_through = true, .is_straight = true};
    vec3 v = V * p->side;
    vec3 m = sample_slopes(u, p->C, p->N, v);
    uint seed = hash_uint(bits_of(u_lobe) ^ hash_uint(bits_of(u[0]) + hash_uint(bits_of(u[1]))));
    float u_fresnel = (u_lobe - p->foam) / (1.0f - p->foam);
    bool is_back = u_fresnel < reflectance(p, dot(v, m));
    path_sea_direction out = {.is_through = !is_back};
    vec3 l = is_back ? reflect(-v, m) : refract(-v, m, index_here(p) / index_beyond(p));
    out.L = l * p->side;
    bool is_out = is_reflected(p, out.L) == is_back && is_consistent(p, out.L);
    if (!is_out || number_of(seed) >= slopes_seen(p->C, p->N, m, is_back ? l : -l))
        return second_facet(p, out.L, !is_back,
                            vec2(number_of(hash_uint(seed + 1u)), number_of(hash_uint(seed + 2u))));
    vec3 f = path_sea_scatter(p, V, out.L, &out.pdf);
    out.weight = out.pdf > 0.0f ? f[0] / out.pdf : 0.0f;
    return out;
}

float path_sea_albedo(const path_sea_point *p, vec3 V)
{
    return mix(reflectance(p, abs(dot(p->N, V))), p->sea->water.foam_albedo, p->foam);
}

/* ---- under the surface ---- */

float path_sea_depth(const path_sea *sea, vec3 P)
{
    float x = P[0] - sea->center[0], z = P[2] - sea->center[1];
    return max(-(P[1] + sea->fall * (x * x + z * z)), 0.0f);
}

vec3 path_sea_transmittance(const path_sea *sea, float x)
{
    vec3 k = max(water_diffuse(sea->water), 1e-9f);
    return x < 1e9f ? water_transmittance(k, x) : vec3(0.0f);
}

vec3 path_sea_unscattered(const path_sea *sea, float x)
{
    return water_unscattered(sea->water, min(x, FARTHEST));
}

/* Deep water seen from above shines alike in all directions, as R_rs has it: water_inscatter() times (K |d.y| + a + b_b) over what it is
 * straight down. An eye in the water sees what the preview shows it. Above the level nothing shines. */
vec3 path_sea_glow(const path_sea *sea, vec3 P, vec3 D, float x)
{
    const Water w = sea->water;
    float z = path_sea_depth(sea, P), way = min(x, D[1] > 1e-4f ? z / D[1] : FARTHEST);
    vec3 diffuse = water_inscatter(w, sea->downwelling, z, D, way);
    if (!sea->is_below && D[1] < 0.0f)
        diffuse *= (water_diffuse(w) - water_K_d(w) * D[1]) / max(water_diffuse(w) + water_K_d(w), 1e-9f);
    return diffuse + water_sun_glow(w, sea->beam, sea->sunward, z, D, way);
}

/* Light on its way back to the bed was scattered out of light that goes up, R times as much as goes down. */
vec3 path_sea_glow_returned(const path_sea *sea, vec3 P, vec3 D, float x)
{
    float z = path_sea_depth(sea, P), way = min(x, D[1] > 1e-4f ? z / D[1] : FARTHEST);
    return water_inscatter(sea->water, sea->downwelling, z, D, way) * water_deep_reflectance(sea->water);
}

/* ---- towards the sun ---- */

/* Points of a plane across sunward, at a distance of 1, by a normal distribution. */
vec3 path_sea_sunward(const path_sea *sea, vec2 u)
{
    float r = sea->sun_spread * sqrt(-2.0f * log(max(1.0f - u[0], 1e-7f)));
    float phi = 2.0f * PI * u[1];
    return normalize(mul(basis_from_normal(sea->sunward), vec3(r * cos(phi), r * sin(phi), 1.0f)));
}

float path_sea_sunward_pdf(const path_sea *sea, vec3 L)
{
    float c = dot(L, sea->sunward);
    if (!(c > 1e-3f))
        return 0.0f;
    float variance = sea->sun_spread * sea->sun_spread, t2 = max(1.0f / (c * c) - 1.0f, 0.0f);
    return exp(-0.5f * t2 / variance) * (0.5f * INV_PI / variance) / (c * c * c);
}
