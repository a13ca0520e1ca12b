/* view_image.c - see view_image.h. */
#include "view/view_image.h"

#include "base/memory.h"
#include "base/result.h"
#include "image/srgb.h"

facet_result view_image_create(const facet_image_view *v, const facet_allocator *allocator, view_image *out,
                               facet_error *error)
{
    size_t count = (size_t)v->width * v->height;
    srgb_tables tables;
    *out = (view_image){v->width, v->height, mem_alloc(allocator, count, 4)};
    if (!out->pixels)
        return fail_memory(error, "image", count * 4);
    srgb_tables_prepare(&tables);
    unsigned char *to = out->pixels;
    for (uint32_t y = 0; y < v->height; y++) {
        const float *from = (const float *)(const void *)((const char *)v->pixels + y * v->row_stride_bytes);
        for (uint32_t x = 0; x < v->width; x++, from += 4, to += 4) {
            float opacity = from[3] < 1.0f ? from[3] : 1.0f;
            float scale = opacity > 0.0f ? 1.0f / opacity : 0.0f;
            for (int c = 0; c < 3; c++)
                to[c] = srgb_encode_u8(&tables, from[c] * scale);
            to[3] = (unsigned char)(opacity > 0.0f ? opacity * 255.0f + 0.5f : 0.0f);
        }
    }
    return FACET_OK;
}

void view_image_destroy(view_image *p)
{
    mem_free(p->pixels);
    *p = (view_image){0};
}

float *view_image_to_linear(const view_image *p, const facet_allocator *allocator)
{
    size_t count = (size_t)p->width * p->height;
    srgb_tables tables;
    float *pixels = mem_alloc(allocator, count, 4 * sizeof *pixels);
    if (!pixels)
        return NULL;
    srgb_tables_prepare(&tables);
    for (size_t i = 0; i < count; i++) {
        float opacity = (float)p->pixels[4 * i + 3] / 255.0f;
        for (int c = 0; c < 3; c++)
            pixels[4 * i + (size_t)c] = opacity * tables.decoded[p->pixels[4 * i + (size_t)c]];
        pixels[4 * i + 3] = opacity;
    }
    return pixels;
}
