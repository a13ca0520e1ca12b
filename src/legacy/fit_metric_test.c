/* fit_metric_test.c - the error of materials: its quadrature against known integrals and against a plain
 * grid of directions. */
#include <math.h>
#include <string.h>

#include "legacy/fit_test_support.h"
#include "ibl/ibl.h"
#include "legacy/classic_materials.h"

static const double pi = 3.14159265358979323846;
static const double view_rad[FIT_VIEWS] = {0.0, 0.52359877559829887308, 1.04719755119659774615};

/* ---- integrals ---- */

/* The weights sum to the integral of the cosine, pi, and with its powers to 2 pi / (n + 2). */
static void weights_sum_to_integrals_of_the_cosine(void **state)
{
    (void)state;
    for (int v = 0; v < FIT_VIEWS; v++)
        for (int n = 0; n < 4; n++) {
            double sum = 0.0;
            for (size_t i = correlated->node_begin[v]; i < correlated->node_begin[v + 1]; i++)
                sum += (double)correlated->weight[i] * pow((double)correlated->NdotL[i], n);
            assert_near(sum, 2.0 * pi / (n + 2), 1e-5);
        }
}

/* At normal incidence N.H is the cosine of half the light angle; with u = (N.H)^2 the integral of (N.H)^(2
 * s) N.L dL is 4 pi int u^s (2 u - 1) du from 1/2 to 1. */
static void highlights_have_their_integral(void **state)
{
    (void)state;
    static const double exponents[] = {0.0, 0.5, 1.0, 4.0, 50.0, 128.0, 1000.0, 1e4, 1e6, 1e8};
    float highlight[FIT_MAX_NODES];
    for (size_t e = 0; e < sizeof exponents / sizeof *exponents; e++) {
        double s = exponents[e];
        double exact =
            4.0 * pi * (2.0 * (1.0 - pow(0.5, s + 2.0)) / (s + 2.0) - (1.0 - pow(0.5, s + 1.0)) / (s + 1.0));
        double sum = 0.0;
        fit_highlight(correlated, (float)s, highlight);
        for (size_t i = 0; i < correlated->node_begin[1]; i++)
            sum += (double)correlated->weight[i] * (double)highlight[i] * (double)highlight[i];
        assert_near(sum / exact, 1.0, 2e-5);
    }
}

/* The lobe without Fresnel integrates to A + B of the split sum for any width, and never above 1. */
static void lobes_have_the_integral_of_the_split_sum(void **state)
{
    (void)state;
    float lobe[FIT_MAX_NODES];
    float bound[FIT_MAX_NODES];
    double worst = 0.0;
    for (int step = 0; step <= 40; step++) {
        float r = (float)step / 40.0f;
        fit_specular_lobe(correlated, r, lobe);
        fit_specular_lobe(separable, r, bound);
        for (int v = 0; v < FIT_VIEWS; v++) {
            double sum = 0.0;
            for (size_t i = correlated->node_begin[v]; i < correlated->node_begin[v + 1]; i++) {
                sum += (double)correlated->weight[i] * (double)lobe[i] / (pi * (double)correlated->NdotL[i]);
                assert_true(bound[i] <= lobe[i] * 1.00001f); /* separable masking hides more */
            }
            float dfg[2];
            ibl_dfg((float)cos(view_rad[v]), r, dfg);
            worst = fmax(worst, fabs(sum - (double)dfg[0] - (double)dfg[1]));
            assert_true(sum <= 1.0 + 1e-4);
        }
    }
    print_message("largest deviation of a lobe's albedo: %.2e\n", worst);
    assert_true(worst < 1e-3);
}

/* exp(s log N.H) against pow() in double. */
static void powers_agree_with_doubles(void **state)
{
    (void)state;
    float highlight[FIT_MAX_NODES];
    for (double s = 0.25; s < 1e7; s *= 3.0) {
        fit_highlight(correlated, (float)s, highlight);
        for (size_t i = 0; i < correlated->node_begin[FIT_VIEWS]; i++) {
            double sin_h = (double)correlated->sin_h[correlated->ring[i]];
            double exact = exp((double)(float)s * 0.5 * log1p(-sin_h * sin_h));
            assert_near(highlight[i], exact, 1e-6 + 3e-6 * exact);
        }
    }
}

