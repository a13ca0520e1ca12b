/* water_surface_test.c - microfacets of a rough sea: distribution, masking and energy, the sun's
 * reflection, means over visible microfacets. Golden numbers were computed independently in double. */
#include "testing/test_support.h"

static const double PI_DOUBLE = 3.14159265358979324;

static const vec3 UP = {0.0f, 1.0f, 0.0f, 0.0f};

static float radians(double degrees)
{
    return (float)(degrees * 0.017453292519943295);
}

/* Above the sea by an elevation, at an azimuth from +X. */
static vec3 direction(double elevation_deg, double azimuth_deg)
{
    float e = radians(elevation_deg), a = radians(azimuth_deg);
    return vec3(cos(e) * cos(a), sin(e), cos(e) * sin(a));
}

static vec3 isotropic(double mean_square_slope)
{
    float v = (float)(0.5 * mean_square_slope);
    return vec3(v, v, 0.0f);
}

/* Total mean square slope of Cox and Munk at 5, 10, 15 m/s. */
static const double cox_munk[3] = {0.0286, 0.0542, 0.0798};

/* ---- distribution ---- */

/* The integral of D m over all directions, in polar coordinates around N, denser near it. */
static vec3 integral_of_normals(int normals, vec3 C, vec3 N, double width)
{
    enum { RINGS = 600, SECTORS = 96 };
    mat3 frame = basis_from_normal(N);
    double sum[3] = {0, 0, 0};
    for (int i = 0; i < RINGS; ++i) {
        double x = (i + 0.5) / RINGS, t = width * x / (1.0 - x); /* tan of half the angle from N */
        double angle = 2.0 * (atan2)(t, 1.0);
        double slope = width / ((1.0 - x) * (1.0 - x)); /* dt / dx */
        double weight = sin(angle) * 2.0 * slope / (1.0 + t * t) * 2.0 * PI_DOUBLE / (RINGS * SECTORS);
        for (int j = 0; j < SECTORS; ++j) {
            double phi = 2.0 * PI_DOUBLE * (j + 0.5) / SECTORS;
            vec3 m = mul(frame, vec3((float)(sin(angle) * cos(phi)), (float)(sin(angle) * sin(phi)),
                                     (float)cos(angle)));
            double D = (double)D_slopes(normals, C, N, m) * weight;
            for (int k = 0; k < 3; ++k)
                sum[k] += D * (double)m[k];
        }
    }
    return vec3((float)sum[0], (float)sum[1], (float)sum[2]);
}

static void test_distribution(void **state)
{
    (void)state;
    const double roughness[4] = {0.02, 0.1, 0.3, 0.5};
    for (int normals = WATER_BECKMANN; normals <= WATER_GGX; ++normals)
        for (size_t i = 0; i < COUNT_OF(roughness); ++i) {
            double alpha = roughness[i] * roughness[i];
            vec3 C = slopes_from_roughness((float)roughness[i]);
            double peak = (double)D_slopes(normals, C, UP, UP);
            expect_relative(peak, 1.0 / (PI_DOUBLE * alpha * alpha), 1e-5, "D(N), roughness %g",
                            roughness[i]);
            vec3 sum = integral_of_normals(normals, C, UP, alpha);
            expect_near((double)sum[1], 1.0, 1e-3, "integral of D cos, roughness %g", roughness[i]);
        }
    /* stretched, askew, on the flank of a wave: the mean normal is that of the wave */
    vec3 C = vec3(0.03f, 0.012f, 0.008f);
    vec3 N = normal_from_slope(vec2(0.25f, -0.15f));
    for (int normals = WATER_BECKMANN; normals <= WATER_GGX; ++normals) {
        vec3 sum = integral_of_normals(normals, C, N, 0.3);
        for (int k = 0; k < 3; ++k)
            expect_near((double)sum[k], (double)N[k], 1e-3, "mean normal, distribution %d, axis %d", normals,
                        k);
        assert_true(D_slopes(normals, C, N, vec3(0.0f, -1.0f, 0.0f)) == 0.0f);
    }
    /* GGX is that of brdf.h: the same alpha about the vertical */
    for (double e = 30.0; e < 90.0; e += 7.0) {
        vec3 m = direction(e, 20.0);
        expect_relative(D_slopes(WATER_GGX, slopes_from_roughness(0.5f), UP, m), D_GGX(m[1], 0.25f), 2e-5,
                        "GGX at %g", e);
    }
}

