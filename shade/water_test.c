/* water_test.c - the interface, light in the water, and both together: Fresnel's table, Snell's window, a
 * closed box, a bed at several depths. Golden numbers were computed independently in double. */
#include "testing/test_support.h"

static const double PI_DOUBLE = 3.14159265358979324;

static const vec3 UP = {0.0f, 1.0f, 0.0f, 0.0f};

static float radians(double degrees)
{
    return (float)(degrees * 0.017453292519943295);
}

/* To the eye or sun, degrees from the vertical. */
static vec3 towards(double zenith_deg, double azimuth_deg)
{
    float z = radians(zenith_deg), a = radians(azimuth_deg);
    return vec3(sin(z) * cos(a), cos(z), sin(z) * sin(a));
}

/* The open ocean with chlorophyll of 0.2 mg/m^3. */
static Water ocean(float ior)
{
    Water w;
    w.ior = ior;
    w.absorption = vec3(0.332f, 0.062f, 0.029f);
    w.scattering = vec3(0.095f, 0.114f, 0.142f);
    w.backscattering = vec3(0.00171f, 0.00271f, 0.00498f);
    w.reflectance = vec3(0.0f, 0.0064f, 0.0242f);
    w.pure_share = vec3(0.01f, 0.017f, 0.03f);
    w.sky_reflectance = 0.06f;
    w.foam_albedo = 0.4f;
    w.normals = WATER_BECKMANN;
    w.masking = WATER_SCALES;
    w.is_schlick = 0;
    return w;
}

static WaterPoint point(float variance)
{
    WaterPoint p;
    p.N = UP;
    p.covariance = vec3(variance, variance, 0.0f);
    p.foam = 0.0f;
    return p;
}

static WaterLight light_of(vec3 L, float sun, float sky, Water w)
{
    WaterLight l;
    l.L = L;
    l.sun_irradiance = vec3(sun);
    l.sky_irradiance = vec3(sky);
    l.sun_fresnel = water_fresnel(w, max(L[1], 0.0f));
    l.downwelling = water_downwelling(w, l);
    return l;
}

/* The LUT values read by the renderer. */
static WaterSpecular mirror_of(Water w, WaterPoint p, vec3 V)
{
    WaterMeans m = integrate_water_means(w.normals, w.masking, dot(p.N, V),
                                         sigma_towards(p.covariance, p.N, V), w.ior, 48);
    return water_specular(w, p, V, m.fresnel, m.escape, m.lift, m.spread);
}

/* ---- the interface ---- */

static const double fresnel_rows[][5] =
    {/* degrees; exact 1.33, Schlick, exact 1.34; from below 1 / 1.33 */
     {0, 0.02006, 0.02006, 0.02111, 0.02006},  {20, 0.02024, 0.02006, 0.02130, 0.02072},
     {40, 0.02415, 0.02075, 0.02533, 0.05425}, {50, 0.03325, 0.02576, 0.03465, 1},
     {60, 0.05913, 0.05068, 0.06100, 1},       {70, 0.13266, 0.14091, 0.13536, 1},
     {75, 0.21143, 0.23925, 0.21456, 1},       {80, 0.34692, 0.39765, 0.35020, 1},
     {85, 0.58273, 0.64119, 0.58533, 1},       {88, 0.80362, 0.84053, 0.80499, 1},
     {89, 0.89605, 0.91742, 0.89680, 1},       {90, 1, 1, 1, 1}};

