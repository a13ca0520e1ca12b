/* ocean_report.h - what is known of a sea, for people and for programs. */
#ifndef CLI_OCEAN_REPORT_H
#define CLI_OCEAN_REPORT_H

#include "cli/ocean/ocean_run.h"
#include "cli/render/render_report.h"

#include <jansson.h>

/* Lines on standard output. */
void ocean_report_print(const ocean_run *run);
/* The same; NULL: no memory. */
json_t *ocean_report_json(const ocean_run *run);

/* report_picture_json() with what another program needs to draw the same: exposure, time, camera, where the model floats. */
json_t *ocean_report_picture_json(const ocean_run *run, const picture_report *p);

#endif
