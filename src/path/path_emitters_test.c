/* Tests of path_lights.h: emissive surfaces, every kind and very many. Each sampling strategy against its
 * pdf, and against BSDF sampling. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <string.h>
#include <time.h>

#include <cmocka.h>

#include "path/path_lights_fixture.h"

/* ---- BSDF sampling ---- */

static const double pi = 3.14159265358979323846;

/* From points all around, a light sample agrees with a ray that hits its point, in place, radiance and
 * pdf. Returns the visible share of the samples. */
static double assert_light_samples_agree(const stage *s, float extent)
{
    enum { TRIALS = IS_SLOW ? 1000 : 4000 };
    int sampled = 0;
    int hit = 0;
    for (int i = 0; i < TRIALS; i++) {
        vec3 P = random_direction() * (extent * random_number());
        vec3 N = i % 3 ? random_direction() : vec3(0.0f);
        path_light_sample l;
        float u = random_number();
        if (!sample_light(s->lights, P, N, u, random_pair(), &l) || l.geometry == VISIBILITY_NONE)
            continue;
        assert_true(!l.is_delta && !l.is_infinite && l.pdf > 0.0f && isfinite(l.pdf));
        sampled++;
        encounter m = trace_to(s, P, l.L);
        if (!m.is_hit || m.hit.geometry != l.geometry || m.hit.primitive != l.primitive)
            continue; /* something is in between, or the ray went through an edge */
        hit++;
        float pdf = emitter_pdf(s->lights, P, N, &m.hit, l.L, m.hit.t);
        float per_cosine = 1.0f / max(abs(dot(normalize(load3(m.hit.normal)), l.L)), 1e-6f); /* rounding */
        assert_true(fabsf(m.hit.t - l.distance_m) < (1e-5f + 1e-6f * per_cosine) * (l.distance_m + 1.0f));
        if (!(fabsf(pdf / l.pdf - 1.0f) < 1e-4f + 1e-5f * per_cosine))
            fail_msg("density %g light-sampled, %g BSDF-sampled", (double)l.pdf, (double)pdf);
        for (int c = 0; c < 3; c++)
            if (!(fabsf(m.radiance[c] * m.opacity - l.radiance[c]) <= 0.01f * max3(m.radiance)))
                fail_msg("radiance %g light-sampled, %g BSDF-sampled", (double)l.radiance[c],
                         (double)(m.radiance[c] * m.opacity));
    }
    assert_true(sampled > TRIALS / 20);
    return (double)hit / sampled;
}

/* Irradiance at P by directions that do not depend on the lights. */
static estimate irradiance_by_chance(const stage *s, vec3 P, vec3 N, int count)
{
    double sum = 0.0;
    double sum2 = 0.0;
    mat3 frame = basis_from_normal(N);
    for (int i = 0; i < count; i++) {
        vec3 d = mul(frame, sample_cosine(random_pair()));
        encounter m = trace_to(s, P, d);
        vec3 radiance = m.is_hit ? m.radiance : path_lights_infinite(s->lights, d);
        double x = pi * (double)radiance[0];
        sum += x;
        sum2 += x * x;
    }
    return estimate_of(sum, sum2, count);
}

static void assert_same(estimate a, estimate b)
{
    double error = sqrt(a.error * a.error + b.error * b.error);
    if (!(fabs(a.mean - b.mean) <= 4.0 * error + 1e-4 * fabs(a.mean)))
        fail_msg("%.6g +- %.2g against %.6g +- %.2g", a.mean, a.error, b.mean, b.error);
}

/* All strategies agree. */
static void assert_strategies_agree(const stage *s, vec3 P, vec3 N, int count)
{
    estimate chance = irradiance_by_chance(s, P, N, count);
    estimate both = irradiance_by_both(s, P, N, count / 2);
    assert_same(both, chance);
    estimate light_sampled = irradiance_at(s, P, N, count);
    assert_same(light_sampled, chance);
    /* never much worse than the better of the two */
    double best = fmin(chance.error, light_sampled.error);
    assert_true(both.error * sqrt(0.5) < 3.1 * best + 1e-6 * chance.mean);
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
static void light_samples_agree_with_rays(void **state)
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
        double visible = assert_light_samples_agree(&s, 2.0f);
        assert_true(visible > (kind == BLENDED ? 0.1 : 0.5));
        stage_destroy(&s);
    }
}

