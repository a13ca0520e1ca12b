/* compare_test.c - errors of pixels, percentiles, SSIM, crops, masks, alpha, nonfinite pixels, failing
 * allocations. FLIP is in compare_flip_test.c. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "tests/support/support.h"
#include "base/memory.h"
#include "compare/compare.h"
#include "compare/compare_fixture.h"
#include "compare/compare_math.h"
#include "compare/compare_metrics.h"

static const facet_compare_desc errors_only = {.skipped_metrics = FACET_METRIC_SSIM | FACET_METRIC_FLIP};

/* ---- closed forms ---- */

/* An offset d everywhere: MSE d^2, MAE and bias d, PSNR -20 log10 d, every percentile d. In linear space
 * PSNR's peak is the largest value of a. */
static void an_offset_gives_known_errors(void **state)
{
    (void)state;
    fixture *a = fixture_create(50, 40, false), *b = fixture_create(50, 40, false);
    fixture_fill(a, 0.5f, 0.25f, 2.0f, 1.0f);
    fixture_fill(b, 0.75f, 0.5f, 2.25f, 1.0f);
    facet_comparison c = fixture_compare(a, b, &(facet_compare_desc){.percentile = 12.5});
    assert_true(c.space == FACET_COMPARE_SPACE_LINEAR && c.channel_count == 3 && c.pixel_count == 2000);
    assert_near(c.mse, 0.0625, 1e-15);
    assert_near(c.rmse, 0.25, 1e-15);
    assert_near(c.mae, 0.25, 1e-15);
    assert_near(c.bias, 0.25, 1e-15);
    assert_near(c.mse_relative, 0.0625 / 3.0 * (1.0 / 0.26 + 1.0 / 0.0725 + 1.0 / 4.01),
                1e-8); /* 0.01 as a float */
    assert_near(c.rmse_relative, sqrt(c.mse_relative), 1e-15);
    assert_near(c.nrmse, 0.25 / sqrt((0.25 + 0.0625 + 4.0) / 3.0), 1e-15);
    assert_near(c.peak, 2.0, 0.0);
    assert_near(c.psnr, 10.0 * log10(4.0 / 0.0625), 1e-12);
    assert_near(c.max_error, 0.25, 0.0);
    const double percentiles[] = {c.percentile_50, c.percentile_95, c.percentile_99, c.percentile_999,
                                  c.percentile};
    for (int i = 0; i < 5; i++)
        assert_near(percentiles[i], 0.25, 0.0);
    assert_true(c.differing_count == 2000 && c.differing_share == 1.0 && !c.is_equal);
    c = fixture_compare(b, a,
                        &(facet_compare_desc){.relative_epsilon = 1.0f, .peak = 1.0f, .threshold = 0.25f});
    assert_near(c.bias, -0.25, 1e-15);
    assert_near(c.mse_relative, 0.0625 / 3.0 * (1.0 / 1.5625 + 1.0 / 1.25 + 1.0 / 6.0625), 1e-12);
    assert_near(c.psnr, 10.0 * log10(1.0 / 0.0625), 1e-12);
    assert_true(c.differing_count == 0);
    free(a);
    free(b);
}

/* A code of 8 bits is 1/255 in display space: PSNR 48.13 dB. */
static void display_images_are_compared_in_codes(void **state)
{
    (void)state;
    fixture *a = fixture_create(256, 16, true), *b = fixture_create(256, 16, true);
    for (uint32_t y = 0; y < 16; y++)
        for (uint32_t x = 0; x < 256; x++)
            for (int k = 0; k < 3; k++) {
                fixture_at(a, x, y)[k] = (float)srgb_decode(x / 255.0);
                fixture_at(b, x, y)[k] = (float)srgb_decode((x < 255 ? x + 1 : x - 1) / 255.0);
            }
    facet_comparison c = fixture_compare(a, b, &errors_only);
    assert_true(c.space == FACET_COMPARE_SPACE_DISPLAY && c.peak == 1.0);
    assert_near(c.rmse * 255.0, 1.0, 1e-4);
    assert_near(c.max_error * 255.0, 1.0, 2e-4);
    assert_near(c.percentile_50 * 255.0, 1.0, 2e-4);
    assert_near(c.psnr, 20.0 * log10(255.0), 1e-3);
    free(a);
    free(b);
}

