/* view_command.h - the facet render command line of what a window shows. */
#ifndef CLI_VIEW_COMMAND_H
#define CLI_VIEW_COMMAND_H

#include "cli/render/render_options.h"

/* Returns a malloc() block for a shell; NULL: no memory. c is the command line of facet view, whose
 * options that no key changes are kept; options are its values. */
char *view_command(const command_line *c, const render_options *options, const facet_view_image *image);

#endif
