/* water_facets_test.c - facets that mirror a box, or show it through Snell's window, beside all facets by
 * chance: none that does is left out, and their shares are those of sample_slopes(); and facets that stand
 * for all that an eye in the water sees. */
#include "testing/test_support.h"

enum { DRAWN = 1 << 14, POINTS = 1 << 12 };
static const float IOR = 1.34f;

/* Whether a ray from the origin meets the box. */
static bool meets(vec3 d, vec3 low, vec3 high)
{
    float first = 0.0f, last = 1e9f;
    for (int i = 0; i < 3; i++) {
        float a = low[i] / d[i], b = high[i] / d[i];
        first = max(first, min(a, b));
        last = min(last, max(a, b));
    }
    return first < last;
}

static bool shows(vec3 m, vec3 V, vec3 low, vec3 high)
{
    vec3 R = reflect(-V, m);
    return meets(vec3(R[0], abs(R[1]), R[2]), low, high);
}

typedef struct scene {
    vec3 C, N, V, low, high;
} scene;

/* Over hands of scenes: eyes from grazing to overhead, boxes before, beside and beyond. */
static scene scene_of(uint k)
{
    vec2 a = sobol_scrambled(k, 1u), b = sobol_scrambled(k, 2u), c = sobol_scrambled(k, 3u);
    float sd = 0.02f + 0.2f * a[0], height = 0.05f + 0.9f * a[1] * a[1];
    scene s;
    s.C = vec3(sd * sd, 0.6f * sd * sd, 0.3f * sd * sd);
    s.N = normal_from_slope((b - 0.5f) * 0.2f);
    s.V = normalize(vec3(0.3f, height, sqrt(1.0f - height * height)));
    vec3 middle = vec3(8.0f * (c[0] - 0.5f), 0.0f, -3.0f - 12.0f * c[1]);
    s.low = middle + vec3(-1.0f, -0.5f, -2.0f);
    s.high = middle + vec3(1.0f, 2.5f, 2.0f);
    return s;
}

/* Whether a facet shows what stands over the water in the box to an eye in it that looks along d. */
static bool bends(vec3 m, vec3 d, vec3 low, vec3 high)
{
    Water w;
    w.ior = IOR;
    w.is_schlick = 0;
    WaterWindow window = water_window(w, d, m);
    return window.fresnel < 1.0f && window.outside[1] > 0.0f && meets(window.outside, low, high);
}

/* How many scenes show the box, and how many of their ranges are less than a third of all. */
typedef struct tally {
    int seen, narrow;
} tally;

/* Of an eye along s->V: no facet is out of the range that shows the box, and the shares of those that do
 * are those of all. */
static void expect_range(const scene *s, FacetRange r, bool (*shown)(vec3 m, vec3 V, vec3 low, vec3 high),
                         uint k, tally *t)
{
    double expected = 0.0, found = 0.0, outside = 0.0;
    for (uint i = 0; i < (uint)DRAWN; i++) {
        vec3 m = sample_slopes(sobol_scrambled(i, 7u), s->C, s->N, s->V);
        if (!shown(m, s->V, s->low, s->high))
            continue;
        vec2 z = facet_place(r, s->N, m);
        bool is_in = z[0] >= r.low[0] && z[0] <= r.high[0] && z[1] >= r.low[1] && z[1] <= r.high[1];
        expected += 1.0 / DRAWN;
        outside += is_in ? 0.0 : 1.0 / DRAWN;
    }
    for (uint i = 0; facets_share(r) > 0.0f && i < (uint)POINTS; i++) {
        Facet f = facet_drawn(r, s->N, sobol_scrambled(i, 9u));
        found += shown(f.m, s->V, s->low, s->high) ? (double)f.weight / POINTS : 0.0;
    }
    expect_near(found, expected, 2e-3 + 0.02 * expected, "share of scene %u", k);
    expect_near(outside, 0.0, 1e-3 + 0.01 * expected, "left out of scene %u", k);
    t->seen += expected > 0.01;
    t->narrow += facets_share(r) < 0.3f;
}

static void test_share(void **state)
{
    (void)state;
    tally t = {0, 0};
    for (uint k = 0; k < 60u; k++) {
        scene s = scene_of(k);
        expect_range(&s, facets_that_reflect(s.C, s.N, s.V, s.low, s.high), shows, k, &t);
    }
    if (!(t.seen >= 12 && t.narrow > 25))
        fail_msg("%d are seen, %d look narrowly", t.seen, t.narrow);
}

