/* Tests of waves_foam.h: foam covers what it should, fades, and is a function of the time alone. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "tests/support/support.h"
#include "ocean/waves_fixture.h"
#include "ocean/waves_foam.h"

typedef struct foamy {
    waves w;
    foam_rule rule;
    waves_foam foam;
    foam_history *history;
} foamy;

static facet_sea_desc windy(float wind_mps, uint64_t seed)
{
    facet_sea_desc d = desc_of(64, sea_default().cascade_count, seed);
    d.wind_mps = wind_mps;
    return d;
}

static void set_time(foamy *f, double time_s)
{
    waves_foam_destroy(&f->foam);
    waves_set_time(&f->w, time_s);
    assert_int_equal(
        waves_foam_create(&f->w, &f->rule, foam_decay_s(35.0), &f->w.allocator, &f->history, &f->foam, NULL),
        FACET_OK);
}

static void create(foamy *f, facet_sea_desc d)
{
    *f = (foamy){.w = waves_of(d)};
    f->rule = foam_rule_create(&f->w);
    set_time(f, 20.0);
}

static void destroy(foamy *f)
{
    waves_foam_destroy(&f->foam);
    foam_history_destroy(f->history);
    waves_destroy(&f->w);
}

static size_t texel_count(const foamy *f)
{
    return (size_t)f->foam.share.size * f->foam.share.size;
}

static void the_mean_is_the_coverage(void **state)
{
    (void)state;
    static const float winds[3] = {5.0f, 10.0f, 20.0f};
    for (int i = 0; i < 3; i++) {
        foamy f;
        create(&f, windy(winds[i], 3));
        double sum = 0.0, most = 0.0;
        for (size_t j = 0; j < texel_count(&f); j++) {
            double share = (double)f.foam.share.levels[0][j];
            sum += share;
            most = fmax(most, share);
        }
        assert_near(sum / (double)texel_count(&f), (double)f.rule.coverage, 1e-4 * (double)f.rule.coverage);
        assert_true(most <= 1.0 && most > 5.0 * (double)f.rule.coverage); /* in patches, not everywhere */
        destroy(&f);
    }
}

/* Through the lace, at footprints below and above its threads. */
static void lace_covers_its_share(void **state)
{
    (void)state;
    static const float footprints[4] = {0.01f, 0.5f, 4.0f, 3000.0f};
    enum { SEEDS = 4, PLACES = IS_SLOW ? 10000 : 40000 };
    double sums[4] = {0.0}, wanted = whitecap_coverage(15.0);
    for (uint64_t seed = 0; seed < SEEDS; seed++) {
        foamy f;
        create(&f, windy(15.0f, seed));
        for (int k = 0; k < 4; k++) {
            uint64_t random = seed;
            for (int i = 0; i < PLACES; i++) {
                float share = waves_foam_at(&f.foam, 1e5 * lcg64_double(&random), 1e5 * lcg64_double(&random),
                                            footprints[k])
                                  .share;
                assert_true(share >= 0.0f && share <= 1.0f);
                sums[k] += (double)share / (PLACES * (double)SEEDS);
            }
        }
        destroy(&f);
    }
    for (int k = 0; k < 4; k++)
        assert_near(sums[k], wanted, 0.1 * wanted);
}

static void foam_fades_where_nothing_breaks(void **state)
{
    (void)state;
    foamy f;
    create(&f, windy(12.0f, 5));
    size_t count = texel_count(&f);
    float *before = malloc(count * sizeof *before);
    assert_non_null(before);
    memcpy(before, f.foam.share.levels[0], count * sizeof *before);
    set_time(&f, 21.0);
    size_t faded = 0, fresh = 0;
    for (size_t i = 0; i < count; i++) {
        double ratio = (double)f.foam.share.levels[0][i] / fmax((double)before[i], 1e-9);
        assert_true(ratio > 0.85 * exp(-1.0 / 3.7) ||
                    before[i] < 1e-6f); /* never quicker; means are kept to 15 % */
        faded += ratio < 1.15 * exp(-1.0 / 3.7);
        fresh += ratio > 2.0;
    }
    assert_true(faded > count / 3); /* most of it */
    assert_true(fresh > count / 200);
    free(before);
    destroy(&f);
}

