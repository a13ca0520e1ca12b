/* aov_options.h - --aov: which layers a renderer has, by name. */
#ifndef CLI_AOV_OPTIONS_H
#define CLI_AOV_OPTIONS_H

#include "cli/render/render_options.h"

/* Sets out->desc.aovs; the format and the renderer are read. FACET_ERROR_ARGUMENT: the renderer does not have a layer, or the
 * file has room for none. */
facet_result aov_options_read(const command_line *c, render_options *out, facet_error *error);

#endif
