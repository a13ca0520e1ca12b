/* Tests of media: the current one of several nested volumes, free flights. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#include "cpu/shading_hit.h"

#include "path/path_media.h"

static scene_material body(float ior, const char *extras)
{
    scene_material m = scene_material_default();
    m.extensions |= SCENE_TRANSMISSION | SCENE_VOLUME | SCENE_IOR;
    m.transmission = 1.0f;
    m.thickness = 0.5f;
    m.ior = ior;
    m.meta.extras = extras;
    return m;
}

static const scene_material *here(const scene_material *const *entered, uint32_t count)
{
    media m = {.count = 0};
    for (uint32_t i = 0; i < count; i++)
        media_enter(&m, entered[i], 0.5f);
    const medium *found = path_media_here(&m);
    return found ? found->material : NULL;
}

/* ---- nested dielectrics ---- */

static void outside_all_volumes_is_air(void **state)
{
    (void)state;
    media m = {.count = 0};
    assert_null(path_media_here(&m));
    assert_true(path_media_ior(&m, 0.0f) == 1.0f);
    vec3 T = path_media_transmittance(&m, INFINITY);
    assert_true(T[0] == 1.0f && T[1] == 1.0f && T[2] == 1.0f);
}

static void order_of_entering_does_not_matter(void **state)
{
    (void)state;
    scene_material materials[3] = {body(1.33f, NULL), body(1.5f, NULL), body(1.1f, "{\"priority\": 2}")};
    static const int orders[6][3] = {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}};
    for (int i = 0; i < 6; i++) {
        const scene_material *entered[3];
        for (int k = 0; k < 3; k++)
            entered[k] = &materials[orders[i][k]];
        assert_ptr_equal(here(entered, 3), &materials[2]);
    }
    const scene_material *two[2] = {&materials[0], &materials[1]};
    assert_ptr_equal(here(two, 2), &materials[1]);
    two[0] = &materials[1];
    two[1] = &materials[0];
    assert_ptr_equal(here(two, 2), &materials[1]);
}

static void priority_is_read_from_extras(void **state)
{
    (void)state;
    static const char *const high[] = {"{\"priority\":1}", "{\"a\": [1, 2], \"priority\" : 7 }",
                                       "{\n\t\"priority\"\t:\n3}"};
    static const char *const low[] = {NULL,
                                      "{}",
                                      "{\"priority\": 0}",
                                      "{\"priority\": -4}",
                                      "{\"priorities\": 9}",
                                      "{\"priority\": \"high\"}",
                                      "\"priority\""};
    for (size_t i = 0; i < sizeof high / sizeof *high; i++)
        for (size_t k = 0; k < sizeof low / sizeof *low; k++) {
            scene_material water = body(1.33f, high[i]);
            scene_material glass = body(1.5f, low[k]);
            const scene_material *entered[2] = {&water, &glass};
            assert_ptr_equal(here(entered, 2), &water);
        }
}

static void equal_volumes_are_ordered(void **state)
{
    (void)state;
    scene_material materials[2] = {body(1.5f, NULL), body(1.5f, NULL)};
    const scene_material *entered[2] = {&materials[1], &materials[0]};
    assert_ptr_equal(here(entered, 2), &materials[0]);
}

/* KHR_materials_dispersion's example: ior 1.5168 with 20 / 64.17 (BK7) has 1.5143 at 656.27 nm, 1.5224 at
 * 486.13 nm. */
static void the_index_depends_on_the_wavelength(void **state)
{
    (void)state;
    scene_material m = body(1.5168f, NULL);
    media in = {.count = 0};
    media_enter(&in, &m, 1.0f);
    assert_true(path_media_ior(&in, 486.13f) == 1.5168f);
    assert_false(path_media_disperses(&in));
    m.extensions |= SCENE_DISPERSION;
    m.dispersion = 20.0f / 64.17f;
    assert_true(path_media_disperses(&in));
    assert_true(path_media_ior(&in, 0.0f) == 1.5168f);
    assert_true(fabsf(path_media_ior(&in, 656.27f) - 1.5143f) < 2e-4f);
    assert_true(fabsf(path_media_ior(&in, 486.13f) - 1.5224f) < 2e-4f);
}