static void test_fresnel(void **state)
{
    (void)state;
    Water w = ocean(1.33f), schlick = w;
    schlick.is_schlick = 1;
    for (size_t i = 0; i < COUNT_OF(fresnel_rows); ++i) {
        const double *row = fresnel_rows[i];
        float c = (float)cos(row[0] * 0.017453292519943295);
        expect_near((double)water_fresnel(w, c), row[1], 1e-5, "exact, %g degrees", row[0]);
        expect_near((double)water_fresnel(schlick, c), row[2], 1e-5, "Schlick, %g degrees", row[0]);
        expect_near((double)water_fresnel(ocean(1.34f), c), row[3], 1e-5, "exact 1.34, %g degrees", row[0]);
        expect_near((double)water_fresnel_inside(w, c), row[4], 1e-5, "from below, %g degrees", row[0]);
        assert_true(row[4] < 1.0 ||
                    (water_fresnel_inside(w, c) == 1.0f && water_fresnel_inside(schlick, c) == 1.0f));
    }
    /* where Schlick's formula is worst */
    double worst = 0.0, at = 0.0, relative = 0.0, relative_at = 0.0;
    for (double a = 0.0; a < 90.0; a += 0.05) {
        float c = (float)cos(a * 0.017453292519943295);
        double exact = (double)water_fresnel(w, c), error = (double)water_fresnel(schlick, c) - exact;
        if (error > worst) {
            worst = error;
            at = a;
        }
        if (error / exact < relative) {
            relative = error / exact;
            relative_at = a;
        }
    }
    expect_near(worst, 0.0599, 1e-4, "Schlick's largest error");
    expect_near(at, 83.8, 0.15, "its angle");
    expect_near(relative, -0.227, 1e-3, "Schlick's largest relative error");
    expect_near(relative_at, 51.1, 0.3, "its angle");
    /* diffuse light, both ways: 2 int F mu dmu */
    const double iors[3] = {1.33, 1.3333, 1.34}, above[3] = {0.06593, 0.06645, 0.06751},
                 below[3] = {0.47195, 0.47485, 0.48068};
    for (int k = 0; k < 3; ++k) {
        Water v = ocean((float)iors[k]);
        double down = 0.0, up = 0.0;
        enum { STEPS = 20000 };
        for (int i = 0; i < STEPS; ++i) {
            float mu = ((float)i + 0.5f) / STEPS;
            down += 2.0 * (double)(mu * water_fresnel(v, mu)) / STEPS;
            up += 2.0 * (double)(mu * water_fresnel_inside(v, mu)) / STEPS;
        }
        expect_near(down, above[k], 2e-5, "diffuse reflectance, ior %g", iors[k]);
        expect_near(up, below[k], 5e-5, "diffuse reflectance from below, ior %g", iors[k]);
        expect_near(up, 1.0 - (1.0 - down) / (iors[k] * iors[k]), 1e-4, "the one from the other");
    }
}

/* Snell's law on both sides, and the window to the sky. */
static void test_refraction(void **state)
{
    (void)state;
    Water w = ocean(1.33f);
    test_rng rng = {5};
    for (int i = 0; i < 200; ++i) {
        vec3 N = normal_from_slope((rng_vec2(&rng) - vec2(0.5f)) * 0.6f);
        vec3 V = rng_direction(&rng);
        V = normalize(vec3(V[0], abs(V[1]) + 0.02f, V[2]));
        if (dot(V, N) < 0.02f)
            continue;
        vec3 d = water_refracted(w, -V, N);
        expect_near((double)length(cross(N, d)) * 1.33, (double)length(cross(N, V)), 2e-6,
                    "Snell, going down");
        assert_true(d[1] < 0.0f && fabs((double)dot(cross(N, d), V)) < 1e-6);
        WaterWindow back = water_window(w, -d, N); /* the same ray from below */
        expect_near((double)length(back.outside - V), 0.0, 2e-4, "Snell, going up");
        expect_near((double)back.fresnel, (double)water_fresnel(w, dot(N, V)), 2e-4, "the same reflectance");
        expect_relative(back.gain, (double)(1.33f * 1.33f) * (1.0 - (double)back.fresnel), 1e-6,
                        "n^2 (1 - F)");
    }
    const double critical = 48.75; /* degrees */
    WaterWindow in = water_window(w, towards(critical - 0.1, 0.0), UP),
                out = water_window(w, towards(critical + 0.1, 0.0), UP);
    assert_true(in.fresnel < 1.0f && in.outside[0] > 0.99f);
    assert_true(out.fresnel == 1.0f && out.gain == 0.0f && length(out.outside) == 0.0f);
    assert_true(out.reflected[1] < 0.0f);
}

/* ---- energy ---- */

/* If sky and water have the same radiance (over n^2), the surface is invisible. And black water reflects its
 * mean reflectance. */
