/* area_light_test.c - sphere and line irradiance, and the representative point against the exact integral. */
#include "testing/test_support.h"

static const vec3 up = {0.0f, 0.0f, 1.0f};
static const double pi = 3.14159265358979323846;

static void test_sphere_irradiance(void **state)
{
    (void)state;
    const double at[][2] = {
        {0, 0.196349540849}, {60, 0.0981747704}, {80, 0.0347227199}, {90, 0.0106187960}, {100, 0.0006269799}};
    for (size_t i = 0; i < COUNT_OF(at); ++i)
        expect_near((double)sphere_irradiance((float)cos(at[i][0] * pi / 180.0), 0.25f), at[i][1], 2e-6,
                    "%g degrees", at[i][0]);
    assert_true(sphere_irradiance(-0.5f, 0.25f) == 0.0f && sphere_irradiance(-1.0f, 0.9f) == 0.0f);
    /* continuous and decreasing through the horizon, and pi for a hemisphere of light */
    for (float a = 0.05f; a < 1.0f; a += 0.1f)
        for (float c = 1.0f; c > -1.0f; c -= 0.001f) {
            float here = sphere_irradiance(c, a), next = sphere_irradiance(c - 0.001f, a);
            assert_true(here - next >= -1e-5f && here - next < 0.01f);
        }
    expect_near((double)sphere_irradiance(1.0f, 0.99999f), pi, 1e-3, "hemisphere");
    /* against a Monte Carlo sum over the sphere's cone, half below the horizon */
    test_rng rng = {9};
    const int n = 400000;
    double sum = 0.0;
    vec3 axis = normalize(vec3(0.9f, 0.0f, 0.1f));
    mat3 frame = basis_from_normal(axis);
    float cos_max = sqrt(1.0f - 0.6f * 0.6f);
    for (int i = 0; i < n; ++i) {
        vec2 u = rng_vec2(&rng);
        float z = 1.0f - u[0] * (1.0f - cos_max), s = sqrt(1.0f - z * z);
        vec3 d = mul(frame, vec3(s * cos(2.0f * PI * u[1]), s * sin(2.0f * PI * u[1]), z));
        sum += d[2] > 0.0f ? (double)d[2] : 0.0;
    }
    double solid_angle = 2.0 * pi * (1.0 - (double)cos_max);
    expect_near((double)sphere_irradiance(axis[2], 0.6f), sum / n * solid_angle, 3e-3, "Monte Carlo");
}

static void test_line_irradiance(void **state)
{
    (void)state;
    expect_relative(line_irradiance(up, vec3(-1.0f, 0.5f, 1.0f), vec3(2.0f, 0.2f, 1.5f)), 0.3761936448, 2e-6,
                    "line");
    /* a short line far away is a point of its length */
    expect_relative(line_irradiance(up, vec3(0.0f, 0.0f, 10.0f), vec3(0.001f, 0.0f, 10.0f)), 0.01, 1e-3,
                    "far");
}

/* Radiance 1, F = 1, V at 45 degrees, center in the mirror direction or 10 degrees farther
 * from the normal; integral by quadrature, and Karis' approximation with alpha + a / 3d and alpha + a / 2d in the
 * normalisation. */
