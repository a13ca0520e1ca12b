/* bed_shadow.c - see bed_shadow.h. Rays from each texel of the bed go to the still surface and on to the
 * light: to the whole disc of the sun, through the slopes of all waves and over the texel's area; to the
 * sky through Snell's window, weighted by its radiance, since the bright sky around the sun is hidden with
 * it; and to sunlight scattered in the water. All texels share the same rays; the steps of scattered light
 * are smoothed. Interreflected light is gathered from the neighborhood. */
#include "water/bed_shadow.h"

#include <math.h>

#include "base/memory.h"
#include "base/parallel.h"
#include "base/result.h"

#include "water/water_setup.h"

#include "water/shadow_points.h"

static const float MIN_SEEN = 0.002f; /* share of the light above the water that returns from the bed */
static const float WIDEST = 1.13f;    /* tangent of the angle of total reflection: half of Snell's window */
static const float SKY_ROUGHNESS = 0.4f; /* perceptual, of a lobe as wide as a ray's solid angle */
/* Spread of light that the surface reflects back to the bed, relative to the depth. */
static const float RETURNED_WIDTH = 2.2f;
static const float LONGEST = 8.0f; /* length of a shadow on the water, in sizes of the model */

enum { SUN_RAYS_FIRST = 8, SUN_RAYS = SHADOW_POINTS, SKY_RAYS = 24, SCATTERED_RAYS = 32 };
enum { SMOOTHED = 3 }; /* texels */

/* A light path. */
typedef struct light_path {
    vec3 below, above; /* unit, towards the light */
    float weight;      /* not of sun rays, which have equal weights */
    float aside[2];    /* of sun rays: end point, in texels from the texel's center */
} light_path;

typedef struct making {
    const water_setup *s;
    bed_shadow *out;
    double texel_m[2];
    float *finer; /* per texel, the beam's share */
    light_path sun[SUN_RAYS], sky[SKY_RAYS], scattered[SCATTERED_RAYS];
} making;

/* ---- light paths ---- */

static vec3 sun_above(const water_setup *s)
{
    return normalize(vec3(s->light.L[0], max(s->light.L[1], 1e-3f), s->light.L[2]));
}

/* From the whole disc, over a texel and half of its neighbors. */
static void choose_sun(making *m)
{
    const water_setup *s = m->s;
    const slope_covariance *C = &s->sea->slopes.total;
    float x = sqrt(max(C->xx, 0.0f)), mixed = x > 0.0f ? C->xz / x : 0.0f;
    float z = sqrt(max(C->zz - mixed * mixed, 0.0f));
    for (uint i = 0; i < SUN_RAYS; i++) {
        shadow_point p = shadow_point_at(i, sun_above(s));
        vec2 g = vec2(inverse_normal(shadow_point_coordinate(i, 2)),
                      inverse_normal(shadow_point_coordinate(i, 3)));
        vec3 N = normal_from_slope(vec2(x * g[0], mixed * g[0] + z * g[1]));
        vec3 down = dot(N, p.L) > 0.0f ? water_refracted(s->water, -p.L, N) : -s->sunward;
        m->sun[i] = (light_path){.below = -down, .above = p.L, .aside = {p.aside[0], p.aside[1]}};
    }
}

static void choose_sky(making *m)
{
    const Water w = m->s->water;
    float sum = 0.0f;
    for (uint i = 0; i < SKY_RAYS; i++) {
        vec3 d = sample_cosine(hammersley(i, SKY_RAYS));
        vec3 above = vec3(d[0], max(d[2], 0.02f), d[1]);
        vec3 below = -water_refracted(w, -normalize(above), vec3(0.0f, 1.0f, 0.0f));
        float radiance = water_sky_reflected(&m->s->sky, normalize(above), SKY_ROUGHNESS)[1];
        m->sky[i] = (light_path){.below = below,
                                 .above = normalize(above),
                                 .weight = radiance * (1.0f - water_fresnel(w, above[1]))};
        sum += m->sky[i].weight;
    }
    for (uint i = 0; i < SKY_RAYS; i++)
        m->sky[i].weight *= 1.0f / max(sum, 1e-20f);
}

/* Single scattering by particles anywhere along the path: lateral offset is the remaining path length
 * times the tangent of the scattering angle. Half of the light falls within 0.065 of the depth, a
 * twentieth beyond half of it. */
