/* chart_test.c - charts as files: well-formed SVG and repeatable bytes for any data and labels; errors
 * without cairo and without memory. */
#include "tests/support/support.h"
#include "plot/chart_test_scene.h"

#include <pthread.h>

/* ---- an XML scanner: elements nest, attributes are quoted, characters are valid, references resolve ---- */

enum { XML_DEPTH = 64, XML_NAME = 32 };

static size_t name_length(const char *p)
{
    return strcspn(p, " \t\r\n/>=");
}

/* Fails if an ampersand begins no entity or a character is not valid in XML. */
static void scan_characters(const char *from, const char *end)
{
    for (const char *p = from; p < end; p++) {
        assert_true((unsigned char)*p >= 0x20 || *p == '\n' || *p == '\t');
        if (*p == '&')
            assert_true(strncmp(p, "&lt;", 4) == 0 || strncmp(p, "&gt;", 4) == 0 ||
                        strncmp(p, "&amp;", 5) == 0 || strncmp(p, "&quot;", 6) == 0);
    }
}

/* Scans attributes from p to the end of the tag; returns whether it is self-closing. */
static const char *scan_attributes(const char *p, bool *is_empty)
{
    for (;;) {
        p += strspn(p, " \t\r\n");
        if (*p == '/' || *p == '>') {
            *is_empty = *p == '/';
            p += *is_empty;
            assert_int_equal(*p, '>');
            return p + 1;
        }
        p += name_length(p);
        assert_int_equal(*p, '=');
        assert_int_equal(p[1], '"');
        const char *end = strchr(p + 2, '"');
        assert_non_null(end);
        assert_null(memchr(p + 2, '<', (size_t)(end - p - 2)));
        scan_characters(p + 2, end);
        p = end + 1;
    }
}

static void expect_well_formed(const char *p)
{
    char names[XML_DEPTH][XML_NAME];
    int depth = 0, root_count = 0;
    assert_true(strncmp(p, "<?xml ", 6) == 0);
    p = strstr(p, "?>") + 2;
    while (*p) {
        const char *tag = p + strcspn(p, "<");
        scan_characters(p, tag);
        if (*tag == 0)
            break;
        assert_true(depth > 0 || root_count == 0);
        if (tag[1] == '/') {
            const size_t length = name_length(tag + 2);
            assert_true(depth > 0);
            depth--;
            assert_true(strlen(names[depth]) == length && memcmp(names[depth], tag + 2, length) == 0);
            assert_int_equal(tag[2 + length], '>');
            p = tag + 3 + length;
            continue;
        }
        const size_t length = name_length(tag + 1);
        bool is_empty;
        assert_true(depth < XML_DEPTH && length > 0 && length < XML_NAME);
        memcpy(names[depth], tag + 1, length);
        names[depth][length] = 0;
        root_count += depth == 0;
        p = scan_attributes(tag + 1 + length, &is_empty);
        depth += !is_empty;
    }
    assert_int_equal(depth, 0);
    assert_int_equal(root_count, 1);
}

/* Every "#name" refers to the id of one element. */
static void expect_references(const char *svg)
{
    int count = 0;
    for (const char *p = svg; (p = strstr(p, "#")) != NULL; p++) {
        char id[80];
        const size_t length = strcspn(p + 1, "\")");
        assert_true(length > 0 && length < 60);
        snprintf(id, sizeof id, " id=\"%.*s\"", (int)length, p + 1);
        const char *found = strstr(svg, id);
        assert_non_null(found);
        assert_null(strstr(found + 1, id));
        count++;
    }
    assert_true(count > 0);
}

/* ---- charts ---- */

static void expect_svg(const chart *c)
{
    const drawn d = draw(c, FACET_PLOT_FORMAT_SVG);
    char head[80];
    assert_int_equal(strlen((const char *)d.bytes), d.size);
    expect_well_formed((const char *)d.bytes);
    snprintf(head, sizeof head, "width=\"%upx\" height=\"%upx\" viewBox=\"0 0 %u %u\"", c->width, c->height,
             c->width, c->height);
    assert_non_null(strstr((const char *)d.bytes, head));
    mem_free(d.bytes);
}

