/* water_crest_test.c - sunlight through waves: against photons traced through a sine, from the sun to an eye
 * opposite it, by Snell, Fresnel, absorption and the phase function only; and conditions without such light. */
#include "testing/test_support.h"

#include <stdint.h>

static const double TURN = 6.28318530717958648;

/* Water of a gale, chlorophyll 0.5 mg/m^3; photons use channel 1. */
static Water gale(void)
{
    Water w;
    w.ior = 1.34f;
    w.absorption = vec3(0.332f, 0.0692f, 0.0477f);
    w.scattering = vec3(0.167f, 0.199f, 0.247f);
    w.backscattering = vec3(0.0024f, 0.00365f, 0.00635f);
    w.reflectance = vec3(0.0f, 0.00796f, 0.0194f);
    w.pure_share = vec3(0.01f);
    w.sky_reflectance = 0.06f;
    w.foam_albedo = 0.4f;
    w.normals = WATER_BECKMANN;
    w.masking = 0;
    w.is_schlick = 0;
    return w;
}

/* ---- photons ---- */

enum { PHASES = 16 };

/* A sine y = amplitude cos kx, constant along z, and the sun over -x. */
typedef struct count {
    double length, amplitude, k, sun; /* m, m, 1/m, rad */
    double horizontal;                /* transmitted irradiance over that of the sun */
    /* below the surface, towards eyes 4 to 12 degrees high, within 20 degrees of +x */
    double radiance[PHASES];
} count;

typedef struct photon {
    double p[3], d[3], weight;
} photon;

static double height_over(const count *c, const photon *a, double t)
{
    return a->p[1] + a->d[1] * t - c->amplitude * cos(c->k * (a->p[0] + a->d[0] * t));
}

static void move(photon *a, double t)
{
    for (int i = 0; i < 3; i++)
        a->p[i] += a->d[i] * t;
}

/* Distance to the surface before `most`, on the current side (1: above); below 0: no hit. */
static double meets(const count *c, const photon *a, double most, double side)
{
    double step = c->length / 64.0, trough = -c->amplitude, next;
    for (double t = 0.0; t < most; t = next) {
        next = fmin(t + step, most);
        double y = a->p[1] + a->d[1] * next;
        if (side < 0.0 && y < trough && a->d[1] < 0.0)
            return -1.0;
        if (side < 0.0 && y < trough) { /* rising: directly to the troughs */
            next = fmin((trough - a->p[1]) / a->d[1] + 1e-9, most);
            continue;
        }
        if (height_over(c, a, next) * side >= 0.0)
            continue;
        double low = t, high = next;
        for (int i = 0; i < 30; i++) {
            double middle = 0.5 * (low + high);
            bool is_past = height_over(c, a, middle) * side < 0.0;
            low = is_past ? low : middle;
            high = is_past ? middle : high;
        }
        return low;
    }
    return -1.0;
}

static double fresnel(double c, double n)
{
    double s2 = (1.0 - c * c) / (n * n);
    if (s2 >= 1.0)
        return 1.0;
    double t = sqrt(1.0 - s2), s = (c - n * t) / (c + n * t), p = (n * c - t) / (n * c + t);
    return 0.5 * (s * s + p * p);
}

/* Its normal, up; returns the cosine of d to it. */
static double normal_at(const count *c, const photon *a, double n[2])
{
    double slope = -c->amplitude * c->k * sin(c->k * a->p[0]), y = 1.0 / sqrt(1.0 + slope * slope);
    n[0] = -slope * y;
    n[1] = y;
    return a->d[0] * n[0] + a->d[1] * n[1];
}

/* Refracts d; n: index of the far over that of the near side. Not beyond the critical angle. */
static void bend(double d[3], const double N[2], double cosine, double n)
{
    double c = fabs(cosine), t = sqrt(1.0 - (1.0 - c * c) / (n * n)), way = cosine < 0.0 ? 1.0 : -1.0;
    double along = way * (c / n - t);
    d[0] = d[0] / n + along * N[0];
    d[1] = d[1] / n + along * N[1];
    d[2] = d[2] / n;
}

