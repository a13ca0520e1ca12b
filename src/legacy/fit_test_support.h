/* fit_test_support.h - the quadratures of both maskings, for tests of fits: a group's setup and teardown. */
#ifndef LEGACY_FIT_TEST_SUPPORT_H
#define LEGACY_FIT_TEST_SUPPORT_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "tests/support/support.h"
#include "legacy/fit_metric.h"

static fit_metric *correlated, *separable;

static inline int fit_test_setup(void **state)
{
    (void)state;
    facet_result a = fit_metric_create(NULL, PBR_CORRELATED, &correlated, NULL);
    facet_result b = fit_metric_create(NULL, PBR_SEPARABLE, &separable, NULL);
    return a == FACET_OK && b == FACET_OK ? 0 : -1;
}

static inline int fit_test_teardown(void **state)
{
    (void)state;
    fit_metric_destroy(correlated);
    fit_metric_destroy(separable);
    return 0;
}

#endif
