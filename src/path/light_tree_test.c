/* Tests of light_tree.h: choices against probabilities, nothing missed, little noise, quick. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <string.h>
#include <time.h>

#include <cmocka.h>

#include "base/memory.h"

#include "path/light_tree.h"
#include "tests/support/support.h"

static uint64_t random_state = 1;
static double random_number(void)
{
    return lcg64_double(&random_state);
}

static float number_between(float low, float high)
{
    return low + (high - low) * (float)random_number();
}

static vec3 random_point(float extent)
{
    float x = number_between(-extent, extent);
    float y = number_between(-extent, extent);
    return vec3(x, y, number_between(-extent, extent));
}

static vec3 random_direction(void)
{
    for (;;) {
        vec3 d = random_point(1.0f);
        float length2 = dot(d, d);
        if (length2 > 1e-4f && length2 < 1.0f)
            return d * inversesqrt(length2);
    }
}

/* Small discs that emit on one side, on both, points, spots, points with a range, in turn. */
static light_bounds make_light(uint32_t i, float extent, float size)
{
    light_bounds l = {.center = random_point(extent),
                      .radius = number_between(0.1f, 1.0f) * size,
                      .axis = random_direction(),
                      .cos_spread = 1.0f,
                      .dark = 0.0f,
                      .full = 1.0f,
                      .reach = INFINITY,
                      .intensity = number_between(0.1f, 2.0f)};
    switch (i % 5) {
    case 1:
        l.is_two_sided = true;
        l.slack = INFINITY;
        break;
    case 2:
    case 4:
        l.radius = 0.01f;
        l.axis = vec3(0.0f);
        l.cos_spread = -1.0f;
        l.dark = -2.0f;
        l.full = -1.0f;
        l.slack = INFINITY;
        l.reach = i % 5 == 4 ? number_between(0.2f, 1.0f) * extent : INFINITY;
        break;
    case 3:
        l.radius = 0.01f;
        l.dark = 0.7f;
        l.full = 0.8f;
        l.slack = INFINITY;
        break;
    default:
        break;
    }
    return l;
}

static light_bounds *make_lights(uint32_t count, float extent, float size)
{
    light_bounds *lights = mem_alloc(NULL, count, sizeof *lights);
    assert_non_null(lights);
    for (uint32_t i = 0; i < count; i++)
        lights[i] = make_light(i, extent, size);
    return lights;
}

static light_tree *make_tree(const light_bounds *lights, uint32_t count)
{
    light_tree *tree;
    assert_int_equal(light_tree_create(lights, count, NULL, &tree, NULL), FACET_OK);
    return tree;
}

/* Irradiance of a light as if all of it were at its center. */
static float irradiance_of(const light_bounds *l, vec3 P, vec3 N)
{
    vec3 to = l->center - P;
    float d = length(to);
    vec3 L = to * (1.0f / d);
    float cosine = -dot(l->axis, L);
    cosine = l->is_two_sided ? abs(cosine) : cosine;
    float emission = clamp((cosine - l->dark) / (l->full - l->dark), 0.0f, 1.0f);
    float window = max(1.0f - pow(d / l->reach, 4.0f), 0.0f);
    return l->intensity * emission * window * max(dot(N, L), 0.0f) / max(d * d, l->radius * l->radius);
}

/* ---- choices ---- */

/* All probabilities add up to 1, less that of subtrees without light; every light with irradiance has one;
 * samples return the same, bit for bit, and have that frequency. */
static void probabilities_match_the_samples(void **state)
{
    (void)state;
    static const uint32_t counts[] = {1, 2, 7, 8, 9, 64, 65, 1000};
    for (size_t k = 0; k < sizeof counts / sizeof counts[0]; k++) {
        uint32_t count = counts[k];
        light_bounds *lights = make_lights(count, 5.0f, 0.5f);
        light_tree *tree = make_tree(lights, count);
        uint32_t *found = mem_alloc(NULL, count, sizeof *found);
        for (int trial = 0; trial < 12; trial++) {
            enum { SAMPLES = 40000 };
            vec3 P = random_point(trial < 6 ? 6.0f : 50.0f);
            vec3 N = trial % 3 ? random_direction() : vec3(0.0f);
            light_tree_view view;
            light_tree_see(tree, P, N, &view);
            double sum = 0.0;
            for (uint32_t i = 0; i < count; i++) {
                float p = light_tree_probability(tree, &view, i);
                sum += (double)p;
                vec3 facing = trial % 3 ? N : normalize(lights[i].center - P);
                if (irradiance_of(&lights[i], P, facing) > 1e-6f)
                    assert_true(p > 0.0f);
            }
            assert_true(sum < 1.0 + 1e-4);
            memset(found, 0, count * sizeof *found);
            uint32_t nothing = 0;
            if (!(view.irradiance > 0.0f)) {
                assert_true(sum == 0.0);
                continue;
            }
            for (int i = 0; i < SAMPLES; i++) {
                float p;
                double rest;
                uint32_t light = light_tree_sample(tree, &view, (i + random_number()) / SAMPLES, &p, &rest);
                if (light == LIGHT_TREE_NONE) {
                    nothing++;
                    continue;
                }
                assert_true(rest >= 0.0 && rest < 1.0);
                assert_true(p == light_tree_probability(tree, &view, light));
                found[light]++;
            }
            assert_true(fabs(sum + (double)nothing / SAMPLES - 1.0) < 0.01);
            for (uint32_t i = 0; i < count; i++) { /* stratified: each is off by less than a few */
                double expected = (double)light_tree_probability(tree, &view, i) * SAMPLES;
                if (fabs(found[i] - expected) > 3.0 + 1e-3 * expected)
                    fail_msg("light %u of %u: %u times, expected %.1f", i, count, found[i], expected);
            }
        }
        mem_free(found);
        light_tree_destroy(tree);
        mem_free(lights);
    }
}

