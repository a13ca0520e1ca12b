/* ibl_sheet.h - a sheet for inspecting a baked cube map: its levels, spheres that it lights, and their error. */
#ifndef REPORT_IBL_SHEET_H
#define REPORT_IBL_SHEET_H

#include "bake/bake.h"

/* F32 RGBA, display-referred linear, opaque. Without cairo text is omitted, and the log of the environment
 * gets a warning. FACET_ERROR_MEMORY, _CANCELLED. */
facet_result ibl_sheet_draw(const facet_cube *cube_map, const facet_environment *environment,
                            const facet_sheet_desc *desc, image *out, facet_error *error);

#endif
