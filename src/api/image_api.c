/* image_api.c - images of facet/image.h: layers, encoding, saving. */
#include "api/api.h"

#include <string.h>
#include <strings.h>

#include "base/file.h"
#include "base/memory.h"
#include "base/result.h"
#include "film/film_channels.h"
#include "film/film_image.h"
#include "image/image.h"
#include "image/srgb.h"
#include "report/report.h"

uint32_t facet_image_get_layer_count(const facet_image *source)
{
    return source->film.layer_count;
}

facet_image_view facet_image_get_layer(const facet_image *source, uint32_t layer)
{
    const film_layer *l = &source->film.layers[layer];
    return (facet_image_view){.name = l->name,
                              .width = source->film.width,
                              .height = source->film.height,
                              .channel_count = l->channel_count,
                              .pixels = l->pixels,
                              .row_stride_bytes =
                                  (size_t)source->film.width * l->channel_count * sizeof(float)};
}

void facet_image_destroy(facet_image *owned)
{
    if (!owned)
        return;
    film_destroy(&owned->film);
    if (owned->texels)
        image_destroy(owned->texels);
    mem_free(owned->texels);
    mem_free(owned);
}

facet_result facet_image_create_sheet(const facet_image *const *images, uint32_t count,
                                      const facet_contact_sheet_desc *desc, facet_image **sheet,
                                      facet_error *error)
{
    const facet_contact_sheet_desc defaults = {0};
    desc = desc ? desc : &defaults;
    *sheet = NULL;
    facet_image *made = mem_zalloc(&desc->allocator, 1, sizeof *made);
    const film **films = mem_alloc(&desc->allocator, count ? count : 1, sizeof *films);
    facet_result result = FACET_OK;
    if (!made || !films)
        result = fail_memory(error, "sheet", count * sizeof *films);
    for (uint32_t i = 0; i < count && films; i++) {
        films[i] = &images[i]->film;
        if (images[i]->texels)
            result = fail(error, FACET_ERROR_ARGUMENT, "sheet: a compact image is for comparisons only");
    }
    if (result == FACET_OK)
        result = contact_sheet_create(films, count, desc, &made->film, error);
    mem_free(films);
    if (result != FACET_OK)
        mem_free(made);
    else
        *sheet = made;
    return result;
}

/* ---- formats ---- */

typedef struct format_name {
    const char *extension;
    facet_image_format format;
} format_name;

static const format_name format_names[] = {
    {"png", FACET_IMAGE_FORMAT_PNG},   {"jpg", FACET_IMAGE_FORMAT_JPEG}, {"jpeg", FACET_IMAGE_FORMAT_JPEG},
    {"webp", FACET_IMAGE_FORMAT_WEBP}, {"exr", FACET_IMAGE_FORMAT_EXR},  {"hdr", FACET_IMAGE_FORMAT_HDR},
    {"pfm", FACET_IMAGE_FORMAT_PFM},
};

static facet_image_format format_from_name(const char *path)
{
    const char *extension = path_extension(path);
    for (size_t i = 0; i < sizeof format_names / sizeof *format_names; i++)
        if (strcasecmp(extension, format_names[i].extension) == 0)
            return format_names[i].format;
    return FACET_IMAGE_FORMAT_FROM_NAME;
}

static image_codec codec_of(facet_image_format format)
{
    switch (format) {
    case FACET_IMAGE_FORMAT_JPEG:
        return IMAGE_CODEC_JPEG;
    case FACET_IMAGE_FORMAT_WEBP:
        return IMAGE_CODEC_WEBP;
    case FACET_IMAGE_FORMAT_HDR:
        return IMAGE_CODEC_HDR;
    case FACET_IMAGE_FORMAT_PFM:
        return IMAGE_CODEC_PFM;
    default:
        return IMAGE_CODEC_PNG;
    }
}

static facet_result encode_exr(const film *f, bool as_half, const image_encode_desc *desc,
                               unsigned char **bytes, size_t *size, facet_error *error)
{
    image_layer layers[FILM_MAX_LAYERS];
    image_text texts[FILM_MAX_TEXTS + 1];
    image_encode_desc with_texts = *desc;
    with_texts.texts = texts;
    with_texts.text_count = f->text_count;
    for (uint32_t i = 0; i < f->text_count; i++)
        texts[i] = (image_text){f->texts[i].name, f->texts[i].value};
    if (desc->text_count) /* the tag */
        texts[with_texts.text_count++] = desc->texts[0];
    for (uint32_t i = 0; i < f->layer_count; i++)
        layers[i] = film_layer_to_image(&f->layers[i], f->width);
    return image_encode_exr(f->width, f->height, layers, f->layer_count, as_half, &with_texts, bytes, size,
                            error);
}

static facet_result encode_raw(const film *f, const image_encode_desc *desc, unsigned char **bytes,
                               size_t *size, facet_error *error)
{
    image converted = {0};
    image rgba = {0};
    facet_result result =
        film_to_display_image(f, IMAGE_U8, true, &desc->allocator, desc->thread_count, &converted, error);
    if (result == FACET_OK) /* no alpha channel where all pixels are opaque */
        result =
            image_convert(&converted, &desc->allocator, desc->thread_count, 4, IMAGE_U8, true, &rgba, error);
    image_destroy(&converted);
    *bytes = rgba.pixels;
    *size = result == FACET_OK ? image_row_size(&rgba) * rgba.height : 0;
    return result;
}

