/* Tests of path_lights.h: every way to aim at a light against its density, against what is met, and against closed forms. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <string.h>
#include <time.h>

#include <cmocka.h>

#include "base/test_effort.h"
#include "base/failing_allocator.h"
#include "base/memory.h"
#include "cpu/preview_fixture.h"
#include "cpu/ray_trace.h"
#include "ibl/environment.h"

#include "path/path_lights.h"

enum { EFFORT = IS_SLOW ? 10 : 1 }; /* what numbers of samples are divided by */

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

static facet_result stage_try(stage *s, const facet_allocator *allocator)
{
    s->desc = s->f.desc;
    s->desc.camera = &s->f.camera;
    s->desc.environment = s->f.environment;
    s->desc.integrator = FACET_INTEGRATOR_PATH;
    s->desc.crop[2] = s->desc.width;
    s->desc.crop[3] = s->desc.height;
    facet_error error = {0};
    prepared_scene_init(&s->prepared, s->f.scene, NULL);
    s->setup = (render_setup){
        .prepared = &s->prepared, .desc = &s->desc, .stats = &s->stats, .reads_everywhere = true};
    assert_int_equal(render_setup_create(&s->setup, &error), FACET_OK);
    if (allocator)
        s->desc.allocator = *allocator;
    return path_lights_create(&s->setup, &s->lights, &error);
}

static void stage_ready(stage *s)
{
    assert_int_equal(stage_try(s, NULL), FACET_OK);
}

static void stage_destroy(stage *s)
{
    path_lights_destroy(s->lights);
    render_setup_destroy(&s->setup);
    prepared_scene_clear(&s->prepared);
    fixture_destroy(&s->f);
}

/* Without environment: that of the fixture is white. */
static stage stage_create(void)
{
    stage s = {.f = fixture_create()};
    facet_environment_destroy(s.f.environment);
    s.f.environment = NULL;
    return s;
}

/* ---- numbers ---- */

static uint64_t random_state = 1;
static float random_number(void)
{
    random_state = random_state * 6364136223846793005u + 1442695040888963407u;
    return (float)(random_state >> 40) * 0x1p-24f;
}

static vec2 random_pair(void)
{
    float x = random_number();
    return vec2(x, random_number());
}

/* Mean and its standard error. */
typedef struct estimate {
    double mean, error;
} estimate;

/* Irradiance (first channel) at P on a surface with normal N, nothing in between. */
static estimate irradiance_at(const stage *s, vec3 P, vec3 N, int count)
{
    double sum = 0.0;
    double sum2 = 0.0;
    for (int i = 0; i < count; i++) {
        path_light_sample l;
        float u = random_number();
        if (!path_lights_sample(s->lights, P, N, u, random_pair(), &l))
            continue;
        double x = (double)(l.radiance[0] * max(dot(l.L, N), 0.0f) / l.pdf);
        sum += x;
        sum2 += x * x;
    }
    double mean = sum / count;
    return (estimate){mean, (sqrt)(fmax(sum2 / count - mean * mean, 0.0) / count)};
}

static void assert_near(estimate e, double expected)
{
    double allowed = 4.0 * e.error + 1e-5 * fabs(expected);
    if (!(fabs(e.mean - expected) <= allowed))
        fail_msg("%.9g, expected %.9g within %.3g", e.mean, expected, allowed);
}

/* ---- what is met ---- */

static const double pi = 3.14159265358979323846;

static vec3 random_direction(void)
{
    float z = 1.0f - 2.0f * random_number();
    float r = sqrt(max(1.0f - z * z, 0.0f));
    float phi = 2.0f * PI * random_number();
    return vec3(r * cos(phi), r * sin(phi), z);
}

/* A surface that a ray meets, with its emission as a path counts it. */
typedef struct meeting {
    bool is_met;
    visibility_hit hit;
    vec3 radiance;
    float opacity;
} meeting;

static meeting meet(const stage *s, vec3 P, vec3 d)
{
    static const ray_spread none = {.moves = false};
    meeting m = {.radiance = vec3(0.0f)};
    shading_ray ray = {.near_t = 1e-5f, .far_t = INFINITY, .spread = &none};
    for (int i = 0; i < 3; i++) {
        ray.origin[i] = P[i];
        ray.direction[i] = d[i];
    }
    uint32_t random = (uint32_t)(random_number() * 4294967040.0f);
    m.is_met = ray_trace_nearest(&s->setup.shading, &ray, random, &m.hit);
    if (!m.is_met || !shading_is_visible_side(&s->setup.shading, &m.hit, ray.direction))
        return m;
    surface_point point;
    surface_point_make(&s->setup.shading, &(shading_point){.hit = &m.hit, .ray = &ray, .shade_count = 1},
                       &point);
    m.radiance = layers_emission(point.m, point.V);
    m.opacity = surface_opacity(point.hit.geometry->material, point.base_color[3]);
    return m;
}

