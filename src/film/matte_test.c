/* Tests of matte.h: ranks of Cryptomatte's layers, and their metadata. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "film/matte.h"

static film make_film(uint32_t aovs)
{
    film f;
    assert_int_equal(film_create(NULL, 2, 1, aovs, &f, NULL), FACET_OK);
    return f;
}

static void layers_are_the_requested_ones(void **state)
{
    (void)state;
    film none = make_film(FACET_AOV_DEPTH), some = make_film(FACET_AOV_CRYPTO_MATERIAL);
    assert_int_equal(matte_find(&none).aovs, 0);
    assert_int_equal(matte_find(&some).aovs, FACET_AOV_CRYPTO_MATERIAL);
    assert_int_equal(some.layer_count, 4);
    assert_string_equal(some.layers[3].channel_names[3], "CryptoMaterial02.A");
    assert_true(some.layers[3].needs_float);
    film_destroy(&none);
    film_destroy(&some);
}

static void coverages_are_sorted_and_add_up(void **state)
{
    (void)state;
    film f = make_film(FACET_AOV_CRYPTO_OBJECT);
    matte_layers m = matte_find(&f);
    static const float weights[][2] = {{3, 1}, {5, 2}, {3, 1}, {8, 3}, {7, 1}};
    for (int i = 0; i < 5; i++)
        matte_add(&m, 1, (float[MATTE_KINDS]){weights[i][0], 0, 0}, weights[i][1]);
    matte_finish(&m, 1, 0.125f);
    static const float expected[2][4] = {{8, 0.375f, 5, 0.25f}, {3, 0.25f, 7, 0.125f}};
    for (int i = 0; i < 2; i++)
        assert_memory_equal(f.layers[1 + i].pixels + 4, expected[i], sizeof expected[i]);
    static const float nothing[4] = {0};
    assert_memory_equal(f.layers[3].pixels + 4, nothing, sizeof nothing);
    assert_memory_equal(f.layers[1].pixels, nothing, sizeof nothing); /* the other pixel */
    film_destroy(&f);
}

static void a_larger_coverage_replaces_the_smallest(void **state)
{
    (void)state;
    film f = make_film(FACET_AOV_CRYPTO_INSTANCE);
    matte_layers m = matte_find(&f);
    for (int i = 1; i <= 8; i++)
        matte_add(&m, 0, (float[MATTE_KINDS]){0, 0, (float)i}, (float)i);
    matte_finish(&m, 0, 1.0f / 64.0f);
    for (int rank = 0; rank < MATTE_RANKS; rank++) {
        const float *r = f.layers[1 + rank / 2].pixels + 2 * (rank % 2);
        assert_true(r[0] == (float)(8 - rank) && r[1] == (float)(8 - rank) / 64.0f);
    }
    film_destroy(&f);
}

/* The keys that programs look for; 3ae39a58 is MurmurHash3 of "CryptoObject". */
static void metadata_names_layer_and_hash(void **state)
{
    (void)state;
    film f = make_film(FACET_AOV_CRYPTO_OBJECT);
    assert_int_equal(matte_describe(&f, 0, "{\"a\":\"3c2569b2\"}", NULL, NULL), FACET_OK);
    static const char *const expected[][2] = {{"/name", "CryptoObject"},
                                              {"/hash", "MurmurHash3_32"},
                                              {"/conversion", "uint32_to_float32"},
                                              {"/manifest", "{\"a\":\"3c2569b2\"}"}};
    assert_int_equal(f.text_count, 4);
    for (int i = 0; i < 4; i++) {
        assert_memory_equal(f.texts[i].name, "cryptomatte/3ae39a5", 19);
        assert_string_equal(f.texts[i].name + 19, expected[i][0]);
        assert_string_equal(f.texts[i].value, expected[i][1]);
    }
    film_destroy(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(layers_are_the_requested_ones),
        cmocka_unit_test(coverages_are_sorted_and_add_up),
        cmocka_unit_test(a_larger_coverage_replaces_the_smallest),
        cmocka_unit_test(metadata_names_layer_and_hash),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
