/* plot_test.c - charts of all kinds: values against closed forms and the functions that they come from, and
 * refusals. */
#include "tests/support/support.h"
#include "plot/plot_test_support.h"

#include "ibl/ibl.h"

#include "shade/shade.h"

static const facet_plot_kind all_kinds[] = {
    FACET_PLOT_KIND_LEGACY, FACET_PLOT_KIND_BRDF,  FACET_PLOT_KIND_SLICE,   FACET_PLOT_KIND_HEMISPHERE,
    FACET_PLOT_KIND_LOBE,   FACET_PLOT_KIND_TERMS, FACET_PLOT_KIND_ALBEDO,  FACET_PLOT_KIND_FURNACE,
    FACET_PLOT_KIND_DFG,    FACET_PLOT_KIND_TONE,  FACET_PLOT_KIND_FRESNEL, FACET_PLOT_KIND_ERROR};
enum { KINDS = sizeof all_kinds / sizeof *all_kinds };
_Static_assert(KINDS == FACET_PLOT_KIND_ERROR + 1, "every kind");

/* ---- all kinds ---- */

static void check_axis(const chart_axis *axis)
{
    if (axis->has_range) {
        assert_true(axis->minimum < axis->maximum);
        assert_true(axis->scale == CHART_LINEAR || axis->minimum > 0.0);
    }
}

static void check_panel(const chart_panel *panel)
{
    assert_non_null(panel->title);
    assert_non_null(panel->note);
    bool has_axes = panel->kind == CHART_XY || panel->kind == CHART_FIELD;
    if (has_axes) {
        assert_true(strlen(panel->x.label) > 0 && strlen(panel->y.label) > 0);
        check_axis(&panel->x);
        check_axis(&panel->y);
    }
    assert_true(panel->curve_count > 0 || panel->field || panel->surface);
    for (size_t i = 0; i < panel->curve_count; i++) {
        const chart_curve *c = &panel->curves[i];
        assert_true(c->count >= 2);
        for (size_t k = 0; k < c->count; k++)
            assert_true(isfinite(c->x[k]) && isfinite(c->y[k]));
    }
    if (panel->field) {
        const chart_field *f = panel->field;
        size_t values = 0;
        for (size_t k = 0; k < (size_t)f->width * f->height; k++)
            values += isfinite(f->values[k]) ? 1 : 0;
        assert_true(values > (size_t)f->width * f->height / 2);
        assert_true(strlen(f->label) > 0);
    }
    if (panel->surface)
        for (size_t k = 0; k < (size_t)panel->surface->width * panel->surface->height; k++)
            assert_true(isfinite(panel->surface->x[k]) && isfinite(panel->surface->y[k]) &&
                        panel->surface->z[k] >= 0.0 && isfinite(panel->surface->values[k]));
}

/* Slow kinds, for which a logarithmic axis changes the axis only. */
static bool is_expensive(facet_plot_kind kind)
{
    return kind == FACET_PLOT_KIND_LEGACY || kind == FACET_PLOT_KIND_ALBEDO ||
           kind == FACET_PLOT_KIND_FURNACE || kind == FACET_PLOT_KIND_ERROR;
}

static void every_kind_has_defaults(void **state)
{
    (void)state;
    for (int k = 0; k < KINDS; k++)
        for (int log = 0; log < (IS_SLOW || is_expensive(all_kinds[k]) ? 1 : 2); log++) {
            plot_fixture f = make_plot(&(facet_plot_desc){.kind = all_kinds[k], .is_logarithmic = log});
            assert_true(f.drawing.panel_count > 0 && f.drawing.columns > 0);
            assert_true(f.drawing.width >= 640 && f.drawing.height >= 400);
            assert_true(strlen(f.drawing.title) > 0);
            for (uint32_t i = 0; i < f.drawing.panel_count; i++)
                check_panel(&f.drawing.panels[i]);
            free_plot(&f);
        }
}

