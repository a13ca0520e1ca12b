/* Tests of path_lights.h: irradiance of lights against closed forms; limits. Emissive surfaces:
 * path_emitters_test.c. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#include "tests/support/support.h"
#include "ibl/environment.h"

#include "path/path_lights_fixture.h"

static const double pi = 3.14159265358979323846;

/* ---- closed forms ---- */

static const double QUAD_ABOVE = 0.752274688454; /* E / L of the quad [-1, 1]^2 2 m above */

static void quad_lights_have_the_exact_irradiance(void **state)
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
        assert_estimate(irradiance_at(&s, vec3(0.0f), up, 200000 / EFFORT), 5.0 * expected[i]);
        assert_estimate(irradiance_by_both(&s, vec3(0.0f), up, 100000 / EFFORT), 5.0 * expected[i]);
        /* Behind the light there is nothing to sample. */
        path_light_sample l;
        for (int k = 0; k < 100; k++) {
            float u = random_number();
            assert_true(
                !sample_light(s.lights, vec3(shifts[i], 0.0f, 2.5f), vec3(0.0f), u, random_pair(), &l));
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
        assert_true(sample_light(s.lights, vec3(0.0f), vec3(0.0f), u, random_pair(), &l));
        assert_true(l.is_infinite && !l.is_delta && l.distance_m == INFINITY &&
                    l.geometry == VISIBILITY_NONE);
        assert_true(fabsf(l.radiance[1] / l.pdf / (4.0f * PI) - 1.0f) < 2e-6f);
    }
    assert_estimate(irradiance_at(&s, vec3(0.0f), normalize(vec3(0.3f, -0.2f, 0.9f)), 100000 / EFFORT), pi);
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
        assert_estimate(irradiance_at(&s, vec3(0.0f), to_sun, 20000 / EFFORT), 1000.0);
        vec3 N = normalize(to_sun + vec3(0.0f, 1.0f, 0.0f));
        assert_estimate(irradiance_at(&s, vec3(0.0f), N, 100000 / EFFORT), 1000.0 * (double)dot(N, to_sun));
        double angle = diameters[i] > 0.0f ? fmax(0.5 * (double)diameters[i], 5e-5) : 0.265 * pi / 180.0;
        vec3 tangent = normalize(cross(to_sun, vec3(1.0f, 0.0f, 0.0f)));
        for (int k = 0; k < 2; k++) {
            double turn = angle * (k ? 1.001 : 0.999);
            vec3 d = to_sun * (float)cos(turn) + tangent * (float)sin(turn);
            assert_true((path_lights_infinite(s.lights, d)[0] > 0.0f) == (k == 0));
            assert_true((infinite_pdf(s.lights, vec3(0.0f), vec3(0.0f), d) > 0.0f) == (k == 0));
        }
        stage_destroy(&s);
    }
}

/* 100 cd at 2 m, cosine .8: 20 lx; with a range of 5 m times 1 - (2/5)^4: 19.488. */
static void punctual_lights_have_the_exact_illuminance(void **state)
{
    (void)state;
    for (int i = 0; i < 3; i++) {
        stage s = stage_create();
        fixture_add_light(&s.f, point_light(100.0f, i == 0 ? 0.0f : i == 1 ? 5.0f : 1.5f), 1.2f, 0.0f, 1.6f);
        stage_ready(&s);
        vec3 up = vec3(0.0f, 0.0f, 1.0f);
        path_light_sample l;
        bool reaches = sample_light(s.lights, vec3(0.0f), up, 0.3f, vec2(0.2f, 0.7f), &l);
        assert_true(reaches == (i < 2));
        if (reaches) {
            assert_true(l.is_delta && l.pdf == 1.0f && fabsf(l.distance_m - 2.0f) < 1e-6f);
            assert_true(fabsf(l.radiance[0] * dot(l.L, up) - (i == 0 ? 20.0f : 19.488f)) < 1e-4f);
        }
        stage_destroy(&s);
    }
}

/* Inner 20 deg, outer 40 deg, at 30 deg: 0.331508104841 of the intensity; nothing outside, of any kind of
 * choice. */
