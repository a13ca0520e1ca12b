/* compare_flip_test.c - FLIP: its properties, and the same written down again as the papers have it: in
 * double, with filters in two dimensions, without tiles. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "compare/compare_fixture.h"

static const facet_compare_desc flip_only = {.skipped_metrics = FACET_METRIC_SSIM};

/* ---- the reference ---- */

#define REFERENCE_PI 3.14159265358979323846

typedef struct triple {
    double c[3];
} triple;

/* Matrix and white of the paper's program. */
static triple xyz_from_rgb(triple v)
{
    static const double m[3][3] = {
        {10135552.0 / 24577794.0, 8788810.0 / 24577794.0, 4435075.0 / 24577794.0},
        {2613072.0 / 12288897.0, 8788810.0 / 12288897.0, 887015.0 / 12288897.0},
        {1425312.0 / 73733382.0, 8788810.0 / 73733382.0, 70074185.0 / 73733382.0},
    };
    triple out;
    for (int i = 0; i < 3; i++)
        out.c[i] = m[i][0] * v.c[0] + m[i][1] * v.c[1] + m[i][2] * v.c[2];
    return out;
}

static triple rgb_from_xyz(triple v)
{
    static const double m[3][3] = {{3.241003275, -1.537398934, -0.498615861},
                                   {-0.969224334, 1.875930071, 0.041554224},
                                   {0.055639423, -0.204011202, 1.057148933}};
    triple out;
    for (int i = 0; i < 3; i++)
        out.c[i] = m[i][0] * v.c[0] + m[i][1] * v.c[1] + m[i][2] * v.c[2];
    return out;
}

static const double white[3] = {0.950428545, 1.0, 1.088900371};

static triple ycxcz_from_rgb(triple v)
{
    v = xyz_from_rgb(v);
    for (int i = 0; i < 3; i++)
        v.c[i] /= white[i];
    return (triple){{116.0 * v.c[1] - 16.0, 500.0 * (v.c[0] - v.c[1]), 200.0 * (v.c[1] - v.c[2])}};
}

static triple rgb_from_ycxcz(triple v)
{
    double y = (v.c[0] + 16.0) / 116.0;
    triple xyz = {{(y + v.c[1] / 500.0) * white[0], y, (y - v.c[2] / 200.0) * white[2]}};
    return rgb_from_xyz(xyz);
}

static triple hunt_lab_from_rgb(triple v)
{
    v = xyz_from_rgb(v);
    for (int i = 0; i < 3; i++) {
        double t = v.c[i] / white[i];
        v.c[i] = t > pow(6.0 / 29.0, 3.0) ? cbrt(t) : t / (3.0 * pow(6.0 / 29.0, 2.0)) + 4.0 / 29.0;
    }
    double l = 116.0 * v.c[1] - 16.0;
    return (triple){{l, 0.01 * l * 500.0 * (v.c[0] - v.c[1]), 0.01 * l * 200.0 * (v.c[1] - v.c[2])}};
}

static double hyab(triple a, triple b)
{
    return fabs(a.c[0] - b.c[0]) + hypot(a.c[1] - b.c[1], a.c[2] - b.c[2]);
}

typedef struct plane {
    int width, height;
    triple *at;
} plane;

static triple pixel_of(const plane *p, int x, int y)
{
    x = x < 0 ? 0 : x >= p->width ? p->width - 1 : x;
    y = y < 0 ? 0 : y >= p->height ? p->height - 1 : y;
    return p->at[y * p->width + x];
}

/* The clamped color at (x, y) after the contrast sensitivity filters, as Hunt-adjusted L*a*b*. */
static triple filtered(const plane *p, double ppd, int x, int y)
{
    static const double a1[3] = {1.0, 1.0, 34.1}, b1[3] = {0.0047, 0.0053, 0.04}, a2[3] = {0.0, 0.0, 13.5},
                        b2[3] = {1e-5, 1e-5, 0.025};
    int radius = (int)ceil(3.0 * sqrt(0.04 / (2.0 * REFERENCE_PI * REFERENCE_PI)) * ppd);
    triple sum = {{0.0, 0.0, 0.0}}, weights = {{0.0, 0.0, 0.0}};
    for (int j = -radius; j <= radius; j++)
        for (int i = -radius; i <= radius; i++) {
            double r2 = (i * i + j * j) / (ppd * ppd), pi2 = REFERENCE_PI * REFERENCE_PI;
            triple v = pixel_of(p, x + i, y + j);
            for (int c = 0; c < 3; c++) {
                double weight = a1[c] * sqrt(REFERENCE_PI / b1[c]) * exp(-pi2 * r2 / b1[c]) +
                                a2[c] * sqrt(REFERENCE_PI / b2[c]) * exp(-pi2 * r2 / b2[c]);
                sum.c[c] += weight * v.c[c];
                weights.c[c] += weight;
            }
        }
    for (int c = 0; c < 3; c++)
        sum.c[c] /= weights.c[c];
    sum = rgb_from_ycxcz(sum);
    for (int c = 0; c < 3; c++)
        sum.c[c] = fmin(fmax(sum.c[c], 0.0), 1.0);
    return hunt_lab_from_rgb(sum);
}