static void equal_images_have_no_error(void **state)
{
    (void)state;
    fixture *a = fixture_create(300, 30, false), *b = fixture_create(300, 30, false);
    fixture_draw(a, 3, 0.5f);
    memcpy(b->rgba, a->rgba, sizeof a->rgba);
    facet_comparison c = fixture_compare(a, b, &(facet_compare_desc){0});
    assert_true(c.is_equal && c.mse == 0.0 && c.mae == 0.0 && c.max_error == 0.0 && c.differing_count == 0);
    assert_true(isinf(c.psnr) && c.psnr > 0.0);
    assert_true(c.ssim == 1.0 && c.ssim_channels == 1.0 && c.flip == 0.0 && c.nrmse == 0.0);
    fixture_at(b, 299, 29)[2] = nextafterf(fixture_at(b, 299, 29)[2], 2.0f);
    c = fixture_compare(a, b, &(facet_compare_desc){0});
    assert_true(!c.is_equal && c.differing_count == 1 && c.max_x == 299 && c.max_y == 29 &&
                c.max_error > 0.0);
    free(a);
    free(b);
}

/* Percentiles against sorting, of pixels in random order. */
static int order(const void *a, const void *b)
{
    const float x = *(const float *)a, y = *(const float *)b;
    return (x > y) - (x < y);
}

static void percentiles_are_those_of_sorting(void **state)
{
    (void)state;
    enum { COUNT = 4321 };
    static float values[COUNT], sorted[COUNT];
    uint32_t random = 9;
    for (int i = 0; i < COUNT; i++)
        values[i] = i % 10 == 0 ? -1.0f : ldexpf(lcg_float(&random), i % 40 - 20);
    values[5] = INFINITY;
    values[6] = 0.0f;
    int count = 0;
    for (int i = 0; i < COUNT; i++)
        if (values[i] >= 0.0f)
            sorted[count++] = values[i];
    qsort(sorted, (size_t)count, sizeof *sorted, order);
    static const double shares[] = {0.001, 10.0, 50.0, 95.0, 99.0, 99.9, 99.99, 100.0};
    double got[8];
    assert_int_equal(compare_select(values, COUNT, shares, 8, NULL, got, NULL), FACET_OK);
    for (int i = 0; i < 8; i++) {
        int rank = (int)ceil(shares[i] / 100.0 * count - 1e-9);
        assert_true(got[i] == (double)sorted[rank < 1 ? 0 : rank - 1]);
    }
    assert_true(isinf(got[7]));
    /* 1 to 100: the 95th percentile is 95 */
    for (int i = 0; i < 100; i++)
        values[i] = (float)((i * 37) % 100 + 1);
    assert_int_equal(compare_select(values, 100, shares, 8, NULL, got, NULL), FACET_OK);
    assert_true(got[2] == 50.0 && got[3] == 95.0 && got[4] == 99.0 && got[5] == 100.0);
    assert_int_equal(compare_select(values, 0, shares, 8, NULL, got, NULL), FACET_OK);
    assert_true(got[0] == 0.0);
}

/* ---- SSIM ---- */

/* Equation 13 of Wang et al. 2004 window by window. */
static double slow_ssim(const fixture *a, const fixture *b, int channel, double peak)
{
    const double luma[3] = {0.2126, 0.7152, 0.0722}, c1 = pow(0.01 * peak, 2.0), c2 = pow(0.03 * peak, 2.0);
    const int width = (int)a->texels.width, height = (int)a->texels.height;
    double total = 0.0, window[11][11], sum = 0.0;
    for (int j = 0; j < 11; j++)
        for (int i = 0; i < 11; i++)
            sum += window[j][i] = exp(-((i - 5) * (i - 5) + (j - 5) * (j - 5)) / 4.5);
    for (int y = 5; y < height - 5; y++)
        for (int x = 5; x < width - 5; x++) {
            double values[2][121], means[2] = {0, 0}, variances[2] = {0, 0}, covariance = 0.0;
            for (int k = 0; k < 121; k++)
                for (int p = 0; p < 2; p++) {
                    const float *pixel = (p ? b : a)->rgba + 4 * ((y + k / 11 - 5) * width + x + k % 11 - 5);
                    values[p][k] = 0.0;
                    for (int c = 0; c < 3; c++)
                        values[p][k] += (channel < 0 ? luma[c] : c == channel ? 1.0 : 0.0) * (double)pixel[c];
                    means[p] += window[k / 11][k % 11] / sum * values[p][k];
                }
            for (int k = 0; k < 121; k++) {
                double weight = window[k / 11][k % 11] / sum, da = values[0][k] - means[0],
                       db = values[1][k] - means[1];
                variances[0] += weight * da * da;
                variances[1] += weight * db * db;
                covariance += weight * da * db;
            }
            total += (2.0 * means[0] * means[1] + c1) * (2.0 * covariance + c2) /
                     ((means[0] * means[0] + means[1] * means[1] + c1) * (variances[0] + variances[1] + c2));
        }
    return total / ((width - 10) * (height - 10));
}