static void test_slopes(void **state)
{
    (void)state;
    vec3 N = normal_from_slope(vec2(0.3f, -0.2f));
    vec2 s = slope_from_normal(N);
    expect_near((double)s[0], 0.3, 1e-6, "slope along x");
    expect_near((double)s[1], -0.2, 1e-6, "slope along z");
    assert_true(N[0] < 0.0f && N[2] > 0.0f); /* uphill along +X leans back */
    expect_near((double)slope_variance(vec3(0.4f, 0.1f, 0.2f), vec2(0.6f, 0.8f)),
                0.4 * 0.36 + 0.1 * 0.64 + 0.4 * 0.48, 1e-6, "variance along a direction");
    expect_near((double)roughness_from_slopes(isotropic(0.0542)), 0.4825, 1e-4, "roughness at 10 m/s");
    expect_near((double)roughness_from_slopes(slopes_from_roughness(0.3f)), 0.3, 1e-6, "there and back");
    /* flat water has its slope variance towards any eye; a slope is foreshortened */
    expect_near((double)sigma_towards(isotropic(0.02), UP, direction(20.0, 70.0)), 0.1, 1e-6, "sigma, flat");
    expect_near((double)sigma_towards(vec3(0.04f, 0.01f, 0.0f), UP, direction(20.0, 90.0)), 0.1, 1e-6,
                "sigma across");
    expect_near((double)sigma_towards(vec3(0.04f, 0.01f, 0.0f), UP, UP), sqrt(0.025), 1e-6,
                "sigma from above");
}

/* ---- masking ---- */

static void test_masking(void **state)
{
    (void)state;
    double worst = 0.0;
    for (double a = 0.01; a < 6.0; a *= 1.03) {
        double exact = exp(-a * a) / (2.0 * a * sqrt(PI_DOUBLE)) - 0.5 * erfc(a);
        worst = fmax(worst, fabs((double)Lambda_Beckmann((float)a) - exact) * a);
    }
    assert_true(worst < 2e-7);
    for (double mu = 0.02; mu < 1.0; mu += 0.05) { /* GGX: alpha and cosine as brdf.h has them */
        vec3 X = vec3((float)sqrt(1.0 - mu * mu), (float)mu, 0.0f);
        expect_relative(Lambda_slopes(WATER_GGX, smith_a(slopes_from_roughness(0.6f), UP, X)),
                        Lambda_SmithGGX((float)mu, 0.36f), 1e-4, "Lambda of GGX at %g", mu);
    }
    /* Schlick's form darkens calm water: G1 at roughness 0.02, where it should be 0.9996 or more */
    const double cosines[3] = {0.2, 0.05, 0.01}, karis[3] = {0.66, 0.29, 0.072};
    for (int i = 0; i < 3; ++i) {
        float k = k_direct(0.02f), c = (float)cosines[i];
        double G1 = (double)c / ((double)c * (1.0 - (double)k) + (double)k);
        expect_near(G1, karis[i], 0.006, "G1 of Karis at %g", cosines[i]);
        vec3 V = vec3(sqrt(1.0f - c * c), c, 0.0f), C = slopes_from_roughness(0.02f);
        expect_relative(V_slopes(WATER_GGX, WATER_SCHLICK_KARIS, C, UP, UP, V) * 4.0f * c, G1, 1e-4,
                        "visibility of Karis");
        assert_true(V_slopes(WATER_BECKMANN, WATER_SMITH, C, UP, UP, V) * 4.0f * c > 0.9996f);
        assert_true(V_slopes(WATER_GGX, WATER_SMITH, C, UP, UP, V) * 4.0f * c > 0.9995f);
    }
}

/* f(L, V) = f(V, L), on flanks too, for each distribution and masking. */
static void test_reciprocity(void **state)
{
    (void)state;
    test_rng rng = {3};
    for (int i = 0; i < 2000; ++i) {
        vec3 N = normal_from_slope((rng_vec2(&rng) - vec2(0.5f)) * 0.8f);
        vec3 C =
            vec3(0.01f + 0.1f * rng_float(&rng), 0.01f + 0.1f * rng_float(&rng), 0.01f * rng_float(&rng));
        vec3 a = rng_direction(&rng), b = rng_direction(&rng);
        a = vec3(a[0], abs(a[1]) + 0.01f, a[2]);
        b = vec3(b[0], abs(b[1]) + 0.01f, b[2]);
        a = normalize(a);
        b = normalize(b);
        if (dot(a, N) < 0.01f || dot(b, N) < 0.01f)
            continue;
        double there = (double)glitter(i & 1, (i >> 1) % 3, C, N, a, b, 0.0f) / (double)dot(N, a);
        double back = (double)glitter(i & 1, (i >> 1) % 3, C, N, b, a, 0.0f) / (double)dot(N, b);
        expect_near(back, there, 1e-6 * fabs(there) + 1e-9, "reciprocity %d", i);
    }
}