/* The strength of an edge (order 1) or a point (2) at (x, y). */
static double feature(const plane *p, double ppd, int order, int x, int y)
{
    double sd = 0.5 * 0.082 * ppd, positive = 0.0, negative = 0.0, sums[2][2] = {{0.0, 0.0}, {0.0, 0.0}};
    int radius = (int)ceil(3.0 * sd);
    for (int j = -radius; j <= radius; j++)
        for (int i = -radius; i <= radius; i++) {
            double g = exp(-(i * i + j * j) / (2.0 * sd * sd));
            double weight = order == 1 ? -i * g : (i * i / (sd * sd) - 1.0) * g;
            double along_x = (pixel_of(p, x + i, y + j).c[0] + 16.0) / 116.0;
            double along_y = (pixel_of(p, x + j, y + i).c[0] + 16.0) / 116.0;
            positive += weight > 0.0 ? weight : 0.0;
            negative -= weight < 0.0 ? weight : 0.0;
            sums[0][weight > 0.0] += weight * along_x;
            sums[1][weight > 0.0] += weight * along_y;
        }
    return hypot(sums[0][0] / negative + sums[0][1] / positive,
                 sums[1][0] / negative + sums[1][1] / positive);
}

/* Linear colors of a display to the mean error. map: of each pixel, or NULL. */
static double reference_flip(const plane *a, const plane *b, double ppd, double *map)
{
    double largest =
        pow(hyab(hunt_lab_from_rgb((triple){{0, 1, 0}}), hunt_lab_from_rgb((triple){{0, 0, 1}})), 0.7);
    double total = 0.0;
    for (int y = 0; y < a->height; y++)
        for (int x = 0; x < a->width; x++) {
            double color = pow(hyab(filtered(a, ppd, x, y), filtered(b, ppd, x, y)), 0.7),
                   knee = 0.4 * largest;
            color = color < knee ? 0.95 / knee * color : 0.95 + (color - knee) / (largest - knee) * 0.05;
            double edges = fabs(feature(a, ppd, 1, x, y) - feature(b, ppd, 1, x, y));
            double points = fabs(feature(a, ppd, 2, x, y) - feature(b, ppd, 2, x, y));
            double error = pow(color, 1.0 - sqrt(fmax(edges, points) / sqrt(2.0)));
            total += error;
            if (map)
                map[y * a->width + x] = fmax(map[y * a->width + x], error);
        }
    return total / (a->width * a->height);
}

static plane plane_of(const fixture *f, double gain, bool is_mapped)
{
    plane p = {(int)f->texels.width, (int)f->texels.height, NULL};
    p.at = malloc((size_t)p.width * (size_t)p.height * sizeof *p.at);
    assert_non_null(p.at);
    for (int i = 0; i < p.width * p.height; i++) {
        triple v;
        for (int c = 0; c < 3; c++) {
            double x = (double)f->rgba[4 * i + c] * gain,
                   s = 0.6 * x; /* Narkowicz without the factor that he has */
            v.c[c] = is_mapped ? s * (2.51 * s + 0.03) / (s * (2.43 * s + 0.59) + 0.14) : x;
            v.c[c] = fmin(fmax(v.c[c], 0.0), 1.0);
        }
        p.at[i] = ycxcz_from_rgb(v);
    }
    return p;
}

/* ---- tests ---- */

static void agrees_with_a_direct_implementation_of_the_paper(void **state)
{
    (void)state;
    static const float ppds[] = {67.0f, 20.0f, 5.0f, 100.0f};
    fixture *a = fixture_create(147, 75, true),
            *b = fixture_create(147, 75, true); /* more than a tile each way */
    fixture_draw(a, 0, 0.0f);
    fixture_draw(b, 7, 0.4f);
    for (uint32_t x = 100; x < 140; x++) /* a line that only one has */
        memset(fixture_at(b, x, 50), 0, 3 * sizeof(float));
    plane pa = plane_of(a, 1.0, false), pb = plane_of(b, 1.0, false);
    for (int i = 0; i < 4; i++) {
        facet_comparison c = fixture_compare(
            a, b, &(facet_compare_desc){.skipped_metrics = FACET_METRIC_SSIM, .pixels_per_degree = ppds[i]});
        double *map = calloc(147 * 75, sizeof *map);
        assert_non_null(map);
        double wanted = reference_flip(&pa, &pb, (double)ppds[i], map), largest = 0.0;
        for (int k = 0; k < 147 * 75; k++)
            largest = fmax(largest, map[k]);
        assert_near(c.flip, wanted, 2e-6);
        assert_near(c.flip_max, largest, 1e-5);
        assert_true(c.flip > 0.05 && !c.is_flip_hdr);
        free(map);
    }
    free(pa.at);
    free(pb.at);
    free(a);
    free(b);
}

