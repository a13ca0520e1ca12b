/* path_lights_fixture.h - for tests: scenes with lights, and their irradiance. Include it last. */
#ifndef PATH_PATH_LIGHTS_FIXTURE_H
#define PATH_PATH_LIGHTS_FIXTURE_H

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#include "tests/support/support.h"
#include "cpu/preview_fixture.h"
#include "cpu/ray_trace.h"

#include "path/path_lights.h"

enum { EFFORT = IS_SLOW ? 10 : 1 }; /* divisor of sample counts */

/* ---- scenes ---- */

/* A fixture's scene, ready for paths. */
typedef struct stage {
    fixture f;
    facet_render_desc desc;
    facet_render_stats stats;
    prepared_scene prepared;
    render_setup setup;
    path_lights *lights;
} stage;

static inline facet_result stage_try(stage *s, const facet_allocator *allocator)
{
    s->desc = s->f.desc;
    s->desc.camera = &s->f.camera;
    s->desc.environment = s->f.environment;
    s->desc.renderer = FACET_RENDERER_KIND_PATH;
    s->desc.crop[2] = s->desc.width;
    s->desc.crop[3] = s->desc.height;
    facet_error error = {0};
    prepared_scene_init(&s->prepared, s->f.scene, NULL);
    s->setup = (render_setup){.prepared = &s->prepared,
                              .desc = &s->desc,
                              .stats = &s->stats,
                              .reads_everywhere = true,
                              .samples_light = true};
    assert_int_equal(render_setup_create(&s->setup, &error), FACET_OK);
    if (allocator)
        s->desc.allocator = *allocator;
    return path_lights_create(&s->setup, &s->lights, &error);
}

static inline void stage_ready(stage *s)
{
    assert_int_equal(stage_try(s, NULL), FACET_OK);
}

static inline void stage_destroy(stage *s)
{
    path_lights_destroy(s->lights);
    render_setup_destroy(&s->setup);
    prepared_scene_clear(&s->prepared);
    fixture_destroy(&s->f);
}

/* Without environment: that of the fixture is white. */
static inline stage stage_create(void)
{
    stage s = {.f = fixture_create()};
    facet_environment_destroy(s.f.environment);
    s.f.environment = NULL;
    return s;
}

/* ---- emitters ---- */

static inline scene_material emitting(float emissive, bool is_double_sided)
{
    scene_material m = scene_material_default();
    m.emissive[0] = m.emissive[1] = m.emissive[2] = 1.0f;
    m.emissive_strength = emissive;
    m.is_double_sided = is_double_sided;
    return m;
}

static inline uint32_t add_emitter(stage *s, float emissive, bool is_double_sided)
{
    return fixture_add_material(&s->f, emitting(emissive, is_double_sided));
}

/* Half a turn around x: the quad faces -Z. */
static inline scene_node *turn_down(scene_node *node)
{
    node->rotation[0] = 1.0f;
    node->rotation[3] = 0.0f;
    return node;
}

static inline scene_light point_light(float intensity, float range)
{
    return (scene_light){
        .name = "", .type = SCENE_LIGHT_POINT, .color = {1, 1, 1}, .intensity = intensity, .range = range};
}

/* ---- random numbers ---- */

static uint64_t random_state = 1;
static inline float random_number(void)
{
    lcg64_next(&random_state);
    return (float)(random_state >> 40) * 0x1p-24f;
}

static inline vec2 random_pair(void)
{
    float x = random_number();
    return vec2(x, random_number());
}

static inline vec3 random_direction(void)
{
    float z = 1.0f - 2.0f * random_number();
    float r = sqrt(max(1.0f - z * z, 0.0f));
    float phi = 2.0f * PI * random_number();
    return vec3(r * cos(phi), r * sin(phi), z);
}

/* Mean and its standard error. */
typedef struct estimate {
    double mean, error;
} estimate;

static inline estimate estimate_of(double sum, double sum_of_squares, int count)
{
    double mean = sum / count;
    return (estimate){mean, sqrt(fmax(sum_of_squares / count - mean * mean, 0.0) / count)};
}

/* path_lights.h's functions at a point that is seen once. */

static inline bool sample_light(const path_lights *lights, vec3 P, vec3 N, float u_light, vec2 u,
                                path_light_sample *out)
{
    path_lights_view view;
    path_lights_see(lights, P, N, &view);
    return path_lights_sample(lights, &view, u_light, u, out);
}