static void test_closed_box(void **state)
{
    (void)state;
    Water w = ocean(1.34f);
    WaterLight night = light_of(UP, 0.0f, 0.0f, w);
    const double mss[4] = {2e-8, 0.0286, 0.0542, 0.0798};
    for (int k = 0; k < 4; ++k)
        for (double a = 0.0; a < 90.0; a += 8.9) {
            WaterPoint p = point((float)(0.5 * mss[k]));
            vec3 V = towards(a, 25.0);
            WaterSpecular m = mirror_of(w, p, V);
            vec3 seen =
                water_radiance(water_parts(w, p, night, m, vec3(1.0f), vec3(0.0f), vec3(1.34f * 1.34f)));
            expect_near((double)seen[1], 1.0, 2e-6, "closed box, mss %g, %g degrees", mss[k], a);
            WaterParts once = water_parts(w, p, night, m, vec3(1.0f), vec3(0.0f), vec3(1.34f * 1.34f));
            double single = (double)(once.reflection[1] + once.transmission[1]);
            assert_true(single <= 1.0 + 2e-6 &&
                        single > (a < 60.0 ? 0.985 : 0.90)); /* what a second facet adds */
            vec3 black = water_radiance(water_parts(w, p, night, m, vec3(1.0f), vec3(0.0f), vec3(0.0f)));
            assert_true(black[1] <= m.fresnel * (1.0f + 1e-6f) && black[1] > 0.7f * m.fresnel);
        }
    vec3 V = towards(70.0, 0.0); /* no light, no radiance: there is no ambient term */
    WaterPoint p = point(0.02f);
    p.foam = 0.5f;
    vec3 dark = water_radiance(water_parts(w, p, night, mirror_of(w, p, V), vec3(0.0f),
                                           water_sun(w, p, night, V), water_from_deep(w, night.downwelling)));
    assert_true(dark[0] == 0.0f && dark[1] == 0.0f && dark[2] == 0.0f);
}

/* Flat water: the mirror direction and its F, the rest from below over n^2; the sun is F times its disc. */
static void test_flat(void **state)
{
    (void)state;
    Water w = ocean(1.333f);
    WaterPoint p = point(SLOPE_VARIANCE_MIN);
    for (double a = 2.0; a < 88.0; a += 7.0) {
        vec3 V = towards(a, 40.0);
        WaterSpecular m = mirror_of(w, p, V);
        double F = (double)F_dielectric(V[1], 1.333f);
        expect_near((double)dot(m.R, reflect(-V, UP)), 1.0, 1e-6, "mirror at %g degrees", a);
        assert_true(m.perceptual_roughness < 0.02f && m.escape > 0.9999f);
        WaterLight day = light_of(m.R, 1.0f, 0.0f, w);
        vec3 seen = water_radiance(water_parts(w, p, day, m, vec3(3.0f), vec3(0.0f), vec3(0.7f)));
        expect_relative(seen[1], 3.0 * F + (1.0 - F) / (1.333 * 1.333) * 0.7, 1e-4,
                        "flat water at %g degrees", a);
        double disc = 1.0 / (PI_DOUBLE * (double)SUN_RADIUS * (double)SUN_RADIUS);
        expect_relative(water_sun(w, p, day, V)[1], F * disc, 5e-3, "the sun at %g degrees", a);
    }
}

/* No energy gain: for any waves, eye and sun, the reflected sun is at most F times its disc. */
static void test_bound(void **state)
{
    (void)state;
    Water w = ocean(1.34f);
    test_rng rng = {11};
    double disc = 1.0 / (PI_DOUBLE * (double)SUN_RADIUS * (double)SUN_RADIUS);
    for (int i = 0; i < 20000; ++i) {
        WaterPoint p = point(0.0f);
        float v = exp(-18.0f * rng_float(&rng));
        p.N = normal_from_slope((rng_vec2(&rng) - vec2(0.5f)) * 0.8f);
        p.covariance =
            vec3(0.1f * v + SLOPE_VARIANCE_MIN, 0.1f * v * rng_float(&rng) + SLOPE_VARIANCE_MIN, 0.0f);
        vec3 L = rng_direction(&rng), V = reflect(-L, p.N);
        V = normalize(V + (rng_color(&rng) - vec3(0.5f)) * (0.2f * v));
        w.normals = i & 1;
        vec3 sun = water_sun(w, p, light_of(L, 1.0f, 0.0f, w), V);
        double F = (double)water_fresnel(w, clamp(dot(V, normalize(V + L)), 0.0f, 1.0f));
        assert_true(is_finite3(sun) && sun[1] >= 0.0f && (double)sun[1] <= F * disc * 1.01);
    }
}

/* ---- the water ---- */