static void ssim_is_that_of_every_window(void **state)
{
    (void)state;
    const facet_compare_desc desc = {.skipped_metrics = FACET_METRIC_FLIP, .peak = 1.0f};
    for (int i = 0; i < 3; i++) {
        fixture *a = fixture_create(i == 2 ? 11 : 150, i == 2 ? 11 : 80, false),
                *b = fixture_create(a->texels.width, a->texels.height, false);
        fixture_draw(a, 0, 0.0f);
        fixture_draw(b, 4, i ? 0.5f : 0.1f);
        facet_comparison c = fixture_compare(a, b, &desc);
        assert_near(c.ssim, slow_ssim(a, b, -1, 1.0), 1e-7); /* weights of luminance as floats or not */
        double channels = 0.0;
        for (int k = 0; k < 3; k++)
            channels += slow_ssim(a, b, k, 1.0) / 3.0;
        assert_near(c.ssim_channels, channels, 1e-11);
        assert_true(c.ssim < 0.999);
        c = fixture_compare(a, b, &(facet_compare_desc){.skipped_metrics = FACET_METRIC_FLIP, .peak = 3.0f});
        assert_near(c.ssim, slow_ssim(a, b, -1, 3.0), 1e-7);
        free(a);
        free(b);
    }
}

/* Of two constants only the means are compared: (2 m n + C1) / (m^2 + n^2 + C1). */
static void ssim_of_constants_is_that_of_their_means(void **state)
{
    (void)state;
    fixture *a = fixture_create(20, 20, false), *b = fixture_create(20, 20, false);
    fixture_fill(a, 0.4f, 0.4f, 0.4f, 1.0f);
    fixture_fill(b, 0.6f, 0.6f, 0.6f, 1.0f);
    facet_comparison c = fixture_compare(a, b, &(facet_compare_desc){.peak = 1.0f});
    assert_near(c.ssim, (2.0 * 0.24 + 1e-4) / (0.16 + 0.36 + 1e-4), 1e-6);
    free(a);
    free(b);
    a = fixture_create(10, 30, false); /* too narrow for a window */
    b = fixture_create(10, 30, false);
    c = fixture_compare(a, b, &(facet_compare_desc){0});
    assert_true(isnan(c.ssim) && isnan(c.ssim_channels) && c.flip == 0.0);
    free(a);
    free(b);
}

/* ---- the compared pixels ---- */

static void only_the_crop_counts(void **state)
{
    (void)state;
    fixture *a = fixture_create(60, 50, false), *b = fixture_create(60, 50, false);
    fixture_draw(a, 0, 0.0f);
    fixture_draw(b, 0, 0.0f);
    fixture_at(b, 10, 12)[1] += 0.5f;
    facet_compare_desc desc = {.crop = {11, 12, 20, 20}};
    facet_comparison c = fixture_compare(a, b, &desc);
    assert_true(c.is_equal && c.flip == 0.0 && c.ssim == 1.0 && c.width == 20 && c.pixel_count == 400);
    desc.crop[0] = 10;
    c = fixture_compare(a, b, &desc);
    assert_true(!c.is_equal && c.flip > 0.0 && c.max_x == 10 && c.max_y == 12 && c.differing_count == 1);
    static const uint32_t wrong[][4] = {
        {0, 0, 61, 1}, {60, 0, 1, 1}, {5, 5, 0, 5}, {1, 45, 5, 6}, {2, 2, UINT32_MAX, 1}};
    for (int i = 0; i < 5; i++) {
        memcpy(desc.crop, wrong[i], sizeof desc.crop);
        facet_error error;
        assert_int_equal(compare_images(&a->image, &b->image, NULL, &desc, &c, NULL, &error),
                         FACET_ERROR_ARGUMENT);
    }
    free(a);
    free(b);
}

