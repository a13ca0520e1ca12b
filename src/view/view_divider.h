/* view_divider.h - two ways to draw the same beside each other, with a border between them that is dragged. */
#ifndef VIEW_VIEW_DIVIDER_H
#define VIEW_VIEW_DIVIDER_H

#include "facet/facet.h"

typedef enum view_comparison {
    VIEW_COMPARE_NOTHING,
    VIEW_COMPARE_MASKING,    /* separable Schlick-GGX | height-correlated Smith */
    VIEW_COMPARE_SCATTERING, /* single | multiple scattering on rough surfaces */
    VIEW_COMPARE_RENDERER,   /* OpenGL | path tracing */
    VIEW_COMPARE_TONEMAP,    /* none | the one chosen */
    VIEW_COMPARE_VARIANT,    /* the file's materials | a variant */
    VIEW_COMPARISON_COUNT
} view_comparison;

typedef struct view_divider {
    view_comparison comparison;
    double position;  /* [0, 1] of the width */
    uint32_t variant; /* that is compared where none is chosen */
    bool is_dragged;
} view_divider;

/* What the left and the right side draw, by name; base is what is drawn without a divider, and keeps its renderer: paths are
 * traced on both sides, where what is compared is not OpenGL's alone (VIEW_COMPARE_MASKING) or the renderer. */
void view_divider_sides(const view_divider *d, const facet_render_desc *base, facet_render_desc sides[2],
                        const char *labels[2]);
/* Whether the pointer at x can take hold of it. reach: px to either side. */
bool view_divider_is_at(const view_divider *d, double x, uint32_t width, double reach);
void view_divider_drag(view_divider *d, double x, uint32_t width);
/* The next comparison, in either direction; those of variants only where there are some, that of masking only without path
 * tracing, which has no separable one. */
void view_divider_step(view_divider *d, int steps, bool has_variants, bool traces_paths);
/* Where labels of those widths begin (x), beside the border where they fit there, else as near as the window allows. True: one of
 * them does not fit on its own side, and they are not to stand in one line. */
bool view_divider_labels(int border, int width, int margin, const int widths[2], int x[2]);

#endif