/* ---- energy ---- */

/* Directional albedo of perfectly reflecting facets, over directions L in polar coordinates around the mirror
 * direction. */
static double albedo(int normals, int masking, vec3 C, vec3 N, vec3 V, float sun)
{
    enum { RINGS = 160, SECTORS = 128 };
    mat3 frame = basis_from_normal(normalize(N * (2.0f * dot(N, V)) - V));
    double sum = 0.0;
    for (int i = 0; i < RINGS; ++i) {
        double x = (i + 0.5) / RINGS, angle = PI_DOUBLE * x * x,
               weight = sin(angle) * 2.0 * PI_DOUBLE * x / RINGS * 2.0 * PI_DOUBLE / SECTORS;
        for (int j = 0; j < SECTORS; ++j) {
            double phi = 2.0 * PI_DOUBLE * (j + 0.5) / SECTORS;
            vec3 L = mul(frame, vec3((float)(sin(angle) * cos(phi)), (float)(sin(angle) * sin(phi)),
                                     (float)cos(angle)));
            sum += (double)glitter(normals, masking, C, N, L, V, sun) * weight;
        }
    }
    return sum;
}

/* Energy lost by single scattering at 10 m/s: golden numbers. */
static void test_furnace(void **state)
{
    (void)state;
    const double angle[7] = {0, 45, 60, 75, 80, 85, 88};
    const double expected[2][7] = {{1.0000, 0.9907, 0.9554, 0.9073, 0.9109, 0.9385, 0.9706},
                                   {0.9276, 0.8998, 0.8700, 0.8447, 0.8589, 0.9033, 0.9475}};
    for (int normals = 0; normals < 2; ++normals)
        for (int i = 0; i < 7; i += CASE_STEP) {
            vec3 V = direction(90.0 - angle[i], 30.0);
            double E = albedo(normals, WATER_SMITH, isotropic(0.0542), UP, V, 0.0f);
            /* the golden numbers of GGX are those of a coarser quadrature: two others here agree to 1e-4 */
            expect_near(E, expected[normals][i], normals == WATER_GGX ? 3e-3 : 2e-4,
                        "furnace, distribution %d, %g degrees", normals, angle[i]);
            WaterMeans m = integrate_water_means(normals, WATER_SMITH, V[1], sqrt(0.0271f), 1e6f,
                                                 128); /* all is reflected */
            expect_near((double)m.escape, E, 1e-3, "the means' integral, distribution %d, %g degrees",
                        normals, angle[i]);
        }
    for (int i = 0; i < 7; i += CASE_STEP) { /* waves of all lengths */
        vec3 V = direction(90.0 - angle[i], 30.0);
        double E = albedo(WATER_BECKMANN, WATER_SCALES, isotropic(0.0542), UP, V, 0.0f);
        WaterMeans m = integrate_water_means(WATER_BECKMANN, WATER_SCALES, V[1], sqrt(0.0271f), 1e6f, 128);
        expect_near((double)m.escape, E, 1e-3, "the means' integral by scales, %g degrees", angle[i]);
    }
    /* stretched, on a flank: never more than comes in */
    vec3 N = normal_from_slope(vec2(0.1f, -0.2f));
    for (int i = 0; i < 10; ++i) {
        int masking = i % 2 ? WATER_SCALES : WATER_SMITH;
        double a = 5.0 + 20.0 * (i / 2);
        double E = albedo(WATER_BECKMANN, masking, vec3(0.05f, 0.02f, 0.01f), N, direction(a, 40.0), 0.0f);
        assert_true(E < 1.002 && E > 0.8);
    }
}

/* The sun's disc in slopes from zero to large: its integral is 1, it is nowhere brighter than the disc,
 * and its covariance is that of slopes and disc; on still water it is 1 within the ellipse, and 0 beyond. */
