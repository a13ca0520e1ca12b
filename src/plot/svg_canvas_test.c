/* svg_canvas_test.c - SVG without cairo: this program has svg_canvas.c's canvas in place of cairo's. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "base/memory.h"
#include "plot/chart.h"
#include "tests/support/support.h"
#include "plot/canvas.h"

static canvas *create(uint32_t width, uint32_t height, const char *title)
{
    canvas *c;
    facet_error error;
    const canvas_desc desc = {
        .format = FACET_PLOT_FORMAT_SVG, .width = width, .height = height, .title = title};
    assert_int_equal(canvas_create(&desc, &c, &error), FACET_OK);
    return c;
}

static void expect_parts(canvas *c, const char *const *parts)
{
    unsigned char *bytes;
    size_t size;
    facet_error error;
    assert_int_equal(canvas_finish(c, &bytes, &size, &error), FACET_OK);
    assert_int_equal(size, strlen((const char *)bytes));
    const char *at = (const char *)bytes;
    for (; *parts; parts++) {
        const char *found = strstr(at, *parts);
        if (!found)
            fail_msg("\"%s\" does not follow in\n%s", *parts, bytes);
        at = found + strlen(*parts);
    }
    mem_free(bytes);
    canvas_destroy(c);
}

static void shapes_are_paths(void **state)
{
    (void)state;
    canvas *c = create(40, 20, "a < b & c");
    canvas_rectangle(c, 1.0, 2.0, 3.5, 4.125);
    canvas_fill(c, (canvas_color){1.0, 0.5, 0.0, 0.25});
    canvas_move_to(c, 0.0, 0.0);
    canvas_line_to(c, -10.0, 1e9);
    canvas_draw(c, &(canvas_stroke){
                       .color = {0.0, 0.0, 0.0, 1.0}, .width = 1.5, .dash = {4.0, 2.0}, .dash_count = 2});
    expect_parts(
        c,
        (const char *const[]){
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"40\" height=\"20\" viewBox=\"0 0 40 20\"",
            "<title>a &lt; b &amp; c</title>",
            "<path d=\"M1 2L4.5 2L4.5 6.13L1 6.13Z\" fill=\"#ff8000\" fill-opacity=\"0.25\"/>",
            "<path d=\"M0 0L-10 1000000\" stroke=\"#000000\" stroke-width=\"1.5\" stroke-linecap=\"round\"",
            "stroke-dasharray=\"4 2\"", "</svg>", NULL});
}

static void arcs_are_parts_of_circles(void **state)
{
    (void)state;
    canvas *c = create(40, 20, NULL);
    canvas_arc(c, 10.0, 10.0, 5.0, 0.0, 6.283185307179586);
    canvas_close(c);
    canvas_fill(c, (canvas_color){0.0, 0.0, 0.0, 1.0});
    expect_parts(
        c, (const char *const[]){"d=\"M15 10A5 5 0 0 1 ", "A5 5 0 0 1 ", "A5 5 0 0 1 ", " 10Z\"", NULL});
}

static void clips_end_with_restore(void **state)
{
    (void)state;
    canvas *c = create(40, 20, NULL);
    canvas_save(c);
    canvas_rectangle(c, 0.0, 0.0, 10.0, 10.0);
    canvas_clip(c);
    canvas_rectangle(c, 5.0, 5.0, 10.0, 10.0);
    canvas_fill(c, (canvas_color){0.0, 0.0, 0.0, 1.0});
    canvas_restore(c);
    expect_parts(c, (const char *const[]){"<clipPath id=\"clip1\"><path d=\"M0 0",
                                          "/></clipPath>\n<g clip-path=\"url(#clip1)\">\n", "<path d=\"M5 5",
                                          "</g>\n</svg>", NULL});
}

static void text_has_its_length(void **state)
{
    (void)state;
    canvas *c = create(40, 20, NULL);
    assert_near(canvas_text_width(c, (canvas_font){.size = 20.48}, "1\xc2\xb0"), 13.03 + 10.24, 1e-9);
    assert_true(canvas_text_width(c, (canvas_font){.size = 10.0, .is_bold = true}, "Roughness") >
                canvas_text_width(c, (canvas_font){.size = 10.0}, "Roughness"));
    canvas_text(c, 3.0, 4.0, -1.5707963267948966, (canvas_font){.size = 20.48}, (canvas_color){0, 0, 0, 1.0},
                "1\xc2\xb0<");
    expect_parts(
        c, (const char *const[]){"<text x=\"3\" y=\"4\" transform=\"rotate(-90 3 4)\" font-size=\"20.48\"",
                                 "textLength=\"40.43\"", ">1\xc2\xb0&lt;</text>", NULL});
}

static void images_are_png(void **state)
{
    (void)state;
    canvas *c = create(40, 20, NULL);
    uint32_t pixels[2] = {0xff0000ffu, 0x80400000u};
    canvas_image(c, 1.0, 2.0, 8.0, 4.0, pixels, 2, 1);
    expect_parts(c, (const char *const[]){
                        "<image preserveAspectRatio=\"none\" x=\"1\" y=\"2\" width=\"8\" height=\"4\" "
                        "href=\"data:image/png;base64,iVBORw0KGgo",
                        NULL});
}

static void other_formats_and_sizes_are_refused(void **state)
{
    (void)state;
    canvas *c;
    facet_error error;
    assert_int_equal(
        canvas_create(&(canvas_desc){.format = FACET_PLOT_FORMAT_PNG, .width = 9, .height = 9}, &c, &error),
        FACET_ERROR_UNSUPPORTED);
    assert_non_null(strstr(error.message, "cairo"));
    assert_int_equal(canvas_create(&(canvas_desc){.width = 20000, .height = 9}, &c, &error),
                     FACET_ERROR_ARGUMENT);
    assert_null(c);
}

/* ---- whole charts ---- */

