/* fit_drawn_test.c - OpenGL 1 as its programs display it, with sums of display values: the error against a
 * plain grid of directions in Python (numpy, 420 x 420 light directions per view, IEC 61966-2-1 in
 * double), fits against a general optimizer (scipy.optimize.least_squares), the grid for texels, default
 * targets, and the hue of broad highlights. */
#include <math.h>

#include "legacy/fit_test_support.h"
#include "legacy/convert_texels.h"
#include "legacy/convert_test_support.h"

static float light(double number)
{
    return (float)srgb_decode(number);
}

/* Colors as display values. */
static ogl1_surface ogl1_of(const double Cd[3], const double Cs[3], double shininess)
{
    ogl1_surface s = {.shininess = (float)shininess};
    for (int k = 0; k < 3; k++) {
        s.diffuse[k] = light(Cd[k]);
        s.specular[k] = light(Cs[k]);
    }
    return s;
}

static ogl1_surface gray_of(double Cd, double Cs, double shininess)
{
    return ogl1_of((const double[3]){Cd, Cd, Cd}, (const double[3]){Cs, Cs, Cs}, shininess);
}

static pbr_surface metal_of(float base, float roughness, float metallic)
{
    pbr_surface p = pbr_surface_default();
    for (int k = 0; k < 3; k++)
        p.base_color[k] = base;
    p.perceptual_roughness = roughness;
    p.metallic = metallic;
    return p;
}

/* ---- the error ---- */

static const struct drawn_case {
    double Cd[3], Cs[3], s;
    float base[3], roughness, specular, specular_color[3];
    double display, to_pbr,
        from_pbr; /* E_display and E_drawn of OpenGL 1 as the source, E_drawn of PBR as it */
} cases[] = {
    {{.07568, .61424, .07568},
     {.633, .727811, .633},
     76.8,
     {.002f, .348f, .002f},
     .417f,
     .0535f,
     {.73f, 1, .73f},
     .11882,
     .37035,
     .39483}, /* emerald */
    {{.5, .5, .5},
     {.05, .05, .05},
     20,
     {.214f, .214f, .214f},
     .5685f,
     .0016f,
     {1, 1, 1},
     .00260,
     .29689,
     .25725},
    {{.2745, .5098, .7059},
     {1, 1, 1},
     50,
     {.0526f, .2479f, .528f},
     .4633f,
     .1682f,
     {1, 1, 1},
     .13501,
     .29581,
     .29790},
    {{1, 1, 1}, {0, 0, 0}, 10, {1, 1, 1}, .6f, 0, {1, 1, 1}, 0, .38303, .30030},
};

static void errors_are_those_of_displayed_light(void **state)
{
    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        const struct drawn_case *c = &cases[i];
        ogl1_surface old = ogl1_of(c->Cd, c->Cs, c->s);
        pbr_surface new = pbr_surface_default();
        memcpy(new.base_color, c->base, sizeof new.base_color);
        memcpy(new.specular_color, c->specular_color, sizeof new.specular_color);
        new.perceptual_roughness = c->roughness;
        new.ior = 0;
        new.specular = c->specular;
        fit_error to = fit_compare(correlated, &old, &new, FIT_FROM_OGL1);
        assert_near(to.E_display, c->display, 1e-3);
        assert_near(to.E_drawn, c->to_pbr, 1e-3);
        assert_near(fit_compare(correlated, &old, &new, FIT_FROM_PBR).E_drawn, c->from_pbr, 1e-3);
    }
}

/* A white matte surface: the integrals of (x - decode(x))^2 x and decode(x)^2 x over the cosine x. */
static void matte_errors_have_a_closed_form(void **state)
{
    (void)state;
    enum { STEPS = 100000 };
    double difference = 0, source = 0;
    for (int i = 0; i < STEPS; i++) {
        double x = (i + 0.5) / STEPS;
        double T = srgb_decode(x);
        difference += (x - T) * (x - T) * x;
        source += T * T * x;
    }
    ogl1_surface old = gray_of(1, 0, 10);
    pbr_surface new = pbr_surface_default();
    new.ior = 0;
    new.specular = 0;
    assert_near(fit_compare(correlated, &old, &new, FIT_FROM_OGL1).E_drawn, sqrt(difference / source), 1e-4);
}

/* ---- fits ---- */

static double drawn_fit(const double Cd[3], const double Cs[3], double s, pbr_surface *out)
{
    ogl1_surface in = ogl1_of(Cd, Cs, s);
    ogl1_to_pbr_fit(correlated, &in, FACET_LEGACY_TARGET_DRAWN, out);
    return fit_compare(correlated, &in, out, FIT_FROM_OGL1).E_drawn;
}