static inline float infinite_pdf(const path_lights *lights, vec3 P, vec3 N, vec3 d)
{
    path_lights_view view;
    path_lights_see(lights, P, N, &view);
    return path_lights_infinite_pdf(lights, &view, d);
}

static inline float emitter_pdf(const path_lights *lights, vec3 P, vec3 N, const visibility_hit *hit, vec3 d,
                                float distance_m)
{
    path_lights_view view;
    path_lights_see(lights, P, N, &view);
    return path_lights_emitter_pdf(lights, &view, hit, d, distance_m);
}

/* Irradiance (first channel) at P on a surface with normal N, nothing in between. */
static inline estimate irradiance_at(const stage *s, vec3 P, vec3 N, int count)
{
    double sum = 0.0;
    double sum2 = 0.0;
    for (int i = 0; i < count; i++) {
        path_light_sample l;
        float u = random_number();
        if (!sample_light(s->lights, P, N, u, random_pair(), &l))
            continue;
        double x = (double)(l.radiance[0] * max(dot(l.L, N), 0.0f) / l.pdf);
        sum += x;
        sum2 += x * x;
    }
    return estimate_of(sum, sum2, count);
}

/* A surface that a ray hits, with its emission as a path counts it. */
typedef struct encounter {
    bool is_hit;
    visibility_hit hit;
    vec3 radiance;
    float opacity;
} encounter;

static inline encounter trace_to(const stage *s, vec3 P, vec3 d)
{
    static const ray_spread none = {.moves = false};
    encounter m = {.radiance = vec3(0.0f)};
    shading_ray ray = {.near_t = 1e-5f, .far_t = INFINITY, .spread = &none};
    for (int i = 0; i < 3; i++) {
        ray.origin[i] = P[i];
        ray.direction[i] = d[i];
    }
    uint32_t random = (uint32_t)(random_number() * 4294967040.0f);
    m.is_hit = ray_trace_nearest(&s->setup.shading, &ray, random, &m.hit);
    if (!m.is_hit || !ray_trace_is_visible_side(&s->setup.shading, &m.hit, ray.direction))
        return m;
    surface_point point;
    surface_point_make(&s->setup.shading, &(shading_point){.hit = &m.hit, .ray = &ray, .shade_count = 1},
                       &point);
    m.radiance = layers_emission(point.m, point.V);
    m.opacity = surface_opacity(point.hit.geometry->material, point.base_color[3]);
    return m;
}

/* Both strategies, weighted by the power heuristic, in a scene without occlusion. */
static inline estimate irradiance_by_both(const stage *s, vec3 P, vec3 N, int count)
{
    double sum = 0.0;
    double sum2 = 0.0;
    mat3 frame = basis_from_normal(N);
    for (int i = 0; i < count; i++) {
        double x = 0.0;
        path_light_sample l;
        float u = random_number();
        if (sample_light(s->lights, P, N, u, random_pair(), &l) && dot(l.L, N) > 0.0f) {
            double p = (double)l.pdf;
            double other = l.is_delta ? 0.0 : (double)(dot(l.L, N) * INV_PI);
            x += (double)(l.radiance[0] * dot(l.L, N)) * p / (p * p + other * other);
        }
        vec3 d = mul(frame, sample_cosine(random_pair()));
        double own = (double)(dot(d, N) * INV_PI);
        encounter m = trace_to(s, P, d);
        vec3 radiance = m.is_hit ? m.radiance : path_lights_infinite(s->lights, d);
        double other = (double)(m.is_hit ? emitter_pdf(s->lights, P, N, &m.hit, d, m.hit.t)
                                         : infinite_pdf(s->lights, P, N, d));
        if (own > 0.0)
            x += (double)(radiance[0] * dot(d, N)) * own / (own * own + other * other);
        sum += x;
        sum2 += x * x;
    }
    return estimate_of(sum, sum2, count);
}

static inline void assert_estimate(estimate e, double expected)
{
    double allowed = 4.0 * e.error + 1e-5 * fabs(expected);
    if (!(fabs(e.mean - expected) <= allowed))
        fail_msg("%.9g, expected %.9g within %.3g", e.mean, expected, allowed);
}

#endif