static void test_disc(void **state)
{
    (void)state;
    const vec3 S = vec3(4e-6f, 2e-6f, 1e-6f);
    const double det = 7e-12, peak = 1.0 / (2.0 * PI_DOUBLE * sqrt(det));
    for (double variance = 1e-8; variance < 1e-3; variance *= 3.0) {
        vec3 C = vec3((float)variance, (float)(0.6 * variance), (float)(-0.2 * variance));
        double reach = 8.0 * sqrt(variance + 4e-6), sum = 0.0, square[3] = {0, 0, 0};
        enum { STEPS = 400 };
        double area = 4.0 * reach * reach / (STEPS * STEPS);
        for (int i = 0; i < STEPS * STEPS; ++i) {
            double x = reach * (2.0 * (i % STEPS + 0.5) / STEPS - 1.0),
                   z = reach * (2.0 * (i / STEPS + 0.5) / STEPS - 1.0),
                   p = (double)sun_density(WATER_BECKMANN, C, S, vec2((float)x, (float)z));
            assert_true(p >= 0.0 && p < 1.001 * peak);
            sum += p * area;
            square[0] += x * x * p * area;
            square[1] += z * z * p * area;
            square[2] += x * z * p * area;
        }
        expect_relative(sum, 1.0, 0.005, "light of the disc in slopes %g", variance);
        expect_relative(square[0], variance + 2e-6, 0.2, "xx in slopes %g", variance);
        expect_relative(square[1], 0.6 * variance + 1e-6, 0.2, "zz in slopes %g", variance);
        expect_near(square[2], -0.2 * variance + 0.5e-6, 0.2 * (variance + 2e-6), "xz in slopes %g",
                    variance);
    }
    vec3 still = vec3(SLOPE_VARIANCE_MIN, SLOPE_VARIANCE_MIN, 0.0f);
    for (double angle = 0.0; angle < 6.28; angle += 0.3) { /* the edge: S = J J^T, twice its slopes */
        double x = 2e-3 * cos(angle), z = 0.5e-3 * cos(angle) + sqrt(1.75e-6) * sin(angle);
        vec2 edge = vec2((float)(sqrt(2.0) * x), (float)(sqrt(2.0) * z));
        expect_relative(sun_density(WATER_BECKMANN, still, S, edge * 0.85f), peak, 1e-4, "within");
        assert_true(sun_density(WATER_BECKMANN, still, S, edge * 1.15f) == 0.0f);
    }
}

/* On flat water the sun is F times its disc, at any angle; nowhere is it brighter. Its flux is that of a
 * mirror. */
static void test_sun(void **state)
{
    (void)state;
    double disc = 1.0 / (PI_DOUBLE * (double)SUN_RADIUS * (double)SUN_RADIUS);
    vec3 flat = vec3(SLOPE_VARIANCE_MIN * 1e-3f, SLOPE_VARIANCE_MIN * 1e-3f, 0.0f);
    for (double e = 2.0; e <= 90.0; e += 11.0) {
        vec3 L = direction(e, 0.0), V = direction(e, 180.0);
        expect_relative(glitter(WATER_BECKMANN, WATER_SMITH, flat, UP, L, V, 1.0f), disc, 2e-3,
                        "sun in flat water, elevation %g", e);
        for (double v = 1.0; v < 90.0; v += 4.0) /* rough water, with the sun anywhere */
            assert_true((double)glitter(WATER_BECKMANN, WATER_SMITH, vec3(1e-6f, 2e-6f, 0.0f), UP, L,
                                        direction(v, 180.0), 1.0f) < disc * 1.001);
    }
    vec3 L = direction(40.0, 10.0), V = direction(40.0, 190.0);
    expect_relative(sun_slopes(UP, UP)[0], SUN_RADIUS * SUN_RADIUS / 8.0f, 1e-5, "alpha^2 = radius^2 / 4");
    assert_true(glitter(WATER_BECKMANN, WATER_SMITH, flat, UP, L, -V, 1.0f) == 0.0f);
    assert_true(glitter(WATER_BECKMANN, WATER_SMITH, flat, UP, -L, V, 1.0f) == 0.0f);
    /* reflected flux of a real sea, over all eyes: mean reflectance from the sun times the incident flux */
    double sum = 0.0;
    const double e = 50.0;
    L = direction(e, 0.0);
    enum { RINGS = 200, SECTORS = 128 };
    mat3 frame = basis_from_normal(direction(e, 180.0));
    for (int i = 0; i < RINGS; ++i) {
        double x = (i + 0.5) / RINGS, angle = PI_DOUBLE * x * x,
               weight = sin(angle) * 2.0 * PI_DOUBLE * x / RINGS * 2.0 * PI_DOUBLE / SECTORS;
        for (int j = 0; j < SECTORS; ++j) {
            double phi = 2.0 * PI_DOUBLE * (j + 0.5) / SECTORS;
            V = mul(frame,
                    vec3((float)(sin(angle) * cos(phi)), (float)(sin(angle) * sin(phi)), (float)cos(angle)));
            if (V[1] <= 0.0f)
                continue;
            double F = (double)F_dielectric(clamp(dot(V, normalize(V + L)), 0.0f, 1.0f), 1.34f);
            sum += F * (double)glitter(WATER_BECKMANN, WATER_SMITH, isotropic(0.0286), UP, L, V, 1.0f) *
                   (double)V[1] * weight;
        }
    }
    WaterMeans m = integrate_water_means(WATER_BECKMANN, WATER_SMITH, L[1], sqrt(0.0143f), 1.34f, 64);
    double mean = (double)(m.fresnel * F_dielectric(L[1], 1.34f)) * (double)L[1];
    expect_relative(sum, mean, 0.01, "flux of the sun from the sea");
}