static const double X[3] = {0.0, 0.5, 1.0}, Y[3] = {0.1, (double)NAN, 3.0};

static facet_result write(const chart *c, bool as_json, const facet_allocator *allocator,
                          unsigned char **bytes)
{
    size_t size;
    facet_error error;
    return as_json ? chart_write_json(c, allocator, bytes, &size, &error)
                   : chart_draw(c, FACET_PLOT_FORMAT_SVG, allocator, bytes, &size, &error);
}

/* The file of a chart with every kind of line and text; at each failing allocation there is none, and nothing leaks. */
static void expect_chart(bool as_json, const char *const parts[2])
{
    const chart_curve curve = {.name = "a \"b\"", .count = 3, .x = X, .y = Y, .style = {.dash = 1}};
    const chart_panel panels[] = {
        {.kind = CHART_XY,
         .title = "one",
         .x = {.label = "x"},
         .y = {.label = "y"},
         .curve_count = 1,
         .curves = &curve,
         .has_legend = true},
        {.kind = CHART_POLAR, .title = "two", .note = "half", .curve_count = 1, .curves = &curve}};
    const chart c = {
        .title = "all", .width = 600, .height = 300, .columns = 2, .panel_count = 2, .panels = panels};
    for (long i = 0;; i = next_failure(i)) {
        failing_allocator failing = {.fail_at = i};
        const facet_allocator allocator = failing_allocator_get(&failing);
        unsigned char *bytes;
        facet_result result = write(&c, as_json, &allocator, &bytes);
        if (result == FACET_OK) {
            for (int k = 0; k < 2; k++)
                if (!strstr((const char *)bytes, parts[k]))
                    fail_msg("%s is not in\n%s", parts[k], bytes);
            mem_free(bytes);
            assert_int_equal(failing.blocks, 0);
            return;
        }
        assert_int_equal(result, FACET_ERROR_MEMORY);
        assert_null(bytes);
        assert_int_equal(failing.blocks, 0);
    }
}

static void charts_are_drawn(void **state)
{
    (void)state;
    expect_chart(false, (const char *const[2]){">two</text>", "<title>all</title>"});
    expect_chart(true,
                 (const char *const[2]){"{\"kind\":\"polar\",\"title\":\"two\",\"note\":\"half\",\"plot\":[",
                                        "\"x\":[0,0.5,1],\"y\":[0.1,null,3]}"});
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(shapes_are_paths),       cmocka_unit_test(arcs_are_parts_of_circles),
        cmocka_unit_test(clips_end_with_restore), cmocka_unit_test(text_has_its_length),
        cmocka_unit_test(images_are_png),         cmocka_unit_test(other_formats_and_sizes_are_refused),
        cmocka_unit_test(charts_are_drawn)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