static void turn(double d[3], double cosine, double around)
{
    double s = sqrt(fmax(1.0 - cosine * cosine, 0.0)), h = fmax((hypot)(d[0], d[2]), 1e-9);
    double u[3] = {-d[2] / h, 0.0, d[0] / h};
    double v[3] = {d[1] * u[2], d[2] * u[0] - d[0] * u[2], -d[1] * u[0]};
    for (int i = 0; i < 3; i++)
        d[i] = cosine * d[i] + s * (cos(around) * u[i] + sin(around) * v[i]);
}

/* Henyey-Greenstein, or 1 + 0.835 cos^2. */
static double turned_by(const Water *w, uint64_t *s)
{
    if (lcg64_double(s) >= (double)w->pure_share[1]) {
        double g = (double)WATER_PARTICLE_G, q = (1.0 - g * g) / (1.0 - g + 2.0 * g * lcg64_double(s));
        return (1.0 + g * g - q * q) / (2.0 * g);
    }
    double c = 2.0 * lcg64_double(s) - 1.0;
    while (lcg64_double(s) * 1.835 > 1.0 + 0.835 * c * c)
        c = 2.0 * lcg64_double(s) - 1.0;
    return c;
}

static void leave(count *c, const photon *a, const double N[2], double cosine, double n)
{
    photon out = *a;
    bend(out.d, N, cosine, 1.0 / n);
    double up = out.d[0] * N[0] + out.d[1] * N[1], place = a->p[0] / c->length;
    bool is_seen = out.d[1] > sin(TURN / 90.0) && out.d[1] < sin(TURN / 30.0) && out.d[0] > 0.0 &&
                   fabs(out.d[2]) < out.d[0] * tan(TURN / 18.0);
    if (is_seen && up > 0.02) /* n^2 and what is reflected taken off; per horizontal area */
        c->radiance[(int)((place - floor(place)) * PHASES) % PHASES] += a->weight * n * n * N[1] / up;
}

static void follow(count *c, const Water *w, photon *a, uint64_t *s)
{
    double beam = (double)(w->absorption[1] + w->scattering[1]), n = (double)w->ior, N[2];
    double t = meets(c, a, 1e9, 1.0);
    move(a, t);
    double cosine = normal_at(c, a, N);
    a->weight = 1.0 - fresnel(fmin(-cosine, 1.0), n);
    c->horizontal += a->weight;
    bend(a->d, N, cosine, n);
    while (a->weight > 0.0) {
        double away = 1e-7 * c->length, free = -log(1.0 - lcg64_double(s)) / beam;
        a->p[0] -= N[0] * away;
        a->p[1] -= N[1] * away;
        for (t = meets(c, a, free, -1.0); t >= 0.0; t = meets(c, a, free, -1.0)) {
            move(a, t);
            free -= t;
            cosine = normal_at(c, a, N);
            if (cosine <= 0.0) { /* along the surface: rounding may have put it outside */
                a->weight = 0.0;
                return;
            }
            double back = fresnel(fmin(cosine, 1.0), 1.0 / n);
            if (back < 1.0)
                leave(c, a, N, cosine, n);
            a->weight *= back;
            for (int i = 0; i < 2; i++) {
                a->d[i] -= 2.0 * cosine * N[i];
                a->p[i] -= N[i] * away;
            }
        }
        N[0] = N[1] = 0.0;
        move(a, free);
        a->weight *= (double)w->scattering[1] / beam;
        turn(a->d, turned_by(w, s), TURN * lcg64_double(s));
        if (a->weight < 0.1)
            a->weight = lcg64_double(s) < 0.2 ? 5.0 * a->weight : 0.0;
    }
}