/* Two materials of each model, two angles, with fits. */
static void every_kind_shows_several_materials(void **state)
{
    (void)state;
    static const float angles[2] = {0.0f, 1.3f};
    facet_plot_material m[4];
    for (int i = 0; i < 4; i++)
        m[i] = material_default();
    m[0].perceptual_roughness = 0.0f;
    m[1].clearcoat = m[1].sheen_color[0] = m[1].iridescence = m[1].anisotropy = 1.0f;
    m[2].model = m[3].model = FACET_PLOT_MODEL_OGL1;
    m[3].shininess = 0.0f;
    for (int k = 0; k < KINDS; k++) {
        bool only_pbr = all_kinds[k] == FACET_PLOT_KIND_TERMS || all_kinds[k] == FACET_PLOT_KIND_FRESNEL;
        if (all_kinds[k] == FACET_PLOT_KIND_TONE || all_kinds[k] == FACET_PLOT_KIND_DFG)
            continue;
        m[0].metallic = all_kinds[k] == FACET_PLOT_KIND_FRESNEL ? 0.5f : 1.0f;
        plot_fixture f = make_plot(&(facet_plot_desc){.kind = all_kinds[k],
                                                      .material_count = only_pbr ? 2 : 4,
                                                      .materials = m,
                                                      .angle_count = 2,
                                                      .angles_rad = angles,
                                                      .has_fit = true,
                                                      .has_separable_smith = true,
                                                      .title = "mine",
                                                      .width = 333,
                                                      .height = 222});
        assert_string_equal(f.drawing.title, "mine");
        assert_int_equal(f.drawing.width, 333);
        assert_int_equal(f.drawing.height, 222);
        for (uint32_t i = 0; i < f.drawing.panel_count; i++)
            check_panel(&f.drawing.panels[i]);
        free_plot(&f);
    }
}

static void values_do_not_depend_on_threads(void **state)
{
    (void)state;
    static const facet_plot_kind kinds[] = {FACET_PLOT_KIND_ALBEDO, FACET_PLOT_KIND_FURNACE,
                                            FACET_PLOT_KIND_ERROR};
    static const float angle = 0.5f;
    facet_plot_material m = material_default();
    for (int k = 0; k < 3; k++) {
        facet_plot_desc desc = {
            .kind = kinds[k], .material_count = 1, .materials = &m, .angle_count = 1, .angles_rad = &angle};
        desc.thread_count = 1;
        plot_fixture a = make_plot(&desc);
        desc.thread_count = 5;
        plot_fixture b = make_plot(&desc);
        for (uint32_t i = 0; i < a.drawing.panel_count; i++)
            for (size_t c = 0; c < a.drawing.panels[i].curve_count; c++) {
                const chart_curve *x = &a.drawing.panels[i].curves[c], *y = &b.drawing.panels[i].curves[c];
                assert_memory_equal(x->y, y->y, x->count * sizeof(double));
            }
        free_plot(&a);
        free_plot(&b);
    }
}

static void running_out_of_memory_leaks_nothing(void **state)
{
    (void)state;
    for (int k = 0; k < KINDS; k++)
        for (long fail_at = 0;; fail_at += 1 + fail_at / (IS_SLOW ? 1 : 2)) {
            failing_allocator failing = {.fail_at = fail_at};
            facet_plot_desc desc = {
                .kind = all_kinds[k], .allocator = failing_allocator_get(&failing), .has_fit = true};
            arena *memory = arena_create(&desc.allocator);
            chart drawing;
            facet_error error = {0};
            facet_result result = memory ? plot_create(&desc, memory, &drawing, &error) : FACET_ERROR_MEMORY;
            arena_destroy(memory);
            assert_int_equal(atomic_load(&failing.blocks), 0);
            if (result == FACET_OK)
                break;
            assert_int_equal(result, FACET_ERROR_MEMORY);
        }
}

/* ---- reflectance ---- */

