/* report.h - a conversion of materials as an HTML page: values, errors, spheres, curves. */
#ifndef REPORT_REPORT_H
#define REPORT_REPORT_H

#include "base/text.h"
#include "scene/legacy.h"

/* facet_scene_report_conversion() as HTML: one self-contained file, readable without scripts, in light and
 * dark themes and in print. Materials are sorted by error, worst first; those after REPORT_PICTURES have
 * no images. Fails with FACET_ERROR_MEMORY; without cairo the curves are omitted, and a line says so. */
enum { REPORT_PICTURES = 100 };
facet_result report_html(const facet_scene *scene, text *out, facet_error *error);

#endif