static const double highlight[][6] = {{0, 0.05, 0.20, 0.351061787793, 0.275037888, 0.209036028},
                                      {0, 0.05, 0.35, 0.055116407781, 0.045299166, 0.040325208},
                                      {0, 0.05, 0.50, 0.013536935316, 0.012058494, 0.011338749},
                                      {0, 0.05, 0.80, 0.001815600994, 0.001726462, 0.001683464},
                                      {0, 0.10, 0.20, 0.680395207727, 0.656908674, 0.436136897},
                                      {0, 0.10, 0.35, 0.188435821872, 0.144510674, 0.117934929},
                                      {0, 0.10, 0.50, 0.052070581279, 0.042726291, 0.038110797},
                                      {0, 0.10, 0.80, 0.007239042064, 0.006568207, 0.006254734},
                                      {0, 0.30, 0.20, 0.951270263517, 1.622162235, 0.880730743},
                                      {0, 0.30, 0.35, 0.677271654422, 0.637974216, 0.425334043},
                                      {0, 0.30, 0.50, 0.334122248538, 0.251997921, 0.192935908},
                                      {0, 0.30, 0.80, 0.062958237215, 0.048942498, 0.042943297},
                                      {10, 0.05, 0.20, 0.017831623845, 0.023364627, 0.017757731},
                                      {10, 0.05, 0.35, 0.025535206602, 0.028660932, 0.025513892},
                                      {10, 0.05, 0.50, 0.010782683076, 0.010661955, 0.010025567},
                                      {10, 0.05, 0.80, 0.001659085149, 0.001632736, 0.001592071},
                                      {10, 0.10, 0.20, 0.088280008404, 0.188066091, 0.124861438},
                                      {10, 0.10, 0.35, 0.097695321510, 0.121165509, 0.098882977},
                                      {10, 0.10, 0.50, 0.041869638001, 0.040787464, 0.036381410},
                                      {10, 0.10, 0.80, 0.006610950102, 0.006383783, 0.006079112},
                                      {10, 0.30, 0.20, 0.894402850363, 1.622162235, 0.880730743},
                                      {10, 0.30, 0.35, 0.566596234841, 0.637974216, 0.425334043},
                                      {10, 0.30, 0.50, 0.288876222802, 0.251997921, 0.192935908},
                                      {10, 0.30, 0.80, 0.057105157352, 0.048942498, 0.042943297}};

static void test_representative_point(void **state)
{
    (void)state;
    for (size_t i = 0; i < COUNT_OF(highlight); ++i) {
        double offset = highlight[i][0];
        float a = (float)highlight[i][1], r = (float)highlight[i][2], alpha = r * r;
        vec3 V = normalize(vec3(-1.0f, 0.0f, 1.0f));
        double angle = (45.0 + offset) * pi / 180.0;
        vec3 center = vec3((float)sin(angle), 0.0f, (float)cos(angle)) * 2.0f; /* d = 2 m */
        Surface s = surface_from_metallic_roughness(up, vec3(1.0f), 1.0f, r);  /* F = 1 */
        RepresentativePoint p = representative_point_sphere(center, reflect(-V, up), 2.0f * a, alpha);
        double E = pi * highlight[i][1] * highlight[i][1];
        double lobe = (double)surface_lobes_cos(s, V, p.L, ENERGY_GLTF, vec2(0.0f)).specular[0];
        double karis = lobe * E * (double)p.normalisation;
        expect_relative(karis, highlight[i][4], 2e-5, "Karis, offset %g, a/d %g, r %g", offset,
                        highlight[i][1], highlight[i][2]);
        double ratio = (double)(alpha / widened_alpha(alpha, 2.0f * a, 2.0f, 2.0f));
        expect_relative(lobe * E * ratio * ratio, highlight[i][5], 2e-5, "with a / 2d");
        /* its error: at most 2.2 times, within 30 % while the light is narrower than the lobe */
        assert_true(karis < 2.2 * highlight[i][3] && karis > 0.7 * highlight[i][3]);
        if (a < alpha && offset == 0.0)
            expect_relative(karis, highlight[i][3], 0.3, "against the exact integral");

        /* shade_sphere() equals it for a metal: intensity = radiance pi a^2 */
        vec3 radiance = shade_sphere(s, vec3(0.0f), V, center, 2.0f * a, vec3((float)(pi * 4.0) * a * a),
                                     ENERGY_GLTF, vec2(0.0f));
        expect_relative(radiance[0], highlight[i][4], 3e-5, "shade_sphere");
    }
}