static void matte_slice_is_flat(void **state)
{
    (void)state;
    facet_plot_material m = material_default();
    m.specular = 0.0f;
    m.base_color[0] = m.base_color[1] = m.base_color[2] = 0.5f;
    for (int cosine = 0; cosine < 2; cosine++) {
        plot_fixture f = make_plot(&(facet_plot_desc){
            .kind = FACET_PLOT_KIND_SLICE, .material_count = 1, .materials = &m, .has_cosine = cosine});
        const chart_panel *panel = &f.drawing.panels[0];
        assert_int_equal(panel->curve_count, 1);
        for (size_t i = 0; i < panel->curves[0].count; i++)
            assert_near(panel->curves[0].y[i],
                        0.5 / PLOT_PI * (cosine ? cos(panel->curves[0].x[i] * PLOT_DEGREE) : 1.0), 1e-6);
        free_plot(&f);
    }
}

/* The largest value of a narrow highlight is on the curve: 1 / (4 pi alpha^2) facing the eye, with F = 1. */
static void peaks_are_not_cut(void **state)
{
    (void)state;
    static const float roughness[] = {0.02f, 0.05f, 0.1f, 0.3f};
    static const float facing = 0.0f;
    for (int i = 0; i < 4; i++) {
        facet_plot_material m = material_default();
        m.metallic = 1.0f;
        m.perceptual_roughness = roughness[i];
        plot_fixture f = make_plot(&(facet_plot_desc){.kind = FACET_PLOT_KIND_SLICE,
                                                      .material_count = 1,
                                                      .materials = &m,
                                                      .angle_count = 1,
                                                      .angles_rad = &facing,
                                                      .energy = FACET_ENERGY_GLTF});
        const chart_curve *c = &f.drawing.panels[0].curves[0];
        double alpha = (double)roughness[i] * (double)roughness[i];
        double peak = 0.25 / (PLOT_PI * alpha * alpha), highest = 0.0;
        size_t above_half = 0;
        for (size_t k = 0; k < c->count; k++) {
            highest = fmax(highest, c->y[k]);
            above_half += c->y[k] > 0.5 * peak;
        }
        assert_near(highest / peak, 1.0, 1e-3);
        assert_true(above_half >= 20); /* and smooth */
        free_plot(&f);
    }
}

static void polar_lobes_reach_one(void **state)
{
    (void)state;
    plot_fixture f = make_plot(&(facet_plot_desc){.kind = FACET_PLOT_KIND_BRDF});
    assert_int_equal(f.drawing.panel_count, 2);
    for (uint32_t i = 0; i < 2; i++) {
        const chart_panel *panel = &f.drawing.panels[i];
        assert_int_equal(panel->kind, CHART_POLAR);
        for (size_t c = 0; c < 6; c++) {
            double highest = 0.0;
            for (size_t k = 0; k < panel->curves[c].count; k++)
                highest = fmax(highest, panel->curves[c].y[k]);
            assert_near(highest, 1.0, 1e-12);
        }
    }
    free_plot(&f);
}

/* A single colored material has a curve per channel; several have luminance. OpenGL 1 adds the cosine. */
static void curves_per_channel_or_luminance(void **state)
{
    (void)state;
    facet_plot_material m[2] = {material_default(), material_default()};
    m[0].base_color[2] = 0.1f;
    m[1].model = FACET_PLOT_MODEL_OGL1;
    plot_fixture f =
        make_plot(&(facet_plot_desc){.kind = FACET_PLOT_KIND_SLICE, .material_count = 1, .materials = m});
    const chart_panel *panel = &f.drawing.panels[0];
    assert_int_equal(panel->curve_count, 3);
    assert_string_equal(panel->y.label, "BRDF, 1/sr");
    assert_true(value_at(&panel->curves[2], 60, 0.3) < value_at(&panel->curves[0], 60, 0.3));
    free_plot(&f);
    f = make_plot(&(facet_plot_desc){.kind = FACET_PLOT_KIND_SLICE, .material_count = 2, .materials = m});
    panel = &f.drawing.panels[0];
    assert_int_equal(panel->curve_count, 2);
    assert_string_equal(panel->y.label, "BRDF times N.L, 1/sr");
    assert_non_null(strstr(panel->note, "OpenGL 1"));
    free_plot(&f);
}

