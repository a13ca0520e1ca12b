/* transmission_test.c - refraction, rough boundaries and thin walls: Snell, published albedos, samplers
 * over the whole sphere, reciprocity. */
#include "testing/chi_square.h"

static const vec3 up = {0.0f, 0.0f, 1.0f};

static void test_snell(void **state)
{
    (void)state;
    /* 45 degrees into water, by Snell's law */
    vec3 t = refract_or_zero(normalize(vec3(1.0f, 0.0f, -1.0f)), up, 1.33f);
    expect_near((double)t[0], 0.5316592340, 1e-6, "x");
    expect_near((double)t[2], -0.8469583573, 1e-6, "z");
    test_rng rng = {2};
    for (int i = 0; i < 10000; ++i) {
        vec3 N = rng_direction(&rng), I = rng_direction(&rng);
        if (dot(I, N) > 0.0f)
            I = -I;
        float eta = 0.4f + 2.0f * rng_float(&rng);
        vec3 T = refract_or_zero(I, N, eta);
        double sin_i = (double)length(cross(I, N)), sin_t = sin_i / (double)eta;
        if (fabs(sin_t - 1.0) < 1e-4)
            continue;
        if (sin_t > 1.0) {
            assert_true(T[0] == 0.0f && T[1] == 0.0f && T[2] == 0.0f);
            continue;
        }
        expect_near((double)length(T), 1.0, 1e-5, "unit");
        expect_near((double)length(cross(T, N)), sin_t, 1e-5, "Snell");
        expect_near((double)dot(cross(I, N), T), 0.0, 1e-5, "in the plane of incidence");
        assert_true(dot(T, N) < 0.0f);
        vec3 back = refract_or_zero(-T, -N, 1.0f / eta); /* refraction is reversible */
        expect_near((double)length(back + I), 0.0, 2e-3, "reversible");
    }
}

/* F_Schlick_boundary: both sides of one pair of angles reflect equally; total reflection beyond the critical
 * angle. */
static void test_fresnel_from_both_sides(void **state)
{
    (void)state;
    vec3 F0 = vec3(0.04f), F90 = vec3(1.0f);
    for (int i = 1; i < 100; ++i) {
        float outside = (float)i / 100.0f;
        float inside = sqrt(1.0f - (1.0f - outside * outside) / 2.25f);
        float there = F_Schlick_boundary(F0, F90, outside, 1.5f)[0];
        expect_near((double)F_Schlick_boundary(F0, F90, inside, 1.0f / 1.5f)[0], (double)there, 2e-4,
                    "Schlick");
        expect_near((double)F_dielectric(inside, 1.0f / 1.5f), (double)F_dielectric(outside, 1.5f), 2e-4,
                    "exact");
        expect_near((double)there, (double)F_dielectric(outside, 1.5f), 0.045, "Schlick near exact");
    }
    float critical = 0.7453559925f;
    assert_true(F_Schlick_boundary(F0, vec3(0.2f), critical - 1e-3f, 1.0f / 1.5f)[1] == 1.0f);
    assert_true(F_dielectric(critical - 1e-3f, 1.0f / 1.5f) == 1.0f);
    assert_true(F_Schlick_boundary(F0, F90, critical + 1e-2f, 1.0f / 1.5f)[1] < 0.7f);
}

/* ---- energy ---- */

typedef struct energy_row {
    float eta, r, NdotV;
    double R, T;
} energy_row;
/* Flux reflected and transmitted by a rough dielectric, exact Fresnel, one scattering event: quadrature in long
 * double. */
static const energy_row energy_rows[] = {{1.33f, 0.25f, 0.25f, 0.194968220724, 0.789269741410},
                                         {1.33f, 0.50f, 0.25f, 0.091324771718, 0.829034374218},
                                         {1.33f, 1.00f, 0.25f, 0.023993545366, 0.669276530096},
                                         {1.33f, 0.25f, 1.00f, 0.020004222627, 0.979677252643},
                                         {1.33f, 1.00f, 1.00f, 0.006456358653, 0.916440062616},
                                         {1.50f, 0.25f, 0.25f, 0.233456163475, 0.749758477838},
                                         {1.50f, 0.50f, 0.25f, 0.118762007766, 0.802941599388},
                                         {1.50f, 1.00f, 0.25f, 0.038412163019, 0.662925273851},
                                         {1.50f, 0.25f, 0.50f, 0.088517433829, 0.908528785672},
                                         {1.50f, 0.50f, 0.50f, 0.066898507093, 0.893867651534},
                                         {1.50f, 1.00f, 0.50f, 0.023386870030, 0.718451210143},
                                         {1.50f, 0.50f, 1.00f, 0.037048663178, 0.954996008257},
                                         {2.42f, 0.25f, 0.25f, 0.311229491070, 0.670719044788},
                                         {2.42f, 0.50f, 0.50f, 0.173636205390, 0.778107502070},
                                         {2.42f, 1.00f, 0.50f, 0.082092470379, 0.613895461367},
                                         {2.42f, 1.00f, 1.00f, 0.053306530497, 0.724977702741}};