/* For a radius of 0 every form is the point light. */
static void test_point_limit(void **state)
{
    (void)state;
    test_rng rng = {17};
    for (int i = 0; i < 2000; ++i) {
        Surface s = surface_from_metallic_roughness(up, rng_color(&rng), rng_float(&rng),
                                                    0.2f + 0.8f * rng_float(&rng));
        vec3 V = rng_direction(&rng), center = rng_direction(&rng) * 3.0f, I = vec3(5.0f, 1.0f, 2.0f);
        V[2] = fabsf(V[2]) + 0.01f;
        V = normalize(V);
        vec2 dfg = vec2(0.7f, 0.1f);
        for (int energy = ENERGY_CONSERVING; energy <= ENERGY_GLTF; ++energy) {
            vec3 point = shade_punctual(s, vec3(0.0f), V, light_point(center, I, 0.0f), energy, dfg);
            vec3 small = shade_sphere(s, vec3(0.0f), V, center, 1e-5f, I, energy, dfg);
            vec3 wide = shade_sphere_widened(s, vec3(0.0f), V, center, 1e-6f, I, energy, dfg);
            for (int k = 0; k < 3; ++k) {
                expect_near((double)small[k], (double)point[k], 2e-3 * (double)point[k] + 2e-4, "sphere");
                expect_near((double)wide[k], (double)point[k], 1e-3 * (double)point[k] + 1e-5,
                            "widened lobe");
            }
        }
    }
}

static void test_tube(void **state)
{
    (void)state;
    vec3 R = normalize(vec3(0.1f, 0.2f, 1.0f));
    vec3 end0 = vec3(-1.0f, 0.5f, 2.0f), end1 = vec3(2.0f, 0.3f, 2.5f);
    RepresentativePoint p = representative_point_tube(end0, end1, R, 0.05f, 0.2f);
    /* no other point of the capsule is closer to the ray */
    float best = dot(p.L, R);
    for (float t = 0.0f; t <= 1.0f; t += 0.01f) {
        RepresentativePoint q = representative_point_sphere(end0 + (end1 - end0) * t, R, 0.05f, 0.2f);
        assert_true(dot(q.L, R) <= best + 2e-3f);
    }
    assert_true(p.normalisation > 0.0f && p.normalisation < 1.0f);
    /* without length it is the sphere */
    RepresentativePoint tube = representative_point_tube(end0, end0, R, 0.1f, 0.3f);
    RepresentativePoint sphere = representative_point_sphere(end0, R, 0.1f, 0.3f);
    expect_near((double)dot(tube.L, sphere.L), 1.0, 1e-6, "same point");
    expect_relative(tube.normalisation, sphere.normalisation, 1e-5, "same factor");
    /* a light on the ray is hit at the intersection */
    p = representative_point_sphere(R * 4.0f, R, 0.3f, 0.2f);
    expect_near((double)dot(p.L, R), 1.0, 1e-6, "on the ray");
}

static void test_finite(void **state)
{
    (void)state;
    test_rng rng = {23};
    for (int i = 0; i < 100000; ++i) {
        Surface s = surface_from_metallic_roughness(rng_direction(&rng), rng_color(&rng), rng_float(&rng),
                                                    i % 3 == 0 ? 0.0f : rng_float(&rng));
        vec3 V = rng_direction(&rng), center = rng_direction(&rng) * (3.0f * rng_float(&rng));
        float radius = i % 5 == 0 ? 0.0f : 2.0f * rng_float(&rng);
        vec3 a = shade_sphere(s, vec3(0.0f), V, center, radius, vec3(1.0f), i % 2, vec2(0.8f, 0.1f));
        vec3 b = shade_sphere_widened(s, vec3(0.0f), V, center, radius, vec3(1.0f), i % 2, vec2(0.8f, 0.1f));
        assert_true(is_finite3(a) && is_finite3(b));
        for (int k = 0; k < 3; ++k)
            assert_true(a[k] >= -1e-6f && b[k] >= -1e-6f);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_sphere_irradiance),
                                       cmocka_unit_test(test_line_irradiance),
                                       cmocka_unit_test(test_representative_point),
                                       cmocka_unit_test(test_point_limit),
                                       cmocka_unit_test(test_tube),
                                       cmocka_unit_test(test_finite)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
