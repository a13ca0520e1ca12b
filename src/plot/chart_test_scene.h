/* chart_test_scene.h - for tests of drawing: charts of every kind, and their pixels. */
#ifndef PLOT_CHART_TEST_SCENE_H
#define PLOT_CHART_TEST_SCENE_H

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "image/image.h"
#include "plot/chart_view.h"

enum { SCENE_POINTS = 91, SCENE_CELLS = 33, SCENE_GRID = 25, SCENE_KINDS = 5 };

/* Values like those of reflectance, shared by all tests of a program. */
typedef struct scene_data {
    double angles[SCENE_POINTS], radians[SCENE_POINTS], values[3][SCENE_POINTS];
    double cells[SCENE_CELLS * SCENE_CELLS];
    double x[SCENE_GRID * SCENE_GRID], y[SCENE_GRID * SCENE_GRID], z[SCENE_GRID * SCENE_GRID];
    chart_curve lines[3], lobes[3];
    chart_field field;
    chart_surface surface;
    chart_panel panels[SCENE_KINDS]; /* by chart_panel_kind */
} scene_data;

static inline void scene_make_curves(scene_data *d)
{
    static const char *const NAMES[3] = {"roughness 0.3", "roughness 0.5", "roughness 0.8"};
    for (int i = 0; i < SCENE_POINTS; i++) {
        d->angles[i] = -90.0 + 2.0 * i;
        d->radians[i] = d->angles[i] * 0.017453292519943295;
        for (int k = 0; k < 3; k++) {
            const double t = (d->angles[i] - 30.0) / (10.0 + 15.0 * k);
            d->values[k][i] = 0.05 + exp(-t * t) / (1.0 + k);
        }
    }
    for (int k = 0; k < 3; k++) {
        d->lines[k] = (chart_curve){.name = NAMES[k],
                                    .count = SCENE_POINTS,
                                    .x = d->angles,
                                    .y = d->values[k],
                                    .style = {.color = k, .dash = k}};
        d->lobes[k] = d->lines[k];
        d->lobes[k].x = d->radians;
    }
}

static inline void scene_make_grids(scene_data *d)
{
    for (int row = 0; row < SCENE_CELLS; row++)
        for (int column = 0; column < SCENE_CELLS; column++) {
            const double x = (2.0 * column + 1.0) / SCENE_CELLS - 1.0,
                         y = 1.0 - (2.0 * row + 1.0) / SCENE_CELLS;
            d->cells[row * SCENE_CELLS + column] =
                x * x + y * y < 1.0 ? 0.1 + exp(-8.0 * ((x - 0.4) * (x - 0.4) + y * y)) : (double)NAN;
        }
    for (int row = 0; row < SCENE_GRID; row++)
        for (int column = 0; column < SCENE_GRID; column++) {
            const double polar = row * 1.5 / (SCENE_GRID - 1),
                         turn = column * 6.283185307179586 / (SCENE_GRID - 1);
            const double radius =
                0.4 + 0.6 * exp(-3.0 * (polar - 0.5) * (polar - 0.5)) * (1.0 + cos(turn)) / 2.0;
            const int i = row * SCENE_GRID + column;
            d->x[i] = radius * sin(polar) * cos(turn);
            d->y[i] = radius * sin(polar) * sin(turn);
            d->z[i] = radius * cos(polar);
        }
    d->field = (chart_field){.width = SCENE_CELLS,
                             .height = SCENE_CELLS,
                             .values = d->cells,
                             .x0 = -1.0,
                             .x1 = 1.0,
                             .y0 = -1.0,
                             .y1 = 1.0,
                             .label = "BRDF, 1/sr",
                             .scale = CHART_LOG10};
    d->surface = (chart_surface){.width = SCENE_GRID,
                                 .height = SCENE_GRID,
                                 .x = d->x,
                                 .y = d->y,
                                 .z = d->z,
                                 .label = "height",
                                 .azimuth_rad = -1.0,
                                 .elevation_rad = 0.4};
}