/* From everywhere around: what is aimed at is what is met there, in place, radiance and density. Returns the share of what
 * was aimed at that was visible. */
static double assert_aimed_is_met(const stage *s, float extent)
{
    enum { TRIALS = IS_SLOW ? 1000 : 4000 };
    int aimed = 0;
    int met = 0;
    for (int i = 0; i < TRIALS; i++) {
        vec3 P = random_direction() * (extent * random_number());
        vec3 N = i % 3 ? random_direction() : vec3(0.0f);
        path_light_sample l;
        float u = random_number();
        if (!path_lights_sample(s->lights, P, N, u, random_pair(), &l) || l.geometry == VISIBILITY_NONE)
            continue;
        assert_true(!l.is_point && !l.is_surroundings && l.pdf > 0.0f && isfinite(l.pdf));
        aimed++;
        meeting m = meet(s, P, l.L);
        if (!m.is_met || m.hit.geometry != l.geometry || m.hit.primitive != l.primitive)
            continue; /* something is in between, or the ray went through an edge */
        met++;
        float pdf = path_lights_emitter_pdf(s->lights, P, N, &m.hit, l.L, m.hit.t);
        float per_cosine = 1.0f / max(abs(dot(normalize(load3(m.hit.normal)), l.L)), 1e-6f); /* rounding */
        assert_true(fabsf(m.hit.t - l.distance_m) < (1e-5f + 1e-6f * per_cosine) * (l.distance_m + 1.0f));
        if (!(fabsf(pdf / l.pdf - 1.0f) < 1e-4f + 1e-5f * per_cosine))
            fail_msg("density %g when aimed at, %g when met", (double)l.pdf, (double)pdf);
        for (int c = 0; c < 3; c++)
            if (!(fabsf(m.radiance[c] * m.opacity - l.radiance[c]) <= 0.01f * max3(m.radiance)))
                fail_msg("radiance %g aimed at, %g met", (double)l.radiance[c],
                         (double)(m.radiance[c] * m.opacity));
    }
    assert_true(aimed > TRIALS / 20);
    return (double)met / aimed;
}

/* Irradiance at P by directions that know nothing of lights. */
static estimate irradiance_by_chance(const stage *s, vec3 P, vec3 N, int count)
{
    double sum = 0.0;
    double sum2 = 0.0;
    mat3 frame = basis_from_normal(N);
    for (int i = 0; i < count; i++) {
        vec3 d = mul(frame, sample_cosine(random_pair()));
        meeting m = meet(s, P, d);
        vec3 radiance = m.is_met ? m.radiance : path_lights_surroundings(s->lights, d);
        double x = pi * (double)radiance[0];
        sum += x;
        sum2 += x * x;
    }
    double mean = sum / count;
    return (estimate){mean, (sqrt)(fmax(sum2 / count - mean * mean, 0.0) / count)};
}

/* The two ways together, by the power heuristic, in a scene where nothing is in between. */
static estimate irradiance_by_both(const stage *s, vec3 P, vec3 N, int count)
{
    double sum = 0.0;
    double sum2 = 0.0;
    mat3 frame = basis_from_normal(N);
    for (int i = 0; i < count; i++) {
        double x = 0.0;
        path_light_sample l;
        float u = random_number();
        if (path_lights_sample(s->lights, P, N, u, random_pair(), &l) && dot(l.L, N) > 0.0f) {
            double p = (double)l.pdf;
            double other = l.is_point ? 0.0 : (double)(dot(l.L, N) * INV_PI);
            x += (double)(l.radiance[0] * dot(l.L, N)) * p / (p * p + other * other);
        }
        vec3 d = mul(frame, sample_cosine(random_pair()));
        double own = (double)(dot(d, N) * INV_PI);
        meeting m = meet(s, P, d);
        vec3 radiance = m.is_met ? m.radiance : path_lights_surroundings(s->lights, d);
        double other = (double)(m.is_met ? path_lights_emitter_pdf(s->lights, P, N, &m.hit, d, m.hit.t)
                                         : path_lights_surroundings_pdf(s->lights, P, N, d));
        if (own > 0.0)
            x += (double)(radiance[0] * dot(d, N)) * own / (own * own + other * other);
        sum += x;
        sum2 += x * x;
    }
    double mean = sum / count;
    return (estimate){mean, (sqrt)(fmax(sum2 / count - mean * mean, 0.0) / count)};
}

