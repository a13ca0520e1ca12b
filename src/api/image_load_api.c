/* image_load_api.c - images of facet.h that no renderer made: from files, from pixels, from comparisons. */
#include "api/api.h"

#include <string.h>

#include "base/file.h"
#include "base/memory.h"
#include "base/parallel.h"
#include "base/result.h"
#include "compare/compare.h"
#include "image/image.h"

enum { GRAIN = 16384 }; /* pixels */

/* ---- pixels to images ---- */

/* Makes an image of rgba (F32, 4 channels) or, compact, of texels of any type; they are taken, also on
 * failure. */
static facet_result take_pixels(image *rgba, bool is_compact, const facet_allocator *allocator,
                                bool is_for_display, facet_image **out, facet_error *error)
{
    facet_image *made = mem_zalloc(allocator, 1, sizeof *made);
    if (made && is_compact)
        made->texels = mem_zalloc(allocator, 1, sizeof *made->texels);
    facet_result result =
        made && (!is_compact || made->texels) ? FACET_OK : fail_memory(error, "image", sizeof *made);
    if (result == FACET_OK) /* for its layer's names; the pixels are there already */
        result = film_create(allocator, 1, 1, 0, &made->film, error);
    if (result != FACET_OK) {
        if (made)
            mem_free(made->texels);
        mem_free(made);
        image_destroy(rgba);
        return result;
    }
    mem_free(made->film.layers[0].pixels);
    made->film.layers[0].pixels = is_compact ? NULL : rgba->pixels;
    made->film.width = rgba->width;
    made->film.height = rgba->height;
    if (is_compact)
        *made->texels = *rgba;
    made->is_for_display = is_for_display;
    *rgba = (image){0};
    *out = made;
    return FACET_OK;
}

static void premultiply(void *context, size_t begin, size_t end)
{
    float *pixel = (float *)((const image *)context)->pixels + 4 * begin;
    for (size_t i = begin; i < end; i++, pixel += 4)
        for (int k = 0; k < 3; k++)
            pixel[k] *= pixel[3];
}

facet_result facet_image_create(const facet_image_view *pixels, const facet_allocator *allocator,
                                facet_image **out, facet_error *error)
{
    *out = NULL;
    const uint32_t channels = pixels->channel_count;
    if (channels != 1 && channels != 3 && channels != 4)
        return fail(error, FACET_ERROR_ARGUMENT, "image: %u channels; 1, 3 or 4 expected", channels);
    image rgba;
    facet_result result = image_create(allocator, pixels->width, pixels->height, 4, IMAGE_F32, &rgba, error);
    if (result != FACET_OK)
        return result;
    const size_t stride = pixels->row_stride_bytes ? pixels->row_stride_bytes
                                                   : (size_t)pixels->width * channels * sizeof(float);
    float *to = rgba.pixels;
    for (uint32_t y = 0; y < pixels->height; y++) {
        const float *from = (const float *)(const void *)((const char *)pixels->pixels + y * stride);
        for (uint32_t x = 0; x < pixels->width; x++, to += 4, from += channels) {
            for (uint32_t k = 0; k < 3; k++)
                to[k] = from[channels == 1 ? 0 : k];
            to[3] = channels == 4 ? from[3] : 1.0f;
        }
    }
    return take_pixels(&rgba, false, allocator, false, out, error);
}

bool facet_image_is_for_display(const facet_image *source)
{
    return source->is_for_display;
}

/* ---- files ---- */

/* A layer of two channels is no grey with opacity. */
static facet_result expand_pair(const image *pair, const facet_allocator *allocator, image *rgba,
                                facet_error *error)
{
    facet_result result = image_create(allocator, pair->width, pair->height, 4, IMAGE_F32, rgba, error);
    const float *from = pair->pixels;
    float *to = rgba->pixels;
    for (size_t i = 0; result == FACET_OK && i < (size_t)pair->width * pair->height;
         i++, from += 2, to += 4) {
        to[0] = from[0];
        to[1] = from[1];
        to[2] = 0.0f;
        to[3] = 1.0f;
    }
    return result;
}