static void choose_scattered(making *m)
{
    const water_setup *s = m->s;
    mat3 frame = basis_from_normal(s->sunward);
    for (uint i = 0; i < SCATTERED_RAYS; i++) {
        vec2 u = hammersley(i, SCATTERED_RAYS) + vec2(0.5f / (float)SCATTERED_RAYS, 0.0f);
        vec3 turned = sample_phase_HG(vec2(u[1], u[0]), vec3(0.0f, 0.0f, 1.0f), WATER_PARTICLE_G);
        /* as evenly distributed as u */
        float remaining = fract(0.5f + 0.618034f * (float)i) / max(turned[2], 0.1f);
        vec3 d = normalize(mul(frame, vec3(turned[0] * remaining, turned[1] * remaining, 1.0f)));
        d[1] = max(d[1], 0.1f);
        m->scattered[i] =
            (light_path){.below = normalize(d), .above = sun_above(s), .weight = 1.0f / SCATTERED_RAYS};
    }
}

/* ---- texels ---- */

static float path_visibility(const making *m, const double P[3], const light_path *path)
{
    const water_model *model = &m->s->model;
    double length = -P[1] / (double)path->below[1], Q[3];
    float visibility = water_model_visibility(model, P, path->below, length);
    if (visibility <= 0.0f)
        return 0.0f;
    for (int i = 0; i < 3; i++)
        Q[i] = P[i] + length * (double)path->below[i];
    return visibility * water_model_visibility(model, Q, path->above, HUGE_VAL);
}

static float share_of(const making *m, const double P[3], const light_path *paths, uint32_t count)
{
    float sum = 0.0f;
    for (uint32_t i = 0; i < count; i++)
        sum += paths[i].weight * path_visibility(m, P, &paths[i]);
    return min(sum, 1.0f);
}

/* Visibility of the beam by the first `count` rays around (X, Z). */
static float sun_share(const making *m, double X, double Z, uint32_t count)
{
    float sum = 0.0f;
    for (uint32_t i = 0; i < count; i++) {
        double x = X + m->texel_m[0] * (double)m->sun[i].aside[0],
               z = Z + m->texel_m[1] * (double)m->sun[i].aside[1];
        const double P[3] = {x, water_bed_height(&m->s->sea->desc.bed, x, z), z};
        sum += P[1] < 0.0 ? path_visibility(m, P, &m->sun[i]) : 1.0f;
    }
    return sum / (float)count;
}

/* Composition of the light of open water at the depth of one texel; shares, including interreflected
 * light, sum to 1. */
typedef struct light_shares {
    float focused, sky, scattered, returned;
} light_shares;

static light_shares shares_at(const water_setup *s, float depth)
{
    vec3 albedo = water_bed_albedo(&s->sea->desc.bed);
    float all = max(s->light.downwelling[1], 1e-20f);
    light_shares l = {.returned = water_bed_returned(s->water, albedo, depth)[1]};
    l.focused = water_focused(s->water, albedo, s->light.downwelling, s->beam, s->sunward[1], depth)[1];
    l.sky = (1.0f - l.returned) * s->light.sky_irradiance[1] * (1.0f - s->water.sky_reflectance) / all;
    l.scattered = max(1.0f - l.returned - l.sky - l.focused, 0.0f);
    return l;
}

/* rest: of all light except interreflected light. */
static bed_shadow_texel texel_at(const making *m, double X, double Z)
{
    const water_setup *s = m->s;
    const double P[3] = {X, water_bed_height(&s->sea->desc.bed, X, Z), Z};
    bed_shadow_texel t = {1.0f, 1.0f};
    if (P[1] >= 0.0)
        return t;
    light_shares l = shares_at(s, (float)-P[1]);
    if (s->light.L[1] > 0.0f)
        t.sun = sun_share(m, X, Z, SUN_RAYS_FIRST);
    float open = l.sky > 0.0f ? l.sky * share_of(m, P, m->sky, SKY_RAYS) : 0.0f;
    open += l.scattered > 0.0f ? l.scattered * share_of(m, P, m->scattered, SCATTERED_RAYS) : 0.0f;
    t.rest = l.sky + l.scattered > 0.0f ? open / (l.sky + l.scattered) : 1.0f;
    return t;
}

/* X or Z of a texel's center. */
static double middle_of(const making *m, int axis, size_t i)
{
    return m->out->low[axis] + ((double)i + 0.5) * m->texel_m[axis];
}

static void fill_rows(void *context, size_t begin, size_t end)
{
    const making *m = context;
    for (size_t z = begin; z < end; z++)
        for (size_t x = 0; x < BED_SHADOW_EDGE; x++)
            m->out->texels[z * BED_SHADOW_EDGE + x] = texel_at(m, middle_of(m, 0, x), middle_of(m, 1, z));
}