static void assert_same(estimate a, estimate b)
{
    double error = (sqrt)(a.error * a.error + b.error * b.error);
    if (!(fabs(a.mean - b.mean) <= 4.0 * error + 1e-4 * fabs(a.mean)))
        fail_msg("%.6g +- %.2g against %.6g +- %.2g", a.mean, a.error, b.mean, b.error);
}

/* All ways to find the light agree. */
static void assert_ways_agree(const stage *s, vec3 P, vec3 N, int count)
{
    estimate chance = irradiance_by_chance(s, P, N, count);
    estimate both = irradiance_by_both(s, P, N, count / 2);
    assert_same(both, chance);
    estimate aimed = irradiance_at(s, P, N, count);
    assert_same(aimed, chance);
    /* never much worse than the better of the two */
    double best = fmin(chance.error, aimed.error);
    assert_true(both.error * (sqrt)(0.5) < 3.1 * best + 1e-6 * chance.mean);
}

/* ---- closed forms: shading-model.md, 16.10 ---- */

static scene_material emitting(float emissive, bool is_double_sided)
{
    scene_material m = scene_material_default();
    m.emissive[0] = m.emissive[1] = m.emissive[2] = 1.0f;
    m.emissive_strength = emissive;
    m.is_double_sided = is_double_sided;
    return m;
}

static uint32_t add_emitter(stage *s, float emissive, bool is_double_sided)
{
    return fixture_add_material(&s->f, emitting(emissive, is_double_sided));
}

/* Half a turn around x: the quad faces -Z. */
static scene_node *turn_down(scene_node *node)
{
    node->rotation[0] = 1.0f;
    node->rotation[3] = 0.0f;
    return node;
}

static const double QUAD_ABOVE = 0.752274688454; /* E / L of the quad [-1, 1]^2 2 m above */

static void a_quad_light_gives_what_it_should(void **state)
{
    (void)state;
    static const float shifts[2] = {0.0f, 2.0f};
    static const double expected[2] = {QUAD_ABOVE, 0.265004852345};
    for (int i = 0; i < 2; i++) {
        stage s = stage_create();
        turn_down(
            fixture_place(&s.f, fixture_add_quad(&s.f, add_emitter(&s, 5.0f, false)), shifts[i], 0, 2, 1.0f));
        stage_ready(&s);
        vec3 up = vec3(0.0f, 0.0f, 1.0f);
        assert_near(irradiance_at(&s, vec3(0.0f), up, 200000 / EFFORT), 5.0 * expected[i]);
        assert_near(irradiance_by_both(&s, vec3(0.0f), up, 100000 / EFFORT), 5.0 * expected[i]);
        /* Behind it there is nothing to aim at. */
        path_light_sample l;
        for (int k = 0; k < 100; k++) {
            float u = random_number();
            assert_true(
                !path_lights_sample(s.lights, vec3(shifts[i], 0.0f, 2.5f), vec3(0.0f), u, random_pair(), &l));
        }
        stage_destroy(&s);
    }
}

static void a_constant_sky_gives_pi(void **state)
{
    (void)state;
    stage s = {.f = fixture_create()};
    stage_ready(&s);
    assert_true(path_lights_has_any(s.lights));
    for (int i = 0; i < 1000; i++) {
        path_light_sample l;
        float u = random_number();
        assert_true(path_lights_sample(s.lights, vec3(0.0f), vec3(0.0f), u, random_pair(), &l));
        assert_true(l.is_surroundings && !l.is_point && l.distance_m == INFINITY &&
                    l.geometry == VISIBILITY_NONE);
        assert_true(fabsf(l.radiance[1] / l.pdf / (4.0f * PI) - 1.0f) < 2e-6f);
    }
    assert_near(irradiance_at(&s, vec3(0.0f), normalize(vec3(0.3f, -0.2f, 0.9f)), 100000 / EFFORT), pi);
    stage_destroy(&s);
}

/* The sun: exactly its illuminance on a surface that faces it, times the cosine on others. */
static void the_sun_gives_its_illuminance(void **state)
{
    (void)state;
    static const float diameters[4] = {0.0f, 1e-7f, 0.2f, 2.0f};
    for (int i = 0; i < 4; i++) {
        stage s = stage_create();
        s.f.desc.sun = (facet_sun){.azimuth_rad = 0.7f,
                                   .elevation_rad = 0.5f,
                                   .illuminance_lux = {1000.0f, 900.0f, 800.0f},
                                   .diameter_rad = diameters[i]};
        stage_ready(&s);
        vec3 to_sun = vec3(cosf(0.5f) * sinf(0.7f), sinf(0.5f), cosf(0.5f) * cosf(0.7f));
        assert_near(irradiance_at(&s, vec3(0.0f), to_sun, 20000 / EFFORT), 1000.0);
        vec3 N = normalize(to_sun + vec3(0.0f, 1.0f, 0.0f));
        assert_near(irradiance_at(&s, vec3(0.0f), N, 100000 / EFFORT), 1000.0 * (double)dot(N, to_sun));
        double angle = diameters[i] > 0.0f ? fmax(0.5 * (double)diameters[i], 5e-5) : 0.265 * pi / 180.0;
        vec3 tangent = normalize(cross(to_sun, vec3(1.0f, 0.0f, 0.0f)));
        for (int k = 0; k < 2; k++) {
            double turn = angle * (k ? 1.001 : 0.999);
            vec3 d = to_sun * (float)(cos)(turn) + tangent * (float)(sin)(turn);
            assert_true((path_lights_surroundings(s.lights, d)[0] > 0.0f) == (k == 0));
            assert_true((path_lights_surroundings_pdf(s.lights, vec3(0.0f), vec3(0.0f), d) > 0.0f) ==
                        (k == 0));
        }
        stage_destroy(&s);
    }
}

