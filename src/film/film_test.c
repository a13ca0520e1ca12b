/* Tests of film.h: layers, tone operators through film_tone_map(), alpha. */
#include <float.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "tests/support/support.h"
#include "film/film.h"

static film make_film(uint32_t width, uint32_t height)
{
    film f;
    assert_int_equal(film_create(NULL, width, height, 0, &f, NULL), FACET_OK);
    return f;
}

/* A tone-mapped film of one pixel. */
static void tone_map_one(const float in[4], facet_tonemap operator_, const float *color, float out[4])
{
    film f = make_film(1, 1);
    memcpy(f.layers[0].pixels, in, 4 * sizeof *in);
    film_tone_map(&f, operator_, color, 1);
    memcpy(out, f.layers[0].pixels, 4 * sizeof *out);
    film_destroy(&f);
}

/* ---- layers ---- */

static void layers_are_the_requested_ones(void **state)
{
    (void)state;
    static const struct {
        uint32_t aov;
        const char *name;
        uint32_t channel_count;
        const char *first, *last;
    } expected[] = {
        {FACET_AOV_DEPTH, "depth", 1, "Z", "Z"},
        {FACET_AOV_NORMAL, "normal", 3, "normal.X", "normal.Z"},
        {FACET_AOV_ALBEDO, "albedo", 3, "albedo.R", "albedo.B"},
        {FACET_AOV_MATERIAL_ID, "material", 1, "material.id", "material.id"},
        {FACET_AOV_UV, "uv", 2, "uv.U", "uv.V"},
        {FACET_AOV_OCCLUSION, "occlusion", 1, "occlusion.A", "occlusion.A"},
    };
    for (uint32_t aovs = 0; aovs < 64; aovs++) {
        film f;
        assert_int_equal(film_create(NULL, 5, 3, aovs, &f, NULL), FACET_OK);
        assert_int_equal(f.layer_count, 1 + __builtin_popcount(aovs));
        assert_string_equal(f.layers[0].name, "");
        assert_string_equal(f.layers[0].channel_names[3], "A");
        for (size_t i = 0; i < sizeof expected / sizeof *expected; i++) {
            film_layer *layer = film_find(&f, expected[i].name);
            assert_int_equal(layer != NULL, (aovs & expected[i].aov) != 0);
            if (!layer)
                continue;
            assert_int_equal(layer->channel_count, expected[i].channel_count);
            assert_string_equal(layer->channel_names[0], expected[i].first);
            assert_string_equal(layer->channel_names[layer->channel_count - 1], expected[i].last);
            for (uint32_t k = 0; k < 15 * layer->channel_count; k++)
                assert_true(layer->pixels[k] == (expected[i].aov == FACET_AOV_DEPTH ? INFINITY : 0.0f));
        }
        film_destroy(&f);
    }
}

static void bad_sizes_are_errors(void **state)
{
    (void)state;
    film f;
    facet_error error;
    assert_int_equal(film_create(NULL, 0, 3, 0, &f, &error), FACET_ERROR_ARGUMENT);
    assert_int_equal(f.layer_count, 0);
    assert_int_equal(film_create(NULL, UINT32_MAX, UINT32_MAX, 0, &f, &error), FACET_ERROR_MEMORY);
    assert_int_equal(f.layer_count, 0);
}

static void running_out_of_memory_leaks_nothing(void **state)
{
    (void)state;
    for (int count = 0;; count++) {
        failing_allocator memory = {.fail_at = count};
        facet_allocator allocator = failing_allocator_get(&memory);
        film f;
        facet_result result = film_create(&allocator, 8, 8, 63, &f, NULL);
        film_destroy(&f);
        assert_int_equal(memory.blocks, 0);
        if (result == FACET_OK) {
            assert_int_equal(count, 7);
            break;
        }
        assert_int_equal(result, FACET_ERROR_MEMORY);
    }
}

/* ---- operators ---- */