static void the_disc_contains_the_slice(void **state)
{
    (void)state;
    static const float view = 0.5f;
    facet_plot_material m = material_default();
    m.metallic = 1.0f;
    plot_fixture f = make_plot(&(facet_plot_desc){.kind = FACET_PLOT_KIND_HEMISPHERE,
                                                  .material_count = 1,
                                                  .materials = &m,
                                                  .angle_count = 1,
                                                  .angles_rad = &view});
    const chart_field *field = f.drawing.panels[0].field;
    uint32_t middle = field->height / 2;
    material prepared = {.parameters = m, .label = ""};
    float V[3];
    plot_direction((double)view, 0.0, V);
    for (uint32_t column = 8; column < field->width - 8; column += 9) {
        double x = (column + 0.5) / field->width * 2.0 - 1.0;
        float L[1][3] = {{(float)x, 0.0f, (float)sqrt(1.0 - x * x)}};
        double out[1][3];
        material_brdf_cos(&prepared, V, 1, (const float(*)[3])L, out);
        assert_near(field->values[middle * field->width + column] / (out[0][0] / (double)L[0][2]), 1.0, 1e-4);
    }
    assert_true(isnan(field->values[0]));
    free_plot(&f);
}

static void lobe_is_as_long_as_the_root_of_its_value(void **state)
{
    (void)state;
    plot_fixture f = make_plot(&(facet_plot_desc){.kind = FACET_PLOT_KIND_LOBE});
    for (uint32_t i = 0; i < f.drawing.panel_count; i++) {
        const chart_surface *s = f.drawing.panels[i].surface;
        double peak = 0.0, longest = 0.0;
        size_t count = (size_t)s->width * s->height;
        for (size_t k = 0; k < count; k++)
            peak = fmax(peak, s->values[k]);
        for (size_t k = 0; k < count; k++) {
            double r = sqrt(s->x[k] * s->x[k] + s->y[k] * s->y[k] + s->z[k] * s->z[k]);
            assert_near(r, sqrt(s->values[k] / peak), 1e-4);
            longest = fmax(longest, r);
        }
        assert_near(longest, 1.0, 1e-4);
    }
    free_plot(&f);
}

/* ---- terms, tables, curves ---- */

static void terms_equal_those_of_the_shader_library(void **state)
{
    (void)state;
    facet_plot_material m = material_default();
    m.perceptual_roughness = 0.4f;
    static const float view = 1.0f;
    plot_fixture f = make_plot(&(facet_plot_desc){.kind = FACET_PLOT_KIND_TERMS,
                                                  .material_count = 1,
                                                  .materials = &m,
                                                  .angle_count = 1,
                                                  .angles_rad = &view});
    const chart_panel *p = f.drawing.panels;
    assert_int_equal(f.drawing.panel_count, 6);
    const chart_curve *D = find_curve(&p[0], "roughness 0.4"), *charlie = find_curve(&p[1], "roughness 0.4");
    const chart_curve *G[3] = {&p[3].curves[0], &p[3].curves[1], &p[3].curves[2]};
    for (size_t i = 0; i < D->count - 1; i += 7) {
        float x = (float)D->x[i], NdotV = cos(view);
        assert_near(D->y[i] / (double)D_GGX(x, 0.16f), 1.0, 1e-5);
        assert_near(charlie->y[i], D_Charlie(x, 0.16f), 1e-5);
        x = (float)G[0]->x[i];
        assert_near(G[0]->y[i], 4.0f * x * NdotV * V_SmithGGX(x, NdotV, 0.16f), 1e-5);
        assert_near(G[1]->y[i], G1_SmithGGX(x, 0.16f) * G1_SmithGGX(NdotV, 0.16f), 1e-5);
        assert_true(G[0]->y[i] <= 1.0 + 1e-6 && G[1]->y[i] <= G[0]->y[i] + 1e-6);
    }
    assert_near(D->y[0], 1.0 / (PLOT_PI * 0.16 * 0.16), 1e-3);
    const chart_curve *F = find_curve(&p[2], "F0 0.04");
    assert_near(F->y[0], 0.04, 1e-6);
    assert_near(F->y[F->count - 1], 1.0, 1e-6);
    free_plot(&f);
}

