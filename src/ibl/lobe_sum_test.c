/* lobe_sum_test.c - sums over blocks against sums over all texels in double, and against what is known exactly. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "base/near_test.h"
#include "ibl/equirect.h"
#include "ibl/lobe_sum.h"

static const double pi = 3.14159265358979323846;

/* A sky over ground, a lamp, and a sun of one texel. */
static image make_picture(uint32_t width, uint32_t height, float sun)
{
    image i;
    assert_int_equal(image_create(NULL, width, height, 3, IMAGE_F32, &i, NULL), FACET_OK);
    for (uint32_t y = 0; y < height; y++)
        for (uint32_t x = 0; x < width; x++) {
            float d[3];
            equirect_direction(width, height, x, y, d);
            float *p = (float *)i.pixels + 3 * (y * width + x);
            p[0] = d[1] > 0.0f ? 0.4f + 0.2f * d[0] : 0.2f;
            p[1] = d[1] > 0.0f ? 0.5f : 0.15f;
            p[2] = d[1] > 0.0f ? 0.8f : 0.1f;
            if (d[0] > 0.8f && d[1] > 0.2f && d[1] < 0.5f)
                p[0] = p[1] = p[2] = 30.0f;
        }
    float *p = (float *)i.pixels + 3 * ((height / 3) * width + width / 7);
    p[0] = p[1] = p[2] = sun;
    return i;
}

static double weight(facet_lobe lobe, double roughness, double x)
{
    double alpha = roughness * roughness;
    double NdotH2 = 0.5 + 0.5 * x;
    if (lobe == FACET_LOBE_LAMBERT)
        return x;
    if (lobe == FACET_LOBE_CHARLIE)
        return pow(1.0 - NdotH2, 0.5 / alpha) * x;
    double t = NdotH2 * (alpha * alpha - 1.0) + 1.0;
    return x / (t * t);
}

static void sum_texels(const image *i, facet_lobe lobe, double roughness, const float axis[3], double out[3])
{
    double sum[3] = {0.0, 0.0, 0.0};
    double whole = 0.0;
    for (uint32_t y = 0; y < i->height; y++)
        for (uint32_t x = 0; x < i->width; x++) {
            float d[3];
            equirect_direction(i->width, i->height, x, y, d);
            double cosine = (double)d[0] * (double)axis[0] + (double)d[1] * (double)axis[1] +
                            (double)d[2] * (double)axis[2];
            if (cosine <= 0.0)
                continue;
            double w = weight(lobe, roughness, fmin(cosine, 1.0)) *
                       equirect_texel_solid_angle(i->width, i->height, y);
            whole += w;
            for (int c = 0; c < 3; c++)
                sum[c] += w * (double)((const float *)i->pixels)[3 * (y * i->width + x) + (uint32_t)c];
        }
    for (int c = 0; c < 3; c++)
        out[c] = sum[c] / whole;
}

enum { AXES = 10 };

static void make_axis(int n, float out[3])
{
    double y = 1.0 - 2.0 * (n + 0.5) / AXES;
    double phi = 2.399963 * n;
    out[0] = (float)(sqrt(1.0 - y * y) * cos(phi));
    out[1] = (float)y;
    out[2] = (float)(sqrt(1.0 - y * y) * sin(phi));
}

static void test_sums_over_texels(void **state)
{
    (void)state;
    static const struct {
        facet_lobe lobe;
        float roughness;
    } lobes[] = {{FACET_LOBE_GGX, 0.15f},    {FACET_LOBE_GGX, 0.3f},     {FACET_LOBE_GGX, 0.5f},
                 {FACET_LOBE_GGX, 0.75f},    {FACET_LOBE_GGX, 1.0f},     {FACET_LOBE_CHARLIE, 0.3f},
                 {FACET_LOBE_CHARLIE, 0.6f}, {FACET_LOBE_CHARLIE, 1.0f}, {FACET_LOBE_LAMBERT, 1.0f}};
    image picture = make_picture(1024, 512, 5e4f);
    lobe_sum s;
    assert_int_equal(lobe_sum_create(&picture, INFINITY, NULL, 0, &s, NULL), FACET_OK);
    for (size_t k = 0; k < sizeof lobes / sizeof *lobes; k++) {
        lobe_plan plan;
        lobe_plan_make(&s, lobes[k].lobe, lobes[k].roughness, &plan);
        double error = 0.0;
        double reference = 0.0;
        for (int n = 0; n < AXES; n++) {
            float axis[3], got[3];
            double want[3];
            make_axis(n, axis);
            lobe_plan_gather(&plan, axis, got);
            sum_texels(&picture, lobes[k].lobe, (double)lobes[k].roughness, axis, want);
            for (int c = 0; c < 3; c++) {
                error += ((double)got[c] - want[c]) * ((double)got[c] - want[c]);
                reference += want[c] * want[c];
            }
        }
        double relative = sqrt(error / reference);
        print_message("lobe %d, roughness %.2f: RMS error %.1e\n", (int)lobes[k].lobe,
                      (double)lobes[k].roughness, relative);
        assert_true(relative < 2e-3);
    }
    lobe_sum_destroy(&s);
    image_destroy(&picture);
}