/* All strategies agree where the light may be occluded. */
static void strategies_agree_on_emitters(void **state)
{
    (void)state;
    for (int kind = 0; kind < KINDS; kind++) {
        stage s = stage_create();
        uint32_t material = fixture_add_material(&s.f, material_of_kind(&s, kind));
        turn_down(fixture_place(&s.f, fixture_add_quad(&s.f, material), 0.5f, 0.0f, 1.0f, 1.0f))->scale[0] =
            -0.7f;
        fixture_place(&s.f, fixture_add_quad(&s.f, material), -0.2f, 0.3f, -1.5f, 1.0f);
        stage_ready(&s);
        assert_strategies_agree(&s, vec3(0.0f), normalize(vec3(0.1f, 0.2f, 0.9f)), 40000);
        assert_strategies_agree(&s, vec3(0.9f, 0.2f, 0.9f), normalize(vec3(-0.3f, 0.0f, 0.3f)), 40000);
        assert_strategies_agree(&s, vec3(0.1f, 0.2f, -1.4f), vec3(0.0f, 0.0f, -1.0f), 40000);
        stage_destroy(&s);
    }
}

/* Unlit surfaces are found by BSDF sampling only, with weight 1. */
static void unlit_surfaces_are_not_light_sampled(void **state)
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
    encounter found = trace_to(&s, vec3(0.0f), vec3(0.0f, 0.0f, 1.0f));
    assert_true(found.is_hit);
    assert_true(emitter_pdf(s.lights, vec3(0.0f), vec3(0.0f), &found.hit, vec3(0.0f, 0.0f, 1.0f), 2.0f) ==
                0.0f);
    path_light_sample l;
    assert_true(!sample_light(s.lights, vec3(0.0f), vec3(0.0f), 0.5f, vec2(0.5f), &l));
    stage_destroy(&s);
}

/* A material that does not emit beside one that does: indices of triangles are not confused. */
static void only_emitters_are_light_sampled(void **state)
{
    (void)state;
    stage s = stage_create();
    fixture_place(&s.f, fixture_add_quad(&s.f, SCENE_NONE), 0.0f, 0.0f, -2.0f, 1.0f);
    fixture_place(&s.f, fixture_add_quad(&s.f, add_emitter(&s, 2.0f, false)), 0.0f, 0.0f, -1.0f, 1.0f);
    fixture_place(&s.f, fixture_add_sphere(&s.f, 16, SCENE_NONE), 0.0f, 0.0f, 3.0f, 1.0f);
    stage_ready(&s);
    assert_light_samples_agree(&s, 0.5f);
    encounter found = trace_to(&s, vec3(0.0f), vec3(0.0f, 0.0f, 1.0f));
    assert_true(found.is_hit);
    assert_true(emitter_pdf(s.lights, vec3(0.0f), vec3(0.0f), &found.hit, vec3(0.0f, 0.0f, 1.0f), 2.0f) ==
                0.0f);
    stage_destroy(&s);
}

/* ---- many ---- */

/* Irradiance of a triangle of radiance 1 above the horizon; corners relative to P: Lambert's
 * formula for polygons. */
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
        double length = sqrt(product[0] * product[0] + product[1] * product[1] + product[2] * product[2]);
        double inner = p[0] * q[0] + p[1] * q[1] + p[2] * q[2];
        double height = product[0] * (double)N[0] + product[1] * (double)N[1] + product[2] * (double)N[2];
        sum += atan2(length, inner) * height / length;
    }
    return 0.5 * fabs(sum);
}

/* A ball of 102 080 triangles over a floor: the irradiance of the floor is the sum over those that face
 * it. */
static void a_hundred_thousand_emitters_are_sampled(void **state)
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
        assert_estimate(found, expected);
        double deviation = found.error * sqrt((double)SAMPLES) / expected;
        print_message("102080 emitters made in %.0f ms, %.0f ns a sample, deviation %.3f\n", made_s * 1e3,
                      sampled_s / SAMPLES * 1e9, deviation);
        assert_true(deviation < (k ? 0.6 : 1.6));
    }
    stage_destroy(&s);
}

static void results_do_not_depend_on_threads(void **state)
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
            sample_light(s.lights, vec3(0.0f), vec3(0.0f, 0.0f, 1.0f), u, random_pair(), &l);
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

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(light_samples_agree_with_rays),
        cmocka_unit_test(strategies_agree_on_emitters),
        cmocka_unit_test(unlit_surfaces_are_not_light_sampled),
        cmocka_unit_test(only_emitters_are_light_sampled),
        cmocka_unit_test(a_hundred_thousand_emitters_are_sampled),
        cmocka_unit_test(results_do_not_depend_on_threads),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
