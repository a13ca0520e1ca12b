/* bake_dfg_test.c - LUTs of directional albedo: nodes, layouts, threads, refusals. The integrals
 * themselves: ibl/dfg_integrate_test.c. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "tests/support/support.h"
#include "bake/bake.h"
#include "ibl/dfg_integrate.h"

static image bake(facet_dfg_kind kind, uint32_t size, uint32_t thread_count)
{
    image table = {0};
    facet_error error = {0};
    facet_result result =
        bake_dfg(&(facet_dfg_desc){.kind = kind, .size = size, .thread_count = thread_count}, &table, &error);
    if (result != FACET_OK)
        fail_msg("%s", error.message);
    return table;
}

static const float *node(const image *table, uint32_t x, uint32_t y)
{
    return (const float *)table->pixels + table->channel_count * ((size_t)y * table->width + x);
}

static void luts_have_the_channels_of_their_kind(void **state)
{
    (void)state;
    static const uint32_t counts[] = {2, 2, 2, 1, 1, 1, 3};
    for (int kind = 0; kind < 7; kind++) {
        assert_int_equal(facet_dfg_get_channel_count((facet_dfg_kind)kind), counts[kind]);
        image table = bake((facet_dfg_kind)kind, 16, 0);
        assert_int_equal(table.width, 16);
        assert_int_equal(table.height, 16);
        assert_int_equal(table.channel_count, counts[kind]);
        assert_int_equal(table.type, IMAGE_F32);
        image_destroy(&table);
    }
    image table = bake(FACET_DFG_KIND_GGX_AVERAGE, 0, 0);
    assert_int_equal(table.width, 128);
    image_destroy(&table);
}

/* x is N.V and y perceptual roughness, at middles of texels, from 0. */
static void texels_are_at_their_nodes(void **state)
{
    (void)state;
    enum { SIZE = 40 };
    image correlated = bake(FACET_DFG_KIND_CORRELATED, SIZE, 0);
    image schlick = bake(FACET_DFG_KIND_SCHLICK, SIZE, 0);
    image charlie = bake(FACET_DFG_KIND_CHARLIE, SIZE, 0);
    static const uint32_t places[4][2] = {{0, 39}, {39, 0}, {7, 20}, {33, 3}};
    for (int i = 0; i < 4; i++) {
        uint32_t x = places[i][0];
        uint32_t y = places[i][1];
        double NdotV = (x + 0.5) / SIZE;
        float roughness = ((float)y + 0.5f) / SIZE;
        dfg_terms t = dfg_integrate(DFG_SMITH_CORRELATED, roughness, NdotV);
        assert_near(node(&correlated, x, y)[0], t.scale, 1e-7);
        assert_near(node(&correlated, x, y)[1], t.bias, 1e-7);
        t = dfg_integrate(DFG_SCHLICK_IBL, roughness, NdotV);
        assert_near(node(&schlick, x, y)[0], t.scale, 1e-7);
        assert_near(node(&schlick, x, y)[1], t.bias, 1e-7);
        sheen_nodes nodes;
        sheen_prepare(roughness, &nodes);
        assert_near(node(&charlie, x, y)[0], sheen_integrate(&nodes, NdotV).charlie, 1e-7);
    }
    image_destroy(&correlated);
    image_destroy(&schlick);
    image_destroy(&charlie);
}

/* One integral in several layouts. */
static void kinds_agree(void **state)
{
    (void)state;
    enum { SIZE = 24 };
    image correlated = bake(FACET_DFG_KIND_CORRELATED, SIZE, 0);
    image multiscatter = bake(FACET_DFG_KIND_MULTISCATTER, SIZE, 0);
    image neubelt = bake(FACET_DFG_KIND_CHARLIE_NEUBELT, SIZE, 0);
    image filament = bake(FACET_DFG_KIND_FILAMENT, SIZE, 0);
    for (uint32_t y = 0; y < SIZE; y++)
        for (uint32_t x = 0; x < SIZE; x++) {
            const float *c = node(&correlated, x, y);
            const float *m = node(&multiscatter, x, y);
            const float *f = node(&filament, x, y);
            assert_true(c[1] == m[0]);
            assert_near(c[0] + c[1], m[1], 1.2e-7);
            assert_true(c[0] + c[1] <= 1.0f + 1e-6f);
            assert_true(f[0] == m[0] && f[1] == m[1] && f[2] == node(&neubelt, x, y)[0]);
        }
    image_destroy(&correlated);
    image_destroy(&multiscatter);
    image_destroy(&neubelt);
    image_destroy(&filament);
}