static void test_energy_by_samples(void **state)
{
    (void)state;
    const uint n = 1u << 15u;
    for (size_t k = 0; k < COUNT_OF(energy_rows); ++k) {
        const energy_row *row = &energy_rows[k];
        vec3 V = view_at(row->NdotV);
        float alpha = row->r * row->r;
        double R = 0.0, T = 0.0;
        for (uint i = 0; i < n; ++i) {
            vec2 u = hammersley(i, n);
            TransmissionSample s = sample_transmission(u, V, alpha, alpha, row->eta);
            float F = F_dielectric(min(s.VdotH, 1.0f), row->eta);
            T += (double)((1.0f - F) * s.weight);
            TransmissionSample mirror = sample_thin_wall(u, V, alpha, alpha);
            R += (double)(F * mirror.weight);
        }
        expect_near(R / n, row->R, 3e-4, "R of row %zu", k);
        expect_near(T / n, row->T, 3e-4, "T of row %zu", k);
    }
}

/* The same flux from the BTDF itself: midpoint rule over z = 1 - t^2, finer around -N. */
static void test_energy_by_quadrature(void **state)
{
    (void)state;
    const double pi = 3.14159265358979323846;
    enum { Z = 800, PHI = 200 };
    for (size_t k = 0; k < COUNT_OF(energy_rows); ++k) {
        const energy_row *row = &energy_rows[k];
        if (row->r < 0.5f)
            continue;
        vec3 V = view_at(row->NdotV);
        float alpha = row->r * row->r;
        double T = 0.0;
        for (int j = 0; j < Z; ++j)
            for (int i = 0; i < PHI; ++i) {
                double t = (j + 0.5) / Z, z = 1.0 - t * t, phi = 2.0 * pi * (i + 0.5) / PHI,
                       r = sqrt(1.0 - z * z);
                vec3 L = vec3((float)(r * cos(phi)), (float)(r * sin(phi)), (float)-z);
                vec3 H = half_vector_transmission(V, L, row->eta);
                float VdotH = dot(V, H);
                if (VdotH > 0.0f)
                    T += 2.0 * t *
                         (double)(btdf_GGX_cos(V, L, alpha, alpha, row->eta) *
                                  (1.0f - F_dielectric(min(VdotH, 1.0f), row->eta)));
            }
        expect_near(T * 2.0 * pi / ((double)Z * PHI), row->T, 2e-3, "T of row %zu", k);
    }
}

/* Without Fresnel no boundary, seen from either side, transmits more than the incident light. */
static void test_never_gains(void **state)
{
    (void)state;
    const uint n = 1u << 12u;
    test_rng rng = {8};
    for (int k = 0; k < 300; ++k) {
        float eta = k % 2 ? 0.4f + 0.59f * rng_float(&rng) : 1.01f + 1.5f * rng_float(&rng);
        float ax = 0.01f + 0.99f * rng_float(&rng), ay = 0.01f + 0.99f * rng_float(&rng);
        vec3 V = view_at(0.03f + 0.97f * rng_float(&rng));
        double sum = 0.0;
        for (uint i = 0; i < n; ++i) {
            TransmissionSample s = sample_transmission(hammersley(i, n), V, ax, ay, eta);
            assert_true(s.weight >= 0.0f && s.weight <= 1.0f + 1e-5f && s.pdf >= 0.0f);
            sum += (double)s.weight;
        }
        assert_true(sum / n <= 1.0 + 1e-5);
    }
}

/* ---- samplers ---- */

typedef struct wall {
    vec3 V;
    float alpha_x, alpha_y, eta;
    bool is_thin;
} wall;
static bool draw_wall(const void *context, vec2 u, vec3 *d)
{
    const wall *w = (const wall *)context;
    TransmissionSample s = w->is_thin ? sample_thin_wall(u, w->V, w->alpha_x, w->alpha_y)
                                      : sample_transmission(u, w->V, w->alpha_x, w->alpha_y, w->eta);
    *d = s.L;
    return s.pdf > 0.0f;
}
static float pdf_wall(const void *context, vec3 d)
{
    const wall *w = (const wall *)context;
    return w->is_thin ? pdf_thin_wall(w->V, d, w->alpha_x, w->alpha_y)
                      : pdf_transmission(w->V, d, w->alpha_x, w->alpha_y, w->eta);
}

