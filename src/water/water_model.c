/* water_model.c - see water_model.h. */
#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "base/result.h"
#include "draw/light_setup.h"

#include "water/water_model.h"

#include "cpu/ray_trace.h"
#include "cpu/render_setup.h"
#include "cpu/shading.h"
#include "draw/ogl1_setup.h"
#include "scene/identity.h"

struct water_model_rays {
    prepared_scene prepared;
    render_setup setup;
    light_setup shaded_light; /* setup's lights without the sun: punctual lights only */
    shading_scene shaded;
    ogl1_setup ogl1; /* of setup.shading.ogl1; {0}: shaded as glTF */
};

static const ray_spread no_spread = {.moves = false, .turns = false};
static const double farthest = 1e6;
enum { SIDES = 8 };

/* ---- making ---- */

static void fill_desc(const facet_render_desc *desc, const water_sky *sky, facet_environment *around,
                      water_model *m)
{
    vec3 L = sky->L, E = sky->sun_irradiance;
    m->desc = *desc;
    m->desc.sea = NULL;
    m->desc.environment = around;
    if (!around)
        m->desc.log = (facet_log){0};
    m->desc.environment_rotation_rad = m->desc.environment_ev = 0.0f;
    m->desc.background = (facet_background){0};
    m->desc.background_blur = 0.0f;
    m->desc.ground = FACET_GROUND_NONE;
    if (desc->shading == FACET_SHADING_OGL1) { /* sky and sun do not light display values */
        m->desc.sun = (facet_sun){0};
        return;
    }
    m->desc.sun = (facet_sun){.azimuth_rad = atan(L[0], L[2]),
                              .elevation_rad = asin(clamp(L[1], -1.0f, 1.0f)),
                              .illuminance_lux = {E[0], E[1], E[2]}};
}

/* Lights without the sun, which is the last one, where it shines. */
static facet_result make_shade(const facet_allocator *allocator, bool has_sun, water_model *m,
                               facet_error *error)
{
    struct water_model_rays *r = m->rays;
    const light_setup *light = &r->setup.light;
    r->shaded_light = *light;
    r->shaded_light.punctual = NULL;
    r->shaded = r->setup.shading;
    r->shaded.light = &r->shaded_light;
    if (light->punctual_count == 0)
        return FACET_OK;
    Light *lights = mem_alloc(allocator, light->punctual_count, sizeof *lights);
    if (!lights)
        return fail_memory(error, "lights", light->punctual_count * sizeof *lights);
    memcpy(lights, light->punctual, light->punctual_count * sizeof *lights);
    if (has_sun)
        lights[light->punctual_count - 1].intensity = vec3(0.0f);
    r->shaded_light.punctual = lights;
    return FACET_OK;
}

static facet_result make_ogl1(water_model *m, facet_error *error)
{
    struct water_model_rays *r = m->rays;
    const prepared_scene *p = &r->prepared;
    const ogl1_source source = {p->scene, &p->pose, &p->geometries, &p->default_legacy};
    render_setup *setup = &r->setup;
    TRY(ogl1_setup_create(&source, &setup->camera, &m->desc, &setup->light, &setup->plans, &r->ogl1, error));
    setup->shading.ogl1 = &r->ogl1;
    return FACET_OK;
}

