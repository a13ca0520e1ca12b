/* compare_report.h - what facet compare found: a table for people, an object for programs, a sentence where limits do not
 * hold. */
#ifndef CLI_COMPARE_REPORT_H
#define CLI_COMPARE_REPORT_H

#include "cli/compare/compare_metrics.h"

#include <jansson.h>
#include <stdio.h>

/* Prints the metrics that are wished for, or the main ones. */
void compare_report_table(FILE *stream, const compare_wish *wish, const facet_comparison *c,
                          bool has_percentile);

/* "flip 0.051 is more than 0.02, .." of the limits that do not hold; "" where all do. */
void compare_report_failures(const compare_wish *wish, const facet_comparison *c, char *text, size_t size);

/* Members of the result: space, size, metrics, limits; NULL: no memory. Numbers that JSON lacks are null. */
json_t *compare_report_json(const compare_wish *wish, const facet_comparison *c);

#endif
