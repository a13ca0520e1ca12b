/* outline.c - see outline.h. */
#include "film/outline.h"

#include "shade/lang/lang_c_load.h"
#include "shade/shade.h"

/* Pixels between one that is covered whole and one that is not covered: an edge that is smoothed lies between. */
enum { ACROSS = 2, LEAST_PIXELS = 64 };

static const float *pixel_at(const film *f, uint32_t x, uint32_t y)
{
    return f->layers[0].pixels + 4 * ((size_t)y * f->width + x);
}

static bool is_open(const film *f, uint32_t x, uint32_t y)
{
    return !(pixel_at(f, x, y)[3] > 0.001f);
}

/* Whether the covered pixel (x, y), which is ACROSS pixels within the film, is on the outline. */
static bool is_on_outline(const film *f, uint32_t x, uint32_t y)
{
    return pixel_at(f, x, y)[3] > 0.999f && (is_open(f, x - ACROSS, y) || is_open(f, x + ACROSS, y) ||
                                             is_open(f, x, y - ACROSS) || is_open(f, x, y + ACROSS));
}

bool film_outline_is_hidden(const film *f, facet_tonemap operator_, const float background[3])
{
    const vec3 behind = srgb_from_linear(load3(background));
    size_t count = 0;
    size_t hidden = 0;
    for (uint32_t y = ACROSS; y + ACROSS < f->height; y++)
        for (uint32_t x = ACROSS; x + ACROSS < f->width; x++) {
            if (!is_on_outline(f, x, y))
                continue;
            vec3 color = clamp(tonemap((int)operator_, load3(pixel_at(f, x, y))), vec3(0.0f), vec3(1.0f));
            count++;
            hidden += max3(abs(srgb_from_linear(color) - behind)) < 16.0f / 255.0f;
        }
    return count >= LEAST_PIXELS && 4 * hidden > 3 * count;
}
