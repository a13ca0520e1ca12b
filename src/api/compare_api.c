/* compare_api.c - comparing pictures. */
#include "api/api.h"

#include "base/memory.h"
#include "base/result.h"
#include "compare/compare.h"

static compare_picture picture_of(const facet_image *picture)
{
    const film *f = &picture->film;
    return (compare_picture){f->layers[0].pixels, f->width, f->height, picture->is_for_display};
}

facet_result facet_compare(const facet_image *a, const facet_image *b, const facet_compare_desc *desc,
                           facet_comparison *out, facet_image **difference, facet_error *error)
{
    const facet_compare_desc defaults = {0};
    desc = desc ? desc : &defaults;
    if (difference)
        *difference = NULL;
    const compare_picture first = picture_of(a), second = picture_of(b);
    compare_picture mask = {0};
    if (desc->mask)
        mask = picture_of(desc->mask);
    compare_difference made = {0};
    facet_result result = compare_pictures(&first, &second, desc->mask ? &mask : NULL, desc, out,
                                           difference ? &made : NULL, error);
    if (result != FACET_OK || !difference)
        return result;
    const facet_image_view view = {
        .width = made.width, .height = made.height, .channel_count = 4, .pixels = made.rgba};
    result = facet_image_create(&view, &desc->allocator, difference, error);
    mem_free(made.rgba);
    if (result != FACET_OK)
        *out = (facet_comparison){0};
    return result;
}
