/* chart_layout_test.c - layout: elements are inside, aligned, and do not overlap; data are visible. */
#include "plot/chart_test_scene.h"
#include "tests/support/support.h"

static bool is_within(const chart_box *inner, const chart_box *outer)
{
    return inner->x >= outer->x - 0.5 && inner->y >= outer->y - 0.5 &&
           inner->x + inner->width <= outer->x + outer->width + 0.5 &&
           inner->y + inner->height <= outer->y + outer->height + 0.5;
}

static bool is_apart(const chart_box *a, const chart_box *b)
{
    return a->x + a->width <= b->x || b->x + b->width <= a->x || a->y + a->height <= b->y ||
           b->y + b->height <= a->y;
}

static void plots_fill_their_space_at_every_size(void **state)
{
    (void)state;
    static const uint32_t SIZES[][2] = {{320, 240},  {640, 480}, {960, 640},  {240, 320},
                                        {1000, 300}, {300, 900}, {4000, 3000}};
    for (size_t i = 0; i < sizeof SIZES / sizeof *SIZES; i++)
        for (int kind = 0; kind < SCENE_KINDS; kind++) {
            chart c = scene_chart(&data.panels[kind]);
            c.width = SIZES[i][0];
            c.height = SIZES[i][1];
            panel_view *v = lay_out(&c);
            const chart_box all = {0.0, 0.0, c.width, c.height};
            assert_true(is_within(&v->cell, &all) && is_within(&v->plot, &v->cell));
            assert_int_equal(v->detail, VIEW_ALL);
            assert_true(v->plot.width * v->plot.height > 0.3 * c.width * c.height);
            free(v);
        }
}

static void axes_of_a_grid_are_aligned(void **state)
{
    (void)state;
    chart_panel panels[6];
    static const double LARGE[2] = {1e-3, 123456.0}, X[2] = {0.0, 1.0};
    const chart_curve wide = {.name = "wide labels", .count = 2, .x = X, .y = LARGE};
    for (int i = 0; i < 6; i++)
        panels[i] = data.panels[i % 2 ? CHART_FIELD : CHART_XY];
    panels[2].curves = &wide;
    panels[2].curve_count = 1;
    panels[3].title = "";
    chart c = scene_chart(panels);
    c.panel_count = 6;
    c.columns = 2;
    c.width = 900;
    c.height = 900;
    panel_view *v = lay_out(&c);
    for (int i = 0; i < 6; i++) {
        assert_true(v[i].plot.x == v[i % 2].plot.x && v[i].plot.width == v[i % 2].plot.width);
        assert_true(v[i].plot.y == v[i / 2 * 2].plot.y && v[i].plot.height == v[i / 2 * 2].plot.height);
        for (int k = 0; k < i; k++)
            assert_true(is_apart(&v[i].cell, &v[k].cell));
    }
    free(v);
}

/* Three columns of a narrow chart would be too small to read: its panels are below each other. */
static void narrow_charts_have_fewer_columns(void **state)
{
    (void)state;
    chart_panel panels[6];
    for (int i = 0; i < 6; i++)
        panels[i] = data.panels[CHART_XY];
    chart c = scene_chart(panels);
    c.panel_count = 6;
    c.columns = 3;
    c.width = 375;
    c.height = 1200;
    panel_view *v = lay_out(&c);
    for (int i = 0; i < 6; i++)
        assert_true(v[i].cell.x == v[0].cell.x && v[i].cell.width > 300.0);
    free(v);
    c.width = 1500;
    c.height = 900;
    v = lay_out(&c);
    assert_true(v[2].cell.y == v[0].cell.y && v[3].cell.y > v[0].cell.y);
    free(v);
}

/* For any curves the legend is inside the plot without covering one, or outside. */
static void legends_cover_no_curve(void **state)
{
    (void)state;
    uint64_t random = 5;
    int places[4] = {0};
    canvas *measure;
    assert_int_equal(canvas_create(&(canvas_desc){.format = FACET_PLOT_FORMAT_SVG, .width = 9, .height = 9},
                                   &measure, NULL),
                     FACET_OK);
    for (int i = 0; i < 60; i++) {
        static double x[40], y[8][40];
        chart_curve curves[8];
        const int count = 1 + i % 8;
        for (int k = 0; k < 40; k++)
            x[k] = k;
        for (int k = 0; k < count; k++) {
            const double level = lcg64_double(&random), swing = (i % 3) * lcg64_double(&random);
            for (int p = 0; p < 40; p++)
                y[k][p] = level + swing * sin(p * 0.5 * level);
            curves[k] =
                (chart_curve){.name = i % 4 ? "a curve" : "a curve with a rather long name of many words",
                              .count = 40,
                              .x = x,
                              .y = y[k]};
        }
        chart_panel panel = {.kind = i % 5 == 4 ? CHART_POLAR : CHART_XY,
                             .x = {.label = "x"},
                             .y = {.label = "y"},
                             .curve_count = (size_t)count,
                             .curves = curves,
                             .has_legend = true};
        chart c = scene_chart(&panel);
        c.width = 480 + 200 * (uint32_t)(i % 3);
        panel_view *v = lay_out(&c);
        drawing d = {.chart = &c, .theme = palette_get_theme(false), .scale = layout_scale(&c)};
        facet_error error;
        const chart_box all = {0.0, 0.0, c.width, c.height};
        places[v->legend.place]++;
        assert_int_not_equal(v->legend.place, LEGEND_NONE);
        assert_true(is_within(&v->legend.box, &all));
        legend whole;
        legend_create(measure, &panel, view_tick_font(&d), d.scale, 1e4, &whole);
        assert_true(v->legend.name_width >= whole.name_width - 0.5); /* no name is cut */
        assert_int_equal(layout_trace(&d, v, &error), FACET_OK);
        if (v->legend.place == LEGEND_INSIDE)
            assert_true(trace_list_length_inside(&v->traces, &v->legend.box) == 0.0);
        else
            assert_true(is_apart(&v->legend.box, &v->plot));
        trace_list_destroy(&v->traces);
        free(v);
    }
    canvas_destroy(measure);
    assert_true(places[LEGEND_INSIDE] > 0 && places[LEGEND_RIGHT] + places[LEGEND_BELOW] > 0);
}