/* Display-linear values of reference vectors, computed in double from the equations; clamped to 1. */
typedef struct vector {
    facet_tonemap operator_;
    float in[3], out[3];
} vector;
static const vector vectors[] = {
    {FACET_TONEMAP_NEUTRAL, {0.18f, 0.18f, 0.18f}, {0.14f, 0.14f, 0.14f}},
    {FACET_TONEMAP_NEUTRAL, {2.0f, 1.0f, 0.25f}, {0.96f, 0.53409051f, 0.21465839f}},
    {FACET_TONEMAP_NEUTRAL, {10.0f, 0.5f, 0.1f}, {0.99389831f, 0.58962128f, 0.57259909f}},
    {FACET_TONEMAP_ACES, {1.0f, 1.0f, 1.0f}, {0.61911543f, 0.61911543f, 0.61910924f}},
    {FACET_TONEMAP_ACES, {0.9f, 0.2f, 0.05f}, {0.62353083f, 0.14135431f, 0.02778783f}},
    {FACET_TONEMAP_ACES_NARKOWICZ, {2.0f, 1.0f, 0.25f}, {0.91485507f, 0.80379747f, 0.37411095f}},
    {FACET_TONEMAP_REINHARD, {10.0f, 0.5f, 0.1f}, {0.90909091f, 0.33333333f, 0.09090909f}},
    {FACET_TONEMAP_REINHARD_EXTENDED, {0.9f, 0.2f, 0.05f}, {0.68686009f, 0.15263558f, 0.03815889f}},
    {FACET_TONEMAP_REINHARD_EXTENDED, {16.0f, 16.0f, 16.0f}, {1.0f, 1.0f, 1.0f}},
    {FACET_TONEMAP_HABLE, {2.0f, 1.0f, 0.25f}, {0.71323801f, 0.49291855f, 0.17196964f}},
    {FACET_TONEMAP_AGX, {0.18f, 0.18f, 0.18f}, {0.21451909f, 0.21451909f, 0.21451909f}},
    {FACET_TONEMAP_AGX, {2.0f, 1.0f, 0.25f}, {0.77229304f, 0.58620256f, 0.37297179f}},
    {FACET_TONEMAP_AGX, {10.0f, 0.5f, 0.1f}, {1.0f, 0.67139727f, 0.53094959f}},
    {FACET_TONEMAP_NONE, {10.0f, 0.5f, 0.1f}, {10.0f, 0.5f, 0.1f}},
};
enum { VECTOR_COUNT = sizeof vectors / sizeof *vectors };

static void operators_give_reference_vectors(void **state)
{
    (void)state;
    for (size_t i = 0; i < VECTOR_COUNT; i++) {
        float out[4];
        tone_map_one((float[4]){vectors[i].in[0], vectors[i].in[1], vectors[i].in[2], 1.0f},
                     vectors[i].operator_, NULL, out);
        for (int k = 0; k < 3; k++)
            assert_float_equal(out[k], vectors[i].out[k], 2e-5f);
        assert_true(out[3] == 1.0f);
    }
}

static void operators_see_unpremultiplied_color(void **state)
{
    (void)state;
    for (size_t i = 0; i < VECTOR_COUNT; i++)
        for (float opacity = 0.125f; opacity <= 1.0f; opacity += 0.125f) {
            float in[4] = {vectors[i].in[0] * opacity, vectors[i].in[1] * opacity, vectors[i].in[2] * opacity,
                           opacity};
            float out[4];
            tone_map_one(in, vectors[i].operator_, NULL, out);
            for (int k = 0; k < 3; k++)
                assert_float_equal(out[k], vectors[i].out[k] * opacity, 2e-5f);
            assert_true(out[3] == opacity);
        }
}

/* ---- compositing ---- */

static void films_over_a_color_are_opaque(void **state)
{
    (void)state;
    const float behind[3] = {0.25f, 0.5f, 1.0f};
    float out[4];
    tone_map_one((float[4]){0.3f, 0.15f, 0.0f, 0.5f}, FACET_TONEMAP_NONE, behind, out);
    assert_float_equal(out[0], 0.3f + 0.125f, 1e-6f);
    assert_float_equal(out[1], 0.15f + 0.25f, 1e-6f);
    assert_float_equal(out[2], 0.5f, 1e-6f);
    assert_true(out[3] == 1.0f);
    tone_map_one((float[4]){0}, FACET_TONEMAP_AGX, behind, out); /* the color itself is not tone-mapped */
    assert_memory_equal(out, behind, sizeof behind);
    assert_true(out[3] == 1.0f);
}

