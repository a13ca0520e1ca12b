/* bake_report.h - the report of facet bake: lines, a table, JSON. */
#ifndef CLI_BAKE_REPORT_H
#define CLI_BAKE_REPORT_H

#include "cli/bake/bake_plan.h"
#include "cli/shared/messages.h"

#include <jansson.h>
#include <stdio.h>

extern const char *const bake_lobe_names[4];

/* Prints "studio.ktx2: cube map 256 x 256, 5 levels, rgba16f, 4 MiB" per file; is_news: also without -v. */
void bake_report_files(const messages *m, const bake_plan *plan, bool is_news, double seconds);

/* Prints the errors of --verify as a table. */
void bake_report_errors(FILE *stream, const bake_plan *plan);
/* Writes "level 3 of ggx: RMS error 0.02" for the worst level with an RMS error above limit, or NaN; "" if
 * there is none. */
void bake_report_worst(const bake_plan *plan, double limit, char *text, size_t size);

/* The verb's members of the JSON object; NULL: no memory. */
json_t *bake_report_json(const bake_options *o, const bake_plan *plan, const facet_environment_info *info,
                         bool is_done);

#endif
