/* light_test.c - punctual lights: units, falloff, cones, and reflected radiance. */
#include "testing/test_support.h"

static const vec3 up = {0.0f, 0.0f, 1.0f};

static Surface lambert(void) /* white, without an interface */
{
    return surface_from_gltf(up, vec3(1.0f), 0.0f, 1.0f, 1.5f, 0.0f, vec3(1.0f), 1.0f, vec3(0.0f));
}

static void test_attenuation(void **state)
{
    (void)state;
    /* 100 cd at 2 m, N.L .8: 20 lx; with a range of 5 m by each window */
    double lx = 100.0 * 0.8;
    expect_relative(lx * (double)attenuation_range(2.0f, 0.0f), 20.0, 1e-6, "inverse square");
    expect_relative(lx * (double)attenuation_range(2.0f, 5.0f), 19.488, 1e-6, "KHR_lights_punctual");
    expect_relative(lx * (double)attenuation_ue4(2.0f, 5.0f), 15.19128576, 1e-6, "UE4");
    expect_relative(lx * (double)attenuation_filament(2.0f, 5.0f), 18.9891072, 1e-6, "Filament");

    /* nothing at and beyond the range, and no jump there */
    float (*attenuations[3])(float, float) = {attenuation_range, attenuation_ue4, attenuation_filament};
    for (int k = 0; k < 3; ++k) {
        assert_true(attenuations[k](5.0f, 5.0f) == 0.0f && attenuations[k](500.0f, 5.0f) == 0.0f);
        assert_true(attenuations[k](4.9999f, 5.0f) < 1e-4f && attenuations[k](4.9999f, 5.0f) > 0.0f);
        float previous = attenuations[k](0.02f, 5.0f);
        for (float d = 0.03f; d <= 5.0f; d += 0.01f) {
            float a = attenuations[k](d, 5.0f);
            assert_true(a <= previous);
            previous = a;
        }
        assert_true(isfinite(attenuations[k](0.0f, 5.0f)) && isfinite(attenuations[k](0.0f, 0.0f)));
    }
    for (float d = 0.1f; d < 100.0f; d *= 1.7f) /* inverse square: four times at half the distance */
        expect_relative(attenuation_range(0.5f * d, 0.0f), 4.0f * attenuation_range(d, 0.0f), 1e-6,
                        "inverse square");
}

static void test_spot(void **state)
{
    (void)state;
    const float degree = PI / 180.0f;
    vec3 down = vec3(0.0f, 0.0f, -1.0f);
    Light l = light_spot(vec3(0.0f, 0.0f, 1.0f), down, vec3(1.0f), 0.0f, 20.0f * degree, 40.0f * degree);
    expect_relative(spot_cone(cos(30.0f * degree), l.spot_scale, l.spot_offset), 0.331508104841, 3e-6,
                    "30 degrees");
    assert_true(spot_cone(cos(19.9f * degree), l.spot_scale, l.spot_offset) == 1.0f);
    assert_true(spot_cone(cos(40.1f * degree), l.spot_scale, l.spot_offset) == 0.0f);
    for (float a = 0.0f; a < 90.0f; a += 0.1f) /* continuous and falling */
        assert_true(fabsf(spot_cone(cos(a * degree), l.spot_scale, l.spot_offset) -
                          spot_cone(cos((a + 0.1f) * degree), l.spot_scale, l.spot_offset)) < 0.02f);
    /* equal cones: a hard edge, no division by 0 */
    Light hard = light_spot(vec3(0.0f), down, vec3(1.0f), 0.0f, 30.0f * degree, 30.0f * degree);
    assert_true(spot_cone(cos(25.0f * degree), hard.spot_scale, hard.spot_offset) == 1.0f);
    assert_true(spot_cone(cos(31.0f * degree), hard.spot_scale, hard.spot_offset) == 0.0f);
    /* behind the spot it is dark; a point light shines there */
    assert_true(light_illuminate(l, vec3(0.0f, 0.0f, 3.0f)).E[0] == 0.0f);
    assert_true(light_illuminate(light_point(l.position, vec3(1.0f), 0.0f), vec3(0.0f, 0.0f, 3.0f)).E[0] ==
                0.25f);
}

static void test_illuminate(void **state)
{
    (void)state;
    LightSample s =
        light_illuminate(light_point(vec3(3.0f, 0.0f, 4.0f), vec3(100.0f, 50.0f, 25.0f), 0.0f), vec3(0.0f));
    expect_relative(s.distance_m, 5.0, 1e-6, "distance");
    expect_relative(s.L[0], 0.6, 1e-6, "direction");
    expect_relative(s.E[0], 4.0, 1e-6, "lx");
    expect_relative(s.E[2], 1.0, 1e-6, "lx");
    s = light_illuminate(light_directional(vec3(0.0f, 0.0f, -1.0f), vec3(7.0f)), vec3(1e6f, 0.0f, 0.0f));
    assert_true(s.L[2] == 1.0f && s.E[1] == 7.0f && s.distance_m > 1e29f);
    /* at the light itself */
    s = light_illuminate(light_point(vec3(1.0f), vec3(1.0f), 0.0f), vec3(1.0f));
    assert_true(is_finite3(s.L) && is_finite3(s.E));
}

/* 1 lx on a white Lambertian surface gives 1 / pi cd/m^2, in both energy modes. */
static void test_units(void **state)
{
    (void)state;
    vec3 V = normalize(vec3(0.3f, 0.1f, 0.8f));
    Light sun = light_directional(vec3(0.0f, 0.0f, -1.0f), vec3(1.0f));
    for (int energy = ENERGY_CONSERVING; energy <= ENERGY_GLTF; ++energy)
        expect_relative(shade_punctual(lambert(), vec3(0.0f), V, sun, energy, vec2(0.9f, 0.05f))[1],
                        1.0 / 3.14159265358979, 1e-6, "1 lx");
    Light slanted = light_directional(normalize(vec3(0.0f, 0.6f, -0.8f)), vec3(1.0f));
    expect_relative(shade_punctual(lambert(), vec3(0.0f), V, slanted, ENERGY_GLTF, vec2(0.0f))[1],
                    0.8 / 3.14159265358979, 1e-6, "N.L");
    Light below = light_directional(vec3(0.0f, 0.6f, 0.8f), vec3(1.0f));
    assert_true(shade_punctual(lambert(), vec3(0.0f), V, below, ENERGY_GLTF, vec2(0.0f))[1] == 0.0f);
}

/* A perfect mirror shows a delta light as a small bright spot, never as inf. */
static void test_mirror_is_finite(void **state)
{
    (void)state;
    Surface mirror = surface_from_metallic_roughness(up, vec3(1.0f), 1.0f, 0.0f);
    Light sun = light_directional(vec3(0.0f, 0.0f, -1.0f), vec3(1.0f));
    float head_on = shade_punctual(mirror, vec3(0.0f), up, sun, ENERGY_GLTF, vec2(0.0f))[0];
    expect_relative(head_on, 1.0 / (4.0 * 3.14159265 * 0.002025 * 0.002025), 1e-5, "1 / (4 pi ALPHA_MIN^2)");
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_attenuation), cmocka_unit_test(test_spot),
                                       cmocka_unit_test(test_illuminate), cmocka_unit_test(test_units),
                                       cmocka_unit_test(test_mirror_is_finite)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