static void svg_is_well_formed(void **state)
{
    (void)state;
    for (int kind = 0; kind < SCENE_KINDS; kind++) {
        const chart c = scene_chart(&data.panels[kind]);
        expect_svg(&c);
        const drawn d = draw(&c, FACET_PLOT_FORMAT_SVG);
        assert_non_null(strstr((const char *)d.bytes, "<title>A chart</title>"));
        if (kind == CHART_XY)
            expect_references((const char *)d.bytes);
        mem_free(d.bytes);
    }
}

/* ---- the same chart, the same bytes ---- */

static void charts_are_repeatable(void **state)
{
    (void)state;
    static const facet_plot_format FORMATS[3] = {FACET_PLOT_FORMAT_SVG, FACET_PLOT_FORMAT_PDF,
                                                 FACET_PLOT_FORMAT_PNG};
    drawn first[SCENE_KINDS][3];
    for (int round = 0; round < 2; round++)
        for (int kind = 0; kind < SCENE_KINDS; kind++)
            for (int f = 0; f < 3; f++) {
                chart c = scene_chart(&data.panels[kind]);
                const drawn d = draw(&c, FORMATS[f]);
                if (round == 0) {
                    first[kind][f] = d;
                    continue;
                }
                assert_int_equal(d.size, first[kind][f].size);
                assert_memory_equal(d.bytes, first[kind][f].bytes, d.size);
                mem_free(d.bytes);
                mem_free(first[kind][f].bytes);
            }
}

static void *draw_in_thread(void *result)
{
    const chart c = scene_chart(&data.panels[CHART_DISC]);
    facet_error error;
    drawn *d = result;
    if (chart_draw(&c, FACET_PLOT_FORMAT_SVG, NULL, &d->bytes, &d->size, &error) != FACET_OK)
        d->bytes = NULL;
    return NULL;
}

/* cairo numbers images across all threads of a process. */
static void threads_draw_the_same_bytes(void **state)
{
    (void)state;
    enum { THREADS = 4 };
    for (int round = 0; round < 5; round++) {
        pthread_t threads[THREADS];
        drawn results[THREADS];
        for (int i = 0; i < THREADS; i++)
            assert_int_equal(pthread_create(&threads[i], NULL, draw_in_thread, &results[i]), 0);
        for (int i = 0; i < THREADS; i++)
            pthread_join(threads[i], NULL);
        for (int i = 0; i < THREADS; i++) {
            assert_non_null(results[i].bytes);
            assert_int_equal(results[i].size, results[0].size);
            assert_memory_equal(results[i].bytes, results[0].bytes, results[0].size);
        }
        for (int i = 0; i < THREADS; i++)
            mem_free(results[i].bytes);
    }
}

static bool contains(const drawn *d, const char *string)
{
    const size_t length = strlen(string);
    for (size_t i = 0; i + length <= d->size; i++)
        if (memcmp(d->bytes + i, string, length) == 0)
            return true;
    return false;
}

static void pdf_has_a_title_and_no_date(void **state)
{
    (void)state;
    const chart c = scene_chart(&data.panels[CHART_XY]);
    const drawn d = draw(&c, FACET_PLOT_FORMAT_PDF);
    assert_memory_equal(d.bytes, "%PDF-", 5);
    assert_true(contains(&d, "/Title (A chart)"));
    assert_true(contains(&d, "/MediaBox [ 0 0 300 225 ]")); /* 400 x 300 px of 1/96 inch */
    assert_false(contains(&d, "Date"));
    assert_true(contains(&d, "/ToUnicode")); /* text is text */
    mem_free(d.bytes);
}

/* ---- hostile data ---- */

