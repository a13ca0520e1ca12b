/* view_terms.h - the values of <model-viewer>'s camera attributes: "45deg 60deg 120%", "auto", "0m 0.5m 0m",
 * "calc(30deg + env(window-scroll-y) * 90deg)". */
#ifndef VIEW_VIEW_TERMS_H
#define VIEW_VIEW_TERMS_H

#include <stdint.h>

#include "facet/base.h"

typedef enum view_unit { VIEW_UNIT_ANGLE, VIEW_UNIT_LENGTH } view_unit;

/* One of the words of a value. Angles: deg, rad, none is deg; lengths: m, cm, mm, none is m. */
typedef struct view_term {
    view_unit unit;
    double whole;     /* 100 %, in rad or m */
    double automatic; /* "auto", and words that are missing */
} view_term;

/* Evaluates text, which has up to count words. scroll: env(window-scroll-y), 0 to 1. name: of the value, for the message.
 * Fails with FACET_ERROR_ARGUMENT, with values untouched. */
facet_result view_terms_read(const char *name, const char *text, const view_term *terms, uint32_t count,
                             double scroll, double *values, facet_error *error);

#endif
