/* film_image.c - see film_image.h. */
#include "film/film_image.h"

#include <stdatomic.h>

#include "base/parallel.h"
#include "base/result.h"
#include "image/srgb.h"

enum { GRAIN = 16384 }; /* pixels; about 0.1 ms */

typedef struct conversion {
    const float *pixels; /* RGBA, premultiplied */
    image *image;
    atomic_bool is_transparent;
    srgb_tables tables;
} conversion;

static float clamp_unit(float x) /* NaN becomes 0 */
{
    return x > 0.0f ? (x < 1.0f ? x : 1.0f) : 0.0f;
}

static uint16_t encode_u16(float linear)
{
    return (uint16_t)(srgb_encode((double)clamp_unit(linear)) * 65535.0 + 0.5);
}

/* Integer code of an opacity, 0 to largest. */
static uint32_t quantize(float opacity, float largest)
{
    return (uint32_t)(clamp_unit(opacity) * largest + 0.5f);
}

/* ---- with alpha ---- */

static void find_transparent(void *context, size_t begin, size_t end)
{
    conversion *c = context;
    float largest = c->image->type == IMAGE_U16 ? 65535.0f : 255.0f;
    for (size_t i = begin; i < end; i++)
        if (quantize(c->pixels[4 * i + 3], largest) < (uint32_t)largest) {
            atomic_store_explicit(&c->is_transparent, true, memory_order_relaxed);
            return;
        }
}

/* Straight alpha: the color over the exact opacity, 0 where opacity is 0. */
static void convert_straight(void *context, size_t begin, size_t end)
{
    conversion *c = context;
    uint8_t *to_8 = (uint8_t *)c->image->pixels + 4 * begin;
    uint16_t *to_16 = (uint16_t *)c->image->pixels + 4 * begin;
    for (size_t i = begin; i < end; i++, to_8 += 4, to_16 += 4) {
        const float *pixel = c->pixels + 4 * i;
        float opacity = clamp_unit(pixel[3]);
        if (c->image->type == IMAGE_U8) {
            uint32_t alpha = quantize(opacity, 255.0f);
            float scale = alpha ? 1.0f / opacity : 0.0f;
            for (int k = 0; k < 3; k++)
                to_8[k] = srgb_encode_u8(&c->tables, pixel[k] * scale);
            to_8[3] = (uint8_t)alpha;
        } else {
            uint32_t alpha = quantize(opacity, 65535.0f);
            float scale = alpha ? 1.0f / opacity : 0.0f;
            for (int k = 0; k < 3; k++)
                to_16[k] = encode_u16(pixel[k] * scale);
            to_16[3] = (uint16_t)alpha;
        }
    }
}

/* ---- without ---- */

static void convert_opaque(void *context, size_t begin, size_t end)
{
    conversion *c = context;
    uint8_t *to_8 = (uint8_t *)c->image->pixels + 3 * begin;
    uint16_t *to_16 = (uint16_t *)c->image->pixels + 3 * begin;
    for (size_t i = begin; i < end; i++, to_8 += 3, to_16 += 3) {
        const float *pixel = c->pixels + 4 * i;
        float white = 1.0f - clamp_unit(pixel[3]);
        for (int k = 0; k < 3; k++)
            if (c->image->type == IMAGE_U8)
                to_8[k] = srgb_encode_u8(&c->tables, pixel[k] + white);
            else
                to_16[k] = encode_u16(pixel[k] + white);
    }
}

static void convert_linear(void *context, size_t begin, size_t end)
{
    conversion *c = context;
    float *to = (float *)c->image->pixels + 3 * begin;
    for (size_t i = begin; i < end; i++, to += 3)
        for (int k = 0; k < 3; k++)
            to[k] = c->pixels[4 * i + (size_t)k];
}

facet_result film_to_display_image(const film *f, image_type type, bool has_alpha,
                                   const facet_allocator *allocator, uint32_t thread_count, image *out,
                                   facet_error *error)
{
    *out = (image){0};
    size_t pixel_count = (size_t)f->width * f->height;
    image made = {.type = type};
    conversion c = {.pixels = f->layers[0].pixels, .image = &made};
    if (has_alpha)
        parallel_for(thread_count, pixel_count, GRAIN, find_transparent, &c);
    has_alpha = atomic_load(&c.is_transparent);
    TRY(image_create(allocator, f->width, f->height, has_alpha ? 4 : 3, type, &made, error));
    made.is_srgb = true;
    srgb_tables_prepare(&c.tables);
    parallel_for(thread_count, pixel_count, GRAIN, has_alpha ? convert_straight : convert_opaque, &c);
    *out = made;
    return FACET_OK;
}

facet_result film_to_linear_image(const film *f, const facet_allocator *allocator, uint32_t thread_count,
                                  image *out, facet_error *error)
{
    *out = (image){0};
    image made;
    TRY(image_create(allocator, f->width, f->height, 3, IMAGE_F32, &made, error));
    conversion c = {.pixels = f->layers[0].pixels, .image = &made};
    parallel_for(thread_count, (size_t)f->width * f->height, GRAIN, convert_linear, &c);
    *out = made;
    return FACET_OK;
}
