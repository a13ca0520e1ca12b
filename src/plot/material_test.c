/* material_test.c - reflectance and albedo of materials against closed forms, tables and shade's own
 * functions. */
#include "plot/plot_test_support.h"

#include "ibl/ibl.h"

#include "shade/shade.h"

static material pbr(float roughness, float metallic, float base)
{
    material m = {.parameters = material_default(), .label = ""};
    m.parameters.perceptual_roughness = roughness;
    m.parameters.metallic = metallic;
    for (int c = 0; c < 3; c++)
        m.parameters.base_color[c] = base;
    return m;
}

static material ogl1(float diffuse, float specular, float shininess)
{
    material m = {.parameters = material_default(), .label = ""};
    m.parameters.model = FACET_PLOT_MODEL_OGL1;
    m.parameters.shininess = shininess;
    for (int c = 0; c < 3; c++) {
        m.parameters.diffuse[c] = diffuse;
        m.parameters.ogl1_specular[c] = specular;
    }
    return m;
}

static double brdf_cos(const material *m, double view, double light, double azimuth)
{
    float V[3], L[1][3];
    double f[1][3];
    plot_direction(view, 0.0, V);
    plot_direction(light, azimuth, L[0]);
    material_brdf_cos(m, V, 1, (const float(*)[3])L, f);
    return f[0][1];
}

static double albedo(const material *m, double degrees)
{
    float V[3];
    double out[3];
    plot_direction(degrees * PLOT_DEGREE, 0.0, V);
    material_albedo(m, V, out);
    return out[1];
}

static void matte_is_albedo_over_pi(void **state)
{
    (void)state;
    material legacy = ogl1(0.6f, 0.0f, 10.0f);
    material base = pbr(0.5f, 0.0f, 0.6f);
    base.parameters.specular = 0.0f;
    for (int i = -8; i <= 8; i++) {
        double light = i * 10.0 * PLOT_DEGREE;
        assert_near(brdf_cos(&legacy, 0.5, light, 0.3), 0.6 / PLOT_PI * cos(light), 1e-6);
        assert_near(brdf_cos(&base, 0.5, light, 0.3), 0.6 / PLOT_PI * cos(light), 1e-6);
    }
    assert_near(albedo(&legacy, 40), 0.6, 1e-3);
    assert_near(albedo(&base, 40), 0.6, 1e-3);
}

static void light_from_below_is_black(void **state)
{
    (void)state;
    material a = pbr(0.5f, 1.0f, 1.0f);
    material b = ogl1(0.5f, 1.0f, 2.0f);
    assert_near(brdf_cos(&a, 0.3, 91 * PLOT_DEGREE, 0.0), 0.0, 0.0);
    assert_near(brdf_cos(&b, 0.3, 91 * PLOT_DEGREE, 0.0), 0.0, 0.0);
}

/* Radiance of both models as in the fits: times pi. */
static void radiance_equals_that_of_the_fits(void **state)
{
    (void)state;
    material a = pbr(0.35f, 0.3f, 0.7f);
    material b = ogl1(0.3f, 0.8f, 20.0f);
    a.energy = FACET_ENERGY_GLTF;
    pbr_surface A = material_pbr_surface(&a.parameters);
    ogl1_surface B = material_ogl1_surface(&b.parameters);
    for (int separable = 0; separable < 2; separable++)
        for (int i = 0; i < 40; i++) {
            double light = -1.5 + i * 0.075;
            float V[3], L[3], out[3];
            a.has_separable_smith = separable;
            plot_direction(0.7, 0.0, V);
            plot_direction(light, 0.4, L);
            pbr_radiance(&A, separable ? PBR_SEPARABLE : PBR_CORRELATED, V, L, out);
            assert_near(brdf_cos(&a, 0.7, light, 0.4) * PLOT_PI, out[1], 1e-5 + 1e-5 * (double)out[1]);
            ogl1_radiance(&B, V, L, out);
            assert_near(brdf_cos(&b, 0.7, light, 0.4) * PLOT_PI, out[1], 1e-5);
        }
}

/* Single-scattering albedo equals the split sum, which src/ibl integrates independently. */
static void albedo_equals_that_of_the_lut(void **state)
{
    (void)state;
    static const float roughness[] = {0.02f, 0.1f, 0.3f, 0.6f, 1.0f};
    static const double degrees[] = {0, 30, 60, 80};
    for (int r = 0; r < 5; r++)
        for (int d = 0; d < 4; d++) {
            float terms[2];
            ibl_dfg((float)cos(degrees[d] * PLOT_DEGREE), roughness[r], terms);
            material white = pbr(roughness[r], 1.0f, 1.0f);
            white.energy = FACET_ENERGY_GLTF;
            assert_near(albedo(&white, degrees[d]), terms[0] + terms[1], 1e-3);
            material half = pbr(roughness[r], 1.0f, 0.5f);
            half.energy = FACET_ENERGY_GLTF;
            assert_near(albedo(&half, degrees[d]), 0.5f * terms[0] + terms[1], 1e-3);
        }
}