/* Masked pixels affect no metric, not through filters either; means are over the unmasked pixels. */
static void hidden_pixels_do_not_count(void **state)
{
    (void)state;
    fixture *a = fixture_create(200, 90, false), *b = fixture_create(200, 90, false),
            *m = fixture_create(200, 90, true);
    fixture_draw(a, 0, 0.0f);
    fixture_draw(b, 0, 0.0f);
    for (uint32_t y = 0; y < 90; y++)
        for (uint32_t x = 0; x < 200; x++) {
            bool is_hidden = x >= 50 && x < 100;
            for (int k = 0; k < 3; k++)
                fixture_at(m, x, y)[k] = is_hidden ? 0.2f : 0.22f; /* sRGB 0.5 is 0.214 */
            if (is_hidden)
                fixture_at(b, x, y)[0] = NAN;
        }
    facet_comparison c;
    facet_error error;
    assert_int_equal(compare_images(&a->image, &b->image, &m->image, NULL, &c, NULL, &error), FACET_OK);
    assert_true(c.is_equal && c.mse == 0.0 && c.flip == 0.0 && c.ssim == 1.0 && c.nonfinite_b == 0);
    assert_int_equal(c.pixel_count, 150 * 90);
    fixture_at(b, 0, 0)[1] += 0.5f;
    assert_int_equal(compare_images(&a->image, &b->image, &m->image, NULL, &c, NULL, &error), FACET_OK);
    assert_near(c.mse, 0.25 / (150 * 90 * 3), 1e-9);
    assert_near(c.differing_share, 1.0 / (150 * 90), 1e-15);
    fixture_fill(m, 0.0f, 0.0f, 0.0f, 1.0f);
    assert_int_equal(compare_images(&a->image, &b->image, &m->image, NULL, &c, NULL, &error),
                     FACET_ERROR_ARGUMENT);
    assert_non_null(strstr(error.message, "mask"));
    m->texels.width = 199;
    assert_int_equal(compare_images(&a->image, &b->image, &m->image, NULL, &c, NULL, &error),
                     FACET_ERROR_ARGUMENT);
    assert_non_null(strstr(error.message, "199 x 90"));
    free(a);
    free(b);
    free(m);
}

static void opacity_is_compared_where_an_image_has_it(void **state)
{
    (void)state;
    fixture *a = fixture_create(20, 20, false), *b = fixture_create(20, 20, false);
    fixture_fill(a, 0.2f, 0.2f, 0.2f, 0.5f);
    fixture_fill(b, 0.2f, 0.2f, 0.2f, 0.75f);
    facet_comparison c = fixture_compare(a, b, &errors_only);
    assert_true(c.channel_count == 4);
    assert_near(c.mse, 0.0625 / 4.0, 1e-12);
    facet_compare_desc desc = errors_only;
    desc.alpha = FACET_COMPARE_ALPHA_IGNORE;
    c = fixture_compare(a, b, &desc);
    assert_true(c.channel_count == 3 && c.mse == 0.0 && !c.is_equal);
    desc.alpha = FACET_COMPARE_ALPHA_BACKGROUND; /* 0.2 + 0.5 * 0.8 and 0.2 + 0.25 * 0.8 */
    desc.background[0] = desc.background[1] = desc.background[2] = 0.8f;
    c = fixture_compare(a, b, &desc);
    assert_near(c.rmse, 0.2, 1e-6);
    free(a);
    free(b);
}

/* Radiance is exposed and tone-mapped, a display-referred image is not; both are compared in display
 * values. */
