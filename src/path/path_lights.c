/* path_lights.c - see path_lights.h: which kind of light is sampled, and the resulting pdf.
 *
 * The kinds are the environment, the sun, directional lights, and lights with a position (the tree). Each
 * estimates its unoccluded irradiance at P and is chosen in proportion to it. But a quarter of the samples
 * is shared evenly by those with any, because of occlusion: a light in a room must be found although the
 * sun shines on the roof. */
#include "path/path_lights.h"

#include "base/memory.h"
#include "base/result.h"
#include "ibl/environment.h"

#include "path/light_emitters.h"

static const double pi = 3.14159265358979323846;
static const float EVEN_SHARE = 0.25f;
static const float MAX_INTENSITY = 1e15f; /* cd or lx; above, sums might not be finite */

/* ---- the sun: a disc of uniform radiance at infinite distance ---- */

typedef struct light_sun {
    vec3 direction;   /* unit, to its middle */
    vec3 radiance;    /* cd/m^2 */
    vec3 illuminance; /* lx, of a surface that faces it */
    float sin_radius;
    float height; /* of the cap of the unit sphere that it is: 1 - cos(radius) */
    float chord2; /* squared distance on the unit sphere from the middle to the border */
    float pdf;    /* per sr, in the disc; 0: there is no sun */
} light_sun;

static bool sun_contains(const light_sun *sun, vec3 d)
{
    vec3 difference = d - sun->direction; /* the cosine of so small an angle would lose its digits */
    return dot(difference, difference) < sun->chord2;
}

static const double DEFAULT_DIAMETER_DEG = 0.53;
static const double MIN_RADIUS_RAD = 5e-5;

static bool is_sunlight(const float channels[3])
{
    bool is_any = false;
    for (int i = 0; i < 3; i++) {
        if (!isfinite(channels[i]) || channels[i] > 1e20f)
            return false;
        is_any |= channels[i] > 0.0f;
    }
    return is_any;
}

/* Without an illuminance above 0 in any channel, or with one, or a direction, that is not finite: no sun.
 * Its radius is clamped to [5e-5 rad (the resolution of floats), a right angle]. */
static light_sun sun_create(const facet_sun *desc)
{
    light_sun sun = {.pdf = 0.0f};
    if (!is_sunlight(desc->illuminance_lux) || !isfinite(desc->azimuth_rad) ||
        !isfinite(desc->elevation_rad) || isnan(desc->diameter_rad))
        return sun;
    double diameter =
        desc->diameter_rad > 0.0f ? (double)desc->diameter_rad : DEFAULT_DIAMETER_DEG * pi / 180.0;
    double radius = fmin(fmax(0.5 * diameter, MIN_RADIUS_RAD), 0.5 * pi);
    double azimuth = (double)desc->azimuth_rad;
    double elevation = (double)desc->elevation_rad;
    double half_sine = sin(0.5 * radius);
    double sine = sin(radius);
    sun.direction = vec3((float)(cos(elevation) * sin(azimuth)), (float)sin(elevation),
                         (float)(cos(elevation) * cos(azimuth)));
    for (int i = 0; i < 3; i++)
        sun.illuminance[i] = max(desc->illuminance_lux[i], 0.0f);
    /* The projected solid angle of a disc around the normal is pi sin^2(radius). */
    sun.radiance = sun.illuminance * (float)(1.0 / (pi * sine * sine));
    sun.sin_radius = (float)sine;
    sun.height = (float)(2.0 * half_sine * half_sine);
    sun.chord2 = (float)(4.0 * half_sine * half_sine);
    sun.pdf = (float)(1.0 / (2.0 * pi * 2.0 * half_sine * half_sine));
    return sun;
}

/* About the illuminance (lx, mean of the channels) of a surface with unit normal N, {0}: one that faces
 * it. 0 only where all of it is below the horizon. */
static float sun_irradiance(const light_sun *sun, vec3 N)
{
    float all = (sun->illuminance[0] + sun->illuminance[1] + sun->illuminance[2]) * (1.0f / 3.0f);
    if (!(dot(N, N) > 0.0f))
        return all;
    float x = dot(N, sun->direction);
    return all * max(max(x, 0.5f * (x + sun->sin_radius)), 0.0f);
}