/* The rest of the random number is uniform again. */
static void the_remainder_is_uniform(void **state)
{
    (void)state;
    enum { COUNT = 5000, SAMPLES = 200000, BINS = 50 };
    light_bounds *lights = make_lights(COUNT, 5.0f, 0.2f);
    light_tree *tree = make_tree(lights, COUNT);
    light_tree_view view;
    light_tree_see(tree, vec3(0.0f), vec3(0.0f, 1.0f, 0.0f), &view);
    double bins[BINS] = {0.0};
    double total = 0.0;
    for (int i = 0; i < SAMPLES; i++) {
        float p;
        double rest;
        if (light_tree_sample(tree, &view, random_number(), &p, &rest) == LIGHT_TREE_NONE)
            continue;
        bins[(int)(rest * BINS)] += 1.0;
        total += 1.0;
    }
    double chi2 = 0.0;
    for (int i = 0; i < BINS; i++)
        chi2 += (bins[i] - total / BINS) * (bins[i] - total / BINS) / (total / BINS);
    assert_true(chi2 < BINS - 1 + 4.0 * sqrt(2.0 * (BINS - 1)));
    light_tree_destroy(tree);
    mem_free(lights);
}

/* ---- noise ---- */

/* Deviation of the estimate from one sample, over the mean; weights by intensity alone for comparison. The
 * true value is the sum over all. */
static void compare_noise(uint32_t count, float extent, float size, double *by_tree, double *by_intensity)
{
    light_bounds *lights = make_lights(count, extent, size);
    light_tree *tree = make_tree(lights, count);
    double all_intensity = 0.0;
    for (uint32_t i = 0; i < count; i++)
        all_intensity += (double)lights[i].intensity;
    *by_tree = *by_intensity = 0.0;
    enum { POINTS = 20 };
    for (int k = 0; k < POINTS; k++) {
        vec3 P = random_point(extent);
        vec3 N = random_direction();
        light_tree_view view;
        light_tree_see(tree, P, N, &view);
        double mean = 0.0;
        double square[2] = {0.0, 0.0};
        double estimated = 0.0;
        for (uint32_t i = 0; i < count; i++) {
            double E = (double)irradiance_of(&lights[i], P, N);
            double p = (double)light_tree_probability(tree, &view, i);
            mean += E;
            square[1] += E * E * all_intensity / (double)lights[i].intensity;
            if (p > 0.0) {
                square[0] += E * E / p;
                estimated += E;
            }
        }
        assert_true(fabs(estimated - mean) <= 1e-5 * mean);
        if (!(mean > 0.0))
            continue;
        *by_tree += (square[0] / (mean * mean) - 1.0) / POINTS;
        *by_intensity += (square[1] / (mean * mean) - 1.0) / POINTS;
    }
    light_tree_destroy(tree);
    mem_free(lights);
}

static void few_lights_are_chosen_almost_perfectly(void **state)
{
    (void)state;
    double by_tree = 0.0;
    double by_intensity = 0.0;
    for (int i = 0; i < 20; i++) {
        double tree;
        double intensity;
        compare_noise(8, 5.0f, 0.1f, &tree, &intensity);
        by_tree += tree / 20.0;
        by_intensity += intensity / 20.0;
    }
    print_message("8 lights: variance %.3f, by intensity %.3f\n", by_tree, by_intensity);
    assert_true(by_tree < 0.02 * by_intensity);
}

static void many_lights_are_chosen_well(void **state)
{
    (void)state;
    double by_tree;
    double by_intensity;
    compare_noise(100000, 5.0f, 0.02f, &by_tree, &by_intensity);
    print_message("100000 lights: variance %.3f, by intensity %.3f\n", by_tree, by_intensity);
    assert_true(by_tree < 0.05 * by_intensity);
}

static double processor_seconds(void)
{
    return (double)clock() / CLOCKS_PER_SEC;
}

