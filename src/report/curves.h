/* curves.h - the reflectance of both models of a converted material over the angle of the light. */
#ifndef REPORT_CURVES_H
#define REPORT_CURVES_H

#include "scene/legacy.h"

enum { CURVES_WIDTH = 900, CURVES_HEIGHT = 270 };

/* An SVG file: luminance under light of 1, seen at 0, 30 and 60 degrees, the source solid, what was made of it dashed. For
 * materials with has_surfaces. A block of mem_alloc(). Fails as chart_draw(). */
facet_result curves_draw(const facet_scene *scene, uint32_t material, unsigned char **bytes, size_t *size,
                         facet_error *error);

#endif