facet_result water_model_create(const facet_scene *scene, const facet_render_desc *desc, const water_sky *sky,
                                facet_environment *around, facet_render_stats *stats, water_model *m,
                                facet_error *error)
{
    fill_desc(desc, sky, around, m);
    struct water_model_rays *r = mem_zalloc(&desc->allocator, 1, sizeof *r);
    if (!r)
        return fail_memory(error, "a model in a sea", sizeof *r);
    m->rays = r;
    prepared_scene_init(&r->prepared, scene, &desc->allocator);
    m->is_there = true;
    r->setup = (render_setup){.prepared = &r->prepared,
                              .desc = &m->desc,
                              .stats = stats,
                              .reads_everywhere = true,
                              .reads_opacity_only = !around && desc->shading == FACET_SHADING_GLTF};
    TRY(ogl1_check(scene, &m->desc, error));
    TRY(render_setup_create(&r->setup, error));
    r->setup.shading.backdrop = SHADING_BACKDROP_ENVIRONMENT; /* the sea's */
    memcpy(m->bounds_min, r->prepared.pose.bounds_min, sizeof m->bounds_min);
    memcpy(m->bounds_max, r->prepared.pose.bounds_max, sizeof m->bounds_max);
    if (desc->shading == FACET_SHADING_OGL1)
        return make_ogl1(m, error);
    vec3 E = sky->sun_irradiance;
    return make_shade(&desc->allocator, max(E[0], max(E[1], E[2])) > 0.0f, m, error);
}

void water_model_destroy(water_model *m)
{
    struct water_model_rays *r = m->rays;
    if (r) {
        mem_free(r->shaded_light.punctual);
        ogl1_setup_destroy(&r->ogl1);
        render_setup_destroy(&r->setup);
        prepared_scene_clear(&r->prepared);
        mem_free(r);
    }
    *m = (water_model){.is_there = false};
}

/* ---- rays ---- */

/* Slab test; a ray within a slab plane gives 0 / 0, compares false, and is kept. */
/* Whether a ray from P along d hits the model's bounds: a fast rejection test. */
static bool may_meet(const water_model *m, const double P[3], vec3 d, double far_m)
{
    if (!m->is_there)
        return false;
    const float *low = m->bounds_min, *high = m->bounds_max;
    double first = 0.0, last = far_m;
    for (int i = 0; i < 3; i++) {
        double per = 1.0 / (double)d[i], margin = 1e-6 * (fabs(P[i]) + 1.0);
        double a = ((double)low[i] - margin - P[i]) * per, b = ((double)high[i] + margin - P[i]) * per;
        double near = a < b ? a : b, far = a < b ? b : a;
        first = near > first ? near : first;
        last = far < last ? far : last;
    }
    return first <= last;
}

static shading_ray ray_from(const double P[3], vec3 d, double far_m)
{
    float size = (float)fmax(fabs(P[0]), fmax(fabs(P[1]), fabs(P[2])));
    shading_ray ray = {
        .near_t = 1e-4f + 4e-7f * size, .far_t = (float)fmin(far_m, farthest), .spread = &no_spread};
    for (int i = 0; i < 3; i++) {
        ray.origin[i] = (float)P[i];
        ray.direction[i] = d[i];
    }
    return ray;
}

/* Completes a hit. length: m per unit of t. */
static void locate(double length, model_hit *hit)
{
    hit->distance_m = (double)hit->hit.t * length;
    hit->P = load3(hit->ray.origin) + load3(hit->ray.direction) * hit->hit.t;
}

bool water_model_find(const water_model *m, const double P[3], vec3 d, double far_m, uint32_t random,
                      model_hit *hit)
{
    if (!may_meet(m, P, d, far_m))
        return false;
    hit->ray = ray_from(P, d, far_m);
    if (!ray_trace_nearest(&m->rays->setup.shading, &hit->ray, random, &hit->hit))
        return false;
    locate(1.0, hit);
    return true;
}

/* In [0, 1). */
static float uniform(uint32_t random)
{
    return (float)(random >> 8) * (1.0f / 16777216.0f);
}

/* Through (x, y) of the image, to far_m; *scale: m per unit of t. */
static shading_ray camera_ray(const water_model *m, float x, float y, float footprint, double far_m,
                              double *scale)
{
    const shading_scene *s = &m->rays->setup.shading;
    shading_ray ray = shading_ray_of_camera(s->camera, &s->camera_spread, x, y, footprint);
    *scale = (double)length(load3(ray.direction));
    ray.far_t = (float)fmin((double)ray.far_t, far_m / *scale);
    return ray;
}

