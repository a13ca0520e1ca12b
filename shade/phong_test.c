/* phong_test.c - the vignette's numbers, the properties of the legacy model, the rules of each variant, every
 * cell of the texture table, fog at its ends and in both forms, sphere maps, normalised Blinn-Phong. */
#include "testing/test_support.h"

static const vec3 up = {0.0f, 0.0f, 1.0f};

static vec3 direction_at(double degrees)
{
    double a = degrees * 3.14159265358979323846 / 180.0;
    return vec3((float)sin(a), 0.0f, (float)cos(a));
}

static void expect_color(vec3 value, vec3 expected, double tolerance, const char *what)
{
    for (int i = 0; i < 3; ++i)
        expect_near((double)value[i], (double)expected[i], tolerance, "%s, channel %d", what, i);
}

/* ---- the equation ---- */

/* N = +Z, V at 30 degrees, s 50, Cd = Cs = 1, light at phi: values of the vignette's R code, in double. */
static const struct {
    double phi, ogl1;
} vignette_values[] = {{-80, 0.180955960}, {-60, 0.676680616}, {-30, 1.866025404}, {0, 1.176680616},
                       {30, 0.866777947},  {60, 0.500000030},  {80, 0.173648178}};

static void test_numbers_of_the_vignette(void **state)
{
    (void)state;
    vec3 V = direction_at(30.0);
    for (size_t i = 0; i < COUNT_OF(vignette_values); ++i) {
        vec3 L = direction_at(vignette_values[i].phi);
        vec3 c = phong_reflection(up, V, L, vec3(1.0f), vec3(1.0f), 50.0f);
        expect_relative(c[1], vignette_values[i].ogl1, 1e-5, "phi %g", vignette_values[i].phi);
    }
}

/* The sum of the parts is the equation: emission once, ambient, diffuse and highlight once per light. */
static void test_several_lights(void **state)
{
    (void)state;
    PhongRules r = phong_rules(PHONG_VIGNETTE);
    PhongMaterial m = {vec3(0.1f, 0.2f, 0.3f), vec3(0.7f, 0.5f, 0.2f), vec3(0.9f, 0.1f, 0.4f),
                       vec3(0.05f, 0.0f, 0.02f), 12.0f};
    vec3 V = direction_at(30.0), La = vec3(0.3f, 0.2f, 0.1f), Ld = vec3(1.0f, 0.5f, 0.25f),
         Ls = vec3(0.2f, 0.8f, 1.0f);
    PhongLit lit = phong_unlit_part(r, m);
    double expected[3];
    for (int c = 0; c < 3; ++c)
        expected[c] = (double)m.emission[c];
    for (int i = 0; i < 3; ++i) {
        double phi = -40.0 + 35.0 * i, to_rad = 3.14159265358979323846 / 180.0;
        PhongLight l = phong_light_directional(direction_at(phi), La, Ld, Ls);
        lit = phong_add(lit, phong_light_part(r, m, l, vec3(1.0f, 2.0f, -7.0f), up, V));
        for (int c = 0; c < 3; ++c)
            expected[c] += (double)(m.ambient[c] * La[c]) +
                           (double)(m.diffuse[c] * Ld[c]) * cos(phi * to_rad) +
                           (double)(m.specular[c] * Ls[c]) * pow(cos((phi + 30.0) * 0.5 * to_rad), 12.0);
    }
    for (int c = 0; c < 3; ++c)
        expect_relative(lit.color[c] + lit.highlight[c], expected[c], 1e-5, "channel %d", c);
}

/* The peak of the highlight is Cs for every exponent; a larger one is narrower. */
static void test_highlight_is_not_normalised(void **state)
{
    (void)state;
    const float exponents[] = {0.0f, 1.0f, 50.0f, 128.0f, 1000.0f};
    for (size_t i = 0; i < COUNT_OF(exponents); ++i)
        expect_near((double)phong_reflection(up, up, up, vec3(0.0f), vec3(0.7f), exponents[i])[0], 0.7, 1e-6,
                    "peak, s %g", (double)exponents[i]);
    /* Half of it where cos^s = 1/2. */
    float a = acosf(powf(0.5f, 1.0f / 50.0f));
    vec3 L = vec3(sinf(2.0f * a), 0.0f, cosf(2.0f * a));
    expect_near((double)phong_reflection(up, up, L, vec3(0.0f), vec3(1.0f), 50.0f)[0], 0.5, 1e-5, "half");
}