/* Whether a texel or one of its neighbors differs from another value. */
static bool is_at_edge(const bed_shadow *b, size_t x, size_t z)
{
    const size_t edge = BED_SHADOW_EDGE;
    float here = b->texels[z * edge + x].sun;
    if (here > 0.0f && here < 1.0f)
        return true;
    for (size_t k = z > 0 ? z - 1 : 0; k <= z + 1 && k < edge; k++)
        for (size_t i = x > 0 ? x - 1 : 0; i <= x + 1 && i < edge; i++)
            if (b->texels[k * edge + i].sun != here)
                return true;
    return false;
}

/* Writes the beam's visibility to m->finer, by all rays where its shadow has an edge. */
static void refine_rows(void *context, size_t begin, size_t end)
{
    const making *m = context;
    const bed_shadow *b = m->out;
    for (size_t z = begin; z < end; z++)
        for (size_t x = 0; x < BED_SHADOW_EDGE; x++)
            m->finer[z * BED_SHADOW_EDGE + x] =
                is_at_edge(b, x, z) ? sun_share(m, middle_of(m, 0, x), middle_of(m, 1, z), SUN_RAYS)
                                    : b->texels[z * BED_SHADOW_EDGE + x].sun;
}

static void fill_texels(making *m)
{
    uint32_t threads = m->s->desc->thread_count;
    parallel_for(threads, BED_SHADOW_EDGE, 4, fill_rows, m);
    if (!(m->s->light.L[1] > 0.0f))
        return;
    parallel_for(threads, BED_SHADOW_EDGE, 4, refine_rows, m);
    for (size_t i = 0; i < (size_t)BED_SHADOW_EDGE * BED_SHADOW_EDGE; i++)
        m->out->texels[i].sun = m->finer[i];
}

/* Mean over a texel and `radius` more on each side, along rows (step 1) or columns; no shadow outside. */
static void smooth_line(float *line, size_t step, int radius)
{
    float values[BED_SHADOW_EDGE];
    for (size_t i = 0; i < BED_SHADOW_EDGE; i++)
        values[i] = line[i * step];
    for (int i = 0; i < BED_SHADOW_EDGE; i++) {
        float sum = 0.0f;
        for (int k = i - radius; k <= i + radius; k++)
            sum += k < 0 || k >= BED_SHADOW_EDGE ? 1.0f : values[k];
        line[(size_t)i * step] = sum / (float)(2 * radius + 1);
    }
}

static void smooth_rest(bed_shadow *b)
{
    const size_t row = BED_SHADOW_EDGE * sizeof *b->texels / sizeof(float),
                 texel = sizeof *b->texels / sizeof(float);
    for (size_t i = 0; i < BED_SHADOW_EDGE; i++)
        smooth_line(&b->texels[i * BED_SHADOW_EDGE].rest, texel, SMOOTHED);
    for (size_t i = 0; i < BED_SHADOW_EDGE; i++)
        smooth_line(&b->texels[i].rest, row, SMOOTHED);
}

/* Water depth at a texel, m; 0: dry. */
static float depth_over(const making *m, size_t x, size_t z)
{
    double X = middle_of(m, 0, x), Z = middle_of(m, 1, z);
    return (float)fmax(-water_bed_height(&m->s->sea->desc.bed, X, Z), 0.0);
}

/* Light except interreflected light, averaged over the distance that light travels back from the surface.
 * around: BED_SHADOW_EDGE^2. */
static void add_returned(making *m, float depth, float *around)
{
    bed_shadow *b = m->out;
    const size_t edge = BED_SHADOW_EDGE;
    for (size_t i = 0; i < edge * edge; i++) {
        light_shares l = shares_at(m->s, depth_over(m, i % edge, i / edge));
        const bed_shadow_texel *t = &b->texels[i];
        float first = l.focused + l.sky + l.scattered;
        around[i] = (l.focused * t->sun + (l.sky + l.scattered) * t->rest) / max(first, 1e-6f);
    }
    for (int axis = 0; axis < 2; axis++) {
        int radius = (int)fmin((double)(RETURNED_WIDTH * depth) / m->texel_m[axis], 4.0 * BED_SHADOW_EDGE);
        for (size_t i = 0; i < edge; i++)
            smooth_line(around + i * (axis ? 1 : edge), axis ? edge : 1, radius);
    }
    for (size_t i = 0; i < edge * edge; i++) {
        light_shares l = shares_at(m->s, depth_over(m, i % edge, i / edge));
        float other = l.sky + l.scattered + l.returned;
        if (other > 0.0f)
            b->texels[i].rest += (around[i] - b->texels[i].rest) * l.returned / other;
    }
}

/* ---- where ---- */

