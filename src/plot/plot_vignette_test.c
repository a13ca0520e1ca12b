/* plot_vignette_test.c - the values of the vignette to all digits, and its formula against shade/. */
#include "plot/plot_test_support.h"
#include "plot/plot_vignette.h"

static const double theta = 30.0 * PLOT_DEGREE;

/* Values of the vignette's R program at seven angles in double precision, to nine decimals. */
static const struct {
    double degrees, ramp, step, ogl1;
} table[] = {{-80, 0.007525289, 0.025238578, 0.180955960}, {-60, 0.027461554, 0.056860585, 0.676680616},
             {-30, 0.059375451, 0.079167267, 1.866025404}, {0, 0.076865935, 0.085290877, 1.176680616},
             {30, 0.068560865, 0.079167267, 0.866777947},  {60, 0.037513180, 0.056860585, 0.500000030},
             {80, 0.011890705, 0.025238578, 0.173648178}};
static const double half_digit = 0.5e-9 * 1.0001;

static void values_equal_those_of_the_vignette(void **state)
{
    (void)state;
    for (size_t i = 0; i < sizeof table / sizeof *table; i++) {
        double phi = table[i].degrees * PLOT_DEGREE;
        assert_near(vignette_pbr(theta, phi, 1, 1, 1, true), table[i].ramp, half_digit);
        assert_near(vignette_pbr(theta, phi, 1, 1, 1, false), table[i].step, half_digit);
        assert_near(vignette_ogl1(theta, phi, 50, 1, 1), table[i].ogl1, half_digit);
    }
}

/* The first two panels are the plots of the vignette: 33 points, phi in rad, three curves, blue last. */
static void panels_equal_those_of_the_vignette(void **state)
{
    (void)state;
    for (int ramp = 0; ramp < 2; ramp++) {
        plot_fixture f = make_plot(&(facet_plot_desc){.has_heaviside_ramp = ramp});
        static const char *const labels[2] = {"PBR", "OGL1[, 1]"};
        for (int k = 0; k < 2; k++) {
            const chart_panel *panel = &f.drawing.panels[k];
            assert_string_equal(panel->x.label, "phi");
            assert_string_equal(panel->y.label, labels[k]);
            assert_int_equal(panel->curve_count, 3);
            assert_string_equal(panel->curves[0].name, "red");
            assert_string_equal(panel->curves[1].name, "green");
            assert_string_equal(panel->curves[2].name, "blue");
            for (int c = 0; c < 3; c++) {
                const chart_curve *curve = &panel->curves[c];
                assert_int_equal(curve->count, 33);
                for (size_t i = 0; i < sizeof table / sizeof *table; i++)
                    assert_near(value_at(curve, table[i].degrees * PLOT_DEGREE, 1e-12),
                                k      ? table[i].ogl1
                                : ramp ? table[i].ramp
                                       : table[i].step,
                                half_digit);
            }
        }
        free_plot(&f);
    }
}

/* The panels of fits over the hemisphere show the same material, in either energy mode: fits are made to it. */
static void fits_are_drawn_beside_their_target(void **state)
{
    (void)state;
    for (int mode = 0; mode < 2; mode++) {
        plot_fixture f =
            make_plot(&(facet_plot_desc){.energy = mode ? FACET_ENERGY_CONSERVING : FACET_ENERGY_GLTF});
        const chart_panel *panel = &f.drawing.panels[4];
        assert_non_null(strstr(panel->title, "30\u00b0"));
        const chart_curve *pbr = find_curve(panel, "PBR times pi");
        for (size_t i = 0; i < pbr->count; i++) {
            double expected = PLOT_PI * vignette_pbr(theta, pbr->x[i], 1, 1, 1, false);
            assert_near(pbr->y[i], expected, 1e-4 * expected + 1e-5);
        }
        free_plot(&f);
    }
}