static scene_light point_light(float intensity, float range)
{
    return (scene_light){
        .name = "", .type = SCENE_LIGHT_POINT, .color = {1, 1, 1}, .intensity = intensity, .range = range};
}

/* 100 cd at 2 m, cosine .8: 20 lx; with a range of 5 m times 1 - (2/5)^4: 19.488. */
static void punctual_lights_give_what_they_should(void **state)
{
    (void)state;
    for (int i = 0; i < 3; i++) {
        stage s = stage_create();
        fixture_add_light(&s.f, point_light(100.0f, i == 0 ? 0.0f : i == 1 ? 5.0f : 1.5f), 1.2f, 0.0f, 1.6f);
        stage_ready(&s);
        vec3 up = vec3(0.0f, 0.0f, 1.0f);
        path_light_sample l;
        bool reaches = path_lights_sample(s.lights, vec3(0.0f), up, 0.3f, vec2(0.2f, 0.7f), &l);
        assert_true(reaches == (i < 2));
        if (reaches) {
            assert_true(l.is_point && l.pdf == 1.0f && fabsf(l.distance_m - 2.0f) < 1e-6f);
            assert_true(fabsf(l.radiance[0] * dot(l.L, up) - (i == 0 ? 20.0f : 19.488f)) < 1e-4f);
        }
        stage_destroy(&s);
    }
}

/* Inner 20 deg, outer 40 deg, at 30 deg: 0.331508104841 of the intensity; nothing outside, of any kind of choice. */
static void spots_shine_in_their_cone(void **state)
{
    (void)state;
    stage s = stage_create();
    scene_light spot = point_light(10.0f, 0.0f);
    spot.type = SCENE_LIGHT_SPOT;
    spot.inner_cone_rad = 0.349065850399f;
    spot.outer_cone_rad = 0.698131700798f;
    fixture_add_light(&s.f, spot, 0.0f, 0.0f, 1.0f); /* shines along -Z */
    fixture_add_light(&s.f, spot, 100.0f, 0.0f, 1.0f);
    stage_ready(&s);
    path_light_sample l;
    vec3 P = vec3(tanf(0.523598775598f), 0.0f, 0.0f);
    assert_true(path_lights_sample(s.lights, P, vec3(0.0f, 0.0f, 1.0f), 0.9f, vec2(0.5f), &l));
    assert_true(l.pdf > 0.999f); /* the other one is 100 m away, beyond its cone */
    assert_true(fabsf(l.radiance[0] * l.distance_m * l.distance_m - 3.31508104841f) < 1e-3f);
    assert_true(!path_lights_sample(s.lights, vec3(0.0f, 0.0f, 3.0f), vec3(0.0f), 0.9f, vec2(0.5f), &l));
    stage_destroy(&s);
}