static void test_volume(void **state)
{
    (void)state;
    Water w = ocean(1.34f);
    double sum = 0.0, forward = 0.0;
    for (int i = 0; i < 4000; ++i) { /* over cosines, closer to 1 */
        double x = (i + 0.5) / 4000, c = 1.0 - 2.0 * x * x * x, weight = 2.0 * PI_DOUBLE * 6.0 * x * x / 4000;
        sum += weight * (double)water_phase_pure((float)c);
        forward += weight * (double)water_phase(w, (float)c)[0];
    }
    expect_near(sum, 1.0, 1e-4, "phase function of water");
    expect_near(forward, 1.0, 1e-3, "of water with particles");
    /* single scattering, eye and sun above: 0.0796 u E, 11 % below Gordon's 0.0895 u */
    w.scattering = w.backscattering; /* quasi-single scattering: forward scattering counts as unscattered */
    w.pure_share = vec3(1.0f);
    vec3 L = water_single_scattering(w, vec3(1.0f), -1.0f, 1.0f, 1.0f, 1e4f);
    vec3 u = w.backscattering / (w.absorption + w.backscattering);
    double isotropic = (double)(water_phase_pure(-1.0f) * 2.0f * PI); /* p over that of 1 / (2 pi) */
    expect_relative(L[2] / u[2], 0.0796 * isotropic, 2e-3, "single scattering");
    /* of a shallow layer: E b p H */
    vec3 thin = water_single_scattering(w, vec3(1.0f), -1.0f, 1.0f, 1.0f, 0.001f);
    expect_relative(thin[1], w.scattering[1] * water_phase_pure(-1.0f) * 0.001f, 1e-3, "a thin layer");
    for (double q = -2.0; q < 2.0; q += 0.0993) { /* the path integral, either sign */
        double exact = (1.0 - exp(-q * 3.0)) / q;
        expect_relative(3.0f * water_mean_transmittance1(0.0f, 3.0f * (float)q), exact, 1e-5, "path at %g",
                        q);
    }
    expect_relative(3.0f * water_mean_transmittance1(0.0f, 0.0f), 3.0, 1e-6, "path without attenuation");
    expect_relative(3.0f * water_mean_transmittance1(0.0f, 3.0f * 3.3e-3f),
                    3.0 * (1.0 - 0.00495 + 0.0099 * 0.0099 / 6.0), 1e-6, "path, nearly without");
}

/* Deep water has the radiance pi R_rs just above the surface, for the factors that define R_rs. */
static void test_deep(void **state)
{
    (void)state;
    Water w = ocean(1.34f);
    WaterLight day = light_of(towards(30.0, 0.0), 80000.0f, 12000.0f, w);
    double E = 80000.0 * (1.0 - (double)day.sun_fresnel) * cos(30.0 * 0.017453292519943295) + 0.94 * 12000.0;
    expect_relative(day.downwelling[1], E, 1e-6, "downwelling");
    vec3 L = water_from_deep(w, day.downwelling);
    /* out through the surface, against pi R_rs of the irradiance above: 0.98 0.96 / n^2 is 0.52 of the
     * published factor */
    double above = 80000.0 * cos(30.0 * 0.017453292519943295) + 12000.0;
    double leaving = PI_DOUBLE * (double)L[2] * (1.0 - 0.0211) / (1.34 * 1.34);
    expect_relative(leaving / above, 0.0242, 0.025, "reflectance of the deep");
    assert_true(L[0] <= L[1] && L[1] < L[2]);
}

static void test_bed(void **state)
{
    (void)state;
    Water w = ocean(1.34f), pure = w;
    pure.absorption = vec3(0.3275f, 0.0505f, 0.0060f);
    vec3 T = water_transmittance(pure.absorption, 5.0f);
    const double golden[3] = {0.182, 0.779,
                              0.989}; /* the spectrum's, which exponentials miss by up to 0.02 */
    for (int k = 0; k < 3; ++k)
        expect_near((double)T[k], golden[k], 0.02, "5 m of pure water, channel %d", k);
    vec3 seed = water_transmittance(vec3(0.1f, 0.2f, 0.3f), 5.0f); /* a version with red water */
    assert_true(fabs((double)seed[0] - golden[0]) > 0.4 && fabs((double)seed[2] - golden[2]) > 0.7);

    vec3 E = vec3(PI), R = water_deep_reflectance(w);
    WaterBed bed = {.albedo = vec3(0.5f), .mean_albedo = vec3(0.5f), .depth = 0.0f, .path_length = 0.0f};
    vec3 dry = water_from_bed(w, E, bed);
    expect_near((double)dry[1], 0.5, 1e-6, "a bed without water");
    double contrast = 1.0, brightness = 1.0;
    for (float H = 0.5f; H < 200.0f; H *= 1.5f) {
        bed.depth = H;
        bed.path_length = H * 1.3f;
        vec3 here = water_from_bed(w, E, bed);
        bed.albedo = vec3(0.7f); /* a bright pebble on it */
        vec3 pebble = water_from_bed(w, E, bed);
        bed.albedo = vec3(0.5f);
        double seen = (double)(pebble[1] - here[1]);
        double K_d = (double)(w.absorption[1] + w.backscattering[1] * (1.0f - R[1])) / 0.86;
        double expected =
            0.2 * exp(-K_d * (double)H) * exp(-(double)(w.absorption[1] + w.scattering[1]) * 1.3 * (double)H);
        expect_near(seen, expected, 1e-4 * expected + 2e-7, "contrast at %g m", (double)H);
        assert_true(seen <= contrast && (double)here[0] < brightness); /* deeper: fainter, darker in red */
        contrast = seen;
        brightness = (double)here[0];
    }
    vec3 deep = water_from_deep(w, E);
    bed.depth = bed.path_length = 1e6f;
    vec3 over_abyss = water_interreflected(w, E, water_bed_reflectance(w, bed.albedo, bed.depth));
    for (int k = 0; k < 3; ++k)
        expect_near((double)water_from_bed(w, over_abyss, bed)[k], (double)deep[k], 1e-7,
                    "a bed out of sight, channel %d", k);
    w.absorption = w.scattering = w.backscattering = vec3(0.0f); /* glass: no attenuation, no NaN */
    assert_true(is_finite3(water_from_bed(w, E, bed)));
}