/* A uniform direction in the disc; density sun->pdf. Shirley and Wang 1994, "Direct Lighting Calculation
 * by Monte Carlo Integration": uniform height in the cap. */
static vec3 sun_sample(const light_sun *sun, vec2 u)
{
    float height = sun->height * u[0];
    float r = sqrt(height * (2.0f - height)); /* sin^2 = 1 - (1 - height)^2 */
    float phi = 2.0f * PI * u[1];
    return normalize(mul(basis_from_normal(sun->direction), vec3(r * cos(phi), r * sin(phi), 1.0f - height)));
}

struct path_lights {
    const render_setup *setup;
    light_environment *environment; /* NULL: black */
    light_sun sun;
    light_emitters emitters;
    light_tree *tree; /* over emitters and, after them, placed; NULL: there are none */
    Light *placed;    /* punctual lights with a position */
    Light *directional;
    uint32_t placed_count, directional_count;
    uint64_t ignored;
};

/* ---- making ---- */

static bool is_finite(vec3 v)
{
    return isfinite(v[0]) && isfinite(v[1]) && isfinite(v[2]);
}

static float mean_of(vec3 channels)
{
    return (channels[0] + channels[1] + channels[2]) * (1.0f / 3.0f);
}

/* Whether the light is valid and positive. Clamps negative channels to 0. */
static bool is_light(Light *l)
{
    bool is_fit = is_finite(l->position) && is_finite(l->spot_direction) && is_finite(l->intensity) &&
                  isfinite(l->spot_scale) && isfinite(l->spot_offset) && !isnan(l->range) &&
                  max3(l->intensity) <= MAX_INTENSITY && max3(abs(l->position)) < 1e15f;
    l->intensity = max(l->intensity, 0.0f);
    return is_fit && max3(l->intensity) > 0.0f;
}

static facet_result take_punctual(path_lights *lights, const facet_allocator *allocator, facet_error *error)
{
    const light_setup *light = &lights->setup->light;
    uint32_t count = light->punctual_count;
    if (count == 0)
        return FACET_OK;
    lights->placed = mem_alloc(allocator, count, sizeof *lights->placed);
    lights->directional = mem_alloc(allocator, count, sizeof *lights->directional);
    if (!lights->placed || !lights->directional)
        return fail_memory(error, "lights", count * sizeof *lights->placed);
    for (uint32_t i = 0; i < count; i++) {
        Light l = light->punctual[i];
        if (!is_light(&l))
            lights->ignored++;
        else if (l.directional)
            lights->directional[lights->directional_count++] = l;
        else
            lights->placed[lights->placed_count++] = l;
    }
    return FACET_OK;
}

/* A punctual light is never nearer than 1 cm: shade/light.h. */
static light_bounds bounds_of_placed(const Light *l)
{
    bool is_spot = l->spot_scale > 0.0f;
    float dark =
        is_spot ? -l->spot_offset / l->spot_scale : -2.0f; /* cosines of the outer and the inner cone */
    float full = is_spot ? (1.0f - l->spot_offset) / l->spot_scale : -1.0f;
    return (light_bounds){.center = l->position,
                          .radius = sqrt(MIN_DISTANCE2),
                          .axis = is_spot ? l->spot_direction : vec3(0.0f),
                          .cos_spread = is_spot ? 1.0f : -1.0f,
                          .dark = dark,
                          .full = full,
                          .slack = INFINITY,
                          .reach = l->range > 0.0f ? l->range : INFINITY,
                          .intensity = mean_of(l->intensity)};
}

static light_bounds bounds_of_emitter(const light_emitters *e, uint32_t item)
{
    light_triangle t = light_emitters_triangle(e, item);
    vec3 center = t.corner + (t.edge1 + t.edge2) * (1.0f / 3.0f);
    vec3 corners[3] = {t.corner, t.corner + t.edge1, t.corner + t.edge2};
    float radius2 = 0.0f;
    for (int i = 0; i < 3; i++)
        radius2 = max(radius2, dot(corners[i] - center, corners[i] - center));
    bool is_two_sided = light_emitters_is_two_sided(e, item);
    return (light_bounds){.center = center,
                          .radius = sqrt(radius2),
                          .axis = normalize(cross(t.edge1, t.edge2)) * light_emitters_normal_sign(e, item),
                          .cos_spread = 1.0f,
                          .dark = 0.0f,
                          .full = 1.0f,
                          .slack = is_two_sided ? INFINITY : 0.0f,
                          .reach = INFINITY,
                          .intensity = e->items[item].intensity,
                          .is_two_sided = is_two_sided};
}