/* Everything at once adds up: sky 2, sun 3 at 60 deg, a directional light of 1.5 at 60 deg, 100 cd at 2 m and .8, a quad. */
static void kinds_add_up(void **state)
{
    (void)state;
    stage s = {.f = fixture_create()};
    facet_environment_destroy(s.f.environment);
    float radiance[3] = {2.0f, 2.0f, 2.0f};
    assert_int_equal(facet_environment_create_constant(radiance, NULL, &s.f.environment, NULL), FACET_OK);
    s.f.desc.environment_ev = 1.0f; /* 4 in all */
    s.f.desc.sun =
        (facet_sun){.azimuth_rad = 0.0f, .elevation_rad = 0.523598776f, .illuminance_lux = {3, 3, 3}};
    fixture_add_light(&s.f, point_light(100.0f, 0.0f), 1.2f, 0.0f, 1.6f);
    scene_light directional = point_light(1.5f, 0.0f);
    directional.type = SCENE_LIGHT_DIRECTIONAL;
    fixture_add_light(&s.f, directional, 0.0f, 0.0f, 0.0f); /* towards -Z */
    stage_ready(&s);
    vec3 up = vec3(0.0f, 0.0f, 1.0f);
    double expected = 4.0 * pi + 3.0 * (cos)(pi / 6.0) + 1.5 + 20.0;
    assert_near(irradiance_at(&s, vec3(0.0f), up, 300000 / EFFORT), expected);
    assert_near(irradiance_by_both(&s, vec3(0.0f), up, 100000 / EFFORT), expected);

    /* The density of the surroundings integrates to the probability of aiming at them. */
    int aimed = 0;
    enum { SAMPLES = 200000 / EFFORT, SIDE = 1500 };
    for (int i = 0; i < SAMPLES; i++) {
        path_light_sample l;
        float u = random_number();
        aimed += path_lights_sample(s.lights, vec3(0.0f), up, u, random_pair(), &l) && l.is_surroundings;
    }
    double integral = 0.0;
    for (int i = 0; i < SIDE * SIDE; i++) {
        float z = 1.0f - 2.0f * ((float)(i / SIDE) + random_number()) / (float)SIDE;
        float phi = 2.0f * PI * ((float)(i % SIDE) + random_number()) / (float)SIDE;
        float r = sqrt(max(1.0f - z * z, 0.0f));
        integral += (double)path_lights_surroundings_pdf(s.lights, vec3(0.0f), up,
                                                         vec3(r * cos(phi), r * sin(phi), z));
    }
    integral *= 4.0 * pi / ((double)SIDE * SIDE);
    double share = (double)aimed / SAMPLES;
    double error = (sqrt)(share * (1.0 - share) / SAMPLES);
    /* the sun has 12 of the points */
    if (fabs(integral - share) > 4.0 * error + 0.03)
        fail_msg("density of the surroundings: %.4f, aimed at: %.4f", integral, share);
    stage_destroy(&s);
}

/* ---- emitters of every kind ---- */

static uint32_t add_checks(stage *s)
{
    unsigned char texels[16 * 16 * 4];
    for (int i = 0; i < 256; i++) {
        bool is_lit = i % 16 < 5 && i / 16 > 6;
        texels[4 * i] = texels[4 * i + 1] = is_lit ? 255 : 0;
        texels[4 * i + 2] = 0;
        texels[4 * i + 3] = is_lit ? 200 : 90;
    }
    return fixture_add_texture(&s->f, 16, 16, texels);
}

enum { PLAIN, DOUBLE_SIDED, TEXTURED, BLENDED, MASKED, COATED, GLASS, KINDS };

static scene_material material_of_kind(stage *s, int kind)
{
    scene_material m = emitting(3.0f, kind == DOUBLE_SIDED || kind == BLENDED);
    if (kind == TEXTURED)
        m.textures[SCENE_EMISSIVE_TEXTURE].texture = add_checks(s);
    if (kind == BLENDED || kind == MASKED) {
        m.alpha_mode = kind == BLENDED ? SCENE_ALPHA_BLEND : SCENE_ALPHA_MASK;
        m.alpha_cutoff = 0.5f;
        m.base_color[3] = 0.9f;
        m.textures[SCENE_BASE_COLOR_TEXTURE].texture = add_checks(s);
    }
    if (kind == COATED) {
        m.extensions |= SCENE_CLEARCOAT;
        m.clearcoat = 0.8f;
    }
    if (kind == GLASS) {
        m.extensions |= SCENE_TRANSMISSION | SCENE_VOLUME;
        m.transmission = 1.0f;
        m.thickness = 0.1f;
        m.metallic = 0.0f;
    }
    return m;
}

/* Quads and balls, turned, mirrored, stretched, seen from all sides. */
static void what_is_aimed_at_is_met(void **state)
{
    (void)state;
    for (int kind = 0; kind < KINDS; kind++) {
        stage s = stage_create();
        uint32_t material = fixture_add_material(&s.f, material_of_kind(&s, kind));
        uint32_t quad = fixture_add_quad(&s.f, material);
        uint32_t ball = fixture_add_sphere(&s.f, 12, material);
        fixture_place(&s.f, quad, 0.0f, 0.0f, -2.0f, 1.0f);
        turn_down(fixture_place(&s.f, quad, 1.0f, 0.5f, 3.0f, 2.0f))->scale[0] = -1.0f;
        scene_node *node = fixture_place(&s.f, ball, -2.0f, 0.0f, 0.3f, 0.6f);
        node->scale[1] = 0.2f;
        fixture_place(&s.f, ball, 2.0f, 1.0f, -0.5f, 0.4f)->scale[2] = -0.5f;
        stage_ready(&s);
        assert_int_equal(path_lights_ignored(s.lights),
                         4 * 12); /* no area: the balls' triangles at the poles */
        double visible = assert_aimed_is_met(&s, 2.0f);
        assert_true(visible > (kind == BLENDED ? 0.1 : 0.5));
        stage_destroy(&s);
    }
}