/* Uniform light stays, whatever the lobe and the resolution. */
static void test_constant(void **state)
{
    (void)state;
    static const uint32_t sizes[3][2] = {{1024, 512}, {200, 100}, {2500, 20}};
    for (int n = 0; n < 3; n++) {
        image picture;
        assert_int_equal(image_create(NULL, sizes[n][0], sizes[n][1], 3, IMAGE_F32, &picture, NULL),
                         FACET_OK);
        for (uint32_t k = 0; k < sizes[n][0] * sizes[n][1] * 3; k++)
            ((float *)picture.pixels)[k] = 3.0f;
        lobe_sum s;
        assert_int_equal(lobe_sum_create(&picture, 2.0f, NULL, 3, &s, NULL), FACET_OK);
        assert_true(s.levels[0].width <= LOBE_SUM_MAX_WIDTH);
        for (int lobe = 0; lobe < 3; lobe++) {
            lobe_plan plan;
            lobe_plan_make(&s, (facet_lobe)lobe, 0.6f, &plan);
            for (int k = 0; k < AXES; k++) {
                float axis[3], got[3];
                make_axis(k, axis);
                lobe_plan_gather(&plan, axis, got);
                /* 20 rows are 9 degrees high each: their edge is not that of the horizon */
                assert_near(got[1], 2.0, n == 2 ? 0.05 : 2e-3);
            }
        }
        lobe_sum_destroy(&s);
        image_destroy(&picture);
    }
}

/* A sun alone is the lobe: its flank 4000 times below the peak, across the fade from small blocks to large ones, the seam of
 * the picture, and beyond the horizon. */
static void test_sun_is_the_lobe(void **state)
{
    (void)state;
    const uint32_t width = 1024;
    const uint32_t height = 512;
    image picture;
    assert_int_equal(image_create(NULL, width, height, 3, IMAGE_F32, &picture, NULL), FACET_OK);
    static const uint32_t suns[3][2] = {{700, 200}, {0, 300}, {1023, 30}};
    for (int n = 0; n < 3; n++) {
        memset(picture.pixels, 0, image_row_size(&picture) * height);
        float *p = (float *)picture.pixels + 3 * (suns[n][1] * width + suns[n][0]);
        p[0] = p[1] = p[2] = 1e5f;
        double energy = 1e5 * equirect_texel_solid_angle(width, height, suns[n][1]);
        lobe_sum s;
        assert_int_equal(lobe_sum_create(&picture, INFINITY, NULL, 2, &s, NULL), FACET_OK);
        lobe_plan plan;
        const double alpha = 0.2 * 0.2;
        lobe_plan_make(&s, FACET_LOBE_GGX, 0.2f, &plan);
        assert_true(plan.near != plan.far);
        /* integral of D N.l / 4 = m0, the mean of N.l over normals of density D N.h, in double */
        double m0 = 0.0;
        for (int k = 0; k < 200000; k++) {
            double u = (k + 0.5) / 200000;
            m0 += fmax(2.0 * (1.0 - u) / (1.0 + (alpha * alpha - 1.0) * u) - 1.0, 0.0) / 200000;
        }
        float d[3];
        equirect_direction(width, height, suns[n][0], suns[n][1], d);
        float side[3] = {-d[2], 0.0f, d[0]};
        float length = sqrtf(side[0] * side[0] + side[2] * side[2]);
        for (int k = 0; k < 60; k++) {
            double angle = 0.03 * k;
            float axis[3];
            for (int c = 0; c < 3; c++)
                axis[c] = (float)(cos(angle) * (double)d[c] + sin(angle) * (double)(side[c] / length));
            float got[3];
            lobe_plan_gather(&plan, axis, got);
            double x = cos(angle);
            double t = (0.5 + 0.5 * x) * (alpha * alpha - 1.0) + 1.0;
            double want = x > 0.0 ? energy * alpha * alpha / (pi * t * t) * x / (4.0 * m0) : 0.0;
            assert_near(got[2], want, 2e-3 * want + 1e-9 * energy);
        }
        lobe_sum_destroy(&s);
    }
    image_destroy(&picture);
}

static void test_threads_do_not_matter(void **state)
{
    (void)state;
    image picture = make_picture(150, 75, 1e3f);
    lobe_sum a, b;
    assert_int_equal(lobe_sum_create(&picture, 100.0f, NULL, 1, &a, NULL), FACET_OK);
    assert_int_equal(lobe_sum_create(&picture, 100.0f, NULL, 5, &b, NULL), FACET_OK);
    for (uint32_t level = 0; level < a.level_count; level++)
        assert_memory_equal(a.levels[level].direction[0], b.levels[level].direction[0],
                            (size_t)a.levels[level].width * a.levels[level].height * 6 * sizeof(float));
    lobe_sum_destroy(&a);
    lobe_sum_destroy(&b);
    image_destroy(&picture);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_sums_over_texels),
        cmocka_unit_test(test_constant),
        cmocka_unit_test(test_sun_is_the_lobe),
        cmocka_unit_test(test_threads_do_not_matter),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