void bed_shadow_of_beam(const struct water_setup *s, float depth, double low[2], double high[2])
{
    const float *from = s->model.bounds_min, *to = s->model.bounds_max;
    vec3 L = s->light.L;
    float above = max(to[1], 0.0f), size = max(max(to[0] - from[0], to[2] - from[2]), above);
    float in_air = L[1] > 0.0f ? min(above / L[1], LONGEST * size) : 0.0f;
    float in_water = depth / max(s->sunward[1], 0.1f), edge = 0.05f * size;
    for (int i = 0; i < 2; i++) {
        float shift = -L[2 * i] * in_air - s->sunward[2 * i] * in_water;
        low[i] = (double)(from[2 * i] + min(shift, 0.0f) - edge);
        high[i] = (double)(to[2 * i] + max(shift, 0.0f) + edge);
    }
}

/* The beam's shadow, and the sky that the model occludes. */
static void choose_rectangle(const water_setup *s, float depth, bed_shadow *b)
{
    bed_shadow_of_beam(s, depth, b->low, b->high);
    for (int i = 0; i < 2; i++) {
        b->low[i] -= (double)(WIDEST * depth);
        b->high[i] += (double)(WIDEST * depth);
    }
}

/* Whether the bed is visible through the water. */
static bool is_worth_it(const water_setup *s, float depth)
{
    vec3 transmitted = water_transmittance(water_K_d(s->water) + water_diffuse(s->water), depth);
    return max(max(transmitted[0], transmitted[1]), transmitted[2]) > MIN_SEEN;
}

facet_result bed_shadow_of_image(const struct water_setup *s, bed_shadow *out, facet_error *error)
{
    *out = (bed_shadow){.is_there = false};
    if (!s->model.is_there || !water_has_bed(s) || s->desc->sea_shading.style != FACET_SEA_STYLE_PHYSICAL)
        return FACET_OK;
    const float *low = s->model.bounds_min, *high = s->model.bounds_max;
    double X = 0.5 * ((double)low[0] + (double)high[0]), Z = 0.5 * ((double)low[2] + (double)high[2]);
    float depth = (float)-water_bed_height(&s->sea->desc.bed, X, Z);
    if (!(depth > 0.0f) || !is_worth_it(s, depth))
        return FACET_OK;
    const facet_allocator *allocator = &s->desc->allocator;
    const size_t count = (size_t)BED_SHADOW_EDGE * BED_SHADOW_EDGE;
    out->texels = mem_alloc(allocator, count, sizeof *out->texels);
    float *around = mem_alloc(allocator, count, sizeof *around);
    if (!out->texels || !around) {
        mem_free(around);
        return fail_memory(error, "a shadow on the bed", count * sizeof *out->texels);
    }
    making m = {.s = s, .out = out, .finer = around};
    choose_rectangle(s, depth, out);
    for (int i = 0; i < 2; i++)
        m.texel_m[i] = (out->high[i] - out->low[i]) / BED_SHADOW_EDGE;
    choose_sun(&m);
    choose_sky(&m);
    choose_scattered(&m);
    fill_texels(&m);
    smooth_rest(out);
    add_returned(&m, depth, around);
    mem_free(around);
    out->is_there = true;
    return FACET_OK;
}

void bed_shadow_destroy(bed_shadow *b)
{
    mem_free(b->texels);
    *b = (bed_shadow){.is_there = false};
}

/* ---- reading ---- */

static bed_shadow_texel between(bed_shadow_texel a, bed_shadow_texel b, float share)
{
    return (bed_shadow_texel){mix(a.sun, b.sun, share), mix(a.rest, b.rest, share)};
}

bed_shadow_texel bed_shadow_at(const bed_shadow *b, double X, double Z)
{
    const bed_shadow_texel open = {1.0f, 1.0f};
    if (!b->is_there || !(X > b->low[0] && X < b->high[0] && Z > b->low[1] && Z < b->high[1]))
        return open;
    const float last = BED_SHADOW_EDGE - 1;
    float u = clamp((float)((X - b->low[0]) / (b->high[0] - b->low[0])) * BED_SHADOW_EDGE - 0.5f, 0.0f, last);
    float v = clamp((float)((Z - b->low[1]) / (b->high[1] - b->low[1])) * BED_SHADOW_EDGE - 0.5f, 0.0f, last);
    size_t x = (size_t)min(u, last - 1.0f), z = (size_t)min(v, last - 1.0f);
    const bed_shadow_texel *t = b->texels + z * BED_SHADOW_EDGE + x;
    float fx = u - (float)x, fz = v - (float)z;
    return between(between(t[0], t[1], fx), between(t[BED_SHADOW_EDGE], t[BED_SHADOW_EDGE + 1], fx), fz);
}