static void radiance_is_compared_over_exposures(void **state)
{
    (void)state;
    enum { WIDTH = 60, HEIGHT = 40 };
    fixture *a = fixture_create(WIDTH, HEIGHT, false), *b = fixture_create(WIDTH, HEIGHT, false);
    fixture_draw(a, 0, 0.0f);
    fixture_draw(b, 3, 0.2f);
    for (uint32_t x = 0; x < 10; x++) { /* small lights, one of them dimmer in b */
        for (int k = 0; k < 3; k++) {
            fixture_at(a, 5 + x, 20)[k] = 40.0f;
            fixture_at(b, 5 + x, 20)[k] = 20.0f;
        }
    }
    facet_comparison c = fixture_compare(a, b, &flip_only);
    assert_true(c.is_flip_hdr);
    double luminance[WIDTH * HEIGHT], sorted[WIDTH * HEIGHT], largest = 0.0;
    for (int i = 0; i < WIDTH * HEIGHT; i++) {
        luminance[i] = 0.2126 * (double)a->rgba[4 * i] + 0.7152 * (double)a->rgba[4 * i + 1] +
                       0.0722 * (double)a->rgba[4 * i + 2];
        largest = fmax(largest, luminance[i]);
        int k = i;
        for (; k > 0 && sorted[k - 1] > luminance[i]; k--)
            sorted[k] = sorted[k - 1];
        sorted[k] = luminance[i];
    }
    /* the larger root of (0.9036 - 0.85 * 0.8748) x^2 + (0.018 - 0.85 * 0.354) x - 0.85 * 0.14 */
    double p = (0.018 - 0.85 * 0.354) / (0.9036 - 0.85 * 0.8748), q = -0.85 * 0.14 / (0.9036 - 0.85 * 0.8748);
    double bright = -p / 2.0 + sqrt(p * p / 4.0 - q);
    double start = log2(bright / largest), stop = log2(bright / sorted[WIDTH * HEIGHT / 2 - 1]);
    int count = (int)fmax(2.0, ceil(stop - start));
    assert_near(c.flip_start_ev, start, 1e-5);
    assert_near(c.flip_stop_ev, stop, 1e-5);
    assert_int_equal(c.flip_exposure_count, count);
    double *map = calloc(WIDTH * HEIGHT, sizeof *map), mean = 0.0;
    assert_non_null(map);
    for (int e = 0; e < count; e++) {
        double gain = exp2(start + (stop - start) * e / (count - 1));
        plane pa = plane_of(a, gain, true), pb = plane_of(b, gain, true);
        reference_flip(&pa, &pb, 67.0, map);
        free(pa.at);
        free(pb.at);
    }
    for (int i = 0; i < WIDTH * HEIGHT; i++)
        mean += map[i] / (WIDTH * HEIGHT);
    assert_near(c.flip, mean, 5e-6);
    free(map);
    free(a);
    free(b);
}

/* Where nothing varies there are no features, and the error is that of the colors. Black and white: HyAB
 * 100; green and blue: the largest there is. The second derivative of a constant is 1e-7, that of weights
 * rounded to float, of which the root of features makes 3e-4: hence 1e-5. */
static void large_areas_differ_by_their_colors(void **state)
{
    (void)state;
    fixture *a = fixture_create(64, 64, true), *b = fixture_create(64, 64, true);
    fixture_fill(b, 1.0f, 1.0f, 1.0f, 1.0f);
    const double knee = 0.4 * 41.276098414595445;
    assert_near(fixture_compare(a, b, &flip_only).flip, 0.95 + (pow(100.0, 0.7) - knee) / (1.5 * knee) * 0.05,
                1e-5);
    fixture_fill(a, 0.0f, 1.0f, 0.0f, 1.0f);
    fixture_fill(b, 0.0f, 0.0f, 1.0f, 1.0f);
    assert_near(fixture_compare(a, b, &flip_only).flip, 1.0, 2e-6);
    /* L* of Y = 0.2 and 0.21 are 51.8372 and 52.9479: 0.95 / knee * 1.1107^0.7 */
    fixture_fill(a, 0.2f, 0.2f, 0.2f, 1.0f);
    fixture_fill(b, 0.21f, 0.21f, 0.21f, 1.0f);
    assert_near(fixture_compare(a, b, &flip_only).flip,
                0.95 / knee * pow(116.0 * (cbrt(0.21) - cbrt(0.2)), 0.7), 1e-5);
    free(a);
    free(b);
}

