/* iridescence_test.c - the thin film: published numbers, limits, and an independent evaluation in double. */
#include "testing/test_support.h"

/* Thin film of ior 1.3, computed by an independent program, which uses a matrix rounded to fewer digits. */
static void test_golden_numbers(void **state)
{
    (void)state;
    const struct {
        float cosine, thickness;
        double dielectric[3], metal[3];
    } golden[] = {
        {1.0f,
         100.0f,
         {0.0031660346, 0.0044575098, 0.0075683282},
         {0.9998328673, 0.6408668247, 0.1683917821}},
        {1.0f,
         400.0f,
         {0.0074564730, 0.0383517167, 0.0160382121},
         {0.9998482571, 0.7635074617, 0.2167357728}},
        {1.0f,
         800.0f,
         {0.0000000000, 0.0288740094, 0.0163783005},
         {0.9998263863, 0.7329553799, 0.2169049057}},
        {0.7f,
         100.0f,
         {0.0119413507, 0.0091285641, 0.0061327512},
         {0.9998497190, 0.6530881168, 0.1472061616}},
        {0.7f,
         400.0f,
         {0.0005728744, 0.0103862458, 0.0414613109},
         {0.9998205143, 0.6601048774, 0.3346378188}},
        {0.7f,
         800.0f,
         {0.0475934589, 0.0236591602, 0.0290050348},
         {0.9999117364, 0.7063907571, 0.2714871437}},
        {0.3f,
         100.0f,
         {0.1793330879, 0.1614399278, 0.1395030691},
         {0.9999079526, 0.6789594873, 0.1301029505}},
        {0.3f, 400.0f, {0.2611544252, 0.1646628848, 0.1333522029}, {1.0, 0.6854133841, 0.0926930759}},
        {0.3f,
         800.0f,
         {0.1434371184, 0.1558134531, 0.2218016355},
         {0.9997990078, 0.6200097687, 0.4935331698}}};
    for (size_t i = 0; i < COUNT_OF(golden); ++i) {
        vec3 d = F_iridescent(1.3f, golden[i].thickness, vec3(0.04f), golden[i].cosine);
        vec3 m = F_iridescent(1.3f, golden[i].thickness, vec3(1.0f, 0.766f, 0.336f), golden[i].cosine);
        for (int c = 0; c < 3; ++c) {
            expect_near((double)d[c], golden[i].dielectric[c], 2e-5, "dielectric, row %zu channel %d", i, c);
            expect_near((double)m[c], golden[i].metal[c], 1e-4, "metal, row %zu channel %d", i, c);
        }
    }
}

/* ---- the same formula in double, one channel at a time and term by term ---- */

static double schlick(double R0, double cosine)
{
    return R0 + (1.0 - R0) * pow(1.0 - cosine, 5.0);
}
static double sensitivity_xyz(int axis, double path_m, double shift)
{
    const double pi = 3.14159265358979323846;
    static const double val[3] = {5.4856e-13, 4.4201e-13, 5.2481e-13},
                        pos[3] = {1.6810e6, 1.7953e6, 2.2084e6}, var[3] = {4.3278e9, 9.3046e9, 6.6121e9};
    double phase = 2.0 * pi * path_m;
    double s = val[axis] * sqrt(2.0 * pi * var[axis]) * cos(pos[axis] * phase + shift) *
               exp(-phase * phase * var[axis]);
    if (axis == 0)
        s += 9.7470e-14 * sqrt(2.0 * pi * 4.5282e9) * cos(2.2399e6 * phase + shift) *
             exp(-4.5282e9 * phase * phase);
    return s / 1.0685e-7;
}
static void reference(double film, double nm, const double F0[3], double cosine, double out[3])
{
    static const double to_rgb[3][3] = {{3.2409699419, -1.5373831776, -0.4986107603},
                                        {-0.9692436363, 1.8759675015, 0.0415550574},
                                        {0.0556300797, -0.2039769589, 1.0569715142}};
    const double pi = 3.14159265358979323846;
    double cos2 = sqrt(1.0 - (1.0 - cosine * cosine) / (film * film));
    double R12 = schlick(pow((film - 1.0) / (film + 1.0), 2.0), cosine), T = 1.0 - R12;
    double shift[3], R123[3], Rs[3];
    for (int c = 0; c < 3; ++c) {
        double root = sqrt(F0[c]), n3 = (1.0 + root) / (1.0 - root);
        double R23 = schlick(pow((n3 - film) / (n3 + film), 2.0), cos2);
        shift[c] = pi + (n3 < film ? pi : 0.0);
        R123[c] = R12 * R23;
        Rs[c] = T * T * R23 / (1.0 - R123[c]);
    }
    for (int c = 0; c < 3; ++c) {
        out[c] = R12 + Rs[c];
        for (int m = 1; m <= 2; ++m)
            for (int axis = 0; axis < 3; ++axis) /* each axis has the shift of its channel */
                out[c] += (Rs[c] - T) * pow(R123[c], 0.5 * m) * 2.0 * to_rgb[c][axis] *
                          sensitivity_xyz(axis, m * 2.0 * film * nm * 1e-9 * cos2, m * shift[axis]);
        out[c] = fmin(fmax(out[c], 0.0), 1.0);
    }
}
static void test_against_double(void **state)
{
    (void)state;
    test_rng rng = {77};
    for (int i = 0; i < 20000; ++i) {
        float film = 1.05f + 1.5f * rng_float(&rng), nm = 0.1f + 900.0f * rng_float(&rng);
        float cosine = 0.05f + 0.95f * rng_float(&rng);
        vec3 F0 = rng_color(&rng) * 0.95f;
        double wide[3] = {(double)F0[0], (double)F0[1], (double)F0[2]}, expected[3];
        reference((double)film, (double)nm, wide, (double)cosine, expected);
        vec3 F = F_iridescent(film, nm, F0, cosine);
        for (int c = 0; c < 3; ++c) {
            float n3 = film_base_ior(F0)[c];
            if (fabsf(n3 - film) > 1e-5f) /* else rounding decides the sign of a reflection of nearly 0 */
                expect_near((double)F[c], expected[c], 3e-5, "film %g, %g nm, cos %g, channel %d",
                            (double)film, (double)nm, (double)cosine, c);
        }
    }
}

