/* view_divider.c - see view_divider.h. */
#include "view/view_divider.h"

#include <math.h>

void view_divider_sides(const view_divider *d, const facet_render_desc *base, facet_render_desc sides[2],
                        const char *labels[2])
{
    static const char *const names[][2] = {
        [VIEW_COMPARE_NOTHING] = {"", ""},
        [VIEW_COMPARE_MASKING] = {"Schlick-GGX, separable", "Smith, height-correlated"},
        [VIEW_COMPARE_SCATTERING] = {"Single scattering", "Multiple scattering"},
        [VIEW_COMPARE_RENDERER] = {"OpenGL", "Path tracing"},
        [VIEW_COMPARE_TONEMAP] = {"Linear", "Tone-mapped"},
        [VIEW_COMPARE_VARIANT] = {"Materials of the file", "Variant"}};
    sides[0] = sides[1] = *base;
    labels[0] = names[d->comparison][0];
    labels[1] = names[d->comparison][1];
    switch (d->comparison) {
    case VIEW_COMPARE_MASKING:
        sides[0].renderer = sides[1].renderer = FACET_RENDERER_KIND_GL;
        sides[0].gl.brdf = FACET_BRDF_SCHLICK_GGX;
        sides[1].gl.brdf = FACET_BRDF_ENERGY;
        break;
    case VIEW_COMPARE_SCATTERING:
        sides[0].gl.brdf = sides[1].gl.brdf = FACET_BRDF_ENERGY;
        sides[0].energy = FACET_ENERGY_GLTF;
        sides[1].energy = FACET_ENERGY_CONSERVING;
        break;
    case VIEW_COMPARE_RENDERER:
        sides[0].renderer = FACET_RENDERER_KIND_GL;
        sides[1].renderer = FACET_RENDERER_KIND_PATH;
        break;
    case VIEW_COMPARE_TONEMAP:
        sides[0].tonemap = FACET_TONEMAP_NONE;
        if (base->tonemap == FACET_TONEMAP_NONE)
            sides[1].tonemap = FACET_TONEMAP_NEUTRAL;
        break;
    case VIEW_COMPARE_VARIANT:
        sides[0].pose.has_variant = false;
        if (!base->pose.has_variant)
            sides[1].pose.variant = d->variant;
        sides[1].pose.has_variant = true;
        break;
    default:
        break;
    }
}

bool view_divider_is_at(const view_divider *d, double x, uint32_t width, double reach)
{
    return d->comparison != VIEW_COMPARE_NOTHING && fabs(x - d->position * width) <= reach;
}

void view_divider_drag(view_divider *d, double x, uint32_t width)
{
    d->position = width ? fmin(fmax(x / width, 0.02), 0.98) : 0.5;
}

static view_comparison step(view_comparison from, int steps, int count)
{
    return (view_comparison)((((int)from + steps) % count + count) % count);
}

void view_divider_step(view_divider *d, int steps, bool has_variants, bool traces_paths)
{
    int count = has_variants ? VIEW_COMPARISON_COUNT : VIEW_COMPARE_VARIANT;
    d->comparison = step(d->comparison, steps, count);
    if (traces_paths && d->comparison == VIEW_COMPARE_MASKING)
        d->comparison = step(d->comparison, steps, count);
}

bool view_divider_labels(int border, int width, int margin, const int widths[2], int x[2])
{
    int first = margin;
    int last = width - margin - widths[1];
    x[0] = border - margin - widths[0];
    x[1] = border + margin;
    bool is_narrow = x[0] < first || x[1] > last;
    x[0] = x[0] < first ? first : x[0];
    x[1] = x[1] > last ? last : x[1];
    return is_narrow;
}