static inline void scene_make(scene_data *d)
{
    scene_make_curves(d);
    scene_make_grids(d);
    d->panels[CHART_XY] = (chart_panel){.kind = CHART_XY,
                                        .title = "Slices",
                                        .note = "eye at 30\xc2\xb0",
                                        .x = {.label = "angle of the light", .is_degrees = true},
                                        .y = {.label = "BRDF, 1/sr"},
                                        .curve_count = 3,
                                        .curves = d->lines,
                                        .has_legend = true};
    d->panels[CHART_POLAR] = d->panels[CHART_XY];
    d->panels[CHART_POLAR].kind = CHART_POLAR;
    d->panels[CHART_POLAR].curves = d->lobes;
    d->panels[CHART_FIELD] = (chart_panel){.kind = CHART_FIELD,
                                           .title = "Table",
                                           .x = {.label = "N.V"},
                                           .y = {.label = "roughness"},
                                           .field = &d->field};
    d->panels[CHART_DISC] = (chart_panel){.kind = CHART_DISC, .title = "Hemisphere", .field = &d->field};
    d->panels[CHART_SURFACE] = (chart_panel){.kind = CHART_SURFACE, .title = "Lobe", .surface = &d->surface};
}

static inline chart scene_chart(const chart_panel *panel)
{
    return (chart){
        .title = "A chart", .width = 400, .height = 300, .columns = 1, .panel_count = 1, .panels = panel};
}

typedef struct drawn {
    unsigned char *bytes;
    size_t size;
} drawn;

static inline drawn draw(const chart *c, facet_plot_format format)
{
    drawn d;
    facet_error error = {0};
    if (chart_draw(c, format, NULL, &d.bytes, &d.size, &error) != FACET_OK)
        fail_msg("%s", error.message);
    assert_non_null(d.bytes);
    return d;
}

static inline image draw_raster(const chart *c)
{
    const drawn d = draw(c, FACET_PLOT_FORMAT_PNG);
    image raster;
    facet_error error;
    assert_int_equal(
        image_decode(d.bytes, d.size, "plot", &(image_decode_desc){.channel_count = 3}, &raster, &error),
        FACET_OK);
    mem_free(d.bytes);
    assert_int_equal(raster.width, c->width);
    assert_int_equal(raster.height, c->height);
    return raster;
}

static inline const uint8_t *pixel_at(const image *i, double x, double y)
{
    assert_true(x >= 0.0 && y >= 0.0 && x < i->width && y < i->height);
    return (const uint8_t *)i->pixels + 3 * ((size_t)y * i->width + (size_t)x);
}

static inline bool is_color(const uint8_t *pixel, canvas_color c, int near)
{
    return abs(pixel[0] - (int)(c.r * 255.0 + 0.5)) <= near &&
           abs(pixel[1] - (int)(c.g * 255.0 + 0.5)) <= near &&
           abs(pixel[2] - (int)(c.b * 255.0 + 0.5)) <= near;
}

/* The laid out views of a chart; free(). */
static inline panel_view *lay_out(const chart *c)
{
    drawing d = {.chart = c, .theme = palette_get_theme(c->is_dark), .scale = layout_scale(c)};
    facet_error error = {0};
    panel_view *views = calloc(c->panel_count + 1, sizeof *views);
    assert_non_null(views);
    for (uint32_t i = 0; i < c->panel_count; i++)
        views[i].panel = &c->panels[i];
    if (canvas_create(&(canvas_desc){.format = FACET_PLOT_FORMAT_PNG, .width = c->width, .height = c->height},
                      &d.canvas, &error) != FACET_OK)
        fail_msg("%s", error.message);
    assert_int_equal(layout_create(&d, views, &error), FACET_OK);
    canvas_destroy(d.canvas);
    return views;
}

/* The data of a test program, made by its group setup. */
static scene_data data;

static inline int make_data(void **state)
{
    (void)state;
    scene_make(&data);
    return 0;
}

#endif