static void albedo_of_white_metal_is_the_sum_of_the_dfg_terms(void **state)
{
    (void)state;
    facet_plot_material m = material_default();
    m.metallic = 1.0f;
    m.perceptual_roughness = 0.7f;
    plot_fixture f = make_plot(&(facet_plot_desc){
        .kind = FACET_PLOT_KIND_ALBEDO, .material_count = 1, .materials = &m, .energy = FACET_ENERGY_GLTF});
    const chart_curve *c = &f.drawing.panels[0].curves[0];
    for (size_t i = 0; i < c->count; i++) {
        float terms[2];
        ibl_dfg((float)cos(c->x[i] * PLOT_DEGREE), 0.7f, terms);
        assert_near(c->y[i], terms[0] + terms[1], 1e-3);
    }
    free_plot(&f);
}

static void conserving_materials_pass_the_furnace_test(void **state)
{
    (void)state;
    plot_fixture f = make_plot(&(facet_plot_desc){.kind = FACET_PLOT_KIND_FURNACE});
    assert_int_equal(f.drawing.panel_count, 4);
    for (uint32_t i = 0; i < 4; i++) {
        const chart_panel *panel = &f.drawing.panels[i];
        static const char *const conserving[] = {"conserving, punctual, 30", "conserving, punctual, 75",
                                                 "conserving, environment, 30"};
        for (int k = 0; k < 3; k++) {
            const chart_curve *c = find_curve(panel, conserving[k]);
            for (size_t j = 0; j < c->count; j++)
                assert_near(c->y[j], 1.0, 3e-3);
        }
    }
    /* smooth metal is lossless, rough metal loses two thirds */
    const chart_curve *metal = find_curve(&f.drawing.panels[0], "glTF, punctual, 30");
    assert_near(metal->y[0], 1.0, 1e-3);
    assert_true(metal->y[metal->count - 1] < 0.45);
    free_plot(&f);
}

static void tables_equal_those_of_ibl(void **state)
{
    (void)state;
    plot_fixture f = make_plot(&(facet_plot_desc){.kind = FACET_PLOT_KIND_DFG});
    assert_int_equal(f.drawing.panel_count, 4);
    for (uint32_t row = 3; row < 192; row += 17)
        for (uint32_t column = 5; column < 192; column += 19) {
            float NdotV = ((float)column + 0.5f) / 192.0f, roughness = 1.0f - ((float)row + 0.5f) / 192.0f;
            float terms[2];
            ibl_dfg(NdotV, roughness, terms);
            size_t k = (size_t)row * 192 + column;
            assert_near(f.drawing.panels[0].field->values[k], terms[0], 0.0);
            assert_near(f.drawing.panels[1].field->values[k], terms[1], 0.0);
            assert_near(f.drawing.panels[2].field->values[k], 1.0f - terms[0] - terms[1], 1e-6);
            assert_near(f.drawing.panels[3].field->values[k], ibl_sheen_albedo(NdotV, roughness), 0.0);
        }
    free_plot(&f);
}