static void radiance_is_compared_with_display_images(void **state)
{
    (void)state;
    fixture *light = fixture_create(20, 20, false), *shown = fixture_create(20, 20, true);
    fixture_fill(light, 3.0f, 0.5f, 0.25f, 1.0f);
    fixture_fill(shown, 0.75f, 0.3333333f, 0.2f, 1.0f); /* Reinhard's c / (1 + c) */
    facet_compare_desc desc = {.tonemap = FACET_TONEMAP_REINHARD};
    facet_comparison c = fixture_compare(light, shown, &desc);
    assert_true(c.space == FACET_COMPARE_SPACE_DISPLAY && !c.is_flip_hdr);
    assert_near(c.max_error, 0.0, 1e-6);
    fixture_fill(light, 1.5f, 0.25f, 0.125f, 1.0f);
    desc.exposure_ev = 1.0f;
    assert_near(fixture_compare(light, shown, &desc).max_error, 0.0, 1e-6);
    assert_near(fixture_compare(shown, light, &desc).max_error, 0.0, 1e-6);
    desc.tonemap = FACET_TONEMAP_NONE; /* clamped: 1, 0.5, 0.25 */
    c = fixture_compare(light, shown, &desc);
    assert_true(c.space == FACET_COMPARE_SPACE_DISPLAY);
    assert_near(c.max_error, srgb_encode(0.5) - srgb_encode(1.0 / 3.0), 1e-6);
    fixture_fill(light, 0.75f, 0.3333333f, 0.2f, 1.0f); /* as it is, in linear space */
    c = fixture_compare(light, shown, &(facet_compare_desc){.space = FACET_COMPARE_SPACE_LINEAR});
    assert_true(c.space == FACET_COMPARE_SPACE_LINEAR && c.max_error == 0.0 && c.is_flip_hdr);
    free(light);
    free(shown);
}

/* ---- nonfinite pixels ---- */

static void nonfinite_pixels_are_reported_and_left_out(void **state)
{
    (void)state;
    fixture *a = fixture_create(40, 40, false), *b = fixture_create(40, 40, false);
    fixture_draw(a, 0, 0.0f);
    fixture_draw(b, 0, 0.0f);
    fixture_at(b, 20, 21)[1] = NAN;
    fixture_at(b, 5, 5)[0] = INFINITY;
    fixture_at(a, 30, 30)[0] = fixture_at(b, 30, 30)[0] = INFINITY; /* the same in both: equal */
    facet_comparison c = fixture_compare(a, b, &(facet_compare_desc){0});
    assert_true(c.nonfinite_a == 1 && c.nonfinite_b == 3 && c.invalid_count == 2);
    assert_true(c.differing_count == 2 && isinf(c.max_error) && c.mse == 0.0 && c.ssim == 1.0);
    assert_near(c.flip, 2.0 / 1600.0, 1e-9); /* and nothing around them */
    assert_true(!c.is_equal && c.max_x == 5 && c.max_y == 5);
    fixture_fill(b, NAN, NAN, NAN, NAN);
    fixture_fill(a, 0.0f, 0.0f, 0.0f, 1.0f);
    c = fixture_compare(a, b, &(facet_compare_desc){0});
    assert_true(isnan(c.mse) && isnan(c.psnr) && c.flip == 1.0 && c.invalid_count == 1600);
    fixture_fill(a, NAN, NAN, NAN, NAN);
    c = fixture_compare(a, b, &(facet_compare_desc){0});
    assert_true(c.is_equal && c.mse == 0.0 && c.flip == 0.0 && c.invalid_count == 0 && c.nonfinite_a == 1600);
    free(a);
    free(b);
}

/* ---- threads, memory, arguments ---- */

static void assert_same_results(const facet_comparison *a, const facet_comparison *b)
{
    const double first[] = {a->mse,           a->mse_relative,   a->nrmse,         a->mae,
                            a->bias,          a->max_error,      a->percentile_50, a->percentile_95,
                            a->percentile_99, a->percentile_999, a->percentile,    a->peak,
                            a->psnr,          a->ssim,           a->ssim_channels, a->flip,
                            a->flip_max,      a->flip_start_ev,  a->flip_stop_ev};
    const double second[] = {b->mse,           b->mse_relative,   b->nrmse,         b->mae,
                             b->bias,          b->max_error,      b->percentile_50, b->percentile_95,
                             b->percentile_99, b->percentile_999, b->percentile,    b->peak,
                             b->psnr,          b->ssim,           b->ssim_channels, b->flip,
                             b->flip_max,      b->flip_start_ev,  b->flip_stop_ev};
    assert_memory_equal(first, second, sizeof first);
    assert_true(a->differing_count == b->differing_count && a->max_x == b->max_x && a->max_y == b->max_y);
    assert_int_equal(a->flip_exposure_count, b->flip_exposure_count);
}

