/* view_command.h - the facet render command line of what a window shows. */
#ifndef CLI_VIEW_COMMAND_H
#define CLI_VIEW_COMMAND_H

#include "cli/render/render_options.h"

/* A block of malloc(), ready for a shell; NULL: no memory. c: how facet view was called, whose options that no key changes go
 * along; options: what they were read as. */
char *view_command(const command_line *c, const render_options *options, const facet_view_image *picture);

#endif
