/* view_overlay_none.c - see view_overlay.h: facet was built without cairo. */
#include "base/result.h"
#include "view/view_overlay.h"

facet_result view_overlay_text(const char *lines, float scale, uint32_t max_width,
                               const facet_allocator *allocator, view_panel *out, facet_error *error)
{
    (void)lines;
    (void)scale;
    (void)max_width;
    (void)allocator;
    *out = (view_panel){0};
    return fail(error, FACET_ERROR_UNSUPPORTED,
                "window: this facet was built without cairo, which writes text");
}

facet_result view_overlay_help(float scale, uint32_t max_width, uint32_t max_height, uint32_t page,
                               uint32_t *page_count, const facet_allocator *allocator, view_panel *out,
                               facet_error *error)
{
    (void)max_height;
    (void)page;
    *page_count = 1;
    return view_overlay_text("", scale, max_width, allocator, out, error);
}

void view_panel_destroy(view_panel *panel)
{
    *panel = (view_panel){0};
}