static facet_result make_tree(path_lights *lights, const facet_allocator *allocator, facet_error *error)
{
    size_t count = (size_t)lights->emitters.count + lights->placed_count;
    if (count == 0)
        return FACET_OK;
    light_bounds *bounds = count < LIGHT_TREE_NONE / 2 ? mem_alloc(allocator, count, sizeof *bounds) : NULL;
    if (!bounds)
        return fail_memory(error, "light tree", count * sizeof *bounds);
    for (uint32_t i = 0; i < lights->emitters.count; i++)
        bounds[i] = bounds_of_emitter(&lights->emitters, i);
    for (uint32_t i = 0; i < lights->placed_count; i++)
        bounds[lights->emitters.count + i] = bounds_of_placed(&lights->placed[i]);
    facet_result result = light_tree_create(bounds, (uint32_t)count, allocator, &lights->tree, error);
    mem_free(bounds);
    return result;
}

facet_result path_lights_create(const render_setup *setup, path_lights **out, facet_error *error)
{
    const facet_render_desc *desc = setup->desc;
    const facet_allocator *allocator = &desc->allocator;
    *out = NULL;
    path_lights *lights = mem_zalloc(allocator, 1, sizeof *lights);
    if (!lights)
        return fail_memory(error, "lights", sizeof *lights);
    lights->setup = setup;
    lights->sun = sun_create(&desc->sun);
    facet_result result = take_punctual(lights, allocator, error);
    if (result == FACET_OK && desc->environment)
        result = light_environment_create(&desc->environment->panorama, &setup->light,
                                          desc->path.light_sampling == FACET_LIGHT_SAMPLING_MIS, allocator,
                                          desc->thread_count, &lights->environment, error);
    if (result == FACET_OK)
        result =
            light_emitters_create(&setup->shading, allocator, desc->thread_count, &lights->emitters, error);
    if (result == FACET_OK)
        result = make_tree(lights, allocator, error);
    if (result != FACET_OK) {
        path_lights_destroy(lights);
        return result;
    }
    lights->ignored += lights->emitters.ignored;
    *out = lights;
    return FACET_OK;
}

void path_lights_destroy(path_lights *lights)
{
    if (!lights)
        return;
    light_environment_destroy(lights->environment);
    light_emitters_destroy(&lights->emitters);
    light_tree_destroy(lights->tree);
    mem_free(lights->placed);
    mem_free(lights->directional);
    mem_free(lights);
}

bool path_lights_has_any(const path_lights *lights)
{
    return lights->environment || lights->sun.pdf > 0.0f || lights->tree || lights->directional_count > 0;
}

uint64_t path_lights_ignored(const path_lights *lights)
{
    return lights->ignored;
}

/* ---- the choice ---- */

enum { ENVIRONMENT, SUN, DIRECTIONAL, PLACED }; /* PATH_LIGHTS_KINDS */

/* Irradiance (mean of the channels) of a directional light. */
static float directional_irradiance(const Light *l, vec3 N)
{
    float cosine = dot(N, N) > 0.0f ? max(dot(N, l->position), 0.0f) : 1.0f;
    return mean_of(l->intensity) * cosine;
}

void path_lights_see(const path_lights *lights, vec3 P, vec3 N, path_lights_view *c)
{
    c->P = P;
    c->N = N;
    float *p = c->probabilities;
    p[ENVIRONMENT] = p[SUN] = p[PLACED] = c->directional = 0.0f;
    if (lights->environment) {
        light_environment_see(lights->environment, N, &c->environment);
        p[ENVIRONMENT] = c->environment.irradiance;
    }
    if (lights->sun.pdf > 0.0f)
        p[SUN] = sun_irradiance(&lights->sun, N);
    for (uint32_t i = 0; i < lights->directional_count; i++)
        c->directional += directional_irradiance(&lights->directional[i], N);
    p[DIRECTIONAL] = c->directional;
    if (lights->tree) {
        light_tree_see(lights->tree, P, N, &c->tree);
        p[PLACED] = c->tree.irradiance;
    }
    float sum = 0.0f;
    float kinds = 0.0f;
    for (int i = 0; i < PATH_LIGHTS_KINDS; i++) {
        p[i] = p[i] > 0.0f && p[i] < INFINITY ? p[i] : 0.0f;
        sum += p[i];
        kinds += p[i] > 0.0f ? 1.0f : 0.0f;
    }
    for (int i = 0; i < PATH_LIGHTS_KINDS; i++)
        p[i] = p[i] > 0.0f ? (1.0f - EVEN_SHARE) * p[i] / sum + EVEN_SHARE / kinds : 0.0f;
}

