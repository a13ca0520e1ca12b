/* ibl_sheet.h - a baked cube map as a picture to look at: its levels, what it lights, and how far that is from exact. */
#ifndef REPORT_IBL_SHEET_H
#define REPORT_IBL_SHEET_H

#include "bake/bake.h"

/* F32 RGBA, linear light of a display, opaque. Words are left out, and the environment's log says so, where there is no cairo.
 * FACET_ERROR_MEMORY, _CANCELLED. */
facet_result ibl_sheet_draw(const facet_cube *cube_map, const facet_environment *environment,
                            const facet_sheet_desc *desc, image *out, facet_error *error);

#endif