bool water_model_find_seen(const water_model *m, float x, float y, float footprint, double far_m,
                           uint32_t random, model_hit *hit)
{
    double scale;
    if (!m->is_there)
        return false;
    hit->ray = camera_ray(m, x, y, footprint, far_m, &scale);
    ray_first first = ray_trace_first(&m->rays->setup.shading, &hit->ray, uniform(random));
    if (uniform(hash_uint(random)) >= first.opacity)
        return false;
    hit->hit = first.hit;
    locate(scale, hit);
    return true;
}

bool water_model_describe(const water_model *m, float x, float y, double far_m, shading_description *out,
                          float *depth_m, uint32_t *geometry)
{
    double scale;
    visibility_hit layers[RAY_TRACE_LAYERS + 1];
    if (!m->is_there)
        return false;
    shading_ray ray = camera_ray(m, x, y, 1.0f, far_m, &scale);
    if (ray_trace_layers(&m->rays->setup.shading, &ray, layers) == 0)
        return false;
    const shading_point point = {.hit = &layers[0], .ray = &ray};
    shading_describe(&m->rays->setup.shading, &point, out);
    *depth_m = layers[0].t;
    *geometry = layers[0].geometry;
    return true;
}

float water_model_visibility(const water_model *m, const double P[3], vec3 d, double far_m)
{
    if (!may_meet(m, P, d, far_m))
        return 1.0f;
    shading_ray ray = ray_from(P, d, far_m);
    return ray_trace_transmittance(&m->rays->setup.shading, &ray, NULL);
}

/* The radiance that the exposure turns into OpenGL 1's display value. */
static vec3 displayed_radiance(const water_model *m, const shading_point *point)
{
    shading_result shown;
    shading_shade(&m->rays->setup.shading, point, &shown);
    return ogl1_displayed(&m->rays->ogl1, load3(shown.radiance)) * exp2(-m->desc.exposure_ev);
}

/* Shadow rays start off the surface, on the sun's side. */
vec3 water_model_radiance(const water_model *m, const model_hit *hit, vec3 sun)
{
    const shading_point point = {.hit = &hit->hit, .ray = &hit->ray, .shade_count = 1};
    if (m->rays->setup.shading.ogl1)
        return displayed_radiance(m, &point);
    shading_result lit, shaded;
    vec3 N = normalize(load3(hit->hit.normal));
    N = dot(N, sun) < 0.0f ? -N : N;
    float size = max(max(abs(hit->P[0]), abs(hit->P[1])), abs(hit->P[2]));
    vec3 start = hit->P + N * (1e-4f + 4e-6f * size);
    const double P[3] = {(double)start[0], (double)start[1], (double)start[2]};
    float share = sun[1] > 0.0f ? water_model_visibility(m, P, sun, HUGE_VAL) : 0.0f;
    vec3 L = vec3(0.0f);
    if (share > 0.0f) {
        shading_shade(&m->rays->setup.shading, &point, &lit);
        L = load3(lit.radiance) * share;
    }
    if (share < 1.0f) {
        shading_shade(&m->rays->shaded, &point, &shaded);
        L = L + load3(shaded.radiance) * (1.0f - share);
    }
    return max(L, 0.0f);
}

const struct scene_identity *water_model_identity(const water_model *m, uint32_t geometry)
{
    return &m->rays->setup.identities[geometry];
}

bool water_model_is_dry(const water_model *m, const double P[3])
{
    const float *low = m->bounds_min, *high = m->bounds_max;
    if (!m->is_there || P[0] < (double)low[0] || P[0] > (double)high[0] || P[2] < (double)low[2] ||
        P[2] > (double)high[2])
        return false;
    model_hit hit;
    if (!water_model_find(m, P, vec3(0.0f, -1.0f, 0.0f), farthest, 0, &hit))
        return false;
    for (int i = 0; i < SIDES; i++) {
        float a = 2.0f * PI * ((float)i + 0.37f) / (float)SIDES;
        if (!water_model_find(m, P, vec3(cos(a), 0.0f, sin(a)), farthest, 0, &hit))
            return false;
    }
    return true;
}
