/* primaries_test.c - matrices beside those that others publish; primaries that do not form a color space. */
#include "image/image_test.h"

#include <math.h>

#include "image/primaries.h"

static const primaries ap0 = {{{0.7347, 0.2653}, {0.0, 1.0}, {0.0001, -0.077}, {0.32168, 0.33767}}};
static const primaries ap1 = {{{0.713, 0.293}, {0.165, 0.830}, {0.128, 0.044}, {0.32168, 0.33767}}};
static const primaries rec2020 = {{{0.708, 0.292}, {0.170, 0.797}, {0.131, 0.046}, {0.3127, 0.3290}}};
static const primaries rec709 = {{{0.64, 0.33}, {0.30, 0.60}, {0.15, 0.06}, {0.3127, 0.3290}}};
static const primaries xyz = {{{1, 0}, {0, 1}, {0, 0}, {1.0 / 3, 1.0 / 3}}};
static const primaries cie_rgb = {{{0.7347, 0.2653}, {0.2738, 0.7174}, {0.1666, 0.0089}, {1.0 / 3, 1.0 / 3}}};

static void expect_matrix(const primaries *p, double expected[3][3], double tolerance)
{
    double m[3][3];
    assert_true(primaries_to_rec709(p, m));
    for (int i = 0; i < 9; i++)
        if (!(fabs(m[i / 3][i % 3] - expected[i / 3][i % 3]) <= tolerance))
            fail_msg("[%d][%d] is %.8f, %.8f was expected", i / 3, i % 3, m[i / 3][i % 3],
                     expected[i / 3][i % 3]);
}

/* AP0 and AP1: the matrices of the ACES configurations of OpenColorIO, to their digits. Rec.2020:
 * Recommendation ITU-R BT.2407-0, section 2. XYZ: IEC 61966-2-1, whose rounded matrix is 2e-3 off the
 * exact one. */
static void matrices_equal_published_ones(void **state)
{
    (void)state;
    expect_matrix(&ap0,
                  (double[3][3]){{2.52168618674388, -1.13413098823972, -0.387555198504164},
                                 {-0.276479914229922, 1.37271908766826, -0.096239173438334},
                                 {-0.0153780649660342, -0.152975335867399, 1.16835340083343}},
                  2e-5);
    expect_matrix(&ap1,
                  (double[3][3]){{1.70505, -0.62179, -0.08326},
                                 {-0.13026, 1.14080, -0.01055},
                                 {-0.02400, -0.12897, 1.15297}},
                  2e-5);
    expect_matrix(
        &rec2020,
        (double[3][3]){{1.6605, -0.5876, -0.0728}, {-0.1246, 1.1329, -0.0083}, {-0.0182, -0.1006, 1.1187}},
        6e-5);
    expect_matrix(
        &xyz,
        (double[3][3]){{3.2406, -1.5372, -0.4986}, {-0.9689, 1.8758, 0.0415}, {0.0557, -0.2040, 1.0570}},
        5e-4);
    expect_matrix(&rec709, (double[3][3]){{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, 1e-12);
}

static void white_stays_white(void **state)
{
    (void)state;
    const primaries *const spaces[] = {&ap0, &ap1, &rec2020, &cie_rgb};
    for (int k = 0; k < 4; k++) {
        double m[3][3];
        assert_true(primaries_to_rec709(spaces[k], m));
        for (int i = 0; i < 3; i++)
            assert_true(fabs(m[i][0] + m[i][1] + m[i][2] - 1.0) < 1e-12);
    }
}

static image make_texels(float texels[4][3])
{
    image i;
    assert_int_equal(image_create(NULL, 4, 1, 3, IMAGE_F32, &i, NULL), FACET_OK);
    memcpy(i.pixels, texels, 4 * 3 * sizeof(float));
    return i;
}

/* Colors outside of Rec.709 are kept or clamped to 0; nonfinite values are kept. */
static void images_are_converted(void **state)
{
    (void)state;
    float texels[4][3] = {{1, 1, 1}, {0, 1, 0}, {NAN, 1, 2}, {0, -1, 0}};
    for (int clips = 0; clips < 2; clips++) {
        image i = make_texels(texels);
        image_note note = {0};
        primaries_convert(
            &i, &rec2020,
            &(image_decode_desc){
                .note = &note, .keeps_nonfinite = true, .clips_gamut = clips != 0, .thread_count = 1});
        const float *p = i.pixels;
        for (int c = 0; c < 3; c++)
            assert_float_equal(p[c], 1.0f, 1e-6f);
        assert_float_equal(p[3], (clips ? 0.0f : -0.5876f), 1e-4f);
        assert_float_equal(p[4], 1.1329f, 1e-4f);
        assert_true(isnan(p[6]) && p[7] == 1.0f && p[8] == 2.0f);
        assert_float_equal(p[10], -1.1329f, 1e-4f);
        assert_int_equal(note.level, FACET_LOG_LEVEL_DETAIL);
        assert_non_null(strstr(note.text, "Rec.2020"));
        image_destroy(&i);
    }
}

static void invalid_primaries_are_a_warning(void **state)
{
    (void)state;
    const primaries bad[] = {
        {{{0}}},
        {{{0.64, 0.33}, {0.30, 0.60}, {0.15, 0.06}, {0.3127, 0.0}}},
        {{{0.64, 0.33}, {0.30, 0.60}, {0.15, 0.06}, {0.05, 0.9}}}, /* white outside */
        {{{0.1, 0.1}, {0.2, 0.2}, {0.3, 0.3}, {0.3127, 0.3290}}},  /* on a line */
        {{{0.64, 0.33}, {0.64, 0.33}, {0.15, 0.06}, {0.3127, 0.3290}}},
        {{{(double)NAN, 0.33}, {0.30, 0.60}, {0.15, 0.06}, {0.3127, 0.3290}}},
        {{{1e30, 0.33}, {0.30, 1e30}, {0.15, 0.06}, {0.3127, 0.3290}}},
        {{{0.64, 0.33}, {0.30, 0.60}, {0.15, 0.06}, {(double)INFINITY, 0.3290}}},
    };
    for (size_t k = 0; k < sizeof bad / sizeof *bad; k++) {
        float texels[4][3] = {{1, 2, 3}};
        image i = make_texels(texels);
        image_note note = {0};
        primaries_convert(&i, &bad[k], &(image_decode_desc){.note = &note, .thread_count = 1});
        assert_memory_equal(i.pixels, texels, sizeof texels);
        assert_int_equal(note.level, FACET_LOG_LEVEL_WARNING);
        assert_non_null(strstr(note.text, "do not form a color space"));
        image_destroy(&i);
    }
    float texels[4][3] = {{1, 2, 3}};
    image i = make_texels(texels);
    image_note note = {0};
    primaries_convert(&i, &rec709, &(image_decode_desc){.note = &note, .thread_count = 1});
    assert_memory_equal(i.pixels, texels, sizeof texels);
    assert_int_equal(note.text[0], 0);
    image_destroy(&i);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(matrices_equal_published_ones),
        cmocka_unit_test(white_stays_white),
        cmocka_unit_test(images_are_converted),
        cmocka_unit_test(invalid_primaries_are_a_warning),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
