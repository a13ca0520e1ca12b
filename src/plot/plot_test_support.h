/* plot_test_support.h - for tests of plots: the chart of a desc, and its parts by name. */
#ifndef PLOT_PLOT_TEST_SUPPORT_H
#define PLOT_PLOT_TEST_SUPPORT_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "tests/support/support.h"
#include "plot/material.h"
#include "plot/plot.h"
#include "plot/plot_build.h"

typedef struct plot_fixture {
    arena *memory;
    chart drawing;
} plot_fixture;

static inline plot_fixture make_plot(const facet_plot_desc *desc)
{
    plot_fixture f = {.memory = arena_create(NULL)};
    facet_error error = {0};
    assert_non_null(f.memory);
    if (plot_create(desc, f.memory, &f.drawing, &error) != FACET_OK)
        fail_msg("%s", error.message);
    return f;
}

static inline void free_plot(plot_fixture *f)
{
    arena_destroy(f->memory);
}

/* The curve whose name begins with a prefix. */
static inline const chart_curve *find_curve(const chart_panel *panel, const char *name)
{
    for (size_t i = 0; i < panel->curve_count; i++)
        if (strncmp(panel->curves[i].name, name, strlen(name)) == 0)
            return &panel->curves[i];
    fail_msg("no curve \"%s\" in panel \"%s\"", name, panel->title);
    return NULL;
}

/* y at the point nearest to x, which must be within a tolerance. */
static inline double value_at(const chart_curve *c, double x, double tolerance)
{
    size_t best = 0;
    for (size_t i = 1; i < c->count; i++)
        if (fabs(c->x[i] - x) < fabs(c->x[best] - x))
            best = i;
    assert_near(c->x[best], x, tolerance);
    return c->y[best];
}

static inline facet_error plot_failure(const facet_plot_desc *desc, facet_result expected)
{
    arena *memory = arena_create(NULL);
    chart drawing;
    facet_error error = {0};
    assert_int_equal(plot_create(desc, memory, &drawing, &error), expected);
    assert_int_equal(error.result, expected);
    assert_true(strlen(error.message) > 10);
    assert_null(strchr(error.message, '\n'));
    arena_destroy(memory);
    return error;
}

#endif