facet_result facet_image_encode(const facet_image *source, const facet_image_save_desc *desc,
                                unsigned char **bytes, size_t *size, facet_error *error)
{
    static const facet_image_save_desc defaults = {.format = FACET_IMAGE_FORMAT_FROM_NAME};
    *bytes = NULL;
    *size = 0;
    desc = desc ? desc : &defaults;
    const film *f = &source->film;
    if (source->texels)
        return fail(error, FACET_ERROR_ARGUMENT,
                    "image: a compact image is for comparisons and cannot be encoded");
    if (source->is_part && desc->format != FACET_IMAGE_FORMAT_EXR &&
        desc->format != FACET_IMAGE_FORMAT_EXR_FLOAT)
        return fail(error, FACET_ERROR_ARGUMENT, "image: a part of an image is kept in an OpenEXR file");
    image_encode_desc encode = {.allocator = desc->allocator,
                                .thread_count =
                                    desc->thread_count ? desc->thread_count : facet_thread_count(),
                                .quality = desc->jpeg_quality,
                                .compression = desc->png_compression,
                                .is_stored = source->is_part};
    const image_text tag = {"facet-tag", desc->tag};
    if (desc->tag) {
        encode.texts = &tag;
        encode.text_count = 1;
    }
    image converted = {0};
    facet_result result;
    switch (desc->format) {
    case FACET_IMAGE_FORMAT_RAW:
        return encode_raw(f, &encode, bytes, size, error);
    case FACET_IMAGE_FORMAT_EXR:
    case FACET_IMAGE_FORMAT_EXR_FLOAT:
        return encode_exr(f, desc->format == FACET_IMAGE_FORMAT_EXR && !source->is_part, &encode, bytes, size,
                          error);
    case FACET_IMAGE_FORMAT_HDR:
    case FACET_IMAGE_FORMAT_PFM:
        result = film_to_linear_image(f, &encode.allocator, encode.thread_count, &converted, error);
        break;
    case FACET_IMAGE_FORMAT_PNG:
    case FACET_IMAGE_FORMAT_PNG16:
    case FACET_IMAGE_FORMAT_WEBP:
    case FACET_IMAGE_FORMAT_JPEG:
        result = film_to_display_image(f, desc->format == FACET_IMAGE_FORMAT_PNG16 ? IMAGE_U16 : IMAGE_U8,
                                       desc->format != FACET_IMAGE_FORMAT_JPEG, &encode.allocator,
                                       encode.thread_count, &converted, error);
        break;
    default:
        return fail(error, FACET_ERROR_ARGUMENT, "image: a file format must be named to encode it in memory");
    }
    if (result == FACET_OK)
        result = image_encode(&converted, codec_of(desc->format), &encode, bytes, size, error);
    image_destroy(&converted);
    return result;
}

void facet_bytes_destroy(unsigned char *bytes)
{
    mem_free(bytes);
}

facet_result facet_bytes_save(const void *bytes, size_t size, const char *path, facet_error *error)
{
    return file_write(path, bytes, size, error);
}

facet_result facet_image_save(const facet_image *source, const char *path, const facet_image_save_desc *desc,
                              facet_error *error)
{
    facet_image_save_desc resolved = desc ? *desc : (facet_image_save_desc){0};
    if (resolved.format == FACET_IMAGE_FORMAT_FROM_NAME)
        resolved.format = format_from_name(path);
    if (resolved.format == FACET_IMAGE_FORMAT_FROM_NAME)
        return fail(error, FACET_ERROR_ARGUMENT,
                    "%s: unknown image extension; expected .png, .jpg, .webp, .exr, .hdr or .pfm", path);
    unsigned char *bytes;
    size_t size;
    facet_result result = facet_image_encode(source, &resolved, &bytes, &size, error);
    if (result == FACET_OK)
        result = file_write(path, bytes, size, error);
    facet_bytes_destroy(bytes);
    return result;
}

/* ---- IDs as colors ---- */

/* Odd, so that numbers below 2^24 have distinct colors, and far apart for successive ones. */
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

static const film_layer *find_layer(const film *f, const char *name)
{
    for (uint32_t i = 0; i < f->layer_count; i++)
        if (strcmp(f->layers[i].name, name) == 0)
            return &f->layers[i];
    return NULL;
}

facet_result facet_image_create_id_colors(const facet_image *source, const char *layer,
                                          const facet_allocator *allocator, facet_image **out,
                                          facet_error *error)
{
    const film *from = &source->film;
    const film_layer *ids = is_id_layer(layer) ? find_layer(from, layer) : NULL,
                     *instances = find_layer(from, "instance");
    *out = NULL;
    if (!ids || !instances)
        return fail(error, FACET_ERROR_ARGUMENT,
                    "image: \"%s\" is no ID layer of this image (object, material, instance), or its layer "
                    "instance is missing",
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
    made->stats = source->stats;
    *out = made;
    return FACET_OK;
}