/* Images that are compared as their files have them give the bits that they give as linear, premultiplied
 * floats. */
static void integers_are_compared_as_floats_are(void **state)
{
    (void)state;
    static const struct {
        image_type type;
        uint32_t channel_count;
        bool is_srgb;
    } kinds[] = {{IMAGE_U8, 1, true},   {IMAGE_U8, 2, true},   {IMAGE_U8, 3, true},  {IMAGE_U8, 4, true},
                 {IMAGE_U8, 3, false},  {IMAGE_U16, 2, true},  {IMAGE_U16, 4, true}, {IMAGE_U16, 3, false},
                 {IMAGE_F16, 4, false}, {IMAGE_F32, 3, false}, {IMAGE_F32, 4, false}};
    for (size_t k = 0; k < sizeof kinds / sizeof *kinds; k++) {
        image files[2], floats[2];
        compare_image own[2], converted[2];
        uint32_t seed = 9;
        const bool has_alpha = kinds[k].channel_count % 2 == 0;
        for (int side = 0; side < 2; side++) {
            image noise;
            assert_int_equal(image_create(NULL, 301, 40, 4, IMAGE_F32, &noise, NULL), FACET_OK);
            for (size_t i = 0; i < (size_t)301 * 40 * 4; i++)
                ((float *)noise.pixels)[i] = lcg_float(&seed);
            if (kinds[k].channel_count < 3) {
                noise.channel_count = kinds[k].channel_count; /* fewer of the random numbers */
            }
            assert_int_equal(image_convert(&noise, NULL, 1, kinds[k].channel_count, kinds[k].type,
                                           kinds[k].is_srgb, &files[side], NULL),
                             FACET_OK);
            assert_int_equal(image_convert(&files[side], NULL, 1, 4, IMAGE_F32, false, &floats[side], NULL),
                             FACET_OK);
            float *p = floats[side].pixels;
            for (size_t i = 0; i < (size_t)301 * 40 && has_alpha; i++)
                for (int c = 0; c < 3; c++)
                    p[4 * i + (size_t)c] *= p[4 * i + 3];
            own[side] = (compare_image){&files[side], has_alpha, kinds[k].is_srgb};
            converted[side] = (compare_image){&floats[side], false, kinds[k].is_srgb};
            image_destroy(&noise);
        }
        const facet_compare_desc desc = {.crop = {3, 1, 290, 37}};
        facet_comparison c[2];
        /* the second image is its own mask */
        assert_int_equal(compare_images(&own[0], &own[1], &own[1], &desc, &c[0], NULL, NULL), FACET_OK);
        assert_int_equal(
            compare_images(&converted[0], &converted[1], &converted[1], &desc, &c[1], NULL, NULL), FACET_OK);
        assert_true(c[0].mse > 0.0 && c[0].pixel_count > 100 && c[0].pixel_count < 290 * 37);
        assert_same_results(&c[0], &c[1]);
        assert_int_equal(compare_images(&own[0], &converted[0], NULL, &desc, &c[0], NULL, NULL), FACET_OK);
        assert_true(c[0].is_equal);
        for (int side = 0; side < 2; side++) {
            image_destroy(&files[side]);
            image_destroy(&floats[side]);
        }
    }
}