/* Light from all ways is the same where it may be in between. */
static void ways_agree_on_emitters(void **state)
{
    (void)state;
    for (int kind = 0; kind < KINDS; kind++) {
        stage s = stage_create();
        uint32_t material = fixture_add_material(&s.f, material_of_kind(&s, kind));
        turn_down(fixture_place(&s.f, fixture_add_quad(&s.f, material), 0.5f, 0.0f, 1.0f, 1.0f))->scale[0] =
            -0.7f;
        fixture_place(&s.f, fixture_add_quad(&s.f, material), -0.2f, 0.3f, -1.5f, 1.0f);
        stage_ready(&s);
        assert_ways_agree(&s, vec3(0.0f), normalize(vec3(0.1f, 0.2f, 0.9f)), 40000);
        assert_ways_agree(&s, vec3(0.9f, 0.2f, 0.9f), normalize(vec3(-0.3f, 0.0f, 0.3f)), 40000);
        assert_ways_agree(&s, vec3(0.1f, 0.2f, -1.4f), vec3(0.0f, 0.0f, -1.0f), 40000);
        stage_destroy(&s);
    }
}

/* What is not lit is met only, and counts fully then. */
static void flat_colors_are_not_aimed_at(void **state)
{
    (void)state;
    stage s = stage_create();
    scene_material m = emitting(3.0f, true);
    m.extensions |= SCENE_UNLIT;
    fixture_place(&s.f, fixture_add_quad(&s.f, fixture_add_material(&s.f, m)), 0.0f, 0.0f, 2.0f, 1.0f);
    static const float point[3] = {0.0f, 0.0f, 0.0f};
    fixture_place(&s.f, fixture_add_sprites(&s.f, SCENE_POINTS, point, 1, add_emitter(&s, 1.0f, true)), 5, 0,
                  0, 1.0f);
    stage_ready(&s);
    assert_true(!path_lights_has_any(s.lights));
    meeting met = meet(&s, vec3(0.0f), vec3(0.0f, 0.0f, 1.0f));
    assert_true(met.is_met);
    assert_true(path_lights_emitter_pdf(s.lights, vec3(0.0f), vec3(0.0f), &met.hit, vec3(0.0f, 0.0f, 1.0f),
                                        2.0f) == 0.0f);
    path_light_sample l;
    assert_true(!path_lights_sample(s.lights, vec3(0.0f), vec3(0.0f), 0.5f, vec2(0.5f), &l));
    stage_destroy(&s);
}

/* A material that does not emit beside one that does: the numbers of triangles are not confused. */
static void only_emitters_are_aimed_at(void **state)
{
    (void)state;
    stage s = stage_create();
    fixture_place(&s.f, fixture_add_quad(&s.f, SCENE_NONE), 0.0f, 0.0f, -2.0f, 1.0f);
    fixture_place(&s.f, fixture_add_quad(&s.f, add_emitter(&s, 2.0f, false)), 0.0f, 0.0f, -1.0f, 1.0f);
    fixture_place(&s.f, fixture_add_sphere(&s.f, 16, SCENE_NONE), 0.0f, 0.0f, 3.0f, 1.0f);
    stage_ready(&s);
    assert_aimed_is_met(&s, 0.5f);
    meeting met = meet(&s, vec3(0.0f), vec3(0.0f, 0.0f, 1.0f));
    assert_true(met.is_met);
    assert_true(path_lights_emitter_pdf(s.lights, vec3(0.0f), vec3(0.0f), &met.hit, vec3(0.0f, 0.0f, 1.0f),
                                        2.0f) == 0.0f);
    stage_destroy(&s);
}

/* ---- many ---- */

/* Irradiance of a triangle of radiance 1 above the horizon; corners relative to P. Lambert: shading-model.md, 6.3. */
static double triangle_irradiance(vec3 a, vec3 b, vec3 c, vec3 N)
{
    vec3 corners[3] = {a, b, c};
    double sum = 0.0;
    for (int i = 0; i < 3; i++) {
        double p[3];
        double q[3];
        double product[3];
        for (int k = 0; k < 3; k++) {
            p[k] = (double)corners[i][k];
            q[k] = (double)corners[(i + 1) % 3][k];
        }
        for (int k = 0; k < 3; k++)
            product[k] = p[(k + 1) % 3] * q[(k + 2) % 3] - p[(k + 2) % 3] * q[(k + 1) % 3];
        double length = (sqrt)(product[0] * product[0] + product[1] * product[1] + product[2] * product[2]);
        double inner = p[0] * q[0] + p[1] * q[1] + p[2] * q[2];
        double height = product[0] * (double)N[0] + product[1] * (double)N[1] + product[2] * (double)N[2];
        sum += atan2(length, inner) * height / length;
    }
    return 0.5 * fabs(sum);
}