/* ---- glitter ---- */

static double glitter_at(double mss, double sun, double depression, double azimuth)
{
    vec3 L = direction(sun, 0.0), V = direction(depression, 180.0 - azimuth);
    double F = (double)F_dielectric(clamp(dot(V, normalize(V + L)), 0.0f, 1.0f), 1.333f);
    return F * (double)glitter(WATER_BECKMANN, WATER_SMITH, isotropic(mss), UP, L, V, 0.0f);
}
static double half_width(double mss, double sun, double depression)
{
    double low = 0.0, high = 90.0, half = 0.5 * glitter_at(mss, sun, depression, 0.0);
    for (int i = 0; i < 40; ++i) {
        double middle = 0.5 * (low + high);
        if (glitter_at(mss, sun, depression, middle) > half)
            low = middle;
        else
            high = middle;
    }
    return low;
}

/* Half widths in degrees of azimuth at the mirror point and 1 degree below the horizon, and radiance over
 * the sun's irradiance. */
static const struct glitter_row {
    double sun, cases[4][3]; /* at 2, 5, 10, 15 m/s */
} glitter_rows[] = {
    {10, {{2.0, 1.1, 11.98}, {3.0, 1.6, 5.350}, {4.1, 2.3, 2.590}, {5.1, 2.8, 1.618}}},
    {20, {{4.1, 2.1, 2.346}, {6.0, 3.1, 1.086}, {8.4, 4.3, 0.5705}, {10.3, 5.3, 0.3835}}},
    {30, {{6.4, 3.1, 0.7175}, {9.5, 4.6, 0.3322}, {13.2, 6.4, 0.1753}, {16.2, 7.9, 0.1190}}},
    {45, {{11.1, 4.8, 0.2371}, {16.5, 7.1, 0.1098}, {23.1, 9.9, 0.0579}, {28.6, 12.1, 0.0393}}},
    {60, {{19.4, 6.9, 0.1488}, {29.0, 10.2, 0.0689}, {41.2, 14.2, 0.0363}, {51.8, 17.4, 0.0247}}},
};

static void test_glitter(void **state)
{
    (void)state;
    const double winds[4] = {2, 5, 10, 15};
    for (size_t i = 0; i < COUNT_OF(glitter_rows); ++i) {
        double sun = glitter_rows[i].sun, width[4];
        for (int w = 0; w < 4; ++w) {
            const double *row = glitter_rows[i].cases[w];
            double mss = 0.003 + 0.00512 * winds[w];
            width[w] = half_width(mss, sun, sun);
            /* the table has the first tenth of a degree that is darker than half */
            expect_near(width[w], row[0] - 0.05, 0.052, "half width, sun %g, wind %g", sun, winds[w]);
            expect_near(half_width(mss, sun, 1.0), row[1] - 0.05, 0.052, "at the horizon, sun %g, wind %g",
                        sun, winds[w]);
            expect_relative(glitter_at(mss, sun, sun, 0.0), row[2], 3e-3, "radiance, sun %g, wind %g", sun,
                            winds[w]);
        }
        expect_near(width[2] / width[1], 1.40, 0.04, "width at 10 over 5 m/s, sun %g", sun);
    }
    /* the brightest point is at the horizon for a sun of 30 degrees and 5 m/s */
    assert_true(glitter_at(0.0286, 30.0, 0.5, 0.0) > glitter_at(0.0286, 30.0, 30.0, 0.0));
}