static void tone_curves_rise(void **state)
{
    (void)state;
    plot_fixture f = make_plot(&(facet_plot_desc){.kind = FACET_PLOT_KIND_TONE});
    for (uint32_t i = 0; i < 2; i++) {
        const chart_panel *panel = &f.drawing.panels[i];
        assert_int_equal(panel->curve_count, TONEMAP_HABLE + 1);
        for (size_t c = 0; c < panel->curve_count; c++)
            for (size_t k = 1; k < panel->curves[c].count; k++)
                assert_true(panel->curves[c].y[k] >= panel->curves[c].y[k - 1] - 2e-6);
    }
    const chart_curve *none = &f.drawing.panels[0].curves[0];
    assert_near(value_at(none, 0.0, 1e-9), srgb_from_linear1(0.18f), 1e-6);
    assert_near(value_at(none, 8.0, 1e-9), 1.0, 1e-6);
    assert_near(value_at(find_curve(&f.drawing.panels[1], "Reinhard 2002"), 1.0, 1e-9), 0.5, 1e-6);
    free_plot(&f);
}

static void fresnel_is_exact_at_both_ends(void **state)
{
    (void)state;
    plot_fixture f = make_plot(&(facet_plot_desc){.kind = FACET_PLOT_KIND_FRESNEL});
    assert_int_equal(f.drawing.panel_count, 6);
    const chart_panel *p = f.drawing.panels;
    static const struct {
        const char *name;
        double ior;
    } media[3] = {{"water, n", 1.333}, {"glass, n", 1.5}, {"diamond, n", 2.417}};
    for (int k = 0; k < 3; k++) {
        double r = (media[k].ior - 1.0) / (media[k].ior + 1.0);
        for (int side = 0; side < 2; side++) {
            const chart_curve *c = find_curve(&p[side], media[k].name);
            assert_near(value_at(c, 0.0, 0.0), r * r, 1e-6);
            assert_near(value_at(c, 90.0, 1e-9), 1.0, 1e-5);
        }
        /* Brewster's angle: s polarization only, ((1 - n^2) / (1 + n^2))^2 / 2 */
        double n2 = media[k].ior * media[k].ior, s = (1.0 - n2) / (1.0 + n2);
        double brewster = atan(media[k].ior) / PLOT_DEGREE;
        assert_near(value_at(find_curve(&p[0], media[k].name), brewster, 0.13), 0.5 * s * s, 2e-3);
        /* total reflection from the critical angle on, not before */
        double critical = asin(1.0 / media[k].ior) / PLOT_DEGREE;
        const chart_curve *inside = find_curve(&p[1], media[k].name);
        for (size_t i = 0; i < inside->count; i++)
            if (inside->x[i] > critical)
                assert_near(inside->y[i], 1.0, 1e-6);
            else
                assert_true(inside->y[i] < 1.0);
        assert_near(p[2].curves[k].y[0], 0.0, 1e-6);
    }
    /* gold is yellow, copper red, aluminium nearly gray; all reflect all at grazing angles */
    for (int k = 3; k < 6; k++) {
        const chart_curve *c[3] = {find_curve(&p[k], "red"), find_curve(&p[k], "green"),
                                   find_curve(&p[k], "blue")};
        for (int i = 0; i < 3; i++)
            assert_near(value_at(c[i], 90.0, 1e-9), 1.0, 1e-5);
        assert_true(k == 5 || (c[0]->y[0] > c[1]->y[0] && c[1]->y[0] > c[2]->y[0]));
    }
    /* ((n - 1)^2 + k^2) / ((n + 1)^2 + k^2) of gold's red */
    assert_near(find_curve(&p[3], "red")->y[0], (0.79 * 0.79 + 3.272 * 3.272) / (1.21 * 1.21 + 3.272 * 3.272),
                1e-5);
    free_plot(&f);
}