/* Reflectance of diffuse light from either side in double. */
static double fresnel_from_air(double mu, double n)
{
    double inside = sqrt(1.0 - (1.0 - mu * mu) / (n * n));
    double s = (mu - n * inside) / (mu + n * inside), p = (n * mu - inside) / (n * mu + inside);
    return 0.5 * (s * s + p * p);
}
static double fresnel_from_water(double mu, double n)
{
    double outside2 = 1.0 - (1.0 - mu * mu) * n * n;
    return outside2 > 0.0 ? fresnel_from_air(sqrt(outside2), n) : 1.0;
}

/* 2 int f(mu) mu dmu over the transmittance of a layer of the optical thickness t. */
static double hemisphere(double (*reflectance)(double, double), double n, double t)
{
    const int count = 20000;
    double sum = 0.0;
    for (int i = 0; i < count; i++) {
        double mu = (i + 0.5) / count;
        sum += 2.0 * mu * (reflectance ? reflectance(mu, n) : 1.0) * exp(-t / mu) / count;
    }
    return sum;
}

static void test_internal_reflectance(void **state)
{
    (void)state;
    const float iors[4] = {1.0f, 1.2f, 1.34f, 1.5f};
    for (int i = 0; i < 4; i++) {
        Water w = ocean(iors[i]);
        double n = (double)w.ior;
        w.sky_reflectance = (float)hemisphere(fresnel_from_air, n, 0.0);
        expect_near((double)water_internal_reflectance(w), hemisphere(fresnel_from_water, n, 0.0), 1e-4,
                    "ior %g", n);
        for (double t = 0.0; t < 3.0; t += 0.11) { /* (a + b_b) H; a bed of 0.5, and nothing scattered */
            w.absorption = vec3((float)t);
            w.backscattering = w.scattering = w.reflectance = vec3(0.0f);
            vec3 R = water_bed_reflectance(w, vec3(0.5f), 1.0f);
            expect_near((double)(R[1] * water_internal_reflectance(w)),
                        0.5 * hemisphere(fresnel_from_water, n, 2.0 * t), 0.006, "to and fro, %g, ior %g", t,
                        n);
            expect_near((double)water_slab(vec3((float)t))[1], hemisphere(NULL, n, t), 0.004, "a layer of %g",
                        t);
        }
    }
}

/* Without absorption: n^2 below a sky of 1, in deep water and over a white bed, from and to any point, for
 * any index. */
