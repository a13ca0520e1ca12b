/* Tests of path_lights.h: every way to aim at a light against its density, against what is met, and against closed forms. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#include "base/memory.h"
#include "cpu/preview_fixture.h"
#include "ibl/environment.h"

#include "path/path_lights.h"

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

/* ---- closed forms: shading-model.md, 16.10 ---- */

static uint32_t add_emitter(stage *s, float emissive, bool is_double_sided)
{
    scene_material m = scene_material_default();
    m.emissive[0] = m.emissive[1] = m.emissive[2] = 1.0f;
    m.emissive_strength = emissive;
    m.is_double_sided = is_double_sided;
    return fixture_add_material(&s->f, m);
}

/* Half a turn around x: the quad faces -Z. */
static void turn_down(scene_node *node)
{
    node->rotation[0] = 1.0f;
    node->rotation[3] = 0.0f;
}

static void a_quad_light_gives_what_it_should(void **state)
{
    (void)state;
    static const float shifts[2] = {0.0f, 2.0f};
    static const double expected[2] = {0.752274688454, 0.265004852345};
    for (int i = 0; i < 2; i++) {
        stage s = stage_create();
        turn_down(
            fixture_place(&s.f, fixture_add_quad(&s.f, add_emitter(&s, 5.0f, false)), shifts[i], 0, 2, 1.0f));
        stage_ready(&s);
        assert_near(irradiance_at(&s, vec3(0.0f), vec3(0.0f, 0.0f, 1.0f), 200000), 5.0 * expected[i]);
        stage_destroy(&s);
    }
}

static void a_constant_sky_gives_pi(void **state)
{
    (void)state;
    stage s = {.f = fixture_create()};
    stage_ready(&s);
    for (int i = 0; i < 1000; i++) {
        path_light_sample l;
        float u = random_number();
        assert_true(path_lights_sample(s.lights, vec3(0.0f), vec3(0.0f), u, random_pair(), &l));
        assert_true(fabsf(l.radiance[1] / l.pdf / (4.0f * PI) - 1.0f) < 2e-6f);
    }
    assert_near(irradiance_at(&s, vec3(0.0f), normalize(vec3(0.3f, -0.2f, 0.9f)), 100000), 3.14159265358979);
    stage_destroy(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_quad_light_gives_what_it_should),
        cmocka_unit_test(a_constant_sky_gives_pi),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
