/* bake_layout.h - the files that engines load, by their names and conventions; docs/bake.md has the table. */
#ifndef CLI_BAKE_LAYOUT_H
#define CLI_BAKE_LAYOUT_H

#include "cli/bake/bake_plan.h"

/* A cube map for a lobe, as desc says; the same one twice is one. */
uint32_t bake_plan_add_cube(bake_plan *plan, const facet_bake_desc *desc, bool is_verified);
/* A file, with path copied; NULL: no memory. */
bake_file *bake_plan_add_file(bake_plan *plan, const char *path, const bake_file *what);

/* Adds the files of o->layout to plan. stem: what the environment is called. FACET_ERROR_ARGUMENT, _MEMORY. */
facet_result bake_layout_add(const bake_options *o, const char *stem, bake_plan *plan, facet_error *error);

/* Turns plan's cube maps and harmonics for an engine that has the middle of an equirectangular picture elsewhere. */
float bake_layout_turn(const bake_options *o, const facet_environment_info *info);

#endif