static void test_furnace(void **state)
{
    (void)state;
    const float iors[3] = {1.0f, 1.34f, 1.6f}, depths[4] = {0.0f, 0.3f, 4.0f, 1000.0f};
    for (int i = 0; i < 12; i++) {
        Water w = ocean(iors[i % 3]);
        double n2 = (double)(w.ior * w.ior);
        w.sky_reflectance = w.ior > 1.0f ? 0.06f : 0.0f;
        w.absorption = vec3(0.0f);
        w.reflectance = vec3(1.0f);
        WaterLight sky = light_of(UP, 0.0f, PI, w);
        vec3 bare = vec3(1.0f), R = water_bed_reflectance(w, bare, depths[i / 3]);
        WaterBed bed = {
            .albedo = bare, .mean_albedo = bare, .depth = depths[i / 3], .path_length = 1.4f * depths[i / 3]};
        vec3 light = water_interreflected(w, sky.downwelling, R);
        vec3 deep = water_from_deep(w, sky.downwelling), shallow = water_from_bed(w, light, bed);
        vec3 foam = water_foam_below(w, sky, light * R), d = towards(15.0 * (i / 3), 0.0);
        vec3 through = water_surface_through(w, sky.downwelling, vec3(0.0f), UP, foam, vec3(0.0f), bed.depth,
                                             d, bed.path_length);
        for (int k = 0; k < 3; k++) {
            expect_relative(deep[k], n2, 2e-6, "deep, ior %g", (double)w.ior);
            expect_relative(shallow[k], n2, 1e-5, "a bed %g m below", (double)bed.depth);
            expect_relative(foam[k], n2, 1e-5, "foam from below");
            expect_relative(through[k], n2, 1e-4, "after %g m of water", (double)bed.path_length);
        }
    }
    /* and a thin film of water on gray ground darkens it, as rain does: (1 - R) (1 - R_int) / (1 - R_int
     * albedo) */
    Water w = ocean(1.34f);
    WaterLight sky = light_of(UP, 0.0f, PI, w);
    vec3 grey = vec3(0.3f);
    WaterBed skin = {.albedo = grey, .mean_albedo = grey};
    vec3 light = water_interreflected(w, sky.downwelling, water_bed_reflectance(w, grey, 0.0f));
    expect_relative(water_from_bed(w, light, skin)[1], 0.3 * 0.94 / (1.0 - 0.3 * (1.0 - 0.94 / 1.7956)), 1e-5,
                    "wet ground");
    Water none = ocean(1.0f);
    assert_true(is_finite3(water_beam_below(none, light_of(vec3(1.0f, 0.0f, 0.0f), 0.0f, 1.0f, none))));
}

/* In-scattering of diffuse light along a path, by Simpson's rule; in nearly black water it fades to 0. */
static void test_inscatter(void **state)
{
    (void)state;
    const double paths[][3] = {
        {5.0, 0.9, 5.5}, {5.0, 0.2, 20.0}, {40.0, 1.0, 40.0}, {3.0, -0.5, 60.0}, {0.0, 0.0, 9.0}};
    Water w = ocean(1.34f);
    vec3 E = vec3(1000.0f), from_deep = water_from_deep(w, E), K = water_K_d(w), along = water_diffuse(w);
    for (int i = 0; i < 5; i++) {
        double z = paths[i][0], up = paths[i][1], x = paths[i][2];
        vec3 d = vec3((float)sqrt(1.0 - up * up), (float)up, 0.0f);
        vec3 seen = water_inscatter(w, E, (float)z, d, (float)x);
        for (int k = 0; k < 3; k++) {
            double sum = 0.0;
            for (int n = 0; n <= 2000; n++) {
                double t = x * n / 2000.0, weight = n % 2000 == 0 ? 1.0 : n % 2 ? 4.0 : 2.0;
                sum += weight * exp(-(double)K[k] * (z - t * up) - (double)along[k] * t) * x / 6000.0;
            }
            expect_relative(seen[k], (double)(from_deep[k] * (K[k] + along[k])) * sum, 1e-4,
                            "path %d, channel %d", i, k);
        }
    }
    w.absorption = vec3(30.0f, 5.0f, 1e6f);
    vec3 black = water_inscatter(w, E, 100.0f, UP, 100.0f);
    for (int k = 0; k < 3; k++)
        assert_true(black[k] >= 0.0f && black[k] < 1e-20f);
}

/* The eye below: looking down it sees the same as from above, without the surface; the glow is around the
 * sun. */