/* A ball of 102 080 triangles over a floor: what reaches the floor is the sum over those that face it. */
static void a_hundred_thousand_emitters(void **state)
{
    (void)state;
    stage s = stage_create();
    fixture_place(&s.f, fixture_add_sphere(&s.f, 320, add_emitter(&s, 2.0f, false)), 0.0f, 0.0f, 0.0f, 1.0f);
    stage_ready(&s);
    path_lights_destroy(s.lights);
    clock_t start = clock();
    assert_int_equal(path_lights_create(&s.setup, &s.lights, NULL), FACET_OK);
    double made_s = (double)(clock() - start) / CLOCKS_PER_SEC;
    const render_geometry *g = &s.prepared.geometries.items[0];
    static const float heights[3] = {-1.02f, -1.5f, -5.0f};
    for (int k = 0; k < 3; k++) {
        vec3 P = vec3(0.1f, heights[k], 0.05f);
        vec3 up = vec3(0.0f, 1.0f, 0.0f);
        double expected = 0.0;
        for (uint32_t i = 0; i < g->primitive->index_count / 3; i++) {
            const uint32_t *corners = render_geometry_triangle(g, i);
            vec3 p[3];
            for (int c = 0; c < 3; c++)
                p[c] = load3(g->vertices + 3 * corners[c]) - P;
            vec3 normal = cross(p[1] - p[0], p[2] - p[0]);
            if (dot(normal, p[0]) < 0.0f && p[0][1] > 0.0f && p[1][1] > 0.0f && p[2][1] > 0.0f)
                expected += 2.0 * triangle_irradiance(p[0], p[1], p[2], up);
        }
        enum { SAMPLES = 100000 / EFFORT };
        start = clock();
        estimate found = irradiance_at(&s, P, up, SAMPLES);
        double sampled_s = (double)(clock() - start) / CLOCKS_PER_SEC;
        assert_near(found, expected);
        double deviation = found.error * (sqrt)((double)SAMPLES) / expected;
        print_message("102080 emitters made in %.0f ms, %.0f ns a sample, deviation %.3f\n", made_s * 1e3,
                      sampled_s / SAMPLES * 1e9, deviation);
        assert_true(deviation < (k ? 0.6 : 1.6));
    }
    stage_destroy(&s);
}

/* ---- limits ---- */

static void threads_change_nothing(void **state)
{
    (void)state;
    path_light_sample first[200];
    for (int run = 0; run < 2; run++) {
        stage s = {.f = fixture_create()};
        s.f.desc.thread_count = run ? 7 : 1;
        uint32_t material = fixture_add_material(&s.f, material_of_kind(&s, TEXTURED));
        fixture_place(&s.f, fixture_add_sphere(&s.f, 60, material), 0.0f, 0.0f, -2.0f, 1.0f);
        fixture_add_light(&s.f, point_light(100.0f, 0.0f), 1.2f, 0.0f, 1.6f);
        stage_ready(&s);
        random_state = 5;
        for (int i = 0; i < 200; i++) {
            path_light_sample l;
            memset(&l, 0, sizeof l);
            float u = random_number();
            path_lights_sample(s.lights, vec3(0.0f), vec3(0.0f, 0.0f, 1.0f), u, random_pair(), &l);
            if (!run) {
                first[i] = l;
                continue;
            }
            assert_true(l.pdf == first[i].pdf && l.geometry == first[i].geometry &&
                        l.primitive == first[i].primitive);
            assert_memory_equal(&l.L, &first[i].L, 3 * sizeof(float));
            assert_memory_equal(&l.radiance, &first[i].radiance, 3 * sizeof(float));
        }
        stage_destroy(&s);
    }
}

static void running_out_of_memory_leaks_nothing(void **state)
{
    (void)state;
    bool is_done = false;
    for (int fails = 1; !is_done; fails++) {
        stage s = {.f = fixture_create()};
        fixture_place(&s.f, fixture_add_sphere(&s.f, 40, add_emitter(&s, 1.0f, false)), 0.0f, 0.0f, -2.0f,
                      1.0f);
        fixture_add_light(&s.f, point_light(100.0f, 0.0f), 1.2f, 0.0f, 1.6f);
        failing_allocator memory = {.fail_at = fails - 1};
        facet_allocator allocator = failing_allocator_get(&memory);
        facet_result result = stage_try(&s, &allocator);
        is_done = result == FACET_OK;
        if (!is_done)
            assert_true(result == FACET_ERROR_MEMORY && !s.lights);
        stage_destroy(&s);
        assert_int_equal(memory.blocks, 0);
        assert_true(fails < 100);
    }
}