/* No worse than the general optimizer, and better than the fit of linear light. */
static void fits_to_pbr_are_as_good_as_a_general_optimizer(void **state)
{
    (void)state;
    static const struct {
        double Cd[3], Cs[3], s, best;
    } known[] = {{{.07568, .61424, .07568}, {.633, .727811, .633}, 76.8, .233},
                 {{.5, .5, .5}, {.01, .01, .01}, 20, .207},
                 {{.75164, .60648, .22648}, {.628281, .555802, .366065}, 51.2, .228},
                 {{1, 1, 1}, {1, 1, 1}, 50, .196},
                 {{.2745, .5098, .7059}, {1, 1, 1}, 50, .190},
                 {{.55, .55, .55}, {.7, .7, .7}, 32, .212},
                 {{1, 1, 1}, {0, 0, 0}, 10, .229}};
    for (size_t i = 0; i < sizeof known / sizeof *known; i++) {
        pbr_surface out, other;
        double found = drawn_fit(known[i].Cd, known[i].Cs, known[i].s, &out);
        assert_true(found < known[i].best * 1.02 + 5e-4);
        assert_true(found > known[i].best * 0.98 - 1e-3);
        ogl1_surface in = ogl1_of(known[i].Cd, known[i].Cs, known[i].s);
        ogl1_to_pbr_fit(correlated, &in, FACET_LEGACY_TARGET_DISPLAY, &other);
        assert_true(found < fit_compare(correlated, &in, &other, FIT_FROM_OGL1).E_drawn);
        ogl1_to_pbr_core_fit(correlated, &in, FACET_LEGACY_TARGET_DRAWN, &other);
        double core = fit_compare(correlated, &in, &other, FIT_FROM_OGL1).E_drawn;
        ogl1_to_pbr_core_fit(correlated, &in, FACET_LEGACY_TARGET_LINEAR, &other);
        assert_true(core <= fit_compare(correlated, &in, &other, FIT_FROM_OGL1).E_drawn + 1e-4);
    }
}

/* The values are display values. Exponents end at 2. */
static void fits_to_ogl1_have_known_optima(void **state)
{
    (void)state;
    static const struct {
        float base, roughness, metallic;
        double best, Cd, Cs, s;
    } known[] = {{1, .4f, 1, .158, .270, 1, 11.6},
                 {1, .2f, 1, .213, .197, 1, 38.5},
                 {1, .6f, 1, .149, .222, .914, 4.6},
                 {.5f, 1, 0, .206, .603, .204, 2},
                 {1, 1, 1, .362, .534, .124, 2}};
    for (size_t i = 0; i < sizeof known / sizeof *known; i++) {
        pbr_surface in = metal_of(known[i].base, known[i].roughness, known[i].metallic);
        ogl1_surface out, other;
        pbr_to_ogl1_fit(correlated, &in, FACET_LEGACY_TARGET_DRAWN, FIT_DISPLAYABLE, &out);
        double found = fit_compare(correlated, &out, &in, FIT_FROM_PBR).E_drawn;
        assert_near(found, known[i].best, .02 * known[i].best + 1e-3);
        assert_near(srgb_encode((double)out.diffuse[0]), known[i].Cd, .01);
        assert_near(srgb_encode((double)out.specular[0]), known[i].Cs, .01);
        assert_near((double)out.shininess / known[i].s, 1, .03);
        for (int target = FACET_LEGACY_TARGET_LINEAR; target < FACET_LEGACY_TARGET_DRAWN; target++) {
            pbr_to_ogl1_fit(correlated, &in, (facet_legacy_target)target, FIT_DISPLAYABLE, &other);
            assert_true(found < fit_compare(correlated, &other, &in, FIT_FROM_PBR).E_drawn);
        }
    }
}

/* ---- texels ---- */

/* Between nodes of the grid colors are nearly as good as fits of the texel. */
static void the_grid_interpolates_fits(void **state)
{
    (void)state;
    static const facet_legacy_target targets[] = {FACET_LEGACY_TARGET_DISPLAY, FACET_LEGACY_TARGET_DRAWN};
    static const float bases[] = {.01f, .03f, .3f, .8f, 1}, roughnesses[] = {.05f, .3f, .55f, .9f};
    pbr_surface factors = pbr_surface_default();
    for (size_t t = 0; t < 2; t++) {
        ogl1_grid *grid = NULL;
        double sum = 0, worst = 0;
        int count = 0;
        assert_int_equal(ogl1_grid_make(NULL, 1, &factors, 20, false, targets[t], &grid, NULL), FACET_OK);
        for (size_t b = 0; b < 5; b++)
            for (size_t r = 0; r < 4; r++)
                for (int m = 0; m < 3; m++) {
                    pbr_surface in = metal_of(bases[b], roughnesses[r], .45f * (float)m);
                    ogl1_surface wanted, found;
                    pbr_to_ogl1_fit_at(correlated, &in, targets[t], 20, &wanted);
                    ogl1_grid_look_up(grid, &in, &found);
                    fit_error d = fit_compare(correlated, &wanted, &in, FIT_FROM_PBR);
                    fit_error e = fit_compare(correlated, &found, &in, FIT_FROM_PBR);
                    bool is_drawn = targets[t] == FACET_LEGACY_TARGET_DRAWN;
                    double more = is_drawn ? e.E_drawn - d.E_drawn : e.E_display - d.E_display;
                    sum += more;
                    worst = fmax(worst, more);
                    count++;
                }
        print_message("target %d: the error is %.4f larger, at most %.3f\n", (int)targets[t], sum / count,
                      worst);
        assert_true(sum / count < .005 && worst < .05);
        ogl1_grid_destroy(grid);
    }
}