static void foam_is_a_function_of_the_time(void **state)
{
    (void)state;
    foamy a, b;
    facet_sea_desc d = windy(10.0f, 8);
    create(&a, d);
    d.thread_count = 3;
    create(&b, d);
    for (int i = 0; i < 5; i++)
        set_time(&b, 7.3 * i); /* wherever it comes from */
    set_time(&a, 33.3);
    set_time(&b, 33.3);
    assert_memory_equal(a.foam.share.levels[0], b.foam.share.levels[0], texel_count(&a) * sizeof(float));
    for (uint32_t i = 0; i < FOAM_PATTERNS; i++) /* and patterns rest */
        assert_memory_equal(a.foam.patterns[i].levels[0], b.foam.patterns[i].levels[0],
                            texel_count(&a) * sizeof(float));
    destroy(&a);
    destroy(&b);
}

static void foam_loops(void **state)
{
    (void)state;
    facet_sea_desc d = windy(10.0f, 9);
    d.loop_s = 30.0;
    foamy a, b;
    create(&a, d);
    create(&b, d);
    set_time(&a, 2.5);
    set_time(&b, 92.5);
    for (size_t i = 0; i < texel_count(&a); i++)
        assert_near(a.foam.share.levels[0][i], b.foam.share.levels[0][i], 1e-5);
    set_time(&a, 0.0); /* the seam */
    set_time(&b, 29.999);
    for (size_t i = 0; i < texel_count(&a); i++)
        assert_near(a.foam.share.levels[0][i], b.foam.share.levels[0][i], 0.01);
    destroy(&a);
    destroy(&b);
}

static void calm_has_none(void **state)
{
    (void)state;
    foamy f;
    create(&f, windy(0.0f, 1));
    assert_true(waves_foam_at(&f.foam, 1.0, 2.0, 0.1f).share == 0.0f);
    destroy(&f);
    facet_sea_desc d = windy(10.0f, 1);
    d.choppiness = 0.0f;
    create(&f, d);
    assert_true(waves_foam_at(&f.foam, 1.0, 2.0, 0.1f).share == 0.0f);
    destroy(&f);
    d = windy(40.0f, 1);
    d.cascade_count = 1; /* and no finer waves */
    create(&f, d);
    for (int i = 0; i < 100; i++)
        assert_in_range(1000.0f * waves_foam_at(&f.foam, 7.0 * i, 3.0, 0.1f).share, 0, 1000);
    assert_true(waves_foam_at(&f.foam, 1e300, 0.0, 0.1f).share <= 1.0f);
    destroy(&f);
}

static void running_out_of_memory_leaks_nothing(void **state)
{
    (void)state;
    facet_sea_desc d = windy(10.0f, 1);
    d.resolution = 32;
    sea_state s;
    assert_int_equal(sea_state_create(&d, &s, NULL), FACET_OK);
    for (long fail_at = 0;; fail_at++) {
        failing_allocator f = {.fail_at = fail_at};
        d.allocator = failing_allocator_get(&f);
        waves w;
        waves_foam foam = {.w = NULL};
        foam_history *history = NULL;
        facet_result result = waves_create(&d, &s, &w, NULL);
        if (!result) {
            foam_rule rule = foam_rule_create(&w);
            result = waves_foam_create(&w, &rule, 3.7, &w.allocator, &history, &foam, NULL);
        }
        waves_foam_destroy(&foam);
        foam_history_destroy(history);
        waves_destroy(&w);
        assert_int_equal(atomic_load(&f.blocks), 0);
        if (result == FACET_OK)
            break;
        assert_int_equal(result, FACET_ERROR_MEMORY);
        assert_in_range(fail_at, 0, 300);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(the_mean_is_the_coverage),
                                       cmocka_unit_test(lace_covers_its_share),
                                       cmocka_unit_test(foam_fades_where_nothing_breaks),
                                       cmocka_unit_test(foam_is_a_function_of_the_time),
                                       cmocka_unit_test(foam_loops),
                                       cmocka_unit_test(calm_has_none),
                                       cmocka_unit_test(running_out_of_memory_leaks_nothing)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