/* The edge of a surface over a background of its own color is invisible at any coverage. */
static void edges_have_no_fringe(void **state)
{
    (void)state;
    for (int step = 0; step <= 64; step++) {
        float opacity = (float)step / 64.0f;
        for (int shade = 0; shade < 2; shade++) {
            float c = shade ? 1.0f : 0.0f;
            float behind[3] = {c, c, c};
            float out[4];
            tone_map_one((float[4]){c * opacity, c * opacity, c * opacity, opacity}, FACET_TONEMAP_NONE,
                         behind, out);
            for (int k = 0; k < 3; k++)
                assert_float_equal(out[k], c, 1e-6f);
        }
    }
}

static void nonfinite_values_are_made_finite(void **state)
{
    (void)state;
    const float odd[] = {NAN, INFINITY, -INFINITY, -1.0f, FLT_MAX, 1e-40f};
    enum { COUNT = sizeof odd / sizeof *odd };
    for (int op = FACET_TONEMAP_NONE; op <= FACET_TONEMAP_HABLE; op++)
        for (int c = 0; c < COUNT; c++)
            for (int a = 0; a < COUNT + 1; a++) {
                float out[4];
                tone_map_one((float[4]){odd[c], 0.5f, odd[c], a < COUNT ? odd[a] : 1.0f}, (facet_tonemap)op,
                             NULL, out);
                for (int k = 0; k < 4; k++)
                    assert_true(out[k] >= 0.0f && out[k] <= FLT_MAX);
                assert_true(out[3] <= 1.0f);
            }
}

static void results_do_not_depend_on_threads(void **state)
{
    (void)state;
    enum { WIDTH = 333, HEIGHT = 217 };
    for (int op = FACET_TONEMAP_NONE; op <= FACET_TONEMAP_HABLE; op++) {
        film one = make_film(WIDTH, HEIGHT);
        film many = make_film(WIDTH, HEIGHT);
        uint32_t random = 1;
        for (size_t i = 0; i < 4 * WIDTH * HEIGHT; i++) {
            lcg_next(&random);
            one.layers[0].pixels[i] = many.layers[0].pixels[i] = (float)(random >> 8) * 0x1p-22f;
        }
        film_tone_map(&one, (facet_tonemap)op, NULL, 1);
        film_tone_map(&many, (facet_tonemap)op, NULL, 7);
        assert_memory_equal(one.layers[0].pixels, many.layers[0].pixels, 16 * WIDTH * HEIGHT);
        film_destroy(&one);
        film_destroy(&many);
    }
}

/* ---- blending of encoded values ---- */

/* Half of 0.8 over 0.2 is 0.5 on the display; blended as light it would be 0.6. Opaque pixels keep their
 * bits. */
static void encoded_values_are_blended_without_decoding(void **state)
{
    (void)state;
    const float linear[3] = {0.60382734f, 0.03310477f, 0.21404114f}; /* of 0.8, 0.2, 0.5 */
    const float color[3] = {linear[1], linear[0], linear[2]};
    static const float opacities[] = {0.0f, 0.25f, 0.5f, 1.0f};
    static const double colors[3] = {0.8, 0.2, 0.5}, behind[3] = {0.2, 0.8, 0.5};
    for (int i = 0; i < 4; i++) {
        film f = make_film(1, 1);
        float *pixel = f.layers[0].pixels;
        for (int c = 0; c < 3; c++)
            pixel[c] = linear[c] * opacities[i];
        pixel[3] = opacities[i];
        film_blend_encoded(&f, color, 1);
        for (int c = 0; c < 3; c++) {
            double a = (double)opacities[i];
            assert_true(fabs(srgb_encode((double)pixel[c]) - (a * colors[c] + (1.0 - a) * behind[c])) < 1e-6);
            if (i == 3)
                assert_memory_equal(pixel, linear, sizeof linear);
        }
        assert_true(pixel[3] == 1.0f);
        film_destroy(&f);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(layers_are_the_requested_ones),
        cmocka_unit_test(bad_sizes_are_errors),
        cmocka_unit_test(running_out_of_memory_leaks_nothing),
        cmocka_unit_test(operators_give_reference_vectors),
        cmocka_unit_test(operators_see_unpremultiplied_color),
        cmocka_unit_test(films_over_a_color_are_opaque),
        cmocka_unit_test(edges_have_no_fringe),
        cmocka_unit_test(nonfinite_values_are_made_finite),
        cmocka_unit_test(results_do_not_depend_on_threads),
        cmocka_unit_test(encoded_values_are_blended_without_decoding),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
