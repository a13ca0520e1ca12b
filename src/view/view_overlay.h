/* view_overlay.h - text over the image: panels rendered to images, which the window composes. Text is
 * drawn by cairo, through plot/; without cairo there are no panels. */
#ifndef VIEW_VIEW_OVERLAY_H
#define VIEW_VIEW_OVERLAY_H

#include "facet/facet.h"

/* sRGB-encoded RGBA, premultiplied in that encoding, rows from the top. */
typedef struct view_panel {
    uint32_t width, height;
    unsigned char *pixels; /* a block of mem_alloc(); NULL: no panel */
} view_panel;

/* Lines of text, separated by line feeds; a tab begins a second column. scale: of the text, 1: 13 pixels. Cut
 * where wider than max_width. FACET_ERROR_UNSUPPORTED, _ENVIRONMENT: there is no cairo; _MEMORY. */
facet_result view_overlay_text(const char *lines, float scale, uint32_t max_width,
                               const facet_allocator *allocator, view_panel *out, facet_error *error);
/* The table of keys, in as many columns as fit, with text no smaller than legible; otherwise on several
 * pages, with a footer that says so. page: which, from 1. *page_count: their number. */
facet_result view_overlay_help(float scale, uint32_t max_width, uint32_t max_height, uint32_t page,
                               uint32_t *page_count, const facet_allocator *allocator, view_panel *out,
                               facet_error *error);
void view_panel_destroy(view_panel *panel); /* {0} is allowed */

#endif