static void building_and_sampling_are_fast(void **state)
{
    (void)state;
    enum { COUNT = 100000, SAMPLES = 200000 };
    light_bounds *lights = make_lights(COUNT, 5.0f, 0.02f);
    double start = processor_seconds();
    light_tree *tree = make_tree(lights, COUNT);
    double built = processor_seconds();
    double sum = 0.0;
    vec3 N = vec3(0.0f, 1.0f, 0.0f);
    vec3 P = vec3(0.0f);
    for (int i = 0; i < SAMPLES; i++) {
        light_tree_view view;
        float p;
        double rest;
        if (i % 16 == 0)
            P = random_point(5.0f);
        light_tree_see(tree, P, N, &view);
        sum += light_tree_sample(tree, &view, random_number(), &p, &rest);
    }
    double sampled = processor_seconds();
    for (uint32_t i = 0; i < SAMPLES; i++) {
        light_tree_view view;
        light_tree_see(tree, P, N, &view);
        sum += (double)light_tree_probability(tree, &view, i * 7919u % COUNT);
    }
    double asked = processor_seconds();
    print_message("100000 lights: built in %.0f ms, sample %.0f ns, probability %.0f ns (%g)\n",
                  (built - start) * 1e3, (sampled - built) / SAMPLES * 1e9, (asked - sampled) / SAMPLES * 1e9,
                  sum);
    assert_true(built - start < 20.0); /* a machine under load, sanitizers */
    light_tree_destroy(tree);
    mem_free(lights);
}

/* ---- limits ---- */

static void coincident_and_distant_lights_are_sampled(void **state)
{
    (void)state;
    const uint32_t count = 3000;
    for (int kind = 0; kind < 4; kind++) {
        light_bounds *lights = make_lights(count, 5.0f, 0.5f);
        for (uint32_t i = 0; i < count; i++) {
            if (kind == 0)
                lights[i].center = vec3(1.0f, 2.0f, 3.0f);
            if (kind == 1) /* each twice as far as the one before: splits are as uneven as can be */
                lights[i].center = vec3(exp2((float)(i % 90) - 45.0f), 0.0f, 0.0f);
            if (kind == 2)
                lights[i].center = lights[i].center * 1e14f;
            if (kind == 3)
                lights[i].intensity = i % 2 ? 1e15f : 1e-30f;
        }
        light_tree *tree = make_tree(lights, count);
        for (int k = 0; k < 100; k++) {
            light_tree_view view;
            vec3 P = k % 2 ? lights[k].center : random_point(10.0f);
            light_tree_see(tree, P, k % 3 ? random_direction() : vec3(0.0f), &view);
            assert_true(view.irradiance >= 0.0f && isfinite(view.irradiance));
            for (int i = 0; i < 100 && view.irradiance > 0.0f; i++) {
                float p;
                double rest;
                double u = i == 0 ? 0.0 : i == 1 ? 1.0 - 0x1p-53 : random_number();
                uint32_t light = light_tree_sample(tree, &view, u, &p, &rest);
                if (light != LIGHT_TREE_NONE)
                    assert_true(light < count && p > 0.0f && p <= 1.0f);
            }
        }
        light_tree_view nowhere;
        light_tree_see(tree, vec3(NAN, 0.0f, 0.0f), vec3(0.0f), &nowhere);
        assert_true(!(nowhere.irradiance > 0.0f));
        light_tree_destroy(tree);
        mem_free(lights);
    }
}

static void failed_allocations_are_reported(void **state)
{
    (void)state;
    enum { COUNT = 5000 };
    light_bounds *lights = make_lights(COUNT, 5.0f, 0.5f);
    bool has_failed = false;
    for (uint64_t limit = 1000;; limit *= 2) {
        facet_budget *budget;
        assert_int_equal(facet_budget_create(limit, &budget, NULL), FACET_OK);
        facet_allocator allocator = facet_budget_allocator(budget);
        light_tree *tree;
        facet_result result = light_tree_create(lights, COUNT, &allocator, &tree, NULL);
        if (result == FACET_OK)
            light_tree_destroy(tree);
        else
            assert_true(result == FACET_ERROR_MEMORY && !tree);
        has_failed |= result != FACET_OK;
        assert_int_equal(facet_budget_used_bytes(budget), 0);
        facet_budget_destroy(budget);
        if (result == FACET_OK)
            break;
    }
    assert_true(has_failed);
    mem_free(lights);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(probabilities_match_the_samples),
        cmocka_unit_test(the_remainder_is_uniform),
        cmocka_unit_test(few_lights_are_chosen_almost_perfectly),
        cmocka_unit_test(many_lights_are_chosen_well),
        cmocka_unit_test(building_and_sampling_are_fast),
        cmocka_unit_test(coincident_and_distant_lights_are_sampled),
        cmocka_unit_test(failed_allocations_are_reported),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