/* Exponent 0 is a constant, also where N.H is 0 or the half vector is undefined: 0^0 = 1. */
static void test_exponent_0(void **state)
{
    (void)state;
    assert_true(phong_power(0.0f, 0.0f) == 1.0f);
    assert_true(phong_power(-1.0f, 0.0f) == 1.0f);
    assert_true(phong_power(0.0f, 3.0f) == 0.0f);
    assert_true(phong_power(-0.5f, 3.0f) == 0.0f);
    assert_true(phong_NdotH(up, up, -up) == 0.0f);
    assert_true(phong_reflection(up, up, -up, vec3(1.0f), vec3(1.0f), 0.0f)[0] == 1.0f);
}

/* ---- variants ---- */

/* Light from below the horizon: the shaders show a highlight, fixed-function OpenGL does not. */
static void test_highlight_without_light(void **state)
{
    (void)state;
    PhongMaterial m = {vec3(0.0f), vec3(1.0f), vec3(1.0f), vec3(0.0f), 2.0f};
    vec3 V = direction_at(60.0), L = direction_at(-100.0); /* N.L = -0.17, N.H = 0.94 */
    PhongLight l = phong_light_directional(L, vec3(0.0f), vec3(1.0f), vec3(1.0f));
    double lobe = pow(cos(20.0 * 3.14159265358979323846 / 180.0), 2.0);
    for (int variant = 0; variant < 4; ++variant) {
        PhongRules r = phong_rules(variant);
        r.is_viewer_infinite = false;
        PhongLit lit = phong_light_part(r, m, l, vec3(0.0f), up, V);
        assert_true(lit.color[0] == 0.0f);
        bool is_gated = variant == PHONG_FIXED || variant == PHONG_RGL_DESKTOP;
        expect_near((double)lit.highlight[0], is_gated ? 0.0 : lobe, 1e-5, "variant %d", variant);
    }
}

/* The lit normal: towards the eye, the view plane, the face, or unchanged. */
static void test_sides(void **state)
{
    (void)state;
    /* A point far off the axis: N.z > 0 and N.V < 0. */
    vec3 V = normalize(vec3(2.0f, 0.0f, 1.0f)), N = normalize(vec3(-1.0f, 0.0f, 0.5f));
    assert_true(dot(N, V) < 0.0f);
    const float vignette = phong_normal(phong_rules(PHONG_VIGNETTE), N, V, true)[2];
    const float webgl = phong_normal(phong_rules(PHONG_WEBGL), N, V, true)[2];
    assert_true(vignette < 0.0f && webgl > 0.0f);
    for (int is_front = 0; is_front < 2; ++is_front) {
        float sign = is_front ? 1.0f : -1.0f;
        expect_color(phong_normal(phong_rules(PHONG_RGL_DESKTOP), N, V, is_front), N * sign, 0.0, "face");
        expect_color(phong_normal(phong_rules(PHONG_FIXED), N, V, is_front), N, 0.0, "as given");
    }
    /* The vignette's normal always faces the eye: -aNorm in its vertex shader has no effect. */
    test_rng rng = {7};
    for (int i = 0; i < 1000; ++i) {
        vec3 n = rng_direction(&rng), v = rng_direction(&rng);
        vec3 a = phong_normal(phong_rules(PHONG_VIGNETTE), n, v, false);
        vec3 b = phong_normal(phong_rules(PHONG_VIGNETTE), -n, v, true);
        assert_true(dot(a, v) >= 0.0f);
        expect_color(a, b, 0.0, "negated");
        assert_true(phong_normal(phong_rules(PHONG_WEBGL), n, v, false)[2] >= 0.0f);
    }
}

