/* legacy_options.h - the options about OBJ files and materials of OpenGL 1. */
#ifndef CLI_LEGACY_OPTIONS_H
#define CLI_LEGACY_OPTIONS_H

#include "cli/command_line.h"
#include "facet/facet.h"

/* Sets what a verb has options for: legacy, obj_normals, has_flipped_texcoords and parameters of out. Text stays with c. */
void legacy_options_read(const command_line *c, facet_scene_desc *out);

#endif