static void test_chi_square(void **state)
{
    (void)state;
    const wall walls[] = {
        {view_at(1.0f), 0.6f, 0.6f, 1.5f, false},        {view_at(0.7f), 0.6f, 0.6f, 1.5f, false},
        {view_at(0.3f), 0.8f, 0.8f, 1.5f, false},        {view_at(0.7f), 0.9f, 0.5f, 1.33f, false},
        {view_at(0.9f), 0.6f, 0.6f, 1.0f / 1.5f, false}, {view_at(0.5f), 0.7f, 0.7f, 1.0f / 1.5f, false},
        {view_at(0.7f), 0.5f, 0.9f, 2.42f, false},       {view_at(0.3f), 1.0f, 1.0f, 1.0f / 2.42f, false},
        {view_at(0.7f), 0.5f, 0.5f, 1.5f, true},         {view_at(0.3f), 0.8f, 0.4f, 1.5f, true},
    };
    for (size_t i = 0; i < COUNT_OF(walls); ++i) {
        double p = chi2_over_sphere(&(sphere_sampler){draw_wall, pdf_wall, &walls[i]}, 40u + i);
        if (p < 1e-3)
            fail_msg("wall %zu: p = %g", i, p);
    }
}

/* The test detects errors: another ior, or alpha off by 3 %. */
static bool draw_other(const void *context, vec2 u, vec3 *d)
{
    wall w = *(const wall *)context;
    w.alpha_x *= 1.03f;
    w.alpha_y *= 1.03f;
    return draw_wall(&w, u, d);
}
static void test_chi_square_sees_slips(void **state)
{
    (void)state;
    wall w = {view_at(0.7f), 0.6f, 0.6f, 1.5f, false};
    assert_true(chi2_over_sphere(&(sphere_sampler){draw_other, pdf_wall, &w}, 3) < 1e-4);
}

/* weight pdf = BTDF |N.L|, and the densities agree with the functions of a direction. */
static void test_weight_is_btdf_over_pdf(void **state)
{
    (void)state;
    test_rng rng = {12};
    for (int i = 0; i < 50000; ++i) {
        float ax = 0.1f + 0.9f * rng_float(&rng), ay = 0.1f + 0.9f * rng_float(&rng);
        float eta = i % 2 ? 1.5f : 1.0f / 1.5f;
        vec3 V = view_at(0.05f + 0.95f * rng_float(&rng));
        TransmissionSample s = sample_transmission(rng_vec2(&rng), V, ax, ay, eta);
        if (s.pdf > 1e-3f && s.L[2] < -1e-3f) {
            expect_relative(pdf_transmission(V, s.L, ax, ay, eta), s.pdf, 5e-3, "pdf");
            expect_relative(btdf_GGX_cos(V, s.L, ax, ay, eta), s.weight * s.pdf, 5e-3, "volume");
        }
        s = sample_thin_wall(rng_vec2(&rng), V, ax, ay);
        if (s.pdf > 1e-3f && s.L[2] < -1e-3f) {
            expect_relative(pdf_thin_wall(V, s.L, ax, ay), s.pdf, 5e-3, "thin pdf");
            expect_relative(thin_wall_cos(V, s.L, ax, ay), s.weight * s.pdf, 5e-3, "thin");
        }
    }
}

/* Reciprocity: f(V, L) / n_V^2 = f(L, V) / n_L^2 with the 1 / eta^2 of plain radiance, which is f(V, L) =
 * f(L, V) eta^2 in this form. L is on the other side, so the frame is flipped. */
