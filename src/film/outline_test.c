/* outline_test.c - squares on backgrounds of their color, and of others. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "film/outline.h"

enum { SIZE = 64 };

/* A square of side pixels of that grey, of which the lower part of the outline is red. */
static bool is_hidden(float grey, uint32_t side, uint32_t red_rows, facet_tonemap operator_, float behind)
{
    film f;
    assert_int_equal(film_create(NULL, SIZE, SIZE, 0, &f, NULL), FACET_OK);
    for (uint32_t y = 10; y < 10 + side; y++)
        for (uint32_t x = 10; x < 10 + side; x++) {
            float *p = f.layers[0].pixels + 4 * ((size_t)y * SIZE + x);
            p[0] = grey;
            p[1] = p[2] = y + red_rows < 10 + side ? grey : 0.0f;
            p[3] = 1.0f;
        }
    bool result = film_outline_is_hidden(&f, operator_, (const float[]){behind, behind, behind});
    film_destroy(&f);
    return result;
}

static void outlines_hide_in_their_own_color(void **state)
{
    (void)state;
    assert_true(is_hidden(1.0f, 40, 0, FACET_TONEMAP_NONE, 1.0f));
    assert_true(is_hidden(50.0f, 40, 0, FACET_TONEMAP_NEUTRAL, 1.0f));
    assert_true(is_hidden(0.0f, 40, 0, FACET_TONEMAP_NEUTRAL, 0.0f));
    assert_true(is_hidden(0.88f, 40, 0, FACET_TONEMAP_NONE, 1.0f));  /* 241 of 255 */
    assert_false(is_hidden(0.85f, 40, 0, FACET_TONEMAP_NONE, 1.0f)); /* 237 */
    assert_false(is_hidden(1.0f, 40, 0, FACET_TONEMAP_NONE, 0.8f));
}

static void a_part_of_the_outline_is_enough_to_see_it(void **state)
{
    (void)state;
    assert_true(is_hidden(1.0f, 40, 1, FACET_TONEMAP_NONE, 1.0f));
    assert_false(is_hidden(1.0f, 40, 20, FACET_TONEMAP_NONE, 1.0f));
}

static void small_things_have_no_outline(void **state)
{
    (void)state;
    assert_false(is_hidden(1.0f, 6, 0, FACET_TONEMAP_NONE, 1.0f));
    assert_false(is_hidden(1.0f, 0, 0, FACET_TONEMAP_NONE, 1.0f));
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(outlines_hide_in_their_own_color),
                                       cmocka_unit_test(a_part_of_the_outline_is_enough_to_see_it),
                                       cmocka_unit_test(small_things_have_no_outline)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