/* Averages are those of the table of albedos over the cosine, by its own midpoints, and the same in each
 * column. */
static void averages_are_those_of_the_albedos(void **state)
{
    (void)state;
    enum { SIZE = 128 };
    image albedo = bake(FACET_DFG_KIND_MULTISCATTER, SIZE, 0);
    image average = bake(FACET_DFG_KIND_GGX_AVERAGE, SIZE, 0);
    for (uint32_t y = 0; y < SIZE; y++) {
        double sum = 0.0;
        for (uint32_t x = 0; x < SIZE; x++) {
            sum += 2.0 * (x + 0.5) / SIZE * (double)node(&albedo, x, y)[1] / SIZE;
            assert_true(node(&average, x, y)[0] == node(&average, 0, y)[0]);
        }
        assert_near(node(&average, 0, y)[0], sum, 3e-5);
    }
    image_destroy(&albedo);
    image_destroy(&average);
}

static void luts_do_not_depend_on_threads(void **state)
{
    (void)state;
    image a = bake(FACET_DFG_KIND_FILAMENT, 33, 1);
    image b = bake(FACET_DFG_KIND_FILAMENT, 33, 5);
    assert_memory_equal(a.pixels, b.pixels, image_row_size(&a) * a.height);
    image_destroy(&a);
    image_destroy(&b);
}

static void progress_is_reported_and_can_cancel(void **state)
{
    (void)state;
    captured_progress w = {0};
    image table = {0};
    facet_dfg_desc desc = {.size = 32, .thread_count = 1, .progress = capture_progress(&w)};
    assert_int_equal(bake_dfg(&desc, &table, NULL), FACET_OK);
    assert_int_equal(w.calls, 32);
    assert_true(w.fraction == 1.0);
    assert_string_equal(w.stage, "table");
    image_destroy(&table);
    w = (captured_progress){.stops_at = 5};
    facet_error error = {0};
    assert_int_equal(bake_dfg(&desc, &table, &error), FACET_ERROR_CANCELLED);
    assert_int_equal(w.calls, 5);
    assert_null(table.pixels);
    assert_string_equal(error.message, "dfg: cancelled after 5 of 32 rows");
}

static void *no_memory(void *user, size_t size)
{
    (void)user, (void)size;
    return NULL;
}

static void no_release(void *user, void *memory, size_t size)
{
    (void)user, (void)memory, (void)size;
}

static void invalid_descs_are_refused(void **state)
{
    (void)state;
    image table = {0};
    facet_error error = {0};
    assert_int_equal(bake_dfg(&(facet_dfg_desc){.size = 15}, &table, &error), FACET_ERROR_ARGUMENT);
    assert_string_equal(error.message, "dfg: size 15: 16 to 1024 texels were expected");
    assert_int_equal(bake_dfg(&(facet_dfg_desc){.size = 1025}, &table, &error), FACET_ERROR_ARGUMENT);
    assert_int_equal(bake_dfg(&(facet_dfg_desc){.kind = (facet_dfg_kind)7}, &table, &error),
                     FACET_ERROR_ARGUMENT);
    facet_dfg_desc desc = {.allocator = {NULL, no_memory, no_release}};
    assert_int_equal(bake_dfg(&desc, &table, &error), FACET_ERROR_MEMORY);
    assert_null(table.pixels);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(luts_have_the_channels_of_their_kind),
        cmocka_unit_test(texels_are_at_their_nodes),
        cmocka_unit_test(kinds_agree),
        cmocka_unit_test(averages_are_those_of_the_albedos),
        cmocka_unit_test(luts_do_not_depend_on_threads),
        cmocka_unit_test(progress_is_reported_and_can_cancel),
        cmocka_unit_test(invalid_descs_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
