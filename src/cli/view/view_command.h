/* view_command.h - what a window shows as options of facet render. Setting them gives the same image. */
#ifndef CLI_VIEW_COMMAND_H
#define CLI_VIEW_COMMAND_H

#include "cli/render/render_options.h"

typedef struct view_option {
    const option *option;
    char *value; /* block of malloc(); "": a flag */
} view_option;

/* {0} initially. */
typedef struct view_options {
    view_option *items;
    size_t count, capacity;
    bool has_failed; /* no memory */
} view_options;

void view_options_add(view_options *list, const option *o, const char *value);
void view_options_remove(view_options *list, option_id id);
void view_options_destroy(view_options *list); /* {0} is allowed */

/* Appends the options of an image, its size aside, without those that have the default of facet render. c is
 * the command line of facet view, whose options that no key changes are kept; options are its values. An orbit
 * without a radius, or without a target, leaves that to framing. */
void view_options_of(const command_line *c, const render_options *options, const facet_view_image *image,
                     view_options *out);

/* The command line for a shell, a malloc() block; NULL: no memory. */
char *view_command(const command_line *c, const render_options *options, const facet_view_image *image);

#endif