static void results_do_not_depend_on_threads(void **state)
{
    (void)state;
    fixture *a = fixture_create(310, 190, false), *b = fixture_create(310, 190, false);
    fixture_draw(a, 0, 0.0f);
    fixture_draw(b, 8, 0.7f);
    fixture_at(b, 100, 100)[3] = 0.5f;
    facet_comparison first = {0}, c;
    image heat[2] = {{0}, {0}};
    for (uint32_t threads = 1; threads < 6; threads++) {
        facet_compare_desc desc = {.thread_count = threads,
                                   .difference = FACET_DIFFERENCE_HEAT_MAP,
                                   .is_sheet = true,
                                   .percentile = 33.0};
        assert_int_equal(compare_images(&a->image, &b->image, NULL, &desc, &c, &heat[threads > 1], NULL),
                         FACET_OK);
        if (threads == 1) {
            first = c;
            continue;
        }
        assert_same_results(&c, &first);
        assert_memory_equal(heat[0].pixels, heat[1].pixels, 3 * 310 * 190 * 4 * sizeof(float));
        mem_free(heat[1].pixels);
    }
    mem_free(heat[0].pixels);
    free(a);
    free(b);
}

static void running_out_of_memory_leaks_nothing(void **state)
{
    (void)state;
    fixture *a = fixture_create(40, 40, false), *b = fixture_create(40, 40, false);
    fixture_draw(b, 8, 0.7f);
    long calls = 1;
    for (long at = -1; at < calls; at++) {
        failing_allocator memory = {.fail_at = at};
        facet_compare_desc desc = {.allocator = failing_allocator_get(&memory), .thread_count = 1};
        facet_comparison c;
        image difference;
        facet_error error = {0};
        facet_result result = compare_images(&a->image, &b->image, NULL, &desc, &c, &difference, &error);
        if (at < 0) {
            calls = atomic_load(&memory.calls);
            assert_true(calls > 6 && result == FACET_OK && c.flip > 0.0);
        } else {
            assert_int_equal(result, FACET_ERROR_MEMORY);
            assert_non_null(strstr(error.message, "memory"));
            assert_true(!difference.pixels && c.width == 0);
        }
        mem_free(difference.pixels);
        assert_int_equal(atomic_load(&memory.blocks), 0);
    }
    free(a);
    free(b);
}

static void invalid_arguments_are_refused(void **state)
{
    (void)state;
    fixture *a = fixture_create(40, 40, false), *b = fixture_create(40, 41, false);
    facet_comparison c;
    facet_error error;
    assert_int_equal(compare_images(&a->image, &b->image, NULL, NULL, &c, NULL, &error),
                     FACET_ERROR_ARGUMENT);
    assert_string_equal(error.message,
                        "compare: the images are of different sizes, 40 x 40 and 40 x 41 pixels");
    const facet_compare_desc wrong[] = {{.pixels_per_degree = 0.5f},
                                        {.pixels_per_degree = NAN},
                                        {.percentile = 101.0},
                                        {.percentile = (double)NAN},
                                        {.threshold = -1.0f},
                                        {.threshold = NAN},
                                        {.gain = INFINITY},
                                        {.relative_epsilon = -1.0f},
                                        {.peak = NAN},
                                        {.space = (facet_compare_space)7},
                                        {.exposure_ev = NAN},
                                        {.space = FACET_COMPARE_SPACE_LINEAR, .tonemap = FACET_TONEMAP_ACES},
                                        {.alpha = (facet_compare_alpha)9}};
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++)
        assert_int_equal(compare_images(&a->image, &a->image, NULL, &wrong[i], &c, NULL, &error),
                         FACET_ERROR_ARGUMENT);
    free(a);
    free(b);
}

/* ---- images ---- */