/* ---- means ---- */

static const struct means_row {
    double angle, smooth, mean[3], below[3], elevation[3]; /* degrees; shares in percent */
} means_rows[] = {
    {0, 0.0204, {0.0204, 0.0204, 0.0205}, {0, 0, 0}, {73.1, 66.9, 62.2}},
    {45, 0.0279, {0.0298, 0.0315, 0.0332}, {0, 0.4, 1.3}, {41.8, 39.5, 38.0}},
    {60, 0.0597, {0.0645, 0.0677, 0.0698}, {0.6, 2.5, 4.0}, {26.4, 25.9, 26.3}},
    {70, 0.1335, {0.1342, 0.1295, 0.1236}, {2.8, 4.6, 5.3}, {18.9, 20.1, 21.3}},
    {75, 0.2124, {0.1946, 0.1757, 0.1605}, {4.2, 5.0, 5.0}, {16.3, 18.2, 19.7}},
    {80, 0.3479, {0.2725, 0.2307, 0.2032}, {4.7, 4.2, 3.6}, {14.3, 16.8, 18.6}},
    {85, 0.5835, {0.3608, 0.2916, 0.2506}, {2.8, 2.0, 1.5}, {13.1, 16.2, 18.3}},
    {88, 0.8040, {0.4148, 0.3299, 0.2810}, {0.8, 0.5, 0.3}, {13.0, 16.4, 18.6}},
    {89.5, 0.9466, {0.4414, 0.3494, 0.2966}, {0.1, 0, 0}, {13.3, 16.7, 19.1}},
};

static void test_means(void **state)
{
    (void)state;
    for (size_t i = 0; i < COUNT_OF(means_rows); ++i) {
        const struct means_row *row = &means_rows[i];
        float mu = sin(radians(90.0 - row->angle));
        double smooth = (double)F_dielectric(mu, 1.333f);
        expect_near(smooth, row->smooth, 6e-5, "flat water, %g degrees", row->angle);
        WaterMeans flat = integrate_water_means(WATER_BECKMANN, WATER_SMITH, mu, 0.0f, 1.333f, 24);
        expect_near((double)flat.fresnel, 1.0, row->angle > 89.0 ? 2e-2 : 2e-3,
                    "flat water again, %g degrees", row->angle);
        for (int k = 0; k < 3; ++k) {
            float sigma = sqrt((float)(0.5 * cox_munk[k]));
            WaterMeans m = integrate_water_means(WATER_BECKMANN, WATER_SMITH, mu, sigma, 1.333f, 96);
            expect_relative((double)m.fresnel * smooth, row->mean[k], 4e-3,
                            "mean reflectance, %g degrees, mss %g", row->angle, cox_munk[k]);
            expect_near(100.0 * (double)m.below, row->below[k], 0.12, "below the horizon, %g degrees, mss %g",
                        row->angle, cox_munk[k]);
            expect_near((double)m.elevation / 0.017453292519943295, row->elevation[k], 0.15,
                        "mean elevation, %g degrees, mss %g", row->angle, cox_munk[k]);
            assert_true(m.escape > 0.6f && m.escape <= 1.0f && m.spread >= 0.0f && m.spread < 0.34f);
            if (row->angle <= 80.0)
                expect_near((double)water_mean_fresnel_fit(mu, sigma, 1.333f), row->mean[k], 0.0095,
                            "Bruneton's fit, %g degrees", row->angle);
        }
    }
}

