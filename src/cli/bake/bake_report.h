/* bake_report.h - what facet bake did: lines for people, an object for programs. */
#ifndef CLI_BAKE_REPORT_H
#define CLI_BAKE_REPORT_H

#include "cli/bake/bake_plan.h"
#include "cli/shared/messages.h"

#include <jansson.h>
#include <stdio.h>

extern const char *const bake_lobe_names[4];

/* "studio.ktx2: cube map 256 x 256, 5 levels, rgba16f, 4 MiB" for each file; is_news: also without -v. */
void bake_report_files(const messages *m, const bake_plan *plan, bool is_news, double seconds);

/* The errors of --verify as a table. */
void bake_report_errors(FILE *stream, const bake_plan *plan);
/* "level 3 of ggx: RMS error 0.02" of the worst level whose RMS error is above limit, or is no number; "" where all hold. */
void bake_report_worst(const bake_plan *plan, double limit, char *text, size_t size);

/* Members of the result; NULL: no memory. */
json_t *bake_report_json(const bake_options *o, const bake_plan *plan, const facet_environment_info *info,
                         bool is_done);

#endif
