/* report.h - what a conversion of materials did, as a page: values, errors, spheres, curves. */
#ifndef REPORT_REPORT_H
#define REPORT_REPORT_H

#include "base/text.h"
#include "scene/legacy.h"

/* facet_scene_report_conversion() as HTML: one file, its pictures inside, readable without scripts, in light and dark, and
 * in print. Materials stand worst first; beyond REPORT_PICTURES of them come without pictures. Fails with
 * FACET_ERROR_MEMORY; without cairo the curves are left out with a line that says so. */
enum { REPORT_PICTURES = 100 };
facet_result report_html(const facet_scene *scene, text *out, facet_error *error);

#endif