/* ---- a plain grid ---- */

enum { GRID = 220 }; /* angles of light in a quarter turn, and azimuths in half a turn */

typedef struct grid_sums {
    double difference[FIT_VIEWS], source[FIT_VIEWS], difference_display, source_display;
} grid_sums;

static double clamped(double x)
{
    return fmin(fmax(x, 0.0), 1.0);
}

/* Midpoints of equal angles; radiance by the functions that plots call, one direction at a time. */
static grid_sums grid_of(const ogl1_surface *ogl1, const pbr_surface *pbr, pbr_masking masking,
                         fit_source from)
{
    grid_sums sums;
    memset(&sums, 0, sizeof sums);
    for (int v = 0; v < FIT_VIEWS; v++)
        for (int i = 0; i < GRID * GRID; i++) {
            double t = 0.5 * pi * (i / GRID + 0.5) / GRID;
            double p = pi * (i % GRID + 0.5) / GRID;
            float V[3] = {(float)sin(view_rad[v]), 0.0f, (float)cos(view_rad[v])};
            float L[3] = {(float)(sin(t) * cos(p)), (float)(sin(t) * sin(p)), (float)cos(t)};
            double w = pi * pi / GRID / GRID * sin(t) * cos(t);
            float old[3];
            float new[3];
            ogl1_radiance(ogl1, V, L, old);
            pbr_radiance(pbr, masking, V, L, new);
            for (int k = 0; k < 3; k++) {
                double T = (double)(from == FIT_FROM_OGL1 ? old[k] : new[k]);
                double M = (double)(from == FIT_FROM_OGL1 ? new[k] : old[k]);
                sums.difference[v] += w * (M - T) * (M - T);
                sums.source[v] += w * T * T;
                sums.difference_display += w * (clamped(M) - clamped(T)) * (clamped(M) - clamped(T));
                sums.source_display += w * clamped(T) * clamped(T);
            }
        }
    return sums;
}

static void compare_with_grid(const ogl1_surface *ogl1, const pbr_surface *pbr, const fit_metric *metric,
                              fit_source from)
{
    grid_sums sums = grid_of(ogl1, pbr, metric->masking, from);
    fit_error e = fit_compare(metric, ogl1, pbr, from);
    double difference = 0.0;
    double source = 0.0;
    for (int v = 0; v < FIT_VIEWS; v++) {
        assert_near(e.views[v], sqrt(sums.difference[v] / sums.source[v]), 2e-4);
        difference += sums.difference[v];
        source += sums.source[v];
    }
    assert_near(e.E, sqrt(difference / source), 1e-4);
    /* where radiance reaches 1 it has a kink, which Gauss's rule resolves to a part of a panel: up to 6e-4
     * here */
    assert_near(e.E_display, sqrt(sums.difference_display / sums.source_display), 1e-3);
}

/* Half of the classic materials by the naive formulas, and a strong colored lobe: the grid resolves these. */
static void errors_agree_with_a_plain_grid(void **state)
{
    (void)state;
    for (int i = 0; i < CLASSIC_COUNT; i += 2) {
        const ogl1_surface *ogl1 = &classic_materials[i].surface;
        pbr_surface pbr;
        if (ogl1->shininess > 100.0f)
            continue;
        ogl1_to_pbr_naive(ogl1, &pbr);
        compare_with_grid(ogl1, &pbr, correlated, FIT_FROM_OGL1);
        pbr.metallic = 0.4f;
        pbr.specular = 0.8f;
        pbr.ior = 0.0f;
        memcpy(pbr.specular_color, ogl1->specular, sizeof pbr.specular_color);
        compare_with_grid(ogl1, &pbr, i % 4 ? correlated : separable, FIT_FROM_PBR);
    }
}

/* ---- what the error means ---- */