/* A sample is chosen by irradiance alone. Where lights are many, or sun and sky are alike, what the BSDF makes
 * of them differs more than other samples cost. Relative MSE of 16 samples: 10 000 emissive triangles with 1, 4, 8
 * candidates .184, .070, .053 for 1, 1.9, 3.0 times the instructions; sun and sky with 1, 2, 4 .041, .032, .028
 * for 1, 1.2, 1.6 times the time; but two panels .114, .111, .108, and an environment alone .0495, .0497, .0494. */
uint32_t path_lights_candidates(const path_lights *lights, const path_lights_view *view)
{
    enum { FEW = 16 };
    const float *p = view->probabilities;
    uint64_t placed = (uint64_t)lights->emitters.count + lights->placed_count;
    if (placed > FEW && p[PLACED] > 0.5f)
        return 4;
    return min(p[SUN], p[ENVIRONMENT]) > 0.25f ? 2 : 1;
}

/* ---- each kind ---- */

/* The pdf per sr of a direction by the environment alone. */
static float environment_pdf(const path_lights *lights, const path_lights_view *c, vec3 d)
{
    if (!(c->probabilities[ENVIRONMENT] > 0.0f))
        return 0.0f;
    return light_environment_pdf(lights->environment, &c->environment, d);
}

/* The pdf per sr of a direction to environment or sun; pdf: that of the environment alone. */
static float mixed_pdf(const path_lights *lights, const path_lights_view *c, float pdf, bool is_in_sun)
{
    return c->probabilities[ENVIRONMENT] * pdf + (is_in_sun ? c->probabilities[SUN] * lights->sun.pdf : 0.0f);
}

vec3 path_lights_environment(const path_lights *lights, vec3 d)
{
    return lights->environment ? light_environment_radiance(lights->environment, d) : vec3(0.0f);
}

static bool sample_environment(const path_lights *lights, const path_lights_view *c, const double u[2],
                               path_light_sample *out)
{
    float pdf = light_environment_sample(lights->environment, &c->environment, u, &out->L);
    bool is_in_sun = lights->sun.pdf > 0.0f && sun_contains(&lights->sun, out->L);
    out->is_infinite = true;
    out->radiance = path_lights_environment(lights, out->L) + (is_in_sun ? lights->sun.radiance : vec3(0.0f));
    out->pdf = mixed_pdf(lights, c, pdf, is_in_sun);
    return out->pdf > 0.0f;
}

static bool sample_sun(const path_lights *lights, const path_lights_view *c, vec2 u, path_light_sample *out)
{
    out->L = sun_sample(&lights->sun, u);
    out->is_infinite = true;
    out->radiance = path_lights_environment(lights, out->L) + lights->sun.radiance;
    out->pdf = mixed_pdf(lights, c, environment_pdf(lights, c, out->L), true);
    return out->pdf > 0.0f;
}

static bool sample_directional(const path_lights *lights, const path_lights_view *c, vec3 N, double u,
                               path_light_sample *out)
{
    double target = u * (double)c->directional;
    const Light *found = NULL;
    float irradiance = 0.0f;
    for (uint32_t i = 0; i < lights->directional_count; i++) {
        float each = directional_irradiance(&lights->directional[i], N);
        if (!(each > 0.0f))
            continue;
        target -= (double)irradiance; /* of the one before */
        found = &lights->directional[i];
        irradiance = each;
        if (target < (double)each)
            break;
    }
    if (!found)
        return false;
    out->L = found->position;
    out->is_delta = true;
    out->radiance = found->intensity;
    out->pdf = c->probabilities[DIRECTIONAL] * (irradiance / c->directional);
    return true;
}