/* The sky lookup. */
static void test_lookup(void **state)
{
    (void)state;
    for (double e = 3.0; e < 90.0; e += 12.0) { /* without a lift it is the mirror direction, on slopes too */
        vec3 V = direction(e, 33.0), N = normal_from_slope(vec2(0.03f, -0.02f)), R = reflect(-V, N);
        expect_near((double)dot(raised_reflection(N, V, 0.0f), R), 1.0, 1e-6, "no lift, elevation %g", e);
        for (double lift = -2.0; lift < 1.0; lift += 0.4)
            expect_near((double)raised_reflection(UP, V, (float)lift)[1],
                        sin(e * 0.017453292519943295 + lift), 1e-5, "lifted from %g by %g", e, lift);
    }
    /* roughness: the fit against the mean direction of prefilter_sample() */
    for (float r = 0.1f; r <= 1.0f; r += 0.15f) {
        double sum = 0.0, weight = 0.0;
        for (uint i = 0; i < 4096; ++i) {
            PrefilterSample p = prefilter_sample(i, 4096, alpha_from_roughness(r), UP);
            sum += (double)(p.weight * p.L[1]);
            weight += (double)p.weight;
        }
        expect_near((double)roughness_from_spread((float)(1.0 - sum / weight)), (double)r, 0.008,
                    "roughness %g", (double)r);
    }
    assert_true(roughness_from_spread(0.0f) == 0.0f);
    for (float mu = 0.0f; mu <= 1.0f; mu += 0.1f) {
        vec2 pair = water_table_pair(water_table_place(mu, 0.4f * mu));
        expect_near((double)pair[0], (double)mu, 1e-6, "column and back");
        expect_near((double)pair[1], 0.4 * (double)mu, 1e-6, "row and back");
    }
}

/* A sky six times as bright at the horizon as at the zenith, by sampled facets and by the lookup of the
 * means. */
static double bright_horizon(vec3 d)
{
    return d[1] > 0.0f ? 1.0 + 6.0 * exp(-7.0 * (double)d[1]) : 0.0;
}
static void test_sky(void **state)
{
    (void)state;
    const double angle[4] = {0.0, 30.0, 70.0, 88.0}, low[4] = {-0.02, -0.03, -0.20, -0.20},
                 high[4] = {0.02, 0.02, 0.0, 0.0};
    vec3 C = isotropic(0.0542);
    for (int k = 0; k < 4; ++k) {
        vec3 V = direction(90.0 - angle[k], 0.0);
        double truth = 0.0, weight = 0.0, looked_up = 0.0, lobe = 0.0;
        enum { DRAWS = 96, POINTS = 4096 };
        for (uint i = 0; i < DRAWS * DRAWS; ++i) {
            vec3 m = sample_slopes(hammersley(i, DRAWS * DRAWS) + vec2(0.5f / (DRAWS * DRAWS)), C, UP, V),
                 L = reflect(-V, m);
            double w = L[1] > 0.0f
                           ? (double)(slopes_seen(C, UP, m, L) * F_dielectric(max(dot(V, m), 0.0f), 1.34f))
                           : 0.0;
            truth += w * bright_horizon(L);
            weight += w;
        }
        WaterMeans means = integrate_water_means(WATER_BECKMANN, WATER_SCALES, V[1], sqrt(C[0]), 1.34f, 64);
        vec3 R = raised_reflection(UP, V, means.lift);
        for (uint i = 0; i < POINTS; ++i) {
            PrefilterSample p =
                prefilter_sample(i, POINTS, alpha_from_roughness(roughness_from_spread(means.spread)), R);
            looked_up += (double)p.weight * bright_horizon(p.L);
            lobe += (double)p.weight;
        }
        double error = looked_up / lobe / (truth / weight) - 1.0;
        if (!(error > low[k] && error < high[k]))
            fail_msg("the sky at %g degrees: %.1f %% off", angle[k], 100.0 * error);
    }
}

/* ---- sampled facets ---- */

/* The inverse normal distribution against the function; sampled facets against the means by quadrature, on a
 * slope and at an azimuth. */