static void test_below(void **state)
{
    (void)state;
    Water w = ocean(1.34f);
    vec3 E = vec3(1000.0f);
    vec3 deep = water_from_deep(w, E), down = water_inscatter(w, E, 0.0f, -UP, 1e4f);
    for (int k = 1; k < 3; ++k)
        expect_relative(down[k], deep[k], 1e-5, "straight down, channel %d", k);
    vec3 level = water_inscatter(w, E, 0.0f, vec3(1.0f, 0.0f, 0.0f), 1e4f);
    vec3 expected = deep * (1.0f + water_K_d(w) / water_diffuse(w));
    expect_relative(level[2], expected[2], 1e-5, "along the horizon");
    expect_relative(level[2], deep[2] * (1.0f + 1.0f / WATER_MEAN_COSINE), 5e-3, "nearly as much again");
    vec3 ten = water_inscatter(w, E, 10.0f, vec3(1.0f, 0.0f, 0.0f), 1e4f);
    expect_relative(ten[2] / level[2], exp(-10.0f * water_K_d(w)[2]), 1e-5, "10 m deeper");
    assert_true(ten[0] < ten[1] && ten[1] < ten[2]);
    WaterLight day = light_of(towards(40.0, 0.0), 80000.0f, 0.0f, w);
    vec3 beam = water_beam_below(w, day), sunward = -water_refracted(w, -day.L, UP);
    expect_relative(beam[1] * sunward[1], 80000.0f * (1.0f - day.sun_fresnel) * day.L[1], 1e-5,
                    "flux through the surface");
    vec3 near =
        water_sun_inscatter(w, beam, sunward, 5.0f, normalize(sunward + vec3(0.0f, 0.1f, 0.0f)), 5.0f);
    vec3 far = water_sun_inscatter(w, beam, sunward, 5.0f, normalize(sunward + vec3(0.0f, 0.0f, 1.0f)), 5.0f);
    assert_true(near[1] > 5.0f * far[1] && far[1] > 0.0f);
    assert_true(water_sun_inscatter(w, beam, sunward, 5.0f, -sunward, 5.0f)[1] == 0.0f);
    /* and fades to the side: no edge */
    vec3 side = normalize(vec3(sunward[1], -sunward[0], 0.0f));
    vec3 aside = water_sun_inscatter(w, beam, sunward, 5.0f, normalize(side + sunward * 1e-3f), 5.0f);
    assert_true(aside[1] < 1e-3f * near[1]);
}

/* Mean over directions between two angles (degrees) from the zenith, of green. */
static double ring_mean(Water w, float z, double from_deg, double to_deg)
{
    enum { STEPS = 64 };
    double sum = 0.0, low = cos((double)radians(to_deg)), high = cos((double)radians(from_deg));
    for (int i = 0; i < STEPS; ++i) {
        float c = (float)(low + (high - low) * (i + 0.5) / STEPS);
        vec3 d = vec3(sqrt(1.0f - c * c), c, 0.0f);
        sum += (double)water_sun_inscatter(w, vec3(1.0f), UP, z, d, z / c)[1];
    }
    return sum / STEPS;
}

/* Light around a sun at the zenith, of 1 lx below the surface: photons traced with a = 0.062, b = 0.114
 * 1/m and Henyey-Greenstein of 0.92 (6 million, by a separate program); and the sum of beam and glow. */
static void test_glow(void **state)
{
    (void)state;
    static const double edges[7] = {0.0, 2.0, 4.0, 7.0, 11.0, 17.0, 25.0};
    static const struct {
        double depth, tolerance, radiance[6];
    } counted[3] = {{4.0, 0.04, {5.1014, 3.4787, 1.7446, 0.7111, 0.2621, 0.0958}},
                    {10.0, 0.05, {4.9575, 3.5072, 1.8894, 0.8586, 0.3554, 0.1410}},
                    {20.0, 0.12, {2.1375, 1.5982, 0.9666, 0.5154, 0.2523, 0.1144}}};
    Water w = ocean(1.34f);
    w.backscattering = w.scattering * 0.017956f; /* of that function */
    w.pure_share = vec3(0.0f);
    for (int k = 0; k < 3; ++k)
        for (int i = 0; i < 6; ++i)
            expect_relative(ring_mean(w, (float)counted[k].depth, edges[i], edges[i + 1]),
                            counted[k].radiance[i], counted[k].tolerance, "%g m, from %g degrees",
                            counted[k].depth, edges[i]);
    for (float z = 0.1f; z < 40.0f;
         z *= 3.0f) { /* path lengths that all are z: 2 pi of the zenith's, its phase integrated */
        enum { STEPS = 4000 };
        double phase = 0.0, t = (double)(w.scattering[1] * z);
        for (int i = 0; i < STEPS; ++i)
            phase += (double)water_inscatter_phase1((float)t, 0.0f, (float)(-1.0 + 2.0 * (i + 0.5) / STEPS));
        expect_relative(phase * 4.0 * PI_DOUBLE / STEPS, 1.0, 0.02, "all directions at %g m", (double)z);
        double through =
            (double)(water_transmittance(water_beam(w), z)[1] +
                     (w.scattering - w.backscattering)[1] * z *
                         water_mean_transmittance1(water_beam(w)[1] * z, water_diffuse(w)[1] * z));
        expect_relative(through, (double)water_transmittance(water_diffuse(w), z)[1], 1e-4,
                        "what %g m let through", (double)z);
        expect_relative(water_unscattered(w, z)[1] * water_transmittance(water_diffuse(w), z)[1],
                        (double)water_transmittance(water_beam(w), z)[1], 1e-4, "the beam after %g m",
                        (double)z);
    }
    w.absorption = vec3(3.0f); /* in murky water far below everything is absorbed, and no number fails */
    assert_true(water_sun_inscatter(w, vec3(1e5f), UP, 500.0f, UP, 500.0f)[1] == 0.0f);
    assert_true(is_finite3(water_sun_inscatter(w, vec3(1e5f), UP, 0.0f, vec3(1.0f, 0.0f, 0.0f), 1e4f)));
}