static void test_reciprocity(void **state)
{
    (void)state;
    test_rng rng = {6};
    int compared = 0;
    for (int i = 0; i < 100000; ++i) {
        float eta = 1.1f + rng_float(&rng), alpha = 0.2f + 0.8f * rng_float(&rng);
        vec3 V = rng_direction(&rng), L = rng_direction(&rng);
        V[2] = max(fabsf(V[2]), 0.05f);
        L[2] = -max(fabsf(L[2]), 0.05f);
        V = normalize(V);
        L = normalize(L);
        float there = btdf_GGX_cos(V, L, alpha, 0.5f, eta) / -L[2];
        vec3 V_turned = vec3(L[0], -L[1], -L[2]), L_turned = vec3(V[0], -V[1], -V[2]);
        float back = btdf_GGX_cos(V_turned, L_turned, alpha, 0.5f, 1.0f / eta) / V[2];
        assert_true((there > 0.0f) == (back > 0.0f));
        if (there > 1e-4f) {
            expect_relative(there, back * eta * eta, 1e-3, "eta %g", (double)eta);
            ++compared;
        }
        float thin = thin_wall_cos(V, L, alpha, 0.5f) / -L[2];
        expect_relative(thin_wall_cos(V_turned, L_turned, alpha, 0.5f) / V[2], thin, 1e-4, "thin");
    }
    assert_true(compared > 10000);
}

/* ---- the thin wall ---- */

/* It is the mirrored reflection; ior 1 does not blur, from 1.5 on the blur is full. */
static void test_thin_wall(void **state)
{
    (void)state;
    test_rng rng = {14};
    for (int i = 0; i < 10000; ++i) {
        float ax = 0.05f + 0.95f * rng_float(&rng), ay = 0.05f + 0.95f * rng_float(&rng);
        vec3 V = view_at(0.05f + 0.95f * rng_float(&rng)), L = rng_direction(&rng);
        L[2] = max(fabsf(L[2]), 1e-3f);
        L = normalize(L);
        vec3 H = normalize(V + L);
        float reflected = D_GGX_anisotropic(H, ax, ay) * V_SmithGGX_anisotropic(L, V, ax, ay) * L[2];
        expect_relative(thin_wall_cos(V, mirror_through(L, up), ax, ay), reflected, 1e-4, "mirrored");
        assert_true(thin_wall_cos(V, L, ax, ay) == 0.0f);
    }
    assert_true(thin_wall_alpha(0.3f, 1.0f) == 0.0f && thin_wall_alpha(0.3f, 1.5f) == 0.3f);
    assert_true(thin_wall_alpha(0.3f, 2.0f) == 0.3f && thin_wall_alpha(0.3f, 0.0f) == 0.3f);
    expect_near((double)thin_wall_alpha(0.3f, 1.25f), 0.15, 1e-7, "half the blur");
}

/* ---- robustness ---- */

static void test_extremes_are_finite(void **state)
{
    (void)state;
    test_rng rng = {21};
    const float alphas[] = {ALPHA_DELTA, 0.01f, 1.0f},
                etas[] = {1.0f, 1.0000001f, 1.5f, 1.0f / 1.5f, 10.0f, 0.1f};
    for (int i = 0; i < 200000; ++i) {
        float ax = alphas[rng_uint(&rng) % 3u], ay = alphas[rng_uint(&rng) % 3u],
              eta = etas[rng_uint(&rng) % 6u];
        vec3 V = view_at(max(rng_float(&rng), NDOTV_MIN));
        if (i % 9 == 0)
            V = view_at(NDOTV_MIN);
        vec3 L = i % 5 == 0 ? -V : rng_direction(&rng);
        assert_true(isfinite(btdf_GGX_cos(V, L, ax, ay, eta)) &&
                    isfinite(pdf_transmission(V, L, ax, ay, eta)));
        assert_true(isfinite(thin_wall_cos(V, L, ax, ay)) && isfinite(pdf_thin_wall(V, L, ax, ay)));
        TransmissionSample s = sample_transmission(rng_vec2(&rng), V, ax, ay, eta);
        assert_true(is_finite3(s.L) && isfinite(s.weight) && isfinite(s.pdf));
        if (s.weight > 0.0f)
            expect_near((double)length(s.L), 1.0, 1e-4, "unit");
    }
    /* equal media: straight on, whatever the roughness */
    TransmissionSample s = sample_transmission(vec2(0.3f, 0.6f), view_at(0.6f), 0.5f, 0.5f, 1.0f);
    expect_near((double)length(s.L + view_at(0.6f)), 0.0, 1e-5, "straight on");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_snell),
        cmocka_unit_test(test_fresnel_from_both_sides),
        cmocka_unit_test(test_energy_by_samples),
        cmocka_unit_test(test_energy_by_quadrature),
        cmocka_unit_test(test_never_gains),
        cmocka_unit_test(test_chi_square),
        cmocka_unit_test(test_chi_square_sees_slips),
        cmocka_unit_test(test_weight_is_btdf_over_pdf),
        cmocka_unit_test(test_reciprocity),
        cmocka_unit_test(test_thin_wall),
        cmocka_unit_test(test_extremes_are_finite),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