static void any_label_can_be_drawn(void **state)
{
    (void)state;
    char *endless = malloc(100001);
    assert_non_null(endless);
    memset(endless, 'w', 100000);
    endless[100000] = 0;
    const char *const labels[] = {"<b>&amp;\"'</b>]]>",
                                  "two\nlines\r\n\tand a tab",
                                  "\x01\x7f\xff\xfe\xc3(\xed\xa0\x80",
                                  "\xf0\x9f\x98\x80 \xd7\xa9 \xe6\xbc\xa2",
                                  "%s%n",
                                  "",
                                  "\xe2\x80",
                                  endless};
    for (size_t i = 0; i < sizeof labels / sizeof *labels; i++) {
        chart_curve curves[2] = {data.lines[0], data.lines[1]};
        curves[0].name = labels[i];
        const chart_panel panel = {.title = labels[i],
                                   .note = labels[i],
                                   .x = {.label = labels[i]},
                                   .y = {.label = labels[i]},
                                   .curve_count = 2,
                                   .curves = curves,
                                   .has_legend = true};
        chart c = scene_chart(&panel);
        c.title = labels[i];
        expect_svg(&c);
        image raster = draw_raster(&c);
        image_destroy(&raster);
        const drawn pdf = draw(&c, FACET_PLOT_FORMAT_PDF);
        mem_free(pdf.bytes);
    }
    chart c = scene_chart(&(chart_panel){.kind = CHART_XY}); /* NULL wherever there may be a label */
    c.title = labels[0];
    const drawn d = draw(&c, FACET_PLOT_FORMAT_SVG);
    assert_non_null(strstr((const char *)d.bytes, "<title>&lt;b&gt;&amp;amp;\"'&lt;/b&gt;]]&gt;</title>"));
    mem_free(d.bytes);
    free(endless);
}

static void draw_all_kinds(const double *x, const double *y, size_t count, chart_scale scale)
{
    const chart_curve curve = {
        .name = "curve", .count = count, .x = x, .y = y, .style = {.has_markers = true}};
    const chart_field field = {.width = (uint32_t)count,
                               .height = 1,
                               .values = y,
                               .x1 = 1.0,
                               .y1 = 1.0,
                               .scale = scale,
                               .label = "values"};
    const chart_surface surface = {
        .width = 2, .height = (uint32_t)count / 2, .x = x, .y = y, .z = y, .label = "z"};
    for (int kind = 0; kind < SCENE_KINDS; kind++) {
        const chart_panel panel = {.kind = (chart_panel_kind)kind,
                                   .x = {.label = "x"},
                                   .y = {.label = "y", .scale = scale},
                                   .curve_count = 1,
                                   .curves = &curve,
                                   .field = &field,
                                   .surface = &surface,
                                   .has_legend = true};
        chart c = scene_chart(&panel);
        expect_svg(&c);
        image raster = draw_raster(&c);
        image_destroy(&raster);
    }
}

static void any_data_can_be_drawn(void **state)
{
    (void)state;
    static const double N = (double)NAN, I = HUGE_VAL;
    static const double X[6] = {0.0, 1.0, 2.0, 3.0, 4.0, 5.0};
    const double cases[][6] = {{N, N, N, N, N, N},
                               {I, -I, I, -I, N, I},
                               {1.0, N, 2.0, N, 3.0, N},
                               {0.0, 0.0, 0.0, 0.0, 0.0, 0.0},
                               {7.25, 7.25, 7.25, 7.25, 7.25, 7.25},
                               {-1.0, -2.0, -3.0, -4.0, -5.0, 0.0},
                               {1.7e308, -1.7e308, 0.0, 1e-320, -1e-320, 1.0},
                               {1e-300, 1e300, 1.0, -1e300, 1e100, 1e-100},
                               {1e15, 1e15 + 1.0, 1e15 + 2.0, 1e15 + 3.0, 1e15, 1e15},
                               {1e-310, 2e-310, 3e-310, 0.0, 1e-310, 5e-324},
                               {0.0, 1e-9, 1e-6, 1e-3, 1.0, 1e3}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++)
        for (int scale = 0; scale < 2; scale++) {
            draw_all_kinds(X, cases[i], 6, (chart_scale)scale);
            draw_all_kinds(cases[i], X, 6, (chart_scale)scale);
            draw_all_kinds(cases[i], cases[i], 1, (chart_scale)scale);
        }
    draw_all_kinds(X, X, 0, CHART_LINEAR);
}