static float odd_number(void)
{
    static const float odd[8] = {NAN, INFINITY, -INFINITY, 0.0f, -1.0f, 3e38f, 1e-38f, 1e12f};
    return odd[(int)(random_number() * 8.0f)];
}

/* Whatever is in vertices, materials, textures and lights: what comes out is finite. */
static void odd_input_does_no_harm(void **state)
{
    (void)state;
    uint64_t ignored = 0;
    for (int trial = 0; trial < (IS_SLOW ? 24 : 60); trial++) {
        stage s = {.f = fixture_create()};
        random_state = (uint64_t)trial + 1;
        scene_material m = emitting(2.0f, trial % 2);
        if (trial % 4 == 1)
            m.emissive[trial % 3] = odd_number();
        if (trial % 4 == 2)
            m.emissive_strength = odd_number();
        uint32_t material = fixture_add_material(&s.f, m);
        uint32_t ball = fixture_add_sphere(&s.f, 8, material);
        scene_primitive *p = fixture_primitive(&s.f, ball);
        for (uint32_t i = 0; i < p->vertex_count; i++)
            if (random_number() < 0.1f)
                ((float *)(uintptr_t)p->positions)[3 * i + i % 3] = odd_number();
        scene_node *node = fixture_place(&s.f, ball, 0.0f, 0.0f, -2.0f, 1.0f);
        if (trial % 5 == 3)
            node->scale[0] = 0.0f;
        for (int i = 0; i < 4; i++) {
            scene_light l = point_light(random_number() < 0.5f ? odd_number() : 3.0f,
                                        random_number() < 0.5f ? odd_number() : 0.0f);
            l.type = i % 2 ? SCENE_LIGHT_POINT : i ? SCENE_LIGHT_SPOT : SCENE_LIGHT_DIRECTIONAL;
            l.outer_cone_rad = 0.7f;
            fixture_add_light(&s.f, l, 1.0f, 2.0f, i == 3 ? odd_number() : 1.0f);
        }
        s.f.desc.sun = (facet_sun){.elevation_rad = trial % 7 == 0 ? odd_number() : 0.3f,
                                   .illuminance_lux = {1.0f, trial % 3 == 0 ? odd_number() : 1.0f, 1.0f},
                                   .diameter_rad = trial % 3 == 1 ? odd_number() : 0.0f};
        s.f.desc.environment_ev = trial % 6 == 5 ? 200.0f : 0.0f;
        stage_ready(&s);
        ignored += path_lights_ignored(s.lights);
        for (int i = 0; i < 2000 / EFFORT; i++) {
            path_light_sample l;
            vec3 P = random_direction() * (i % 10 ? 3.0f : 1e10f);
            vec3 N = i % 3 ? random_direction() : vec3(0.0f);
            float u = i < 2 ? 0x1.fffffep-1f * (float)i : random_number();
            if (!path_lights_sample(s.lights, P, N, u,
                                    i < 4 ? vec2(0x1.fffffep-1f * (float)(i % 2)) : random_pair(), &l))
                continue;
            assert_true(l.pdf > 0.0f && isfinite(l.pdf));
            assert_true(fabsf(dot(l.L, l.L) - 1.0f) < 1e-4f);
            for (int c = 0; c < 3; c++)
                assert_true(l.radiance[c] >= 0.0f && isfinite(l.radiance[c]));
            float pdf = path_lights_surroundings_pdf(s.lights, P, N, l.L);
            assert_true(pdf >= 0.0f && isfinite(pdf));
            vec3 seen = path_lights_surroundings(s.lights, l.L);
            assert_true(isfinite(seen[0] + seen[1] + seen[2]));
        }
        stage_destroy(&s);
    }
    assert_true(ignored > 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_quad_light_gives_what_it_should),
        cmocka_unit_test(a_constant_sky_gives_pi),
        cmocka_unit_test(the_sun_gives_its_illuminance),
        cmocka_unit_test(punctual_lights_give_what_they_should),
        cmocka_unit_test(spots_shine_in_their_cone),
        cmocka_unit_test(kinds_add_up),
        cmocka_unit_test(what_is_aimed_at_is_met),
        cmocka_unit_test(ways_agree_on_emitters),
        cmocka_unit_test(flat_colors_are_not_aimed_at),
        cmocka_unit_test(only_emitters_are_aimed_at),
        cmocka_unit_test(a_hundred_thousand_emitters),
        cmocka_unit_test(threads_change_nothing),
        cmocka_unit_test(running_out_of_memory_leaks_nothing),
        cmocka_unit_test(odd_input_does_no_harm),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
