/* id_colors.c - IDs as colors, for files that hold nothing else. See facet.h. */
#include <string.h>

#include "api/api.h"
#include "base/memory.h"
#include "base/result.h"
#include "image/srgb.h"

/* Odd, so that no two numbers below 2^24 have one color; and far from them where they follow each other. */
static const uint32_t STRIDE = 0x3779b1;

static bool is_id_layer(const char *name)
{
    return strcmp(name, "object") == 0 || strcmp(name, "material") == 0 || strcmp(name, "instance") == 0;
}

static void color_pixel(float number, float out[4])
{
    uint32_t color = (uint32_t)number * STRIDE & 0xffffff;
    for (int c = 0; c < 3; c++)
        out[c] = (float)srgb_decode((double)(color >> (16 - 8 * c) & 255) / 255.0);
    out[3] = 1.0f;
}

facet_result facet_image_create_id_colors(const facet_image *picture, const char *layer,
                                          const facet_allocator *allocator, facet_image **out,
                                          facet_error *error)
{
    film *from = (film *)(uintptr_t)&picture->film; /* which is only read */
    const film_layer *ids = is_id_layer(layer) ? film_find(from, layer) : NULL,
                     *instances = film_find(from, "instance");
    *out = NULL;
    if (!ids || !instances)
        return fail(error, FACET_ERROR_ARGUMENT,
                    "image: \"%s\" and instance must be layers of it, and one of object, material, instance",
                    layer);
    facet_image *made = mem_zalloc(allocator, 1, sizeof *made);
    if (!made)
        return fail_memory(error, "image", sizeof *made);
    facet_result result = film_create(allocator, from->width, from->height, 0, &made->film, error);
    if (result != FACET_OK) {
        mem_free(made);
        return result;
    }
    for (size_t i = 0; i < (size_t)from->width * from->height; i++)
        if (instances->pixels[i] > 0.0f)
            color_pixel(ids->pixels[i], made->film.layers[0].pixels + 4 * i);
    made->stats = picture->stats;
    *out = made;
    return FACET_OK;
}