/* The errors of fit.h for one material, and the order of the methods. */
static void errors_equal_those_of_the_fits(void **state)
{
    (void)state;
    plot_fixture f =
        make_plot(&(facet_plot_desc){.kind = FACET_PLOT_KIND_ERROR, .has_separable_smith = true});
    assert_int_equal(f.drawing.panel_count, 4);
    fit_metric *metric;
    assert_int_equal(fit_metric_create(NULL, PBR_SEPARABLE, &metric, NULL), FACET_OK);
    pbr_surface pbr = pbr_surface_default();
    pbr.base_color[0] = pbr.base_color[1] = pbr.base_color[2] = 0.5f;
    pbr.perceptual_roughness = 0.5f;
    ogl1_surface s;
    pbr_to_ogl1_fit(metric, &pbr, FACET_LEGACY_TARGET_LINEAR, FIT_DISPLAYABLE, &s);
    const chart_panel *gray = &f.drawing.panels[0];
    assert_near(value_at(find_curve(gray, "fit"), 0.5, 1e-9), fit_compare(metric, &s, &pbr, FIT_FROM_PBR).E,
                1e-6);
    fit_metric_destroy(metric);
    /* values of an independent computation for gray dielectrics and white metals: naive, box, free */
    static const struct {
        int panel;
        double roughness, naive, box, unlimited;
    } table[] = {{0, 0.3, .386, .236, .210}, {0, 0.5, .109, .071, .071}, {0, 0.8, .071, .012, .012},
                 {1, 0.4, .902, .785, .270}, {1, 0.6, .510, .334, .227}, {1, 0.8, .753, .169, .169},
                 {1, 1.0, 3.44, .132, .132}};
    for (size_t i = 0; i < sizeof table / sizeof *table; i++) {
        const chart_panel *panel = &f.drawing.panels[table[i].panel];
        double naive = value_at(find_curve(panel, "usual formula"), table[i].roughness, 1e-9);
        double box = value_at(find_curve(panel, "fit"), table[i].roughness, 1e-9);
        double unlimited = value_at(find_curve(panel, "fit, colors above 1"), table[i].roughness, 1e-9);
        assert_near(naive, table[i].naive, 0.05 * table[i].naive + 0.003);
        assert_near(box, table[i].box, 0.05 * table[i].box + 0.003);
        assert_near(unlimited, table[i].unlimited, 0.05 * table[i].unlimited + 0.003);
    }
    for (int k = 2; k < 4; k++) { /* a fit is never worse than a formula */
        const chart_panel *panel = &f.drawing.panels[k];
        const chart_curve *closed = find_curve(panel, "closed form, specular"),
                          *fit = find_curve(panel, "fit, specular");
        for (size_t i = 0; i < fit->count; i++)
            assert_true(fit->y[i] <= closed->y[i] * 1.02 + 1e-3);
    }
    free_plot(&f);
}

/* ---- materials and conversions ---- */

static void conversions_are_drawn_beside_their_sources(void **state)
{
    (void)state;
    facet_plot_material m[2] = {material_default(), material_default()};
    m[0].base_color[0] = m[0].base_color[1] = m[0].base_color[2] = 0.5f;
    m[1].model = FACET_PLOT_MODEL_OGL1;
    plot_fixture f = make_plot(&(facet_plot_desc){.material_count = 2, .materials = m, .has_fit = true});
    assert_int_equal(f.drawing.panel_count, 8);
    assert_int_equal(f.drawing.columns, 4);
    const chart_panel *p = f.drawing.panels;
    for (int row = 0; row < 2; row++)
        for (int view = 0; view < 3; view++) {
            const chart_panel *panel = &p[4 * row + view];
            const chart_curve *a = find_curve(panel, row ? "OpenGL 1" : "PBR times pi");
            const chart_curve *b = find_curve(panel, row ? "PBR times pi" : "OpenGL 1");
            const chart_curve *d = &p[4 * row + 3].curves[view];
            assert_int_equal(a->count, b->count);
            for (size_t i = 0; i < a->count; i++)
                assert_near(d->y[i], b->y[i] - a->y[i], 1e-12);
        }
    /* the source of the second row is the vignette's highlight: 1.8 facing the mirror direction */
    assert_near(value_at(&p[4].curves[0], 0.0, 1e-6), 0.8 + 1.0, 1e-5);
    free_plot(&f);
}

