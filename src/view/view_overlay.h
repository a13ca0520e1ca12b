/* view_overlay.h - text over the picture: pictures of panels, which are laid where the window wants them. Letters are
 * cairo's, through plot/; where there is no cairo there are no panels. */
#ifndef VIEW_VIEW_OVERLAY_H
#define VIEW_VIEW_OVERLAY_H

#include "facet/facet.h"

/* sRGB-encoded RGBA, premultiplied as such, rows from the top. */
typedef struct view_panel {
    uint32_t width, height;
    unsigned char *pixels; /* a block of mem_alloc(); NULL: no panel */
} view_panel;

/* Lines of text, separated by line feeds; behind a tab begins a second column. scale: of letters, 1: of 13 pixels. Wider than
 * max_width they are cut. FACET_ERROR_UNSUPPORTED, _ENVIRONMENT: there is no cairo; _MEMORY. */
facet_result view_overlay_text(const char *lines, float scale, uint32_t max_width,
                               const facet_allocator *allocator, view_panel *out, facet_error *error);
/* The table of keys, in as many columns as fit, and letters as small as can be read well; where that is not enough on several
 * pages, with a last line that tells so. page: which, from 1. *page_count: of how many. */
facet_result view_overlay_help(float scale, uint32_t max_width, uint32_t max_height, uint32_t page,
                               uint32_t *page_count, const facet_allocator *allocator, view_panel *out,
                               facet_error *error);
void view_panel_destroy(view_panel *panel); /* {0} is allowed */

#endif