static void the_difference_image_holds_the_errors(void **state)
{
    (void)state;
    fixture *a = fixture_create(30, 20, true), *b = fixture_create(30, 20, true);
    fixture_fill(a, (float)srgb_decode(0.5), 0.0f, 0.0f, 1.0f);
    fixture_fill(b, (float)srgb_decode(0.4), 1.0f, 0.0f, 1.0f);
    facet_comparison c;
    image d;
    facet_compare_desc desc = {.gain = 3.0f, .is_sheet = true};
    assert_int_equal(compare_images(&a->image, &b->image, NULL, &desc, &c, &d, NULL), FACET_OK);
    assert_true(d.width == 90 && d.height == 20);
    const float *row = (const float *)d.pixels + 4 * 90 * 7;
    assert_near(row[4 * 3], srgb_decode(0.5), 1e-6); /* a */
    assert_near(row[4 * 33 + 1], 1.0, 1e-6);         /* b */
    assert_near(srgb_encode((double)row[4 * 63]), 0.3, 1e-5);
    assert_near(row[4 * 63 + 1], 1.0, 0.0);
    assert_true(row[4 * 63 + 2] == 0.0f && row[4 * 63 + 3] == 1.0f);
    mem_free(d.pixels);
    desc = (facet_compare_desc){.difference = FACET_DIFFERENCE_HEAT_MAP};
    assert_int_equal(compare_images(&a->image, &b->image, NULL, &desc, &c, &d, NULL), FACET_OK);
    float wanted[3];
    compare_magma((float)c.flip_max, wanted);
    double best = 1.0;
    for (int i = 0; i < 600; i++)
        best = fmin(best, fabs(srgb_encode((double)((const float *)d.pixels)[4 * i]) - (double)wanted[0]));
    assert_near(best, 0.0, 1e-5);
    mem_free(d.pixels);
    a->image.is_display = b->image.is_display = false; /* linear: as they are, also above 1 */
    fixture_at(b, 1, 0)[0] = 9.0f;
    desc = (facet_compare_desc){.gain = 0.5f};
    assert_int_equal(compare_images(&a->image, &b->image, NULL, &desc, &c, &d, NULL), FACET_OK);
    assert_near(((const float *)d.pixels)[4], (9.0 - srgb_decode(0.5)) / 2.0, 1e-6);
    mem_free(d.pixels);
    free(a);
    free(b);
}

/* From dark to light, each step brighter than the last. */
static void the_color_map_rises_in_lightness(void **state)
{
    (void)state;
    float last = -1.0f, color[3];
    for (int i = 0; i <= 1000; i++) {
        compare_magma((float)i / 1000.0f, color);
        float luma = 0.2126f * color[0] + 0.7152f * color[1] + 0.0722f * color[2];
        assert_true(luma > last && luma <= 1.0f);
        last = luma;
    }
    compare_magma(NAN, color);
    assert_true(color[2] < 0.02f);
    compare_magma(5.0f, color);
    assert_near(color[1], 0.991, 1e-6);
}

static void powers_are_those_of_libm(void **state)
{
    (void)state;
    for (double x = 1e-6; x < 1e6; x *= 1.00137)
        for (int i = 0; i < 3; i++) {
            const double y = i == 0 ? 1.0 / 3.0 : i == 1 ? 0.7 : 1.0 / 2.4;
            const double wanted = pow((double)(float)x, (double)(float)y);
            assert_near((double)compare_pow((float)x, (float)y) / wanted, 1.0, 1e-6);
        }
    for (int i = 0; i <= 65535; i++) {
        const double x = i / 65535.0;
        assert_near((double)compare_srgb_encode((float)x), srgb_encode((double)(float)x), 3e-7);
        assert_near((double)compare_srgb_decode((float)x), srgb_decode((double)(float)x), 5e-7);
    }
    assert_true(compare_pow(0.0f, 0.5f) == 0.0f && compare_pow(1.0f, 0.7f) == 1.0f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(an_offset_gives_known_errors),
        cmocka_unit_test(display_images_are_compared_in_codes),
        cmocka_unit_test(equal_images_have_no_error),
        cmocka_unit_test(percentiles_are_those_of_sorting),
        cmocka_unit_test(ssim_is_that_of_every_window),
        cmocka_unit_test(ssim_of_constants_is_that_of_their_means),
        cmocka_unit_test(only_the_crop_counts),
        cmocka_unit_test(hidden_pixels_do_not_count),
        cmocka_unit_test(opacity_is_compared_where_an_image_has_it),
        cmocka_unit_test(radiance_is_compared_with_display_images),
        cmocka_unit_test(nonfinite_pixels_are_reported_and_left_out),
        cmocka_unit_test(integers_are_compared_as_floats_are),
        cmocka_unit_test(results_do_not_depend_on_threads),
        cmocka_unit_test(running_out_of_memory_leaks_nothing),
        cmocka_unit_test(invalid_arguments_are_refused),
        cmocka_unit_test(the_difference_image_holds_the_errors),
        cmocka_unit_test(the_color_map_rises_in_lightness),
        cmocka_unit_test(powers_are_those_of_libm),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