/* An infinite viewer has the same highlight everywhere under a directional light. */
static void test_viewers(void **state)
{
    (void)state;
    PhongMaterial m = {vec3(0.0f), vec3(0.0f), vec3(1.0f), vec3(0.0f), 20.0f};
    PhongLight l = phong_light_directional(direction_at(30.0), vec3(0.0f), vec3(1.0f), vec3(1.0f));
    double at_infinity = pow(cos(15.0 * 3.14159265358979323846 / 180.0), 20.0);
    for (int i = 0; i < 5; ++i) {
        vec3 P = vec3((float)i - 2.0f, 0.3f, -3.0f), V = normalize(-P);
        PhongRules fixed = phong_rules(PHONG_FIXED), rgl = phong_rules(PHONG_RGL_DESKTOP);
        expect_near((double)phong_light_part(fixed, m, l, P, up, V).highlight[0], at_infinity, 1e-5,
                    "infinite");
        float local = phong_power(max(dot(up, normalize(l.position + V)), 0.0f), 20.0f);
        expect_near((double)phong_light_part(rgl, m, l, P, up, V).highlight[0], (double)local, 1e-5, "local");
    }
}

static void test_ambient_light(void **state)
{
    (void)state;
    PhongMaterial m = {vec3(0.5f), vec3(1.0f), vec3(0.0f), vec3(0.125f), 1.0f};
    expect_near((double)phong_unlit_part(phong_rules(PHONG_FIXED), m).color[0], 0.225, 1e-7, "fixed");
    const int others[] = {PHONG_VIGNETTE, PHONG_WEBGL, PHONG_RGL_DESKTOP};
    for (int i = 0; i < 3; ++i)
        expect_near((double)phong_unlit_part(phong_rules(others[i]), m).color[0], 0.125, 0.0, "%d",
                    others[i]);
}

/* 1 / (a0 + a1 d + a2 d^2) and cos^e within the cone, for the ambient color too; in fixed-function OpenGL
 * only. */
static void test_attenuation_and_spots(void **state)
{
    (void)state;
    PhongMaterial m = {vec3(1.0f), vec3(1.0f), vec3(1.0f), vec3(0.0f), 3.0f};
    PhongLight l = phong_light_point(vec3(0.0f, 0.0f, 2.0f), vec3(0.1f), vec3(1.0f), vec3(1.0f));
    l.attenuation = vec3(1.0f, 0.5f, 0.25f);
    expect_relative(phong_light_share(l, vec3(0.0f)), 1.0 / 3.0, 1e-6, "1 + 1 + 1");
    PhongRules fixed = phong_rules(PHONG_FIXED), shader = phong_rules(PHONG_WEBGL);
    PhongLit a = phong_light_part(fixed, m, l, vec3(0.0f), up, up);
    PhongLit b = phong_light_part(shader, m, l, vec3(0.0f), up, up);
    expect_relative(b.color[0], 1.1, 1e-6, "no attenuation");
    expect_relative(a.color[0], 1.1 / 3.0, 1e-6, "attenuated");
    expect_relative(a.highlight[0], 1.0 / 3.0, 1e-6, "highlight");
    l.attenuation = vec3(1.0f, 0.0f, 0.0f);
    l.spot_direction = vec3(0.0f, 0.0f, -1.0f);
    l.spot_cos = 0.8f;
    l.spot_exponent = 4.0f;
    for (int i = 0; i < 9; ++i) {
        float x = 0.3f * (float)i + 0.1f; /* cos = 2 / sqrt(4 + x^2) is 0.8 at x = 1.5 */
        double cosine = 2.0 / sqrt(4.0 + (double)(x * x));
        expect_near((double)phong_light_share(l, vec3(x, 0.0f, 0.0f)), x < 1.5f ? pow(cosine, 4.0) : 0.0,
                    1e-6, "spot at %g", (double)x);
    }
    l.is_point = false;
    assert_true(phong_light_share(l, vec3(5.0f, 0.0f, 0.0f)) == 1.0f);
}