/* ---- flight ---- */

enum { STRATA = 1024 };

/* Means of beta over a grid of flights: of those that pass, and of those that scatter. */
static void fly_all(const scene_material *m, vec3 beta, float distance_m, double passed[3],
                    double scattered[3])
{
    for (int c = 0; c < 3; c++)
        passed[c] = scattered[c] = 0.0;
    for (int i = 0; i < STRATA; i++)
        for (int k = 0; k < STRATA; k++) {
            media in = {.count = 0};
            media_enter(&in, m, m->thickness);
            path_flight f = path_media_sample_flight(&in, beta, distance_m, ((float)i + 0.5f) / STRATA,
                                                     ((float)k + 0.5f) / STRATA);
            if (f.is_scattered)
                assert_true(f.distance_m >= 0.0f && f.distance_m <= distance_m);
            for (int c = 0; c < 3; c++)
                (f.is_scattered ? scattered : passed)[c] += (double)(beta[c] * f.weight[c]) / STRATA / STRATA;
        }
}

static void free_flights_conserve_energy(void **state)
{
    (void)state;
    scene_material m = body(1.0f, NULL);
    m.extensions |= SCENE_VOLUME_SCATTER;
    m.attenuation_distance = 0.4f;
    static const float colors[2][3] = {{0.9f, 0.3f, 0.05f}, {1.0f, 0.5f, 0.5f}};
    static const float scatter[3] = {0.2f, 0.7f, 1.0f};
    for (int i = 0; i < 2; i++) {
        for (int c = 0; c < 3; c++) {
            m.attenuation_color[c] = colors[i][c];
            m.multiscatter_color[c] = scatter[c];
        }
        vec3 beta = vec3(1.0f, 0.5f, 0.25f);
        double passed[3], scattered[3];
        fly_all(&m, beta, 0.3f, passed, scattered);
        vec3 albedo = single_scatter_albedo(load3(scatter));
        for (int c = 0; c < 3; c++) {
            double T = pow((double)colors[i][c], 0.75);
            double each = (double)beta[c];
            assert_true(fabs(passed[c] - each * T) < 1e-3 * each);
            assert_true(fabs(scattered[c] - each * (1.0 - T) * (double)albedo[c]) < 1e-3 * each);
        }
    }
}

/* Without a far boundary a volume has the thickness of its material. */
static void open_volumes_end_at_their_thickness(void **state)
{
    (void)state;
    scene_material m = body(1.5f, NULL);
    m.attenuation_distance = 1.0f;
    m.attenuation_color[0] = 0.25f;
    media in = {.count = 0};
    media_enter(&in, &m, m.thickness);
    path_flight f = path_media_sample_flight(&in, vec3(1.0f), INFINITY, 0.5f, 0.5f);
    assert_false(f.is_scattered);
    assert_true(fabsf(f.weight[0] - 0.5f) < 1e-6f);
    assert_true(f.weight[1] == 1.0f);
    m.attenuation_color[0] = 0.0f;
    f = path_media_sample_flight(&in, vec3(1.0f), INFINITY, 0.5f, 0.5f);
    assert_false(f.is_scattered);
    assert_true(f.weight[0] == 0.0f && f.weight[2] == 1.0f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(outside_all_volumes_is_air),
        cmocka_unit_test(order_of_entering_does_not_matter),
        cmocka_unit_test(priority_is_read_from_extras),
        cmocka_unit_test(equal_volumes_are_ordered),
        cmocka_unit_test(the_index_depends_on_the_wavelength),
        cmocka_unit_test(free_flights_conserve_energy),
        cmocka_unit_test(open_volumes_end_at_their_thickness),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