static void conserving_surfaces_return_all(void **state)
{
    (void)state;
    for (int kind = 0; kind < 4; kind++)
        for (int r = 1; r <= 10; r++) {
            material m = pbr((float)r * 0.1f, kind == 0, 1.0f);
            m.energy = FACET_ENERGY_CONSERVING;
            m.parameters.clearcoat = kind == 2;
            m.parameters.clearcoat_roughness = (float)r * 0.1f;
            m.parameters.sheen_color[0] = m.parameters.sheen_color[1] = m.parameters.sheen_color[2] =
                kind == 3;
            m.parameters.sheen_roughness = (float)r * 0.1f;
            assert_near(albedo(&m, 20), 1.0, 2e-3);
            assert_near(albedo(&m, 70), 1.0, 2e-3);
            float V[3];
            double image[3];
            plot_direction(70 * PLOT_DEGREE, 0.0, V);
            material_albedo_image_based(&m, V, image);
            assert_near(image[1], 1.0, 1e-3);
        }
}

/* Sheen over black: the LUT of its albedo. */
static void sheen_equals_its_lut(void **state)
{
    (void)state;
    static const float roughness[] = {0.2f, 0.5f, 0.9f};
    for (int r = 0; r < 3; r++) {
        material m = pbr(0.5f, 0.0f, 0.0f);
        m.parameters.specular = 0.0f;
        m.parameters.sheen_color[0] = m.parameters.sheen_color[1] = m.parameters.sheen_color[2] = 1.0f;
        m.parameters.sheen_roughness = roughness[r];
        for (int d = 10; d < 80; d += 20)
            assert_near(albedo(&m, d), ibl_sheen_albedo((float)cos(d * PLOT_DEGREE), roughness[r]), 2e-3);
    }
}

/* Anisotropic: a plain grid over the hemisphere agrees with lobe sampling. */
static void anisotropic_albedos_agree_with_a_grid(void **state)
{
    (void)state;
    material m = pbr(0.5f, 1.0f, 0.9f);
    m.parameters.anisotropy = 0.6f;
    m.parameters.anisotropy_rotation_rad = 0.7f;
    for (int separable = 0; separable < 2; separable++) {
        m.has_separable_smith = separable;
        double sum = 0;
        enum { N = 300 };
        for (int i = 0; i < N; i++)
            for (int j = 0; j < N; j++) {
                double z = (i + 0.5) / N;
                sum += brdf_cos(&m, 0.6, acos(z), (j + 0.5) / N * 2 * PLOT_PI) * 2 * PLOT_PI / (N * N);
            }
        assert_near(albedo(&m, 0.6 / PLOT_DEGREE), sum, 2e-3);
    }
}

/* OpenGL 1's highlight facing the eye: 2 pi / pi of the integral of cos^s(theta / 2) over the hemisphere,
 * which is int_0^1 ((1 + z) / 2)^(s / 2) dz = (2 - 2^(-s / 2)) / (s / 2 + 1). */
static void highlight_has_its_integral(void **state)
{
    (void)state;
    static const float shininess[] = {0.0f, 1.0f, 10.0f, 50.0f, 128.0f, 1000.0f};
    for (int i = 0; i < 6; i++) {
        material m = ogl1(0.0f, 1.0f, shininess[i]);
        double half = (double)shininess[i] / 2.0;
        assert_near(albedo(&m, 0), 2.0 * (2.0 - exp2(-half)) / (half + 1.0),
                    1e-3 * (1.0 + 4.0 / (half + 1.0)));
    }
}

static void labels_name_the_relevant_parameters(void **state)
{
    (void)state;
    arena *memory = arena_create(NULL);
    facet_allocator malloc_ = {0};
    facet_plot_material m = material_default();
    assert_string_equal(material_describe(&m, &malloc_, memory), "white dielectric, roughness 0.5");
    m.metallic = 1.0f;
    m.base_color[2] = 0.25f;
    m.clearcoat = 1.0f;
    assert_string_equal(material_describe(&m, &malloc_, memory),
                        "metal (1, 1, 0.25), roughness 0.5, clearcoat 1");
    m.clearcoat = 0.0f;
    m.metallic = 0.75f;
    assert_string_equal(material_describe(&m, &malloc_, memory),
                        "metal (1, 1, 0.25), metallic 0.75, roughness 0.5");
    /* results of fits: free F0 distinguishes metals */
    m.metallic = m.ior = 0.0f;
    m.base_color[0] = m.base_color[1] = m.base_color[2] = 0.0625f;
    m.specular_color[2] = 0.25f;
    m.specular = 0.75f;
    assert_string_equal(material_describe(&m, &malloc_, memory),
                        "metal (0.75, 0.75, 0.188), diffuse 0.0625, roughness 0.5");
    m.base_color[0] = m.base_color[1] = m.base_color[2] = 0.5f;
    assert_string_equal(material_describe(&m, &malloc_, memory),
                        "dielectric, color 0.5, F0 (0.75, 0.75, 0.188), roughness 0.5");
    m.model = FACET_PLOT_MODEL_OGL1;
    assert_string_equal(material_describe(&m, &malloc_, memory),
                        "OpenGL 1, diffuse 0.8, specular 1, shininess 50");
    m.model = FACET_PLOT_MODEL_MERL;
    m.path = "brdfs/gold-metallic-paint.binary";
    assert_string_equal(material_describe(&m, &malloc_, memory), "gold-metallic-paint.binary");
    arena_destroy(memory);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(matte_is_albedo_over_pi),
        cmocka_unit_test(light_from_below_is_black),
        cmocka_unit_test(radiance_equals_that_of_the_fits),
        cmocka_unit_test(albedo_equals_that_of_the_lut),
        cmocka_unit_test(conserving_surfaces_return_all),
        cmocka_unit_test(sheen_equals_its_lut),
        cmocka_unit_test(anisotropic_albedos_agree_with_a_grid),
        cmocka_unit_test(highlight_has_its_integral),
        cmocka_unit_test(labels_name_the_relevant_parameters),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