static void wrong_descs_are_refused(void **state)
{
    (void)state;
    facet_plot_material m[FACET_PLOT_MAX_MATERIALS + 1];
    for (int i = 0; i <= FACET_PLOT_MAX_MATERIALS; i++)
        m[i] = material_default();
    facet_plot_desc desc = {.kind = (facet_plot_kind)99};
    plot_failure(&desc, FACET_ERROR_ARGUMENT);
    desc = (facet_plot_desc){
        .kind = FACET_PLOT_KIND_BRDF, .material_count = FACET_PLOT_MAX_MATERIALS + 1, .materials = m};
    assert_non_null(strstr(plot_failure(&desc, FACET_ERROR_ARGUMENT).message, "17 materials"));
    desc.material_count = 2;
    static const float angles[4] = {0.3f, 1.5708f, -0.1f, NAN};
    for (uint32_t i = 1; i < 4; i++) {
        desc.angle_count = i == 1 ? 2 : 1;
        desc.angles_rad = i == 1 ? angles : &angles[i];
        assert_non_null(strstr(plot_failure(&desc, FACET_ERROR_ARGUMENT).message, "degrees"));
    }
    desc.angle_count = 9;
    plot_failure(&desc, FACET_ERROR_ARGUMENT);
    desc.angle_count = 0;
    desc.width = 100000;
    plot_failure(&desc, FACET_ERROR_ARGUMENT);
    desc.width = 0;
    m[1].sheen_roughness = NAN;
    assert_non_null(
        strstr(plot_failure(&desc, FACET_ERROR_ARGUMENT).message, "sheen_roughness of material 2"));
    m[1] = material_default();
    m[1].ior = 0.5f;
    assert_non_null(strstr(plot_failure(&desc, FACET_ERROR_ARGUMENT).message, "ior of material 2 is 0.5"));
    m[1].ior = 0.0f; /* infinite */
    plot_fixture f = make_plot(&desc);
    free_plot(&f);
    desc.kind = FACET_PLOT_KIND_FRESNEL;
    plot_failure(&desc, FACET_ERROR_ARGUMENT);
    m[1].ior = 1.5f;
    m[1].metallic = 1.0f;
    plot_failure(&desc, FACET_ERROR_ARGUMENT);
    desc.kind = FACET_PLOT_KIND_TONE;
    plot_failure(&desc, FACET_ERROR_ARGUMENT);
    desc.kind = FACET_PLOT_KIND_BRDF;
    m[1].model = (facet_plot_model)7;
    plot_failure(&desc, FACET_ERROR_ARGUMENT);
    m[1].model = FACET_PLOT_MODEL_OGL1;
    m[1].shininess = -1.0f;
    plot_failure(&desc, FACET_ERROR_ARGUMENT);
    m[1].model = FACET_PLOT_MODEL_MERL;
    assert_non_null(strstr(plot_failure(&desc, FACET_ERROR_ARGUMENT).message, "path"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_kind_has_defaults),
        cmocka_unit_test(every_kind_shows_several_materials),
        cmocka_unit_test(values_do_not_depend_on_threads),
        cmocka_unit_test(running_out_of_memory_leaks_nothing),
        cmocka_unit_test(matte_slice_is_flat),
        cmocka_unit_test(peaks_are_not_cut),
        cmocka_unit_test(polar_lobes_reach_one),
        cmocka_unit_test(curves_per_channel_or_luminance),
        cmocka_unit_test(the_disc_contains_the_slice),
        cmocka_unit_test(lobe_is_as_long_as_the_root_of_its_value),
        cmocka_unit_test(terms_equal_those_of_the_shader_library),
        cmocka_unit_test(albedo_of_white_metal_is_the_sum_of_the_dfg_terms),
        cmocka_unit_test(conserving_materials_pass_the_furnace_test),
        cmocka_unit_test(tables_equal_those_of_ibl),
        cmocka_unit_test(tone_curves_rise),
        cmocka_unit_test(fresnel_is_exact_at_both_ends),
        cmocka_unit_test(errors_equal_those_of_the_fits),
        cmocka_unit_test(conversions_are_drawn_beside_their_sources),
        cmocka_unit_test(wrong_descs_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