static void curves_stay_in_the_plot(void **state)
{
    (void)state;
    static const double X[6] = {-1e9, 0.2, 0.4, 0.6, 0.8, 1e300}, Y[6] = {-5.0, 0.5, 1e300, -1e300, 0.5, 7.0};
    const chart_curve curve = {
        .name = "", .count = 6, .x = X, .y = Y, .style = {.color = -1, .rgb = {1.0f, 0.0f, 0.0f}}};
    const chart_panel panel = {.x = {.label = "x", .has_range = true, .maximum = 1.0},
                               .y = {.label = "y", .has_range = true, .maximum = 1.0},
                               .curve_count = 1,
                               .curves = &curve};
    chart c = scene_chart(&panel);
    panel_view *v = lay_out(&c);
    image raster = draw_raster(&c);
    int inside = 0;
    for (uint32_t y = 0; y < raster.height; y++)
        for (uint32_t x = 0; x < raster.width; x++) {
            const uint8_t *p = pixel_at(&raster, x, y);
            if (p[0] < 200 || p[1] > 100 || p[2] > 100)
                continue;
            inside++;
            assert_true(x >= v->plot.x - 3.0 && x <= v->plot.x + v->plot.width + 3.0);
            assert_true(y >= v->plot.y - 3.0 && y <= v->plot.y + v->plot.height + 3.0);
        }
    assert_true(inside > 200);
    image_destroy(&raster);
    free(v);
}

/* Pixels of the three pure colors. */
static void count_colors(const image *raster, int counts[3])
{
    for (int k = 0; k < 3; k++)
        counts[k] = 0;
    for (uint32_t y = 0; y < raster->height; y++)
        for (uint32_t x = 0; x < raster->width; x++) {
            const uint8_t *p = pixel_at(raster, x, y);
            for (int k = 0; k < 3; k++)
                counts[k] += p[k] > 120 && p[(k + 1) % 3] < 60 && p[(k + 2) % 3] < 60;
        }
}

static void coinciding_curves_are_all_visible(void **state)
{
    (void)state;
    chart_curve curves[3];
    for (int k = 0; k < 3; k++) {
        curves[k] = data.lines[0];
        curves[k].name = "";
        curves[k].style = (chart_style){.color = -1, .width = 3.0f};
        curves[k].style.rgb[k] = 0.75f;
    }
    for (int dash = 0; dash < 2; dash++) { /* all solid; then the first dashed, below the others by order */
        curves[0].style.dash = dash;
        chart_panel panel = data.panels[CHART_XY];
        panel.curves = curves;
        const chart c = scene_chart(&panel);
        image raster = draw_raster(&c);
        int counts[3];
        count_colors(&raster, counts);
        for (int k = 0; k < 3; k++)
            assert_true(10 * counts[k] > counts[0] + counts[1] + counts[2]);
        image_destroy(&raster);
    }
}

static void fields_are_colored_by_value(void **state)
{
    (void)state;
    static const double VALUES[4] = {1.0, 100.0, (double)NAN, 10.0};
    const chart_field field = {
        .width = 2, .height = 2, .values = VALUES, .x1 = 2.0, .y1 = 2.0, .scale = CHART_LOG10, .label = "v"};
    const chart_panel panel = {.kind = CHART_FIELD, .field = &field};
    chart c = scene_chart(&panel);
    panel_view *v = lay_out(&c);
    image raster = draw_raster(&c);
    const chart_box *b = &v->plot;
    const double left = b->x + 0.1 * b->width, right = b->x + 0.9 * b->width;
    const double top = b->y + 0.1 * b->height, bottom = b->y + 0.9 * b->height;
    assert_true(is_color(pixel_at(&raster, left, top), palette_viridis(0.0), 2));
    assert_true(is_color(pixel_at(&raster, right, top), palette_viridis(1.0), 2));
    assert_true(is_color(pixel_at(&raster, right, bottom), palette_viridis(0.5), 2));
    assert_true(is_color(pixel_at(&raster, left, bottom), palette_get_theme(false)->background, 0)); /* NaN */
    assert_true(
        is_color(pixel_at(&raster, b->x + 0.5 * b->width, top), palette_viridis(0.5), 4)); /* between */
    image_destroy(&raster);
    free(v);
}