static void grids_report_failed_allocations(void **state)
{
    (void)state;
    pbr_surface factors = pbr_surface_default();
    for (int at = 0; at < 2; at++) {
        failing_allocator failing = {.fail_at = at};
        facet_allocator allocator = failing_allocator_get(&failing);
        ogl1_grid *grid = NULL;
        assert_int_equal(
            ogl1_grid_make(&allocator, 1, &factors, 20, false, FACET_LEGACY_TARGET_DRAWN, &grid, NULL),
            FACET_ERROR_MEMORY);
        assert_null(grid);
        assert_int_equal(atomic_load(&failing.blocks), 0);
    }
}

/* A textured metal is converted for the same target as one without textures. */
static void textured_metals_have_the_same_target(void **state)
{
    (void)state;
    const uint8_t packed[] = {0, 102, 255, 0, 102, 255,
                              0, 102, 255, 0, 102, 255}; /* roughness .4, metallic 1 */
    facet_scene *scene = gltf_scene(1);
    scene_material m = scene_material_default();
    m.textures[SCENE_METALLIC_ROUGHNESS_TEXTURE].texture = add_texels(scene, 2, 2, 3, packed);
    scene->materials[0] = m;
    convert_to(scene, FACET_MATERIAL_MODEL_OGL1, &(facet_legacy_desc){0});
    const facet_conversion *c = &scene->conversion->materials[0].summary;
    assert_string_equal(c->method, "fit");
    assert_near(c->error_drawn, .158, .003);
    uint8_t diffuse[4], specular[4];
    const legacy_material *out = &scene->legacy->materials[0];
    assert_near(out->shininess, 11.6, .4);
    texel_at(scene, out->maps[LEGACY_DIFFUSE_MAP].ref.texture, 0, diffuse);
    texel_at(scene, out->maps[LEGACY_SPECULAR_MAP].ref.texture, 0, specular);
    assert_near(diffuse[0] / 255.0, .27, .05);
    assert_near(specular[0] / 255.0, 1, .02);
    scene_destroy(scene);
}

/* ---- defaults ---- */

/* White metal of roughness .4: the error of linear light alone (E_display .913) was the default once. */
static void the_default_target_to_ogl1_is_the_drawn_light(void **state)
{
    (void)state;
    facet_scene *scene = gltf_scene(1);
    scene->materials[0] = scene_material_default();
    scene->materials[0].metallic = 1;
    scene->materials[0].perceptual_roughness = .4f;
    convert_to(scene, FACET_MATERIAL_MODEL_OGL1, &(facet_legacy_desc){0});
    const facet_conversion *c = &scene->conversion->materials[0].summary;
    assert_near(c->error_drawn, .158, .003);
    assert_near(c->error_display, .252, .005);
    assert_true(c->is_graded_as_drawn);
    assert_near(c->error_graded, c->error_drawn, 0);
    assert_int_equal(c->grade, FACET_CONVERSION_GRADE_POOR);
    convert_to(scene, FACET_MATERIAL_MODEL_OGL1, &(facet_legacy_desc){.target = FACET_LEGACY_TARGET_DISPLAY});
    c = &scene->conversion->materials[0].summary;
    assert_near(c->error_display, .219, .003);
    assert_false(c->is_graded_as_drawn);
    scene_destroy(scene);
}