/* ---- limits ---- */

/* No film without thickness; nor, at normal incidence, with the index of air or of the base. */
static void test_no_film(void **state)
{
    (void)state;
    const float cosines[] = {1.0f, 0.7f, 0.3f, 0.05f};
    vec3 F0 = vec3(0.04f, 0.3f, 0.8f);
    for (size_t i = 0; i < COUNT_OF(cosines); ++i) {
        vec3 plain = F_Schlick(F0, vec3(1.0f), cosines[i]);
        vec3 none = F_iridescent(1.7f, 0.0f, F0, cosines[i]);
        for (int c = 0; c < 3; ++c)
            assert_true(none[c] == plain[c]);
    }
    vec3 air = F_iridescent(1.0f, 400.0f, F0, 1.0f);
    for (int c = 0; c < 3; ++c)
        expect_near((double)air[c], (double)F0[c], 2e-6, "film of air");
    expect_near((double)F_iridescent(1.5f, 400.0f, vec3(0.04f), 1.0f)[1], 0.04, 1e-5,
                "film of the base's glass");
}

/* The film fades in without a step, and a thick one is colorless: its orders overlap. */
static void test_thickness(void **state)
{
    (void)state;
    vec3 F0 = vec3(0.04f);
    vec3 before = F_iridescent(1.4f, 0.0f, F0, 0.8f);
    for (int i = 1; i <= 1000; ++i) {
        vec3 F = F_iridescent(1.4f, (float)i * 1e-4f, F0, 0.8f);
        assert_true(fabsf(F[0] - before[0]) < 2e-3f && fabsf(F[2] - before[2]) < 2e-3f);
        before = F;
    }
    vec3 thick = F_iridescent(1.4f, 50000.0f, vec3(0.3f), 0.8f);
    expect_near((double)(thick[0] - thick[2]), 0.0, 1e-5, "gray");
}

static void test_range(void **state)
{
    (void)state;
    test_rng rng = {5};
    for (int i = 0; i < 300000; ++i) {
        float film = 1.0f + 2.0f * rng_float(&rng) * rng_float(&rng), nm = 3000.0f * rng_float(&rng);
        if (i % 16 == 0)
            film = 0.5f + rng_float(&rng);
        if (i % 7 == 0)
            nm = 0.05f * rng_float(&rng);
        vec3 F0 = i % 5 == 0 ? vec3(0.0f, 1.0f, 0.5f) : rng_color(&rng);
        vec3 F = F_iridescent(film, nm, F0, i % 3 == 0 ? 0.0f : rng_float(&rng));
        for (int c = 0; c < 3; ++c)
            assert_true(F[c] >= 0.0f && F[c] <= 1.0f);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_golden_numbers),
                                       cmocka_unit_test(test_against_double), cmocka_unit_test(test_no_film),
                                       cmocka_unit_test(test_thickness), cmocka_unit_test(test_range)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