static void discs_end_at_the_horizon(void **state)
{
    (void)state;
    chart_field field = data.field;
    chart_panel panel = data.panels[CHART_DISC];
    panel.field = &field;
    chart c = scene_chart(&panel);
    c.is_dark = true;
    panel_view *v = lay_out(&c);
    image raster = draw_raster(&c);
    const double x = v->plot.x + 0.5 * v->plot.width, y = v->plot.y + 0.5 * v->plot.height;
    const double radius = 0.5 * fmin(v->plot.width, v->plot.height), side = 0.8 * radius;
    assert_true(is_color(pixel_at(&raster, x - side, y - side), palette_get_theme(true)->background, 0));
    assert_false(
        is_color(pixel_at(&raster, x - 0.6 * side, y - 0.6 * side), palette_get_theme(true)->background, 40));
    /* the peak is at x = 0.4, to the right */
    assert_true(is_color(pixel_at(&raster, x + 0.4 * radius, y + 4.0), palette_viridis(1.0), 12));
    image_destroy(&raster);
    free(v);
}

/* The center shows the surface in the colors of its values, apart from shading; beside it is the background. */
static void surfaces_are_colored_by_value(void **state)
{
    (void)state;
    chart_panel panel = data.panels[CHART_SURFACE];
    static double ones[SCENE_GRID * SCENE_GRID];
    chart_surface surface = data.surface;
    for (int i = 0; i < SCENE_GRID * SCENE_GRID; i++)
        ones[i] = i < 3 ? 0.0 : 1.0; /* yellow, except for the pole */
    surface.values = ones;
    panel.surface = &surface;
    chart c = scene_chart(&panel);
    panel_view *v = lay_out(&c);
    image raster = draw_raster(&c);
    int yellow = 0, within = 0;
    for (double y = v->plot.y; y < v->plot.y + v->plot.height; y++)
        for (double x = v->plot.x; x < v->plot.x + v->plot.width; x++) {
            const uint8_t *p = pixel_at(&raster, x, y);
            yellow += p[0] > 120 && p[1] > 100 && p[2] < 0.5 * p[1];
            within++;
        }
    assert_in_range(yellow, within / 8, within);
    assert_true(is_color(pixel_at(&raster, v->plot.x + 1.0, v->plot.y + 1.0),
                         palette_get_theme(false)->background, 0));
    image_destroy(&raster);
    free(v);
}

static void polar_angles_are_from_above(void **state)
{
    (void)state;
    static const double ANGLES[5] = {0.0, 1.5707963267948966, -1.5707963267948966, 0.5235987755982988, 0.0};
    static const double RADII[5] = {1.0, 0.5, 1.0, 1.0, -3.0};
    const chart_curve curve = {.name = "", .count = 5, .x = ANGLES, .y = RADII};
    const chart_panel panel = {
        .kind = CHART_POLAR, .y = {.has_range = true, .maximum = 1.0}, .curve_count = 1, .curves = &curve};
    chart c = scene_chart(&panel);
    panel_view *v = lay_out(&c);
    drawing d = {.chart = &c, .theme = palette_get_theme(false), .scale = layout_scale(&c)};
    facet_error error;
    assert_int_equal(layout_trace(&d, v, &error), FACET_OK);
    const trace *t = v->traces.traces;
    const double radius = fmin(0.5 * v->plot.width, v->plot.height), x = t->x[0], y = t->y[1];
    assert_true(fabs(t->y[0] - (y - radius)) < 1e-6); /* straight up */
    assert_true(fabs(t->x[1] - (x + 0.5 * radius)) < 1e-6);
    assert_true(fabs(t->x[2] - (x - radius)) < 1e-6);
    assert_true(fabs(t->x[3] - (x + 0.5 * radius)) < 1e-6 && t->y[3] < y);
    assert_true(fabs(t->x[4] - x) < 1e-6 && fabs(t->y[4] - y) < 1e-6); /* below the axis: the center */
    trace_list_destroy(&v->traces);
    free(v);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(plots_fill_their_space_at_every_size),
        cmocka_unit_test(axes_of_a_grid_are_aligned),
        cmocka_unit_test(narrow_charts_have_fewer_columns),
        cmocka_unit_test(legends_cover_no_curve),
        cmocka_unit_test(curves_stay_in_the_plot),
        cmocka_unit_test(coinciding_curves_are_all_visible),
        cmocka_unit_test(fields_are_colored_by_value),
        cmocka_unit_test(discs_end_at_the_horizon),
        cmocka_unit_test(surfaces_are_colored_by_value),
        cmocka_unit_test(polar_angles_are_from_above),
    };
    return cmocka_run_group_tests(tests, make_data, NULL);
}