/* With the step it equals shade/ with separable masking for any material. */
static void masking_with_its_step_equals_the_shader_library(void **state)
{
    (void)state;
    static const float roughness[] = {0.2f, 0.5f, 1.0f};
    for (int r = 0; r < 3; r++)
        for (int metallic = 0; metallic < 2; metallic++)
            for (int i = 0; i < VIGNETTE_POINTS; i++) {
                material m = {.parameters = material_default(),
                              .energy = FACET_ENERGY_GLTF,
                              .has_separable_smith = true};
                m.parameters.perceptual_roughness = roughness[r];
                m.parameters.metallic = (float)metallic;
                m.parameters.base_color[0] = 0.5f;
                float V[3], L[1][3];
                double f[1][3];
                plot_direction(theta, 0.0, V);
                plot_direction(vignette_phi(i), 0.0, L[0]);
                material_brdf_cos(&m, V, 1, (const float(*)[3])L, f);
                double expected =
                    vignette_pbr(theta, vignette_phi(i), (double)roughness[r], metallic, 0.5, false);
                /* with metallic 0 the vignette weighs the base with 1 - F of gray, as shade does */
                assert_near(f[0][0] / expected, 1.0, 2e-5);
            }
}

/* "This looks pretty hopeless": as plotted, and with the light times pi and the optimal parameters. */
static void the_hard_case_fits_to_four_percent(void **state)
{
    (void)state;
    static const struct {
        bool has_ramp;
        double drawn, fitted;
    } cases[2] = {{true, 18.6, 0.094}, {false, 14.4, 0.038}};
    for (int k = 0; k < 2; k++) {
        double pbr[VIGNETTE_POINTS], times_pi[VIGNETTE_POINTS];
        for (int i = 0; i < VIGNETTE_POINTS; i++) {
            pbr[i] = vignette_pbr(theta, vignette_phi(i), 1, 1, 1, cases[k].has_ramp);
            times_pi[i] = PLOT_PI * pbr[i];
        }
        assert_near(vignette_error(theta, pbr, 50, 1, 1), cases[k].drawn, 0.05);
        vignette_parameters best = vignette_fit(theta, times_pi);
        assert_near(best.error, cases[k].fitted, 0.0005);
        assert_true(best.shininess >= 0 && best.shininess <= 128 && best.diffuse <= 1 && best.specular <= 1);
        /* a local minimum */
        for (int c = 0; c < 3; c++)
            for (int sign = -1; sign < 2; sign += 2) {
                double d = best.diffuse + (c == 0 ? sign * 1e-3 : 0),
                       s = best.specular + (c == 1 ? sign * 1e-3 : 0);
                double n = best.shininess + (c == 2 ? sign * 1e-2 : 0);
                if (d >= 0 && d <= 1 && s >= 0 && s <= 1 && n >= 0 && n <= 128)
                    assert_true(vignette_error(theta, times_pi, n, d, s) >= best.error - 1e-12);
            }
    }
}

/* An OpenGL 1 curve is recovered, also with a color at its bound. */
static void fits_recover_known_parameters(void **state)
{
    (void)state;
    static const double cases[3][3] = {{37.3, 0.4, 0.7}, {5.0, 1.0, 0.2}, {128.0, 0.0, 1.0}};
    for (int k = 0; k < 3; k++) {
        double target[VIGNETTE_POINTS];
        for (int i = 0; i < VIGNETTE_POINTS; i++)
            target[i] = vignette_ogl1(theta, vignette_phi(i), cases[k][0], cases[k][1], cases[k][2]);
        vignette_parameters found = vignette_fit(theta, target);
        assert_near(found.shininess, cases[k][0], 1e-3);
        assert_near(found.diffuse, cases[k][1], 1e-5);
        assert_near(found.specular, cases[k][2], 1e-5);
        assert_near(found.error, 0, 1e-5);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(values_equal_those_of_the_vignette),
        cmocka_unit_test(panels_equal_those_of_the_vignette),
        cmocka_unit_test(fits_are_drawn_beside_their_target),
        cmocka_unit_test(masking_with_its_step_equals_the_shader_library),
        cmocka_unit_test(the_hard_case_fits_to_four_percent),
        cmocka_unit_test(fits_recover_known_parameters),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
