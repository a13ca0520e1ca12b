/* palette_test.c - colors are visible and distinguishable. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "plot/palette.h"

/* Rows of the published table, most of them between stored ones. */
static void viridis_equals_the_published_one(void **state)
{
    (void)state;
    static const double ROWS[][4] = {{0, 0.267004, 0.004874, 0.329415},   {7, 0.276022, 0.044167, 0.370164},
                                     {68, 0.221989, 0.339161, 0.548752},  {128, 0.127568, 0.566949, 0.550556},
                                     {143, 0.120081, 0.622161, 0.534946}, {198, 0.421908, 0.805774, 0.351910},
                                     {243, 0.876168, 0.891125, 0.095250}, {252, 0.964894, 0.902323, 0.123941},
                                     {255, 0.993248, 0.906157, 0.143936}};
    for (size_t i = 0; i < sizeof ROWS / sizeof *ROWS; i++) {
        const canvas_color c = palette_viridis(ROWS[i][0] / 255.0);
        /* half a step of 8 bits */
        assert_true(fabs(c.r - ROWS[i][1]) < 0.002);
        assert_true(fabs(c.g - ROWS[i][2]) < 0.002);
        assert_true(fabs(c.b - ROWS[i][3]) < 0.002);
    }
}

static void viridis_rises_in_lightness(void **state)
{
    (void)state;
    const canvas_color black = {0.0, 0.0, 0.0, 1.0};
    double last = 0.0;
    for (int i = 0; i <= 1000; i++) {
        const canvas_color c = palette_viridis(i / 1000.0);
        assert_true(c.r >= 0.0 && c.r <= 1.0 && c.g >= 0.0 && c.g <= 1.0 && c.b >= 0.0 && c.b <= 1.0);
        const double lightness = palette_contrast(c, black);
        assert_true(lightness > last);
        last = lightness;
    }
    assert_true(palette_viridis(-1.0).r == palette_viridis(0.0).r &&
                palette_viridis(2.0).g == palette_viridis(1.0).g);
}

static void colors_are_visible_on_both_backgrounds(void **state)
{
    (void)state;
    for (int is_dark = 0; is_dark < 2; is_dark++) {
        const palette_theme *theme = palette_get_theme(is_dark);
        assert_true(palette_contrast(theme->text, theme->background) >= 7.0);
        assert_true(palette_contrast(theme->muted_text, theme->background) >= 4.5); /* WCAG 2.1, 1.4.3 */
        assert_true(palette_contrast(theme->grid, theme->background) < 2.0);        /* weaker than the data */
        for (int i = 0; i < PALETTE_COUNT; i++)
            assert_true(palette_contrast(palette_color(&(chart_style){.color = i}, is_dark),
                                         theme->background) >= (is_dark ? 4.5 : PALETTE_MIN_CONTRAST));
        for (int i = 0; i < 8; i++) {
            const chart_style own = {.color = -1,
                                     .rgb = {(float)(i & 1), (float)(i >> 1 & 1), (float)(i >> 2)}};
            assert_true(palette_contrast(palette_color(&own, is_dark), theme->background) >=
                        PALETTE_MIN_CONTRAST);
        }
    }
    const canvas_color red = palette_color(&(chart_style){.color = -1, .rgb = {0.8f, 0.1f, 0.0f}}, false);
    assert_true(fabs(red.r - 0.8) < 1e-6 && fabs(red.g - 0.1) < 1e-6 && red.b == 0.0); /* unchanged */
}

static void color_indices_wrap_around(void **state)
{
    (void)state;
    const canvas_color first = palette_color(&(chart_style){.color = 0}, false);
    const canvas_color again = palette_color(&(chart_style){.color = PALETTE_COUNT}, false);
    assert_memory_equal(&first, &again, sizeof first);
    for (int i = 0; i < PALETTE_COUNT; i++)
        for (int k = 0; k < i; k++) {
            const canvas_color a = palette_color(&(chart_style){.color = i}, false);
            const canvas_color b = palette_color(&(chart_style){.color = k}, false);
            assert_true(fabs(a.r - b.r) + fabs(a.g - b.g) + fabs(a.b - b.b) > 0.3);
        }
    assert_int_equal(palette_stroke(&(chart_style){.dash = 0}, false, 1.0).dash_count, 0);
    assert_int_equal(palette_stroke(&(chart_style){.dash = 1}, false, 1.0).dash_count, 2);
    assert_int_equal(palette_stroke(&(chart_style){.dash = 7}, false, 1.0).dash_count, 4);
    assert_int_equal(palette_stroke(&(chart_style){.dash = -1}, false, 1.0).dash_count, 4);
    const chart_style hostile = {.color = -1, .rgb = {NAN, INFINITY, -1.0f}, .width = NAN};
    const canvas_stroke stroke = palette_stroke(&hostile, false, 2.0);
    assert_true(stroke.width == 3.5 && isfinite(stroke.color.r) && isfinite(stroke.color.g));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(viridis_equals_the_published_one),
        cmocka_unit_test(viridis_rises_in_lightness),
        cmocka_unit_test(colors_are_visible_on_both_backgrounds),
        cmocka_unit_test(color_indices_wrap_around),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