/* Through Snell's window. */
static void test_bent(void **state)
{
    (void)state;
    tally t = {0, 0};
    for (uint k = 0; k < 200u; k++) {
        scene s = scene_of(k);
        float sin_e = 0.4f + 0.58f * sobol_scrambled(k, 4u)[0], cos_e = sqrt(1.0f - sin_e * sin_e);
        s.V = vec3(-cos_e * 0.3f, sin_e, -cos_e * sqrt(1.0f - 0.09f));
        s.low[1] = 0.0f;
        s.high[1] = 0.5f + 6.0f * sobol_scrambled(k, 3u)[1];
        expect_range(&s, facets_that_refract(s.C, s.N, s.V, s.low, s.high, IOR), bends, k, &t);
    }
    if (!(t.seen >= 24 && t.narrow > 40))
        fail_msg("%d are seen, %d look narrowly", t.seen, t.narrow);
}

/* All facets that are seen are worth 1, and a mirror has but one. */
static void test_all(void **state)
{
    (void)state;
    for (uint k = 0; k < 10u; k++) {
        scene s = scene_of(k);
        FacetRange r = facets_seen(s.C, s.N, s.V);
        double sum = 0.0;
        for (uint i = 0; i < (uint)POINTS; i++)
            sum += (double)facet_drawn(r, s.N, sobol_scrambled(i, 5u)).weight / POINTS;
        expect_near(sum, 1.0, 3e-3, "scene %u", k);
    }
    const vec3 still = vec3(SLOPE_VARIANCE_MIN, SLOPE_VARIANCE_MIN, 0.0f), up = vec3(0.0f, 1.0f, 0.0f);
    vec3 V = normalize(vec3(0.0f, 1.0f, 1.0f));
    FacetRange in_it = facets_that_reflect(still, up, V, vec3(-1.0f, 2.0f, -4.0f), vec3(1.0f, 4.0f, -2.0f));
    FacetRange beside = facets_that_reflect(still, up, V, vec3(3.0f, 2.0f, -4.0f), vec3(4.0f, 4.0f, -2.0f));
    expect_near((double)facets_share(in_it), 1.0, 1e-3, "in the mirror image");
    expect_near((double)facets_share(beside), 0.0, 1e-6, "beside it");
}

/* What an eye in the water sees through the window, and how high the light comes from, beside all facets
 * by chance: inside of the window, at its rim and outside of it, of rough water and of calm, on flanks,
 * and askew. */
static void test_window(void **state)
{
    (void)state;
    Water w;
    w.ior = 1.34f;
    w.is_schlick = 0;
    double worst = 0.0, worst_height = 0.0;
    for (uint k = 0; k < 160u; k++) {
        scene s = scene_of(k);
        float sin_e = 0.3f + 0.68f * sobol_scrambled(k, 4u)[0], cos_e = sqrt(1.0f - sin_e * sin_e);
        vec3 d = vec3(cos_e * 0.6f, sin_e, cos_e * 0.8f);
        FacetRange all = facets_seen(s.C, s.N, d);
        double share = 0.0, through = 0.0, height = 0.0, expected = 0.0, expected_height = 0.0;
        for (int i = 0; i < WINDOW_FACETS; i++) {
            Facet f = facet_of_window(all, s.C, s.N, d, water_critical_cosine(w), i);
            WaterWindow window = water_window(w, d, f.m);
            share += (double)f.weight;
            through += (double)(f.weight * (1.0f - window.fresnel));
            height += (double)(f.weight * (1.0f - window.fresnel) * window.outside[1]);
        }
        expect_near(share, 1.0, 1.5e-3, "all facets, case %u", k);
        for (uint i = 0; i < (uint)POINTS; i++) {
            WaterWindow window = water_window(w, d, sample_slopes(sobol_scrambled(i, 7u), s.C, s.N, d));
            expected += (double)(1.0f - window.fresnel) / POINTS;
            expected_height += (double)((1.0f - window.fresnel) * window.outside[1]) / POINTS;
        }
        worst = fmax(worst, fabs(through - expected));
        worst_height = fmax(worst_height, fabs(height - expected_height));
    }
    if (!(worst < 0.025) || !(worst_height < 0.02))
        fail_msg("light through the window is off by %g, its height by %g", worst, worst_height);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_window), cmocka_unit_test(test_share),
                                       cmocka_unit_test(test_bent), cmocka_unit_test(test_all)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