static void equal_surfaces_have_no_error(void **state)
{
    (void)state;
    ogl1_surface matte = {{0.2f, 0.5f, 0.8f}, {0.0f, 0.0f, 0.0f}, 10.0f};
    pbr_surface pbr = pbr_surface_default();
    memcpy(pbr.base_color, matte.diffuse, sizeof matte.diffuse);
    pbr.specular = 0.0f;
    fit_error e = fit_compare(correlated, &matte, &pbr, FIT_FROM_OGL1);
    assert_near(e.E, 0.0, 1e-7);
    assert_near(e.E_display, 0.0, 1e-7);
}

/* Errors are relative: both radiances halved leave E as it is. Half the light is half of Cd and Cs, and of
 * base and F where base (1 - F) is linear in what is halved. */
static void errors_are_relative(void **state)
{
    (void)state;
    ogl1_surface ogl1 = {{0.3f, 0.2f, 0.1f}, {0.4f, 0.4f, 0.2f}, 20.0f};
    pbr_surface pbr = pbr_surface_default();
    pbr.ior = 0.0f;
    pbr.perceptual_roughness = 0.5f;
    pbr.specular = 0.2f;
    for (int k = 0; k < 3; k++)
        pbr.base_color[k] = ogl1.diffuse[k] / 0.8f;
    fit_error one = fit_compare(correlated, &ogl1, &pbr, FIT_FROM_OGL1);
    for (int k = 0; k < 3; k++) {
        ogl1.diffuse[k] *= 0.5f;
        ogl1.specular[k] *= 0.5f;
        pbr.base_color[k] *= 0.5f * 0.8f / 0.9f;
    }
    pbr.specular = 0.1f;
    fit_error half = fit_compare(correlated, &ogl1, &pbr, FIT_FROM_OGL1);
    assert_near(half.E, one.E, 1e-6);
    assert_near(half.views[2], one.views[2], 1e-6);
}

/* Black has no relative error: it counts as a thousandth of white. */
static void black_counts_as_a_thousandth_of_white(void **state)
{
    (void)state;
    ogl1_surface black = {{0.0f, 0.0f, 0.0f}, {0.0f, 0.0f, 0.0f}, 0.0f};
    pbr_surface pbr = pbr_surface_default();
    memset(pbr.base_color, 0, sizeof pbr.base_color);
    fit_error e = fit_compare(correlated, &black, &pbr, FIT_FROM_OGL1);
    assert_true(isfinite(e.E) && e.E > 1.0);
    pbr.specular = 0.0f;
    e = fit_compare(correlated, &black, &pbr, FIT_FROM_OGL1);
    assert_true(e.E == 0.0 && e.E_display == 0.0 && e.views[1] == 0.0);
    e = fit_compare(correlated, &black, &pbr, FIT_FROM_PBR);
    assert_true(e.E == 0.0);
}

static void *no_memory(void *user, size_t size)
{
    (void)user;
    (void)size;
    return NULL;
}
static void no_release(void *user, void *memory, size_t size)
{
    (void)user;
    (void)memory;
    (void)size;
}

static void failed_allocations_are_reported(void **state)
{
    (void)state;
    facet_allocator none = {.allocate = no_memory, .release = no_release};
    fit_metric *metric = correlated;
    facet_error error;
    assert_int_equal(fit_metric_create(&none, PBR_CORRELATED, &metric, &error), FACET_ERROR_MEMORY);
    assert_null(metric);
    fit_metric_destroy(NULL);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(weights_sum_to_integrals_of_the_cosine),
        cmocka_unit_test(highlights_have_their_integral),
        cmocka_unit_test(lobes_have_the_integral_of_the_split_sum),
        cmocka_unit_test(powers_agree_with_doubles),
        cmocka_unit_test(errors_agree_with_a_plain_grid),
        cmocka_unit_test(equal_surfaces_have_no_error),
        cmocka_unit_test(errors_are_relative),
        cmocka_unit_test(black_counts_as_a_thousandth_of_white),
        cmocka_unit_test(failed_allocations_are_reported),
    };
    return cmocka_run_group_tests(tests, fit_test_setup, fit_test_teardown);
}