static void spots_emit_in_their_cone(void **state)
{
    (void)state;
    stage s = stage_create();
    scene_light spot = point_light(10.0f, 0.0f);
    spot.type = SCENE_LIGHT_SPOT;
    spot.inner_cone_rad = 0.349065850399f;
    spot.outer_cone_rad = 0.698131700798f;
    fixture_add_light(&s.f, spot, 0.0f, 0.0f, 1.0f); /* emits along -Z */
    fixture_add_light(&s.f, spot, 100.0f, 0.0f, 1.0f);
    stage_ready(&s);
    path_light_sample l;
    vec3 P = vec3(tanf(0.523598775598f), 0.0f, 0.0f);
    assert_true(sample_light(s.lights, P, vec3(0.0f, 0.0f, 1.0f), 0.9f, vec2(0.5f), &l));
    assert_true(l.pdf > 0.999f); /* the other one is 100 m away, beyond its cone */
    assert_true(fabsf(l.radiance[0] * l.distance_m * l.distance_m - 3.31508104841f) < 1e-3f);
    assert_true(!sample_light(s.lights, vec3(0.0f, 0.0f, 3.0f), vec3(0.0f), 0.9f, vec2(0.5f), &l));
    stage_destroy(&s);
}

/* Everything at once adds up: sky 2, sun 3 at 60 deg, a directional light of 1.5 at 60 deg, 100 cd at 2 m
 * and .8, a quad. */
static void kinds_of_light_add_up(void **state)
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
    double expected = 4.0 * pi + 3.0 * cos(pi / 6.0) + 1.5 + 20.0;
    assert_estimate(irradiance_at(&s, vec3(0.0f), up, 300000 / EFFORT), expected);
    assert_estimate(irradiance_by_both(&s, vec3(0.0f), up, 100000 / EFFORT), expected);

    /* The pdf of environment and sun integrates to the probability of sampling them. */
    int infinite_count = 0;
    enum { SAMPLES = 200000 / EFFORT, SIDE = 1500 };
    for (int i = 0; i < SAMPLES; i++) {
        path_light_sample l;
        float u = random_number();
        infinite_count += sample_light(s.lights, vec3(0.0f), up, u, random_pair(), &l) && l.is_infinite;
    }
    double integral = 0.0;
    for (int i = 0; i < SIDE * SIDE; i++) {
        float z = 1.0f - 2.0f * ((float)(i / SIDE) + random_number()) / (float)SIDE;
        float phi = 2.0f * PI * ((float)(i % SIDE) + random_number()) / (float)SIDE;
        float r = sqrt(max(1.0f - z * z, 0.0f));
        integral += (double)infinite_pdf(s.lights, vec3(0.0f), up, vec3(r * cos(phi), r * sin(phi), z));
    }
    integral *= 4.0 * pi / ((double)SIDE * SIDE);
    double share = (double)infinite_count / SAMPLES;
    double error = sqrt(share * (1.0 - share) / SAMPLES);
    /* the sun has 12 of the points */
    if (fabs(integral - share) > 4.0 * error + 0.03)
        fail_msg("density of the environment: %.4f, share of samples: %.4f", integral, share);
    stage_destroy(&s);
}

/* ---- limits ---- */

static void failed_allocations_leak_nothing(void **state)
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

/* For any values in vertices, materials, textures and lights the samples are finite. */
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
            if (!sample_light(s.lights, P, N, u,
                              i < 4 ? vec2(0x1.fffffep-1f * (float)(i % 2)) : random_pair(), &l))
                continue;
            assert_true(l.pdf > 0.0f && isfinite(l.pdf));
            assert_true(fabsf(dot(l.L, l.L) - 1.0f) < 1e-4f);
            for (int c = 0; c < 3; c++)
                assert_true(l.radiance[c] >= 0.0f && isfinite(l.radiance[c]));
            float pdf = infinite_pdf(s.lights, P, N, l.L);
            assert_true(pdf >= 0.0f && isfinite(pdf));
            vec3 radiance = path_lights_infinite(s.lights, l.L);
            assert_true(isfinite(radiance[0] + radiance[1] + radiance[2]));
        }
        stage_destroy(&s);
    }
    assert_true(ignored > 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(quad_lights_have_the_exact_irradiance),
        cmocka_unit_test(a_constant_sky_gives_pi),
        cmocka_unit_test(the_sun_gives_its_illuminance),
        cmocka_unit_test(punctual_lights_have_the_exact_illuminance),
        cmocka_unit_test(spots_emit_in_their_cone),
        cmocka_unit_test(kinds_of_light_add_up),
        cmocka_unit_test(failed_allocations_leak_nothing),
        cmocka_unit_test(odd_input_does_no_harm),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