static void equal_images_give_zero_and_order_does_not_matter(void **state)
{
    (void)state;
    for (int is_display = 0; is_display < 2; is_display++) {
        fixture *a = fixture_create(150, 70, is_display), *b = fixture_create(150, 70, is_display);
        fixture_draw(a, 1, 0.3f);
        memcpy(b->rgba, a->rgba, sizeof a->rgba);
        facet_comparison c = fixture_compare(a, b, &flip_only);
        assert_true(c.flip == 0.0 && c.flip_max == 0.0);
        fixture_draw(b, 2, 0.3f);
        double forth = fixture_compare(a, b, &flip_only).flip, back = fixture_compare(b, a, &flip_only).flip;
        assert_true(forth > 0.01);
        if (is_display) /* for radiance, exposures are chosen from the first image */
            assert_true(forth == back);
        free(a);
        free(b);
    }
}

/* More noise is more error; a pattern too fine for the eye gives a smaller error than a coarse one. */
static void noise_raises_and_fine_detail_lowers_errors(void **state)
{
    (void)state;
    fixture *a = fixture_create(128, 128, true), *b = fixture_create(128, 128, true);
    double last = 0.0;
    for (int i = 1; i < 5; i++) {
        fixture_draw(a, 0, 0.0f);
        fixture_draw(b, 5, 0.1f * (float)i);
        double flip = fixture_compare(a, b, &flip_only).flip;
        assert_true(flip > last);
        last = flip;
    }
    double flips[2];
    for (int i = 0; i < 2; i++) {
        fixture_fill(a, 0.2f, 0.2f, 0.2f, 1.0f);
        for (uint32_t y = 0; y < 128; y++)
            for (uint32_t x = 0; x < 128; x++) {
                uint32_t size = i ? 32 : 1;
                float grey = (x / size + y / size) % 2 ? 0.22f : 0.18f;
                for (int k = 0; k < 3; k++)
                    fixture_at(b, x, y)[k] = grey;
            }
        flips[i] = fixture_compare(a, b, &flip_only).flip;
    }
    assert_true(flips[0] < 0.25 * flips[1]);
    /* the same seen from twice as near is worse */
    fixture_draw(a, 0, 0.0f);
    fixture_draw(b, 5, 0.3f);
    assert_true(fixture_compare(a, b, &(facet_compare_desc){.pixels_per_degree = 30.0f}).flip >
                fixture_compare(a, b, &(facet_compare_desc){.pixels_per_degree = 120.0f}).flip);
    free(a);
    free(b);
}

/* Opaque black and full transparency differ over a bright background only. */
static void opacity_shows_over_white(void **state)
{
    (void)state;
    fixture *a = fixture_create(64, 64, true), *b = fixture_create(64, 64, true);
    fixture_fill(a, 0.0f, 0.0f, 0.0f, 1.0f);
    fixture_fill(b, 0.0f, 0.0f, 0.0f, 0.0f);
    facet_comparison c = fixture_compare(a, b, &(facet_compare_desc){0});
    assert_int_equal(c.channel_count, 4);
    assert_near(c.flip, 0.96738, 1e-5);
    assert_true(c.ssim < 0.01);
    c = fixture_compare(a, b, &(facet_compare_desc){.alpha = FACET_COMPARE_ALPHA_IGNORE});
    assert_true(c.channel_count == 3 && c.flip == 0.0 && c.ssim == 1.0);
    free(a);
    free(b);
}

static void extreme_radiance_gives_finite_errors(void **state)
{
    (void)state;
    static const float lights[] = {0.0f, 1e-30f, 1e-3f, 1e30f, 3e38f, -1.0f};
    fixture *a = fixture_create(32, 32, false), *b = fixture_create(32, 32, false);
    for (int i = 0; i < 6; i++)
        for (int k = 0; k < 6; k++) {
            fixture_fill(a, lights[i], lights[i], lights[i], 1.0f);
            fixture_fill(b, lights[k], lights[k], lights[k], 1.0f);
            memset(a->rgba, 0, 16 * sizeof(float)); /* some black */
            facet_comparison c = fixture_compare(a, b, &(facet_compare_desc){0});
            assert_true(c.flip >= 0.0 && c.flip <= 1.0);
            assert_true(c.flip_exposure_count >= 2 && c.flip_exposure_count <= 32);
        }
    free(a);
    free(b);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(agrees_with_a_direct_implementation_of_the_paper),
        cmocka_unit_test(radiance_is_compared_over_exposures),
        cmocka_unit_test(large_areas_differ_by_their_colors),
        cmocka_unit_test(equal_images_give_zero_and_order_does_not_matter),
        cmocka_unit_test(noise_raises_and_fine_detail_lowers_errors),
        cmocka_unit_test(opacity_shows_over_white),
        cmocka_unit_test(extreme_radiance_gives_finite_errors),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