/* Positions transform with the eye, directions do not; with w 1, as printed in the vignette, they do. */
static void test_w_of_directions(void **state)
{
    (void)state;
    mat3 view = mat3(vec3(0.0f, 0.0f, -1.0f), vec3(0.0f, 1.0f, 0.0f), vec3(1.0f, 0.0f, 0.0f));
    vec3 translation = vec3(0.0f, 0.0f, -10.0f);
    expect_color(phong_to_eye(view, translation, vec3(1.0f, 0.0f, 0.0f), 0.0f), vec3(0.0f, 0.0f, -1.0f), 0.0,
                 "direction");
    expect_color(phong_to_eye(view, translation, vec3(1.0f, 0.0f, 0.0f), 1.0f), vec3(0.0f, 0.0f, -11.0f), 0.0,
                 "position");
    assert_true(phong_rules(PHONG_VIGNETTE).direction_w == 1.0f);
    assert_true(phong_rules(PHONG_WEBGL).direction_w == 0.0f);
    assert_true(phong_rules(PHONG_FIXED).direction_w == 0.0f);
}

/* ---- textures ---- */

/* rgl's table, cell by cell, with E = (E, Ea), T = (T, Ta), m the mean of T: an independent transcription. */
static PhongColor cell(int type, int mode, PhongColor e, PhongColor t)
{
    float m = (t.rgb[0] + t.rgb[1] + t.rgb[2]) / 3.0f;
    vec3 E = e.rgb, T = t.rgb, one = vec3(1.0f);
    float Ea = e.opacity, Ta = t.opacity;
    const PhongColor table[5][5] = {
        /* MODULATE, REPLACE, DECAL, BLEND, ADD */
        {{E * T, Ea}, {T, Ea}, {T, Ea}, {(one - T) * E, Ea}, {E + T, Ea}},
        {{E * T, Ea * Ta}, {T, Ta}, {E + (T - E) * Ta, Ea}, {(one - T) * E, Ea * Ta}, {E + T, Ea * Ta}},
        {{E, Ea * m}, {E, m}, {E, m}, {E, Ea * m}, {E, Ea * m}},
        {{E * m, Ea}, {vec3(m), Ea}, {vec3(m), Ea}, {E * (1.0f - m), Ea}, {E + m, Ea}},
        {{E * m, Ea * Ta}, {vec3(m), Ta}, {vec3(m), Ta}, {E * (1.0f - m), Ea * Ta}, {E + m, Ea * Ta}},
    };
    return table[type][mode];
}

static void test_every_texture_type_and_mode(void **state)
{
    (void)state;
    PhongColor e = {vec3(0.8f, 0.25f, 0.5f), 0.75f}, t = {vec3(0.1f, 0.9f, 0.35f), 0.4f};
    for (int type = 0; type < 5; ++type)
        for (int mode = 0; mode < 5; ++mode) {
            PhongColor c = phong_texture(type, mode, e, t), x = cell(type, mode, e, t);
            char what[32];
            snprintf(what, sizeof what, "type %d, mode %d", type, mode);
            expect_color(c.rgb, x.rgb, 1e-6, what);
            expect_near((double)c.opacity, (double)x.opacity, 1e-6, "%s, opacity", what);
        }
}

/* The reflected direction of the center, of the rim, and half way: at 45 degrees the normal reflects +Z to
 * the side. */
static void test_sphere_map(void **state)
{
    (void)state;
    vec2 uv = phong_sphere_map(up, up);
    expect_near((double)uv[0], 0.5, 1e-7, "middle u");
    expect_near((double)uv[1], 0.5, 1e-7, "middle v");
    uv = phong_sphere_map(normalize(vec3(1.0f, 0.0f, 1.0f)), up); /* r = +X, m = 2 sqrt 2 */
    expect_near((double)uv[0], 0.5 + 0.35355339, 1e-6, "side u");
    expect_near((double)uv[1], 0.5, 1e-6, "side v");
    /* For V = +Z the map is an image of the normals: uv = n.xy / 2 + 1/2. */
    test_rng rng = {3};
    for (int i = 0; i < 500; ++i) {
        vec3 n = rng_direction(&rng);
        if (n[2] < 0.05f)
            continue;
        uv = phong_sphere_map(n, up);
        expect_near((double)uv[0], (double)(0.5f * n[0] + 0.5f), 2e-5, "u");
        expect_near((double)uv[1], (double)(0.5f * n[1] + 0.5f), 2e-5, "v");
    }
}

/* ---- fog ---- */