static void test_sampling(void **state)
{
    (void)state;
    for (double z = -4.5; z <= 4.5; z += 0.37)
        expect_near((double)inverse_normal((float)(0.5 * erfc(-z * sqrt(0.5)))), z,
                    fabs(z) > 3.0 ? 0.02 : 2e-5, "inverse at %g", z);
    vec3 C = vec3(0.03f, 0.012f, 0.008f), N = normal_from_slope(vec2(0.2f, -0.1f));
    for (double e = 4.0; e < 90.0; e += 21.0) {
        vec3 V = direction(e, 35.0);
        if (dot(N, V) < 0.02f)
            continue;
        double exact[3] = {0, 0, 0}, weight = 0.0;
        enum { STEPS = 240, DRAWS = 128 };
        for (int i = 0; i < STEPS; ++i) /* over the plane of slopes, within six standard deviations */
            for (int j = 0; j < STEPS; ++j) {
                vec2 d = vec2((float)(12.0 * (i + 0.5) / STEPS - 6.0) * 0.1732f,
                              (float)(12.0 * (j + 0.5) / STEPS - 6.0) * 0.1095f);
                vec3 m = normal_from_slope(slope_from_normal(N) + d);
                float seen = dot(V, m) > 0.0f ? slopes_seen(C, N, m, V) * dot(V, m) / m[1] : 0.0f;
                double w = (double)(slope_density(WATER_BECKMANN, C, d) * seen);
                weight += w;
                exact[0] += w * (double)d[0];
                exact[1] += w * (double)(d[0] * d[1]);
                exact[2] += w * (double)F_dielectric(max(dot(V, m), 0.0f), 1.34f);
            }
        double drawn[3] = {0, 0, 0};
        for (int i = 0; i < DRAWS; ++i)
            for (int j = 0; j < DRAWS; ++j) {
                vec2 u = vec2(((float)i + 0.5f) / DRAWS, ((float)j + 0.5f) / DRAWS);
                vec3 m = sample_slopes(u, C, N, V);
                vec2 d = slope_from_normal(m) - slope_from_normal(N);
                assert_true(dot(V, m) > -1e-4f);
                drawn[0] += (double)d[0];
                drawn[1] += (double)(d[0] * d[1]);
                drawn[2] += (double)F_dielectric(max(dot(V, m), 0.0f), 1.34f);
            }
        const double tolerance[3] = {1e-3, 1e-4, 2e-3};
        for (int k = 0; k < 3; ++k)
            expect_near(drawn[k] / (DRAWS * DRAWS), exact[k] / weight, tolerance[k],
                        "mean %d of what is drawn, elevation %g", k, e);
    }
}

/* The sun from below: n^2 times its disc in flat water; its flux through a rough surface is the incident flux
 * less masking. */
static void test_sun_below(void **state)
{
    (void)state;
    double disc = 1.0 / (PI_DOUBLE * (double)SUN_RADIUS * (double)SUN_RADIUS);
    vec3 flat = vec3(SLOPE_VARIANCE_MIN * 1e-3f, SLOPE_VARIANCE_MIN * 1e-3f, 0.0f);
    for (double e = 20.0; e <= 90.0; e += 17.0) {
        vec3 L = direction(e, 60.0), d = -refract(-L, UP, 1.0f / 1.34f);
        expect_relative(glitter_below(WATER_BECKMANN, flat, UP, L, d, 1.34f), 1.34 * 1.34 * disc, 6e-3,
                        "sun from below, elevation %g", e);
        assert_true(glitter_below(WATER_BECKMANN, flat, UP, L, -d, 1.34f) == 0.0f);
        double sum = 0.0;
        enum { RINGS = 160, SECTORS = 96 };
        mat3 frame = basis_from_normal(d);
        for (int i = 0; i < RINGS; ++i) {
            double x = (i + 0.5) / RINGS, angle = 1.2 * x * x;
            double weight = sin(angle) * 1.2 * 2.0 * x / RINGS * 2.0 * PI_DOUBLE / SECTORS;
            for (int j = 0; j < SECTORS; ++j) {
                double phi = 2.0 * PI_DOUBLE * (j + 0.5) / SECTORS;
                vec3 w = mul(frame, vec3((float)(sin(angle) * cos(phi)), (float)(sin(angle) * sin(phi)),
                                         (float)cos(angle)));
                sum += (double)glitter_below(WATER_BECKMANN, isotropic(0.0286), UP, L, w, 1.34f) *
                       (double)w[1] * weight;
            }
        }
        expect_near(sum / (double)L[1], 1.0, 0.02, "flux from below, elevation %g", e);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_distribution), cmocka_unit_test(test_slopes),  cmocka_unit_test(test_masking),
        cmocka_unit_test(test_reciprocity),  cmocka_unit_test(test_furnace), cmocka_unit_test(test_sun),
        cmocka_unit_test(test_glitter),      cmocka_unit_test(test_disc),    cmocka_unit_test(test_means),
        cmocka_unit_test(test_lookup),       cmocka_unit_test(test_sky),     cmocka_unit_test(test_sampling),
        cmocka_unit_test(test_sun_below),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