static bool sample_placed_light(const Light *l, vec3 P, float probability, path_light_sample *out)
{
    LightSample s = light_illuminate(*l, P);
    out->L = s.L;
    out->distance_m = s.distance_m;
    out->is_delta = true;
    out->radiance = s.E;
    out->pdf = probability;
    return max3(s.E) > 0.0f && s.distance_m > 0.0f && probability > 0.0f;
}

static bool sample_emitter(const path_lights *lights, uint32_t item, vec3 P, vec2 u, float probability,
                           path_light_sample *out)
{
    light_triangle t = light_emitters_triangle(&lights->emitters, item);
    light_triangle_point point;
    if (!light_triangle_sample(&t, P, u, &point))
        return false;
    out->L = point.L;
    out->distance_m = point.distance_m;
    out->radiance =
        light_emitters_radiance(&lights->emitters, item, point.u, point.v, P, point.L, point.distance_m);
    out->pdf = probability * point.pdf;
    out->geometry = lights->emitters.items[item].geometry;
    out->primitive = lights->emitters.items[item].primitive;
    return max3(out->radiance) > 0.0f && out->pdf > 0.0f;
}

/* ---- all ---- */

bool path_lights_sample(const path_lights *lights, const path_lights_view *view, float u_light, vec2 u,
                        path_light_sample *out)
{
    *out = (path_light_sample){
        .distance_m = INFINITY, .geometry = VISIBILITY_NONE, .primitive = VISIBILITY_NONE};
    /* 24 bits are few where a choice among 100 000 continues with the rest of the choice before. */
    uint hash = hash_uint(floatBitsToUint(u_light) ^
                          hash_uint(floatBitsToUint(u[0]) ^ hash_uint(floatBitsToUint(u[1]))));
    double fine = (double)u_light + (double)hash * 0x1p-56;
    int kind = 0;
    float probability = 0.0f;
    for (int i = 0; i < PATH_LIGHTS_KINDS; i++) {
        if (!(view->probabilities[i] > 0.0f))
            continue;
        fine -= (double)probability; /* of the one before */
        kind = i;
        probability = view->probabilities[i];
        if (fine < (double)probability)
            break;
    }
    if (!(probability > 0.0f))
        return false;
    fine /= (double)probability;
    fine = fine < 1.0 - 0x1p-53 ? fine : 1.0 - 0x1p-53;
    if (kind == ENVIRONMENT)
        return sample_environment(lights, view, (double[2]){(double)u[0], (double)u[1]}, out);
    if (kind == SUN)
        return sample_sun(lights, view, u, out);
    if (kind == DIRECTIONAL)
        return sample_directional(lights, view, view->N, fine, out);
    float share;
    uint32_t light = light_tree_sample(lights->tree, &view->tree, fine, &share, &fine);
    if (light == LIGHT_TREE_NONE)
        return false;
    if (light >= lights->emitters.count)
        return sample_placed_light(&lights->placed[light - lights->emitters.count], view->P,
                                   probability * share, out);
    return sample_emitter(lights, light, view->P, u, probability * share, out);
}

vec3 path_lights_infinite(const path_lights *lights, vec3 d)
{
    vec3 radiance = path_lights_environment(lights, d);
    if (lights->sun.pdf > 0.0f && sun_contains(&lights->sun, d))
        radiance += lights->sun.radiance;
    return radiance;
}

float path_lights_infinite_pdf(const path_lights *lights, const path_lights_view *view, vec3 d)
{
    bool is_in_sun = lights->sun.pdf > 0.0f && sun_contains(&lights->sun, d);
    return mixed_pdf(lights, view, environment_pdf(lights, view, d), is_in_sun);
}

float path_lights_emitter_pdf(const path_lights *lights, const path_lights_view *view,
                              const visibility_hit *hit, vec3 d, float distance_m)
{
    uint32_t item = light_emitters_find(&lights->emitters, hit->geometry, hit->primitive);
    if (item == LIGHT_EMITTERS_NONE)
        return 0.0f;
    if (!(view->probabilities[PLACED] > 0.0f))
        return 0.0f;
    light_triangle t = light_emitters_triangle(&lights->emitters, item);
    float pdf = view->probabilities[PLACED] * light_tree_probability(lights->tree, &view->tree, item) *
                light_triangle_pdf(&t, view->P, d, distance_m);
    return pdf < INFINITY ? pdf : 0.0f;
}