facet_result facet_image_load_memory(const void *bytes, size_t size, const char *name,
                                     const facet_image_load_desc *desc, facet_image **out, facet_error *error)
{
    const facet_image_load_desc defaults = {0};
    desc = desc ? desc : &defaults;
    *out = NULL;
    const uint32_t thread_count = desc->thread_count ? desc->thread_count : facet_thread_count();
    image_note note;
    const image_decode_desc decode = {.allocator = desc->allocator,
                                      .thread_count = thread_count,
                                      .max_size = desc->max_size,
                                      .layer = desc->layer,
                                      .keeps_nonfinite = true,
                                      .note = &note};
    image decoded = {0}, rgba = {0};
    facet_result result = image_decode(bytes, size, name, &decode, &decoded, error);
    if (result != FACET_OK)
        return result;
    image_note_log(&note, name, &desc->log);
    const bool is_associated = image_codec_detect(bytes, size) == IMAGE_CODEC_EXR; /* the format says so */
    const bool is_straight = decoded.channel_count % 2 == 0 && !is_associated;
    const bool is_for_display = decoded.is_srgb;
    const bool is_pair = desc->layer && decoded.channel_count == 2; /* not grey with opacity */
    if (desc->is_compact && !is_pair) {
        result = take_pixels(&decoded, true, &desc->allocator, is_for_display, out, error);
        if (result == FACET_OK)
            (*out)->is_straight = is_straight;
        return result;
    }
    if (decoded.type == IMAGE_F32 && decoded.channel_count == 4 && !decoded.is_srgb) {
        rgba = decoded;
        decoded = (image){0};
    } else if (is_pair) {
        result = expand_pair(&decoded, &desc->allocator, &rgba, error);
        image_destroy(&decoded);
    } else {
        result = image_convert(&decoded, &desc->allocator, thread_count, 4, IMAGE_F32, false, &rgba, error);
        image_destroy(&decoded);
    }
    if (result != FACET_OK)
        return result;
    if (is_straight)
        parallel_for(thread_count, (size_t)rgba.width * rgba.height, GRAIN, premultiply, &rgba);
    return take_pixels(&rgba, false, &desc->allocator, is_for_display, out, error);
}

facet_result facet_image_load(const char *path, const facet_image_load_desc *desc, facet_image **out,
                              facet_error *error)
{
    const facet_image_load_desc defaults = {0};
    desc = desc ? desc : &defaults;
    *out = NULL;
    file_bytes file = {0};
    facet_result result = file_open(path, file_limit(desc->max_file_bytes), &desc->allocator, &file, error);
    if (result == FACET_OK)
        result = facet_image_load_memory(file.data, file.size, path, desc, out, error);
    file_close(&file);
    return result;
}

/* ---- comparisons ---- */

/* An image to compare; rgba is filled in where the pixels are floats. */
static compare_image view_image(const facet_image *i, image *rgba)
{
    *rgba = (image){.pixels = i->film.layers[0].pixels,
                    .width = i->film.width,
                    .height = i->film.height,
                    .channel_count = 4,
                    .type = IMAGE_F32};
    return (compare_image){.texels = i->texels ? i->texels : rgba,
                           .is_straight = i->is_straight,
                           .is_display = i->is_for_display};
}

facet_result facet_compare(const facet_image *a, const facet_image *b, const facet_compare_desc *desc,
                           facet_comparison *out, facet_image **difference, facet_error *error)
{
    const facet_compare_desc defaults = {0};
    desc = desc ? desc : &defaults;
    if (difference)
        *difference = NULL;
    image rgba[3];
    const compare_image first = view_image(a, &rgba[0]), second = view_image(b, &rgba[1]);
    compare_image mask = {0};
    if (desc->mask)
        mask = view_image(desc->mask, &rgba[2]);
    image made = {0};
    TRY(compare_images(&first, &second, desc->mask ? &mask : NULL, desc, out, difference ? &made : NULL,
                       error));
    if (!difference)
        return FACET_OK;
    facet_result result = take_pixels(&made, false, &desc->allocator, false, difference, error);
    if (result != FACET_OK)
        *out = (facet_comparison){0};
    return result;
}