static count count_photons(const Water *w, double length, double steepness, double sun_deg, int number)
{
    count c = {.length = length, .k = TURN / length, .sun = sun_deg * TURN / 360.0};
    c.amplitude = steepness / c.k;
    uint64_t seed = 20260801u;
    for (int i = 0; i < number; i++) {
        photon a = {.p = {length * ((double)i + 0.5) / number, c.amplitude + 1e-6 * length, 0.0},
                    .d = {cos(c.sun), -sin(c.sun), 0.0}};
        follow(&c, w, &a, &seed);
    }
    double each = sin(c.sun) / number, eyes = TURN / 9.0 * (sin(TURN / 30.0) - sin(TURN / 90.0));
    c.horizontal *= each;
    for (int i = 0; i < PHASES; i++)
        c.radiance[i] *= each * PHASES / eyes;
    return c;
}

/* Radiance of the shading at the phases of the count, relative to level water. */
static double shaded(const Water *w, const count *c, int phase)
{
    WaterLight light;
    light.L = vec3(-(float)cos(c->sun), (float)sin(c->sun), 0.0f);
    light.sun_irradiance = vec3(1.0f);
    light.sky_irradiance = vec3(0.0f);
    light.sun_fresnel = (float)(1.0 - c->horizontal / sin(c->sun));
    light.downwelling = water_downwelling(*w, light);
    float steepness = (float)(c->amplitude * c->k), place = (float)(TURN * (phase + 0.5) / PHASES);
    WaterCrest crest =
        water_crest_beam(*w, light, 0.5f * steepness * steepness, (float)c->k, (float)c->amplitude);
    vec3 V = normalize(vec3(1.0f, 0.1405f, 0.0f)); /* the middle of the eyes */
    vec3 N = normal_from_slope(vec2(-steepness * sin(place), 0.0f));
    return (double)water_crest(*w, light, crest, N, V, water_refracted(*w, -V, N),
                               (float)c->amplitude * cos(place))[1];
}

/* Mean of the first phases: half of them, on the visible side. */
static double mean_of(const count *c, int phases)
{
    double sum = 0.0;
    for (int i = 0; i < phases; i++)
        sum += c->radiance[i] / phases;
    return sum;
}

/* m, greatest slope, degrees; of the radiance that was counted, the share that level water and the wave's
 * own light are. */
typedef struct wave {
    double length, steepness, sun_deg, least, most;
} wave;

static double own_of_side(const Water *w, const count *c)
{
    double sum = 0.0;
    for (int i = 0; i < PHASES / 2; i++)
        sum += shaded(w, c, i) / (PHASES / 2);
    return sum;
}

/* In waves not much wider than the path of light in water (14 m here) the excess equals the radiance of level
 * water, and never exceeds the count; it is lower, as multiple scattering is not included. Waves of 257 m do
 * not glow. */
static void test_photons(void **state)
{
    (void)state;
    static const wave waves[] = {
        {4, 0.3, 6, 0.5, 1.0}, {16, 0.25, 6, 0.5, 1.0}, {16, 0.25, 20, 0.5, 1.0}, {60, 0.25, 6, 0.5, 1.0}};
    Water w = gale();
    double before = 1e9;
    for (size_t i = 0; i < COUNT_OF(waves); i += CASE_STEP) {
        const wave *v = &waves[i];
        count level = count_photons(&w, 20.0, 0.0, v->sun_deg, 200000);
        count c = count_photons(&w, v->length, v->steepness, v->sun_deg, 100000);
        double flat = mean_of(&level, PHASES) * c.horizontal / level.horizontal, own = own_of_side(&w, &c);
        double share = (flat + own) / mean_of(&c, PHASES / 2);
        if (!(share > v->least && share < v->most && own > 0.0))
            fail_msg("%g m, sun %g: %g of %g and %g, %g", v->length, v->sun_deg, share,
                     mean_of(&c, PHASES / 2), flat, own);
        if (v->sun_deg < 10.0)
            assert_true(own < before);
        before = v->sun_deg < 10.0 ? own : before;
    }
    for (double sun_deg = 2.0; sun_deg < 7.0; sun_deg += 4.0) {
        count c = count_photons(&w, 257.0, 0.25, sun_deg, 20000);
        double deep = c.horizontal * (double)w.reflectance[1] / (TURN / 2.0 * (double)WATER_RRS_SHARE);
        assert_true(own_of_side(&w, &c) < 0.1 * deep && mean_of(&c, PHASES / 2) < 1.5 * deep);
    }
}