static void any_range_can_be_drawn(void **state)
{
    (void)state;
    const double values[] = {0.0,     -1.0,     1.0,         1e-300,   1e300,
                             1.7e308, -1.7e308, (double)NAN, HUGE_VAL, 1.0 + 1e-15};
    const size_t count = sizeof values / sizeof *values;
    for (size_t i = 0; i < count; i++)
        for (size_t k = IS_SLOW ? i % 3 : 0; k < count; k += IS_SLOW ? 3 : 1)
            for (int scale = 0; scale < 2; scale++) {
                const chart_axis axis = {.scale = (chart_scale)scale,
                                         .has_range = true,
                                         .minimum = values[i],
                                         .maximum = values[k]};
                chart_field field = data.field;
                field.minimum = values[i];
                field.maximum = values[k];
                field.x0 = values[i];
                field.y1 = values[k];
                chart_panel panels[3] = {data.panels[CHART_XY], data.panels[CHART_POLAR],
                                         data.panels[CHART_FIELD]};
                for (int p = 0; p < 3; p++) {
                    panels[p].x = panels[p].y = axis;
                    panels[p].field = p == 2 ? &field : NULL;
                }
                chart c = scene_chart(panels);
                c.panel_count = 3;
                c.columns = 2;
                const drawn d = draw(&c, FACET_PLOT_FORMAT_SVG);
                mem_free(d.bytes);
            }
}

static void any_size_can_be_drawn(void **state)
{
    (void)state;
    static const uint32_t SIZES[][2] = {{1, 1},   {1, 600},  {600, 1},   {20, 20},
                                        {60, 45}, {130, 90}, {5000, 100}};
    for (size_t i = 0; i < sizeof SIZES / sizeof *SIZES; i++) {
        chart c = scene_chart(data.panels);
        c.panel_count = SCENE_KINDS;
        c.columns = i % 2 ? 0 : 2;
        c.width = SIZES[i][0];
        c.height = SIZES[i][1];
        image raster = draw_raster(&c);
        image_destroy(&raster);
        expect_svg(&c);
    }
    chart c = scene_chart(data.panels);
    const uint32_t wrong[] = {0, CANVAS_MAX_SIZE + 1, UINT32_MAX};
    for (int i = 0; i < 3; i++) {
        drawn d;
        facet_error error;
        c.width = wrong[i];
        assert_int_equal(chart_draw(&c, FACET_PLOT_FORMAT_PNG, NULL, &d.bytes, &d.size, &error),
                         FACET_ERROR_ARGUMENT);
        assert_null(d.bytes);
        assert_non_null(strstr(error.message, "pixels"));
    }
    c.width = 300;
    c.panel_count = 0; /* a title on its ground */
    expect_svg(&c);
}

static void many_panels_and_points_are_drawn(void **state)
{
    (void)state;
    enum { PANELS = 288, POINTS = 100000 };
    chart_panel *panels = malloc(PANELS * sizeof *panels);
    double *x = malloc(2 * POINTS * sizeof *x);
    assert_true(panels && x);
    for (int i = 0; i < PANELS; i++)
        panels[i] = data.panels[i % SCENE_KINDS];
    chart c = scene_chart(panels);
    c.panel_count = PANELS;
    c.columns = 18;
    c.width = 1600;
    c.height = 1200;
    image raster = draw_raster(&c);
    image_destroy(&raster);
    for (int i = 0; i < POINTS; i++) {
        x[i] = i;
        x[POINTS + i] = sin(i * 1e-3) + 0.1 * sin(i * 0.37);
    }
    const chart_curve curve = {.name = "many points", .count = POINTS, .x = x, .y = x + POINTS};
    const chart_panel panel = {.curve_count = 1, .curves = &curve, .has_legend = true};
    c = scene_chart(&panel);
    raster = draw_raster(&c);
    image_destroy(&raster);
    free(panels);
    free(x);
}