static PhongFog make_fog(int mode, float scale, float fov_rad)
{
    PhongFog f = {mode, vec3(1.0f, 0.5f, 0.0f), 2.0f, 10.0f, scale, phong_fog_w(fov_rad)};
    return f;
}

static void test_fog_between_its_ends(void **state)
{
    (void)state;
    expect_relative(phong_fog_w(0.0f), 1.0 / 3.0, 1e-6, "FOV 0");
    expect_relative(phong_fog_w(PI / 3.0f), 1.0 / 3.0, 1e-6, "60 degrees: sin 30 = 1/2");
    PhongFog f = make_fog(PHONG_FOG_LINEAR, 1.0f, 0.5f);
    expect_near((double)phong_fog_share(f, 2.0f), 0.0, 1e-7, "near");
    expect_near((double)phong_fog_share(f, 6.0f), 0.5, 1e-7, "middle");
    expect_near((double)phong_fog_share(f, 10.0f), 1.0, 1e-7, "far");
    assert_true(phong_fog_share(f, 1.0f) == 0.0f && phong_fog_share(f, 20.0f) == 1.0f);
    f.scale = 2.0f;
    expect_near((double)phong_fog_share(f, 6.0f), 1.0, 1e-7, "scaled");
    for (int mode = PHONG_FOG_EXP; mode <= PHONG_FOG_EXP2; ++mode) {
        f = make_fog(mode, 1.5f, 0.5f);
        double w = (double)f.w, e = mode == PHONG_FOG_EXP ? 1.0 : 2.0;
        expect_near((double)phong_fog_share(f, 2.0f), 1.0 - exp(-pow(1.5 * w, e)), 1e-6, "near");
        expect_near((double)phong_fog_share(f, 10.0f), 1.0 - exp(-pow(1.5, e)), 1e-6, "far");
        expect_near((double)phong_fog_share(f, 4.0f), 1.0 - exp(-pow(1.5 * (w + 0.25 * (1.0 - w)), e)), 1e-6,
                    "a quarter");
    }
    f = make_fog(PHONG_FOG_NONE, 1.0f, 0.5f);
    assert_true(phong_fog_share(f, 9.0f) == 0.0f && phong_fog_share_fixed(f, 9.0f) == 0.0f);
}

/* glFog's linear fog equals the shaders' for every frustum; its exponential ones do if w = near / far, as
 * for a frustum that tightly encloses a sphere: distance r / sin(FOV / 2), near and far r before and
 * behind. */
static void test_fog_of_both_pipelines(void **state)
{
    (void)state;
    const float fov = 0.7f, r = 3.0f, distance = r / sinf(0.5f * fov);
    PhongFog f = {PHONG_FOG_LINEAR, vec3(0.0f), distance - r, distance + r, 1.7f, phong_fog_w(fov)};
    expect_relative(f.near_m / f.far_m, f.w, 1e-6, "w");
    for (int mode = PHONG_FOG_LINEAR; mode <= PHONG_FOG_EXP2; ++mode)
        for (int i = 0; i <= 20; ++i) {
            f.mode = mode;
            float d = f.near_m + (f.far_m - f.near_m) * (float)i / 20.0f;
            expect_near((double)phong_fog_share_fixed(f, d), (double)phong_fog_share(f, d), 2e-6, "mode %d",
                        mode);
        }
    /* Otherwise they differ, hence has_fixed_fog. */
    f.near_m *= 0.5f;
    f.mode = PHONG_FOG_EXP;
    assert_true(fabsf(phong_fog_share_fixed(f, distance) - phong_fog_share(f, distance)) > 0.01f);
    vec3 c = vec3(0.2f, 0.4f, 0.6f);
    expect_color(phong_fogged(phong_rules(PHONG_VIGNETTE), f, c, distance),
                 mix(c, f.color, phong_fog_share(f, distance)), 0.0, "shader");
    expect_color(phong_fogged(phong_rules(PHONG_FIXED), f, c, distance),
                 mix(c, f.color, phong_fog_share_fixed(f, distance)), 0.0, "fixed");
}