/* ---- conditions without it ---- */

static WaterLight sun_at(const Water *w, float elevation_deg, float azimuth_deg)
{
    float e = elevation_deg * 0.017453293f, a = azimuth_deg * 0.017453293f;
    WaterLight light;
    light.L = vec3(cos(e) * cos(a), sin(e), cos(e) * sin(a));
    light.sun_irradiance = vec3(30000.0f);
    light.sky_irradiance = vec3(5000.0f);
    light.sun_fresnel = 0.3f;
    light.downwelling = water_downwelling(*w, light);
    return light;
}

static vec3 crest_of(const Water *w, WaterLight light, float amplitude, float k, float slope, vec3 V)
{
    WaterCrest c = water_crest_beam(*w, light, 0.02f, k, amplitude);
    vec3 N = normal_from_slope(vec2(slope, 0.0f));
    return water_crest(*w, light, c, N, V, water_refracted(*w, -V, N), 0.5f * amplitude);
}

static void test_nothing(void **state)
{
    (void)state;
    Water w = gale();
    vec3 V = normalize(vec3(-1.0f, 0.1f, 0.0f));
    assert_true(crest_of(&w, sun_at(&w, 6.0f, 0.0f), 0.5f, 1.0f, 0.3f, V)[1] > 0.0f);
    assert_true(crest_of(&w, sun_at(&w, 6.0f, 180.0f), 0.5f, 1.0f, 0.3f, V)[1] == 0.0f); /* behind the eye */
    assert_true(crest_of(&w, sun_at(&w, 6.0f, 0.0f), 0.5f, 1.0f, -0.3f, V)[1] == 0.0f);  /* its own side */
    assert_true(crest_of(&w, sun_at(&w, 6.0f, 0.0f), 0.0f, 0.0f, 0.3f, V)[1] == 0.0f);   /* no waves */
    assert_true(crest_of(&w, sun_at(&w, -6.0f, 0.0f), 0.5f, 1.0f, 0.3f, V)[1] == 0.0f);  /* night */
    assert_true(crest_of(&w, sun_at(&w, 6.0f, 0.0f), 0.5f, 1.0f, 0.0f, V)[1] == 0.0f);   /* level */
    w.absorption = w.scattering = w.backscattering = vec3(0.0f);
    assert_true(crest_of(&w, sun_at(&w, 6.0f, 0.0f), 0.5f, 1.0f, 0.3f, V)[1] == 0.0f);
}

/* Mean of sunlit slopes, by the integral of s max(tilt + s, 0) over that of max(tilt + s, 0). */
static void test_sunlit_slope(void **state)
{
    (void)state;
    for (double tilt = 0.0; tilt < 2.0; tilt += 0.17) {
        double light = 0.0, sum = 0.0, sd = 0.2;
        for (int i = 0; i < 4000; i++) {
            double z = -8.0 + 0.004 * ((double)i + 0.5), seen = fmax(tilt + sd * z, 0.0) * exp(-0.5 * z * z);
            light += seen;
            sum += sd * z * seen;
        }
        expect_near((double)water_sunlit_slope((float)tilt, 0.04f), sum / light, 1e-4, "tilt %g", tilt);
    }
    assert_true(water_sunlit_slope(0.1f, 0.0f) == 0.0f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_photons), cmocka_unit_test(test_nothing),
                                       cmocka_unit_test(test_sunlit_slope)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
