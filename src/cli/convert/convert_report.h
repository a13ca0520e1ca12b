/* convert_report.h - what facet convert tells of the materials that it converted. */
#ifndef CLI_CONVERT_REPORT_H
#define CLI_CONVERT_REPORT_H

#include "cli/shared/messages.h"
#include "facet/facet.h"

#include <jansson.h>

/* Of the last conversion of a scene. */
typedef struct conversion_totals {
    uint32_t count, grades[FACET_CONVERSION_GRADE_BAD + 1];
    uint32_t told; /* materials that have an error to tell */
    double mean_error, mean_display, mean_drawn;
    facet_conversion worst; /* by the error that is graded */
} conversion_totals;

conversion_totals conversion_sum(const facet_scene *scene);

/* One line per material, worst first: all with -v, else the poor and bad ones, as far as they are few; then one for all.
 * Nothing where nothing was converted. */
void convert_report_print(const messages *m, const char *model, const facet_scene *scene);
/* The same in short; null where nothing was converted. */
json_t *convert_report_json(const facet_scene *scene);

/* Writes the report of scene to path: whole or nothing. */
facet_result convert_report_write(const facet_scene *scene, bool is_html, const char *path,
                                  facet_error *error);

#endif
