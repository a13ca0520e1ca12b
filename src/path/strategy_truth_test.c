/* Truth tests of the two sampling strategies. Light sampling and BSDF sampling are independent estimators
 * that share no pdf; if either, or their weights, were wrong, their means would differ. They agree within
 * three standard errors of the difference, for each scene and channel. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#include "path/path_fixture.h"

/* Independent images of a mean. With 24 values each, Student's t exceeds 3 once in 250 comparisons. */
enum { RENDERS = 24 };

static void check_strategies(fixture *f, const char *what)
{
    static const char *names[] = {"both", "BSDF-sampled", "light-sampled"};
    truth_value v[3];
    f->desc.width = f->desc.height = 6;
    for (int i = 0; i < 3; i++) {
        f->desc.path.light_sampling = (facet_light_sampling)i;
        v[i] = truth_measure(f, RENDERS);
        /* The test is meaningless where the mean is not known to a percent. */
        for (int c = 0; c < 3; c++)
            if (v[i].mean[c] <= 0.0 || v[i].error[c] > 0.015 * v[i].mean[c])
                fail_msg("%s, %s: channel %d is %.5g with a standard error of %.2g", what, names[i], c,
                         v[i].mean[c], v[i].error[c]);
    }
    truth_assert_same(&v[0], &v[1], 3.0, "%s: %s, against %s", what, names[0], names[1]);
    truth_assert_same(&v[0], &v[2], 3.0, "%s: %s, against %s", what, names[0], names[2]);
    truth_assert_same(&v[1], &v[2], 3.0, "%s: %s, against %s", what, names[1], names[2]);
    fixture_destroy(f);
}

static void area_light_over_diffuse_and_glossy(void **state)
{
    (void)state;
    static const float roughness[] = {0.3f, 0.5f, 0.8f};
    for (int i = 0; i < 3; i++) {
        fixture f = truth_create();
        scene_material m = truth_metal(0.8f, 0.6f, 0.3f, roughness[i]);
        m.metallic = i == 1 ? 0.0f : 1.0f;
        truth_add_floor(&f, fixture_add_material(&f, m), 0.0f, 5.0f);
        truth_add_ceiling(&f, fixture_add_material(&f, truth_emitter(5.0f)), 2.0f, 1.0f);
        /* An occluder that reflects. */
        truth_add_box(&f, fixture_add_material(&f, truth_lambert(0.7f)), 0.5f, 0.3f, 0.2f, 0.3f);
        truth_set_camera(&f, 60.0, -0.5f, 0.0f, 1.5f);
        f.desc.samples = i == 0 ? 256 : 128;
        check_strategies(&f, "area light");
    }
}

static void sky_with_a_bright_window(const double d[3], float rgb[3])
{
    bool is_window = d[1] > 0.3 && d[1] < 0.7 && d[0] > 0.4;
    rgb[0] = is_window ? 8.0f : 0.3f;
    rgb[1] = is_window ? 6.0f : 0.4f;
    rgb[2] = is_window ? 4.0f : 0.6f + 0.4f * (float)d[1];
}

static void environment_over_layers(void **state)
{
    (void)state;
    for (int i = 0; i < 3; i++) {
        fixture f = truth_create();
        truth_set_sky(&f, 32, sky_with_a_bright_window);
        scene_material m = truth_metal(0.7f, 0.5f, 0.4f, 0.4f);
        m.metallic = i == 0 ? 0.0f : 0.5f;
        if (i == 1) {
            m.extensions |= SCENE_CLEARCOAT | SCENE_SHEEN;
            m.clearcoat = 0.7f;
            m.clearcoat_roughness = 0.2f;
            m.sheen_color[0] = m.sheen_color[1] = m.sheen_color[2] = 0.5f;
            m.sheen_roughness = 0.5f;
        }
        if (i == 2) {
            m.extensions |= SCENE_ANISOTROPY | SCENE_DIFFUSE_TRANSMISSION;
            m.anisotropy = 0.6f;
            m.diffuse_transmission = 0.5f;
            m.metallic = 0.2f;
        }
        truth_add_flat_sphere(&f, fixture_add_material(&f, m), 48, 0.0f, 1.0f);
        truth_set_camera(&f, 70.0, 0.0f, 0.0f, 1.8f);
        f.desc.environment_rotation_rad = 0.7f * (float)i;
        f.desc.samples = 256;
        check_strategies(&f, "environment");
    }
}

static void emissive_texture(void **state)
{
    (void)state;
    unsigned char texels[8 * 8 * 4];
    for (int i = 0; i < 64; i++)
        for (int c = 0; c < 4; c++)
            texels[4 * i + c] = (unsigned char)(c == 3                   ? 255
                                                : i % 8 > 4 && i / 8 < 3 ? 255 - 60 * c
                                                                         : 20 * c);
    fixture f = truth_create();
    scene_material emitter = truth_emitter(10.0f);
    emitter.textures[SCENE_EMISSIVE_TEXTURE].texture = fixture_add_texture(&f, 8, 8, texels);
    truth_add_floor(&f, fixture_add_material(&f, truth_lambert(0.8f)), 0.0f, 5.0f);
    truth_add_ceiling(&f, fixture_add_material(&f, emitter), 1.0f, 1.0f);
    truth_set_camera(&f, 80.0, 0.0f, 0.0f, 0.3f);
    f.desc.samples = 256;
    check_strategies(&f, "emissive texture");
}