/* Foam is opaque: at 1 only foam is visible, as bright as its albedo. */
static void test_foam(void **state)
{
    (void)state;
    Water w = ocean(1.34f);
    WaterLight day = light_of(UP, 60000.0f, 10000.0f, w);
    WaterPoint p = point(0.01f);
    WaterSpecular m = mirror_of(w, p, towards(50.0, 0.0));
    vec3 clear = water_radiance(water_parts(w, p, day, m, vec3(5000.0f), vec3(100.0f), vec3(900.0f)));
    p.foam = 1.0f;
    vec3 covered = water_radiance(water_parts(w, p, day, m, vec3(5000.0f), vec3(100.0f), vec3(900.0f)));
    expect_relative(covered[1], 0.4 / PI_DOUBLE * 70000.0, 1e-5, "foam");
    p.foam = 0.25f;
    vec3 quarter = water_radiance(water_parts(w, p, day, m, vec3(5000.0f), vec3(100.0f), vec3(900.0f)));
    expect_relative(quarter[1], 0.75 * (double)clear[1] + 0.25 * (double)covered[1], 1e-5,
                    "a quarter of foam");
}

/* A surface without a step of the ior is invisible; and no number fails at the edges: eyes at the horizon, a
 * sun at or below it, no waves or a hurricane's. */
static void test_edges(void **state)
{
    (void)state;
    Water none = ocean(1.0f);
    WaterPoint p = point(0.01f);
    vec3 V = towards(60.0, 0.0), below = vec3(3.0f, 2.0f, 1.0f);
    WaterLight day = light_of(V, 1000.0f, 10.0f, none);
    vec3 seen = water_radiance(
        water_parts(none, p, day, mirror_of(none, p, V), vec3(50.0f), water_sun(none, p, day, V), below));
    for (int k = 0; k < 3; ++k)
        expect_near((double)seen[k], (double)below[k], 1e-6, "ior 1, channel %d", k);
    assert_true(is_finite3(water_sun_below(none, p, day, V)));
    Water w = ocean(1.34f);
    const double eyes[4] = {0.0, 60.0, 89.9, 89.999}, suns[4] = {0.0, 89.5, 90.0, 100.0};
    const float variances[3] = {SLOPE_VARIANCE_MIN, 0.02f, 0.25f};
    for (int i = 0; i < 4 * 4 * 3 * 2; ++i) {
        w.normals = i & 1;
        p = point(variances[(i >> 1) % 3]);
        V = towards(eyes[i / 6 % 4], 10.0);
        day = light_of(towards(suns[i / 24 % 4], 190.0), 1e5f, 1e4f, w);
        seen = water_radiance(water_parts(w, p, day, mirror_of(w, p, V), vec3(4000.0f),
                                          water_sun(w, p, day, V), water_from_deep(w, day.downwelling)));
        assert_true(is_finite3(seen) && seen[0] >= 0.0f && seen[1] >= 0.0f && seen[2] >= 0.0f);
        assert_true(suns[i / 24 % 4] < 90.0 || water_sun(w, p, day, V)[1] <= 1e-3f);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_fresnel),
        cmocka_unit_test(test_refraction),
        cmocka_unit_test(test_closed_box),
        cmocka_unit_test(test_flat),
        cmocka_unit_test(test_bound),
        cmocka_unit_test(test_volume),
        cmocka_unit_test(test_deep),
        cmocka_unit_test(test_bed),
        cmocka_unit_test(test_inscatter),
        cmocka_unit_test(test_below),
        cmocka_unit_test(test_foam),
        cmocka_unit_test(test_edges),
        cmocka_unit_test(test_internal_reflectance),
        cmocka_unit_test(test_furnace),
        cmocka_unit_test(test_glow),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