/* MTL is read as present programs do, which add light; rgl's programs add display values. */
static void the_default_target_from_ogl1_depends_on_the_format(void **state)
{
    (void)state;
    for (int is_rgl = 0; is_rgl < 2; is_rgl++) {
        facet_scene *scene = legacy_scene(1);
        legacy_material *m = &scene->legacy->materials[0];
        scene->legacy->colors = FACET_LEGACY_COLORS_SRGB;
        scene->legacy->is_rgl = is_rgl;
        m->fields = LEGACY_DIFFUSE | LEGACY_SPECULAR | LEGACY_SHININESS;
        set_color(m->diffuse, .07568f, .61424f, .07568f);
        set_color(m->specular, .633f, .727811f, .633f);
        m->shininess = 76.8f;
        convert_to(scene, FACET_MATERIAL_MODEL_METALLIC_ROUGHNESS, &(facet_legacy_desc){0});
        const facet_conversion *c = &scene->conversion->materials[0].summary;
        assert_string_equal(c->method, is_rgl ? "fit" : "closed");
        assert_near(c->error_drawn, is_rgl ? .233 : .3705, .003);
        assert_int_equal(c->grade, is_rgl ? FACET_CONVERSION_GRADE_POOR : FACET_CONVERSION_GRADE_FAIR);
        assert_int_equal(c->grade_drawn, is_rgl ? FACET_CONVERSION_GRADE_POOR : FACET_CONVERSION_GRADE_BAD);
        scene_destroy(scene);
    }
    /* Colors that are light are added as light. */
    facet_scene *scene = legacy_scene(1);
    scene->legacy->is_rgl = true;
    scene->legacy->materials[0].fields = LEGACY_DIFFUSE;
    convert_to(scene, FACET_MATERIAL_MODEL_METALLIC_ROUGHNESS, &(facet_legacy_desc){0});
    assert_near(scene->conversion->materials[0].summary.error_drawn, 0, 1e-3);
    scene_destroy(scene);
}

/* ---- hue ---- */

static void hues_are_kept_in_proportion(void **state)
{
    (void)state;
    const double blue[3] = {.2745, .5098, .7059}, white[3] = {1, 1, 1};
    for (int target = FACET_LEGACY_TARGET_LINEAR; target <= FACET_LEGACY_TARGET_DRAWN; target++) {
        ogl1_surface in = ogl1_of(blue, white, 1);
        pbr_surface out;
        ogl1_to_pbr_fit(correlated, &in, (facet_legacy_target)target, &out);
        assert_true(fit_hue_share(&in, &out) < .1);
        pbr_surface kept = out;
        assert_true(fit_keep_hue(correlated, &in, (facet_legacy_target)target, &kept));
        assert_true(fit_hue_share(&in, &kept) > FIT_HUE_KEPT - .01);
        for (int k = 0; k < 2; k++) /* steelblue's own proportions */
            assert_near(kept.base_color[k] / kept.base_color[2], in.diffuse[k] / in.diffuse[2], 1e-4);
        assert_true(kept.base_color[2] > .9f);
    }
    ogl1_surface narrow = ogl1_of(blue, white, 50), gray = gray_of(.5, 1, 1);
    pbr_surface out;
    ogl1_to_pbr_closed(&narrow, &out);
    pbr_surface before = out;
    assert_false(fit_keep_hue(correlated, &narrow, FACET_LEGACY_TARGET_LINEAR, &out));
    assert_memory_equal(&before, &out, sizeof out);
    ogl1_to_pbr_closed(&gray, &out);
    assert_false(fit_keep_hue(correlated, &gray, FACET_LEGACY_TARGET_LINEAR, &out)); /* no hue */
}

static void lost_hues_are_reported(void **state)
{
    (void)state;
    for (int keeps = 0; keeps < 2; keeps++) {
        facet_scene *scene = legacy_scene(1);
        legacy_material *m = &scene->legacy->materials[0];
        m->fields = LEGACY_DIFFUSE | LEGACY_SPECULAR | LEGACY_SHININESS;
        set_color(m->diffuse, .061f, .223f, .456f);
        set_color(m->specular, 1, 1, 1);
        m->shininess = 5;
        convert_to(scene, FACET_MATERIAL_MODEL_METALLIC_ROUGHNESS, &(facet_legacy_desc){.keeps_hue = keeps});
        assert_int_equal(has_warning(scene, 0, "hue-lost"), !keeps);
        assert_int_equal(has_warning(scene, 0, "hue-kept"), keeps);
        assert_int_equal(scene->materials[0].base_color[0] < .2f, keeps);
        scene_destroy(scene);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(errors_are_those_of_displayed_light),
        cmocka_unit_test(matte_errors_have_a_closed_form),
        cmocka_unit_test(fits_to_pbr_are_as_good_as_a_general_optimizer),
        cmocka_unit_test(fits_to_ogl1_have_known_optima),
        cmocka_unit_test(the_grid_interpolates_fits),
        cmocka_unit_test(grids_report_failed_allocations),
        cmocka_unit_test(textured_metals_have_the_same_target),
        cmocka_unit_test(the_default_target_to_ogl1_is_the_drawn_light),
        cmocka_unit_test(the_default_target_from_ogl1_depends_on_the_format),
        cmocka_unit_test(hues_are_kept_in_proportion),
        cmocka_unit_test(lost_hues_are_reported),
    };
    return cmocka_run_group_tests(tests, fit_test_setup, fit_test_teardown);
}