static void many_emitters(void **state)
{
    (void)state;
    fixture f = truth_create();
    truth_add_floor(&f, fixture_add_material(&f, truth_metal(0.9f, 0.9f, 0.9f, 0.6f)), 0.0f, 5.0f);
    for (int i = 0; i < 24; i++) {
        scene_material emitter = truth_emitter(4.0f + (float)(i % 5));
        emitter.emissive[i % 3] = 0.2f;
        emitter.is_double_sided = i % 2;
        float angle = 0.7f * (float)i;
        float c[3] = {1.5f * cosf(angle), 0.4f + 0.1f * (float)(i % 7), 1.5f * sinf(angle)};
        float u[3] = {0.2f * cosf(angle), 0.1f, 0.2f * sinf(angle)};
        float v[3] = {0.2f * sinf(angle), 0.0f, -0.2f * cosf(angle)};
        truth_add_panel(&f, fixture_add_material(&f, emitter), c, u, v);
    }
    truth_set_camera(&f, 45.0, 0.0f, 0.0f, 1.0f);
    f.desc.samples = 512;
    check_strategies(&f, "24 emitters");
}

static void sun_and_sky(void **state)
{
    (void)state;
    fixture f = truth_create();
    truth_set_sky(&f, 32, sky_with_a_bright_window);
    f.desc.sun = (facet_sun){.azimuth_rad = 0.5f,
                             .elevation_rad = 0.8f,
                             .illuminance_lux = {3.0f, 2.5f, 2.0f},
                             .diameter_rad = 0.4f};
    scene_material m = truth_metal(0.6f, 0.5f, 0.4f, 0.5f);
    m.metallic = 0.3f;
    truth_add_floor(&f, fixture_add_material(&f, m), 0.0f, 5.0f);
    truth_add_box(&f, fixture_add_material(&f, truth_lambert(0.5f)), 0.5f, 0.2f, 0.4f, 0.2f);
    truth_set_camera(&f, 50.0, 0.3f, 0.0f, 1.5f);
    f.desc.samples = 256;
    check_strategies(&f, "sun and sky");
}

static void rough_glass(void **state)
{
    (void)state;
    fixture f = truth_create();
    truth_set_sky(&f, 32, sky_with_a_bright_window);
    truth_add_flat_sphere(&f, fixture_add_material(&f, truth_glass(1.5f, 0.6f)), 32, 0.0f, 1.0f);
    truth_add_floor(&f, fixture_add_material(&f, truth_lambert(0.6f)), -1.2f, 4.0f);
    truth_add_panel(&f, fixture_add_material(&f, truth_emitter(3.0f)), (float[3]){0.0f, 2.5f, 0.0f},
                    (float[3]){1.0f, 0.0f, 0.0f}, (float[3]){0.0f, 0.0f, 1.0f});
    truth_set_camera(&f, 60.0, 0.0f, 0.0f, 1.6f);
    f.desc.samples = 256;
    check_strategies(&f, "rough glass");
}

static void scattering_volume(void **state)
{
    (void)state;
    fixture f = truth_create();
    truth_set_sky(&f, 32, sky_with_a_bright_window);
    scene_material fog = truth_glass(1.0f, 0.0f);
    fog.extensions |= SCENE_VOLUME_SCATTER;
    fog.attenuation_distance = 1.0f;
    for (int c = 0; c < 3; c++) {
        fog.attenuation_color[c] = 0.3f + 0.1f * (float)c;
        fog.multiscatter_color[c] = 0.9f - 0.1f * (float)c;
    }
    fog.scatter_anisotropy = 0.4f;
    truth_add_box(&f, fixture_add_material(&f, fog), 0.0f, 1.0f, 1.0f, 1.0f);
    scene_material emitter = truth_emitter(4.0f);
    emitter.is_double_sided = true;
    truth_add_panel(&f, fixture_add_material(&f, emitter), (float[3]){0.1f, 0.2f, 0.3f},
                    (float[3]){0.5f, 0.0f, 0.0f}, (float[3]){0.0f, 0.3f, 0.3f});
    truth_set_camera(&f, 60.0, 0.0f, 0.0f, 1.6f);
    f.desc.samples = 256;
    check_strategies(&f, "area light in fog");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(area_light_over_diffuse_and_glossy),
        cmocka_unit_test(environment_over_layers),
        cmocka_unit_test(emissive_texture),
        cmocka_unit_test(many_emitters),
        cmocka_unit_test(sun_and_sky),
        cmocka_unit_test(rough_glass),
        cmocka_unit_test(scattering_volume),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