static void test_halo(void **state)
{
    (void)state;
    expect_near((double)phong_halo(0.3f, 1.0f), 0.3, 1e-7, "facing");
    expect_near((double)phong_halo(0.3f, 0.0f), 1.0, 1e-7, "rim");
    expect_near((double)phong_halo(1.0f, 0.5f), 1.0, 1e-7, "opaque");
}

/* ---- normalised Blinn-Phong ---- */

/* Midpoint sum over cos(theta) of f in [0, 1], times 2 pi. */
static double over_hemisphere(double (*f)(float cosine, float s), float s)
{
    enum { STEPS = 200000 };
    double sum = 0.0;
    for (int i = 0; i < STEPS; ++i)
        sum += f(((float)i + 0.5f) / STEPS, s) / STEPS;
    return 2.0 * 3.14159265358979323846 * sum;
}
static double D_cos(float c, float s)
{
    return (double)(D_BlinnPhong(c, s) * c);
}
/* (N.H)^s N.L with V = N, over L: H is half way. */
static double lobe_seen_head_on(float c, float s)
{
    return (double)(phong_power(phong_NdotH(up, up, vec3((sqrtf)(1.0f - c * c), 0.0f, c)), s) * c);
}

static void test_normalised_blinn_phong(void **state)
{
    (void)state;
    const float exponents[] = {0.0f, 1.0f, 4.0f, 10.0f, 64.0f, 128.0f};
    for (size_t i = 0; i < COUNT_OF(exponents); ++i) {
        float s = exponents[i];
        expect_near(over_hemisphere(D_cos, s), 1.0, 1e-4, "D, s %g", (double)s);
        expect_near(over_hemisphere(lobe_seen_head_on, s) * (double)blinn_phong_normalisation(s), 1.0, 2e-4,
                    "albedo, s %g", (double)s);
        float alpha = alpha_from_shininess(s);
        expect_near((double)shininess_from_alpha(alpha), (double)s, 1e-5 * (double)(s + 2.0f), "inverse");
        /* Karis 2013: D = 1 / (pi alpha^2) (N.H)^(2 / alpha^2 - 2) */
        expect_relative(D_BlinnPhong(0.9f, s),
                        pow(0.9, 2.0 / (double)(alpha * alpha) - 2.0) /
                            (3.14159265358979 * (double)(alpha * alpha)),
                        2e-4, "Karis, s %g", (double)s);
        expect_relative(brdf_blinn_phong(vec3(0.3f), 0.9f, s)[2],
                        0.3 * (double)(s + 2.0f) / (8.0 * 3.14159265358979) * pow(0.9, (double)s), 1e-5,
                        "BRDF");
        /* Cs is pi times the BRDF's peak. */
        expect_relative(phong_specular_from_F0(vec3(0.04f), s)[0],
                        3.14159265358979 * (double)brdf_blinn_phong(vec3(0.04f), 1.0f, s)[0], 1e-6, "Cs");
    }
    expect_relative(blinn_phong_normalisation_linear(9.0f) / blinn_phong_normalisation(9.0f), 1.07518392,
                    1e-5, "s 9");
    expect_relative(blinn_phong_normalisation_linear(64.0f) / blinn_phong_normalisation(64.0f), 1.0267, 1e-4,
                    "s 64");
    expect_relative(alpha_from_shininess(50.0f), 0.19611613514, 1e-6, "s 50");
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_numbers_of_the_vignette),
                                       cmocka_unit_test(test_several_lights),
                                       cmocka_unit_test(test_highlight_is_not_normalised),
                                       cmocka_unit_test(test_exponent_0),
                                       cmocka_unit_test(test_highlight_without_light),
                                       cmocka_unit_test(test_sides),
                                       cmocka_unit_test(test_viewers),
                                       cmocka_unit_test(test_ambient_light),
                                       cmocka_unit_test(test_attenuation_and_spots),
                                       cmocka_unit_test(test_w_of_directions),
                                       cmocka_unit_test(test_every_texture_type_and_mode),
                                       cmocka_unit_test(test_sphere_map),
                                       cmocka_unit_test(test_fog_between_its_ends),
                                       cmocka_unit_test(test_fog_of_both_pipelines),
                                       cmocka_unit_test(test_halo),
                                       cmocka_unit_test(test_normalised_blinn_phong)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