/* ---- missing cairo and memory ---- */

static void a_missing_cairo_is_reported_with_advice(void **state)
{
    (void)state;
    const chart c = scene_chart(&data.panels[CHART_XY]);
    drawn d;
    facet_error error;
    assert_int_equal(chart_draw_with(&c, FACET_PLOT_FORMAT_SVG, "libcairo-is-missing.so.2", NULL, &d.bytes,
                                     &d.size, &error),
                     FACET_ERROR_SYSTEM);
    assert_null(d.bytes);
    assert_int_equal(d.size, 0);
    assert_non_null(strstr(error.message, "libcairo-is-missing.so.2"));
    assert_non_null(strstr(error.message, "libcairo2"));
    assert_non_null(strstr(error.message, "CSV"));
    /* a library, but not this one */
    assert_int_equal(chart_draw_with(&c, FACET_PLOT_FORMAT_PNG, "libm.so.6", NULL, &d.bytes, &d.size, &error),
                     FACET_ERROR_SYSTEM);
    assert_non_null(strstr(error.message, "cairo_"));
    assert_int_equal(chart_draw_with(&c, FACET_PLOT_FORMAT_CSV, "libcairo-is-missing.so.2", NULL, &d.bytes,
                                     &d.size, &error),
                     FACET_OK);
    assert_true(contains(&d, "# Slices\n"));
    mem_free(d.bytes);
}

static void running_out_of_memory_leaks_nothing(void **state)
{
    (void)state;
    static const facet_plot_format FORMATS[3] = {FACET_PLOT_FORMAT_SVG, FACET_PLOT_FORMAT_PDF,
                                                 FACET_PLOT_FORMAT_PNG};
    for (int f = 0; f < 3; f++)
        for (int kind = 0; kind < SCENE_KINDS; kind++) {
            chart c = scene_chart(&data.panels[kind]);
            c.width = 200;
            c.height = 150;
            for (long i = 0;; i = next_failure(i)) {
                failing_allocator failing = {.fail_at = i};
                const facet_allocator allocator = failing_allocator_get(&failing);
                drawn d;
                facet_error error;
                const facet_result result = chart_draw(&c, FORMATS[f], &allocator, &d.bytes, &d.size, &error);
                mem_free(d.bytes);
                assert_int_equal(failing.blocks, 0);
                if (failing.calls <= i) {
                    assert_int_equal(result, FACET_OK);
                    assert_true(i > 4);
                    break;
                }
                assert_int_equal(result, FACET_ERROR_MEMORY);
                assert_null(d.bytes);
            }
        }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(svg_is_well_formed),
        cmocka_unit_test(charts_are_repeatable),
        cmocka_unit_test(threads_draw_the_same_bytes),
        cmocka_unit_test(pdf_has_a_title_and_no_date),
        cmocka_unit_test(any_label_can_be_drawn),
        cmocka_unit_test(any_data_can_be_drawn),
        cmocka_unit_test(any_range_can_be_drawn),
        cmocka_unit_test(any_size_can_be_drawn),
        cmocka_unit_test(many_panels_and_points_are_drawn),
        cmocka_unit_test(a_missing_cairo_is_reported_with_advice),
        cmocka_unit_test(running_out_of_memory_leaks_nothing),
    };
    return cmocka_run_group_tests(tests, make_data, NULL);
}
