/* merl_test.c - measured BRDFs: files generated from known materials are read, interpolated and fitted.
 * They follow the description of the format; files of the database are not part of the tests. */
#define _POSIX_C_SOURCE 200809L
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

#include "plot/merl.h"
#include "plot/plot_test_support.h"

enum { FILE_SIZE = 12 + 3 * 8 * MERL_THETA_H * MERL_THETA_D * MERL_PHI_D };

typedef struct fixture {
    char path[64];
    unsigned char *bytes;
} fixture;

static void put_int(unsigned char *b, int32_t x)
{
    for (int i = 0; i < 4; i++)
        b[i] = (unsigned char)((uint32_t)x >> (8 * i));
}
static void put_double(fixture *f, int channel, size_t cell, double x)
{
    uint64_t u;
    memcpy(&u, &x, sizeof u);
    for (size_t i = 0; i < 8; i++)
        f->bytes[12 + ((size_t)channel * MERL_CELLS + cell) * 8 + i] = (unsigned char)(u >> (8 * i));
}

static void write_file(const fixture *f, size_t size)
{
    FILE *file = fopen(f->path, "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(f->bytes, 1, size, file), size);
    fclose(file);
}

static int set_up(void **state)
{
    fixture *f = calloc(1, sizeof *f);
    strcpy(f->path, "/tmp/facet-merl-XXXXXX");
    int descriptor = mkstemp(f->path);
    f->bytes = calloc(FILE_SIZE, 1);
    if (descriptor < 0 || !f->bytes)
        return 1;
    close(descriptor);
    put_int(f->bytes, MERL_THETA_H);
    put_int(f->bytes + 4, MERL_THETA_D);
    put_int(f->bytes + 8, MERL_PHI_D);
    *state = f;
    return 0;
}
static int tear_down(void **state)
{
    fixture *f = *state;
    unlink(f->path);
    free(f->bytes);
    free(f);
    return 0;
}

/* Values at the cell centers; -1 where light or eye would be below the horizon. */
static void write_material(fixture *f, const facet_plot_material *parameters)
{
    material m = {.parameters = *parameters, .label = "", .energy = FACET_ENERGY_GLTF}; /* as fits have it */
    size_t cell = 0;
    for (int h = 0; h < MERL_THETA_H; h++)
        for (int d = 0; d < MERL_THETA_D; d++)
            for (int p = 0; p < MERL_PHI_D; p++, cell++) {
                float V[3], L[1][3];
                double value[1][3] = {{-1, -1, -1}};
                merl_directions(merl_theta_h(h + 0.5), (d + 0.5) * PLOT_DEGREE, (p + 0.5) * PLOT_DEGREE, V,
                                L[0]);
                bool is_above = V[2] > 0.0f && L[0][2] > 0.0f;
                if (is_above)
                    material_brdf_cos(&m, V, 1, (const float(*)[3])L, value);
                for (int c = 0; c < 3; c++)
                    put_double(f, c, cell, is_above ? value[0][c] / (double)L[0][2] / merl_scale(c) : -1.0);
            }
    write_file(f, FILE_SIZE);
}

static merl *open_file(const fixture *f)
{
    merl *m = NULL;
    facet_error error = {0};
    if (merl_open(f->path, NULL, &m, &error) != FACET_OK)
        fail_msg("%s", error.message);
    return m;
}

static facet_plot_material shiny(float roughness)
{
    facet_plot_material m = material_default();
    m.perceptual_roughness = roughness;
    m.base_color[0] = 0.5f;
    m.base_color[1] = 0.2f;
    m.base_color[2] = 0.1f;
    return m;
}

static void cells_and_places_between_them(void **state)
{
    fixture *f = *state;
    facet_plot_material parameters = shiny(0.3f);
    material m = {.parameters = parameters, .label = "", .energy = FACET_ENERGY_GLTF};
    write_material(f, &parameters);
    merl *file = open_file(f);
    double worst = 0.0;
    for (int i = 0; i < 2000; i++) {
        bool is_middle = i % 2;
        int h = i * 7 % 70, d = i * 13 % 50, p = i * 29 % 180;
        double off = is_middle ? 0.5 : 0.5 + (i % 9) * 0.1;
        float V[3], L[1][3];
        double measured[3], swapped[3], expected[1][3];
        merl_directions(merl_theta_h(h + off), (d + off) * PLOT_DEGREE, (p + off) * PLOT_DEGREE, V, L[0]);
        if (!(V[2] > 0.2f && L[0][2] > 0.2f))
            continue;
        material_brdf_cos(&m, V, 1, (const float(*)[3])L, expected);
        merl_brdf(file, V, L[0], measured);
        merl_brdf(file, L[0], V, swapped);
        for (int c = 0; c < 3; c++) {
            double ratio = measured[c] * (double)L[0][2] / expected[0][c];
            if (is_middle)
                assert_near(ratio, 1.0, 1e-3); /* directions in floats, back to cells of 0.011 degrees */
            worst = fmax(worst, fabs(ratio - 1.0));
            assert_near(swapped[c] / measured[c], 1.0, 1e-4); /* reciprocal */
        }
    }
    for (int i = 1; i < 12; i++) { /* isotropic: rotation about the normal changes nothing */
        float V[2][3], L[2][3];
        double out[2][3];
        for (int k = 0; k < 2; k++) {
            plot_direction(0.5, k * i * 0.5, V[k]);
            plot_direction(0.9, 2.0 + k * i * 0.5, L[k]);
            merl_brdf(file, V[k], L[k], out[k]);
        }
        for (int c = 0; c < 3; c++)
            assert_near(out[0][c] / out[1][c], 1.0, 1e-4);
    }
    assert_true(worst < 0.02); /* linear between cells: 1.2 % at the steepest part of the highlight */
    merl_close(file);
}

/* A cell without a value is interpolated from its neighbors; a region without values has none. */
static void unmeasured_cells_do_not_count(void **state)
{
    fixture *f = *state;
    for (int h = 0; h < MERL_THETA_H; h++)
        for (size_t i = 0; i < (size_t)MERL_THETA_D * MERL_PHI_D; i++)
            for (int c = 0; c < 3; c++)
                put_double(f, c, (size_t)h * MERL_THETA_D * MERL_PHI_D + i,
                           h > 40 ? (h % 2 ? -1.0 : (double)NAN) : 1500.0);
    put_double(f, 0, ((size_t)20 * MERL_THETA_D + 10) * MERL_PHI_D + 90, (double)NAN);
    put_double(f, 0, ((size_t)20 * MERL_THETA_D + 10) * MERL_PHI_D + 91, (double)INFINITY);
    write_file(f, FILE_SIZE);
    merl *file = open_file(f);
    float V[3], L[3];
    double out[3];
    merl_directions(merl_theta_h(20.7), 10.6 * PLOT_DEGREE, 90.7 * PLOT_DEGREE, V, L);
    merl_brdf(file, V, L, out);
    assert_near(out[0], 1.0, 1e-9);
    assert_near(out[1], 1.15, 1e-9);
    assert_near(out[2], 1.66, 1e-9);
    merl_directions(merl_theta_h(45.0), 10.6 * PLOT_DEGREE, 90.7 * PLOT_DEGREE, V, L);
    merl_brdf(file, V, L, out);
    assert_true(isnan(out[0]) && isnan(out[1]) && isnan(out[2]));
    merl_close(file);
}

static material measured_material(const fixture *f, merl *file)
{
    return (material){
        .parameters = {.model = FACET_PLOT_MODEL_MERL, .path = f->path}, .label = "", .measured = file};
}

/* Fits a model; its RMS (material_fit()). */
static double fit(const material *measured, facet_plot_model model, facet_plot_material *found)
{
    double rms;
    facet_allocator malloc_ = {0};
    assert_int_equal(material_fit(measured, model, &malloc_, found, &rms, NULL), FACET_OK);
    return rms;
}

/* Fitting recovers the parameters up to the error of interpolation. */
static void parameters_are_recovered(void **state)
{
    fixture *f = *state;
    static const float roughness[] = {0.15f, 0.3f, 0.6f};
    for (int r = 0; r < 3; r++) {
        facet_plot_material parameters = shiny(roughness[r]), found;
        write_material(f, &parameters);
        merl *file = open_file(f);
        material measured = measured_material(f, file);
        double rms = fit(&measured, FACET_PLOT_MODEL_PBR, &found);
        assert_near(found.perceptual_roughness, roughness[r], 0.005);
        for (int c = 0; c < 3; c++) {
            assert_near(found.specular_color[c], 0.04, 0.002);
            assert_near(found.base_color[c], parameters.base_color[c], 0.005);
        }
        assert_true(rms < 0.02);
        merl_close(file);
    }
}

static void metals_are_recovered(void **state)
{
    fixture *f = *state;
    static const float gold[3] = {1.0f, 0.766f, 0.336f};
    facet_plot_material parameters = shiny(0.35f), found;
    parameters.metallic = 1.0f;
    memcpy(parameters.base_color, gold, sizeof gold);
    write_material(f, &parameters);
    merl *file = open_file(f);
    material measured = measured_material(f, file);
    double rms = fit(&measured, FACET_PLOT_MODEL_PBR, &found);
    assert_near(found.perceptual_roughness, 0.35, 0.005);
    for (int c = 0; c < 3; c++)
        assert_near(found.specular_color[c], gold[c], 0.01);
    assert_true(rms < 0.02);
    merl_close(file);
}

/* A legacy material through the file, and the albedo of both. */
static void legacy_materials_are_recovered(void **state)
{
    fixture *f = *state;
    facet_plot_material parameters = material_default(), found;
    parameters.model = FACET_PLOT_MODEL_OGL1;
    parameters.diffuse[0] = 0.3f;
    parameters.ogl1_specular[1] = 0.5f;
    write_material(f, &parameters);
    merl *file = open_file(f);
    material measured = measured_material(f, file);
    fit(&measured, FACET_PLOT_MODEL_OGL1, &found);
    assert_near(found.shininess / 50.0f, 1.0, 0.03);
    for (int c = 0; c < 3; c++) {
        assert_near(found.diffuse[c], parameters.diffuse[c], 0.01);
        assert_near(found.ogl1_specular[c], parameters.ogl1_specular[c], 0.01);
    }
    material source = {.parameters = parameters, .label = ""};
    float V[3];
    double a[3], b[3];
    plot_direction(0.5, 0.0, V);
    material_albedo(&source, V, a);
    material_albedo(&measured, V, b);
    for (int c = 0; c < 3; c++)
        assert_near(a[c], b[c], 0.01);
    merl_close(file);
}

static void expect_failure(const char *path, facet_result result, const char *part)
{
    merl *m = NULL;
    facet_error error = {0};
    assert_int_equal(merl_open(path, NULL, &m, &error), result);
    assert_null(m);
    assert_non_null(strstr(error.message, path));
    assert_non_null(strstr(error.message, part));
}

static void broken_files_are_errors(void **state)
{
    fixture *f = *state;
    expect_failure("/tmp/facet-no-such-file.binary", FACET_ERROR_READ, "");
    write_file(f, 7);
    expect_failure(f->path, FACET_ERROR_INVALID, "7 bytes");
    write_file(f, FILE_SIZE - 8);
    expect_failure(f->path, FACET_ERROR_INVALID, "34992004 bytes; 34992012 expected");
    put_int(f->bytes + 8, 360);
    write_file(f, FILE_SIZE);
    expect_failure(f->path, FACET_ERROR_INVALID, "90 x 90 x 360");
    put_int(f->bytes + 8, 180);
    for (size_t i = 0; i < MERL_CELLS; i++)
        put_double(f, 0, i, -1.0);
    write_file(f, FILE_SIZE);
    expect_failure(f->path, FACET_ERROR_INVALID, "no cell");
}

/* In a plot: curve and fit, with channels. */
static void plots_show_measured_beside_fit(void **state)
{
    fixture *f = *state;
    facet_plot_material parameters = shiny(0.4f);
    write_material(f, &parameters);
    facet_plot_material measured = {.model = FACET_PLOT_MODEL_MERL, .path = f->path, .label = "measured"};
    plot_fixture p = make_plot(&(facet_plot_desc){
        .kind = FACET_PLOT_KIND_SLICE, .material_count = 1, .materials = &measured, .has_fit = true});
    const chart_panel *panel = &p.drawing.panels[0];
    assert_int_equal(panel->curve_count, 6);
    const chart_curve *a = find_curve(panel, "measured, green"), *b = find_curve(panel, "fit, ");
    for (int i = -6; i < 7; i++) {
        double x = i * 10.0;
        assert_near(value_at(a, x, 0.3) / value_at(panel->curves + 4, x, 0.3), 1.0, 0.03);
    }
    assert_int_equal(b->style.dash, 1);
    free_plot(&p);
    p = make_plot(
        &(facet_plot_desc){.kind = FACET_PLOT_KIND_LEGACY, .material_count = 1, .materials = &measured});
    assert_non_null(find_curve(&p.drawing.panels[0], "measured times pi, red"));
    assert_non_null(find_curve(&p.drawing.panels[0], "OpenGL 1, red"));
    free_plot(&p);
    plot_failure(
        &(facet_plot_desc){.kind = FACET_PLOT_KIND_ERROR, .material_count = 1, .materials = &measured},
        FACET_ERROR_ARGUMENT);
    measured.path = "/tmp/facet-no-such-file.binary";
    plot_failure(
        &(facet_plot_desc){.kind = FACET_PLOT_KIND_BRDF, .material_count = 1, .materials = &measured},
        FACET_ERROR_READ);
}

int main(void)
{
#define FILE_TEST(test) cmocka_unit_test_setup_teardown(test, set_up, tear_down)
    const struct CMUnitTest tests[] = {
        FILE_TEST(cells_and_places_between_them),  FILE_TEST(unmeasured_cells_do_not_count),
        FILE_TEST(parameters_are_recovered),       FILE_TEST(metals_are_recovered),
        FILE_TEST(legacy_materials_are_recovered), FILE_TEST(broken_files_are_errors),
        FILE_TEST(plots_show_measured_beside_fit),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
